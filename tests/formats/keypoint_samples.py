"""Output of each pose estimator for a person in front of a camera, and TRC files."""

from __future__ import annotations

import io
import json
from pathlib import Path

import numpy as np

import kineme
from kineme.formats.keypoints.detectors import NAMES as COCO
from kineme.formats.keypoints.detectors import OPENPOSE_LAYOUTS as OPENPOSE
from kineme.formats.keypoints.mediapipe import NAMES as MEDIAPIPE

_SPOTS = {
    "nose": (0, 1.6), "neck": (0, 1.45), "head": (0, 1.65), "chest": (0, 1.2),
    "eye": (0.03, 1.63), "ear": (0.07, 1.62), "mouth": (0.02, 1.55), "shoulder": (0.2, 1.4),
    "elbow": (0.3, 1.15), "wrist": (0.35, 0.9), "pinky": (0.36, 0.8), "index": (0.35, 0.8),
    "thumb": (0.34, 0.82), "midhip": (0, 0.95), "hip": (0.1, 0.95), "knee": (0.12, 0.5),
    "ankle": (0.12, 0.1), "heel": (0.12, 0.02), "foot": (0.15, 0.02), "toe": (0.15, 0.02),
}  # fmt: skip


def make_person(names: tuple[str, ...], frames: int = 30) -> np.ndarray:
    """(frames, keypoints, 3): metres, y up, x to the left of the person, the left wrist waving."""
    points = np.zeros((frames, len(names), 3))
    for i, name in enumerate(names):
        low = name.lower()
        keys = [key for key in _SPOTS if key in low]
        x, y = _SPOTS["midhip" if "midhip" in low else "foot" if "foot" in low else keys[0]]
        right = low.startswith(("r", "mouth_r"))
        points[:, i] = (-x if right else x, y, 0)
        if low in ("lwrist", "left_wrist"):
            points[:, i, 1] += 0.4 * np.sin(np.linspace(0, 6 * np.pi, frames))
    points[:, :, 0] += np.linspace(0, 0.3, frames)[:, None]
    return points


def project(points: np.ndarray, x: float = 500.0) -> np.ndarray:
    """(frames, keypoints, 2): as a camera in front sees them, 300 pixels to the metre."""
    return np.stack([x + 300 * points[..., 0], 900 - 300 * points[..., 1]], axis=-1)


def make_frame(*people: np.ndarray, sure: float = 0.8, key: str = "pose_keypoints_2d") -> dict:
    """One frame of OpenPose's with these people, (keypoints, 2 or 3) each."""
    found = []
    for points in people:
        rows = np.column_stack([points, np.full(len(points), sure)])
        found.append({"person_id": [-1], key: rows.ravel().tolist(), "face_keypoints_2d": []})
    return {"version": 1.3, "people": found}


def make_openpose(count: int = 25, frames: int = 30) -> list[dict]:
    return [make_frame(points) for points in project(make_person(OPENPOSE[count], frames))]


def make_coco(frames: int = 30, *, x: float = 500.0, **more) -> list[dict]:
    points = project(make_person(COCO, frames), x)
    return [
        {
            "image_id": i + 1,
            "category_id": 1,
            "keypoints": np.column_stack([row, np.full(17, 0.9)]).ravel().tolist(),
            **more,
        }
        for i, row in enumerate(points)
    ]


def make_mmpose(
    names: tuple[str, ...] = COCO, *, named: bool = True, xs: tuple[float, ...] = (500.0,), **more
) -> dict | list:
    """A video of people at these places; without its facts where it is not ``named``."""
    points = [project(make_person(names), x) for x in xs]
    frames = [
        {
            "frame_id": i + 1,
            "instances": [
                {"keypoints": each[i].tolist(), "keypoint_scores": [0.9] * len(names), **more}
                for each in points
            ],
        }
        for i in range(len(points[0]))
    ]
    facts = {"keypoint_id2name": {str(i): name for i, name in enumerate(names)}}
    return {"meta_info": facts, "instance_info": frames} if named else frames


def make_world_landmarks(frames: int = 30) -> np.ndarray:
    """(frames, 33, 3): metres from the hips' middle, y down, z away from the camera."""
    points = make_person(MEDIAPIPE, frames)
    hips = [MEDIAPIPE.index("left_hip"), MEDIAPIPE.index("right_hip")]
    return (points - points[:, hips].mean(axis=1, keepdims=True)) * (1, -1, -1)


def make_image_landmarks(frames: int = 30) -> np.ndarray:
    """(frames, 33, 3): shares of an image of 1000 x 1000 pixels."""
    points = make_person(MEDIAPIPE, frames)
    return np.concatenate([project(points) / 1000, 0.3 * points[..., 2:]], axis=2)


def to_marks(pose: np.ndarray, visibility: float = 0.99) -> list[dict]:
    return [{"x": x, "y": y, "z": z, "visibility": visibility} for x, y, z in pose.tolist()]


def to_sleap_csv(tracks: dict[str, np.ndarray], nodes: tuple[str, ...]) -> str:
    head = ["track", "frame_idx", "instance.score"]
    head += [f"{node}.{field}" for node in nodes for field in ("x", "y", "score")]
    lines = [",".join(head)]
    for track, points in tracks.items():
        for i, row in enumerate(points):
            cells = np.column_stack([row, np.full(len(row), 0.9)]).ravel()
            lines.append(",".join([track, str(i), "0.9", *map(str, cells)]))
    return "\n".join(lines) + "\n"


def to_sleap_h5(tracks: np.ndarray, nodes: tuple[str, ...], names: list[str], new: bool) -> bytes:
    """An analysis file; ``tracks`` is (tracks, frames, nodes, 2)."""
    import h5py

    order = (1, 0, 2, 3) if new else (0, 3, 2, 1)
    scores = np.full(tracks.shape[:3], 0.9).transpose((1, 0, 2) if new else (0, 2, 1))
    file = io.BytesIO()
    with h5py.File(file, "w") as out:
        out.create_dataset("tracks", data=tracks.transpose(order), compression="gzip")
        out["point_scores"] = scores
        out["node_names"] = np.array([node.encode() for node in nodes])
        out["track_names"] = np.array([name.encode() for name in names])
    return file.getvalue()


def as_json(data: object) -> bytes:
    return json.dumps(data).encode()


def write_trc(
    path: Path, points: np.ndarray, names: list[str], unit: str = "mm", fps: float = 30.0
) -> Path:
    """Write points (frames, names, 3), which are in this unit, as a TRC file."""
    head = [
        f"PathFileType\t4\t(X/Y/Z)\t{path.name}",
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits",
        f"{fps:g}\t{fps:g}\t{len(points)}\t{len(names)}\t{unit}",
        "Frame#\tTime\t" + "\t\t\t".join(names),
        "\t\t" + "\t".join(f"{axis}{i + 1}" for i in range(len(names)) for axis in "XYZ"),
        "",
    ]
    rows = (
        "\t".join([f"{i + 1}", f"{i / fps:.4f}", *(f"{v:.5f}" for v in frame.ravel())])
        for i, frame in enumerate(points)
    )
    path.write_text("\n".join([*head, *rows]))
    return path


def measure_wave(motion: kineme.Motion, wrist: str = "left_wrist") -> float:
    """Metres that the wrist goes up and down: 0.8 in every sample."""
    return float(np.ptp(motion.positions[:, motion.joint(wrist), 1]))


def is_standing(motion: kineme.Motion) -> bool:
    """Upright, of human height, with the left on the left; pose features can be had."""
    at = dict(zip(motion.skeleton.names, motion.positions[0], strict=True))
    upright = at["head"][1] - at["left_ankle"][1]
    kineme.pose_features(motion)
    return bool(1.0 < upright < 1.9 and at["left_hip"][0] > at["right_hip"][0])


def check_sample(motion: kineme.Motion, program: str) -> None:
    """It is the whole sample: 30 frames of a standing body that waves."""
    assert (motion.provenance.format, motion.n_frames) == (program, 30)
    assert is_standing(motion)
    assert 0.6 < measure_wave(motion) < 1.0
