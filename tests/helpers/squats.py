"""A person who squats, as a pose estimator would see it: poses, tables of them, and videos."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from fractions import Fraction
from pathlib import Path
from types import MappingProxyType

import numpy as np

from kineme.formats.keypoints.mediapipe import NAMES
from kineme.formats.keypoints.poses import NOBODY, make_row_type, write_poses
from kineme.pose import Pose, PoseEstimator

PERIOD_S = 2.0
"""Seconds of a squat."""
STANDING = {  # right, up and towards the camera, from the middle of the hips, in metres
    "nose": (0, 0.65, 0.1), "left_ear": (0.07, 0.65, 0), "right_ear": (-0.07, 0.65, 0),
    "left_shoulder": (0.18, 0.5, 0), "right_shoulder": (-0.18, 0.5, 0),
    "left_elbow": (0.22, 0.22, 0), "right_elbow": (-0.22, 0.22, 0),
    "left_wrist": (0.24, 0, 0), "right_wrist": (-0.24, 0, 0),
    "left_hip": (0.1, 0, 0), "right_hip": (-0.1, 0, 0),
    "left_knee": (0.1, -0.42, 0.02), "right_knee": (-0.1, -0.42, 0.02),
    "left_ankle": (0.1, -0.84, 0), "right_ankle": (-0.1, -0.84, 0),
}  # fmt: skip


def squat(time: float, left: float = 320.0) -> Pose:
    """Return the pose at a second of squats without end, so many pixels from the left."""
    depth = 0.2 * (1 - np.cos(2 * np.pi * time / PERIOD_S))
    metres = np.array([STANDING.get(name, (0, 0.6, 0)) for name in NAMES], float)
    for k, name in enumerate(NAMES):
        if name.endswith("ankle"):
            metres[k, 1] += depth  # nearer to the hips
        elif name.endswith("knee"):
            metres[k] += (0, depth / 2, depth)
        elif name.endswith("wrist"):
            metres[k] += (0, depth, depth)  # the arms go forward
    image = np.column_stack([left + 200 * metres[:, 0], 240 - 200 * metres[:, 1]])
    return Pose(image, np.full(len(NAMES), 0.9), metres)


def write_squats(
    path: Path,
    times: Sequence[float],
    people: Callable[[float], Sequence[Pose]] = lambda time: [squat(time)],
    moves: Mapping[float, float] = MappingProxyType({}),
    **told: object,
) -> Path:
    """Write the table of poses that `estimate_poses` leaves of such people at these times.

    ``moves`` maps times to the seconds before them in which the camera moved.
    """
    rows = []
    for time in times:
        poses = people(time)
        frame = np.zeros(max(1, len(poses)), make_row_type(len(NAMES)))
        frame["time"], frame["person"], frame["metres"] = time, NOBODY, np.nan
        frame["moved"] = moves.get(round(float(time), 3), 0.0)
        for i, pose in enumerate(poses):
            frame[i]["person"], frame[i]["image"] = i, pose.image
            frame[i]["confidence"] = pose.confidence
            if pose.metres is not None:
                frame[i]["metres"] = pose.metres
        rows.append(frame)
    head = {"estimator": "drawn", "keypoints": list(NAMES), "limit": 0.0, "sha256": "", **told}
    write_poses(path, head, np.concatenate(rows))
    return path


def drawn_estimator(
    watch: Callable[[float], None] = lambda time: None,
    people: Callable[[float], Sequence[Pose]] = lambda time: [squat(time)],
) -> PoseEstimator:
    """Return an estimator that sees squats, or these people, in any video.

    ``watch`` is called with the time of each picture.
    """

    @contextmanager
    def start(model: Path | None) -> Iterator[Callable[..., Sequence[Pose]]]:
        def estimate(picture: np.ndarray, time: float) -> Sequence[Pose]:
            watch(time)
            return people(time)

        yield estimate

    return PoseEstimator("drawn", NAMES, "numpy", start)


def write_video(
    path: Path,
    times: Sequence[float],
    *,
    rotation: int = 0,
    size: tuple[int, int] = (64, 48),
    codec: str = "mpeg4",
    pix_fmt: str = "yuv420p",
) -> Path:
    """Write a video whose pictures are red in the upper left quarter, shown at these times."""
    import av

    with av.open(str(path), "w", options={"movflags": "faststart"}) as container:
        stream = container.add_stream(codec, rate=30)
        stream.width, stream.height = size
        stream.pix_fmt = pix_fmt
        stream.codec_context.time_base = Fraction(1, 1000)
        if rotation:
            stream.set_display_rotation(rotation)
        picture = np.zeros((size[1], size[0], 3), np.uint8)
        picture[: size[1] // 2, : size[0] // 2, 0] = 255
        container.start_encoding()  # so that there is a file without frames, too
        for time in times:
            frame = av.VideoFrame.from_ndarray(picture, format="rgb24")
            frame.pts, frame.time_base = round(1000 * time), Fraction(1, 1000)
            container.mux(stream.encode(frame))
        container.mux(stream.encode())
    return path
