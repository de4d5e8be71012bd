"""MediaPipe's landmarks in JSON and CSV, and FreeMoCap's tables of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from keypoint_samples import (
    MEDIAPIPE,
    check_sample,
    is_standing,
    make_image_landmarks,
    make_person,
    make_world_landmarks,
    measure_wave,
    to_marks,
)

from kineme.errors import KinemeWarning, ReadError
from reading import read

LAYOUTS = {
    "list": lambda poses: [to_marks(pose) for pose in poses],
    "rows": lambda poses: [[[*p, 0.9] for p in pose.tolist()] for pose in poses],
    "keys": lambda poses: [{"frame": i, "landmarks": to_marks(p)} for i, p in enumerate(poses)],
    "tasks": lambda poses: [{"landmarks": [to_marks(p)]} for p in poses],
    "camel": lambda poses: {
        "fps": 25,
        "frames": [{"poseWorldLandmarks": to_marks(p)} for p in poses],
    },
    "solutions": lambda poses: [{"pose_landmarks": {"landmark": to_marks(p)}} for p in poses],
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_mediapipe_json(tmp_path: Path, layout: str) -> None:
    motion = read(tmp_path, "a.json", LAYOUTS[layout](make_world_landmarks()), fps=25)
    check_sample(motion, "MediaPipe")
    assert any("world landmarks" in note for note in motion.provenance.notes)
    assert measure_wave(motion) == pytest.approx(0.8, abs=0.05)


def test_other_json_of_landmarks_is_refused(tmp_path: Path) -> None:
    named = [dict(zip(MEDIAPIPE, to_marks(pose), strict=True)) for pose in make_world_landmarks(2)]
    with pytest.raises(ReadError, match="MediaPipe .a list of frames with 33 landmarks"):
        read(tmp_path, "a.json", named, fps=25)


def test_mediapipe_takes_world_landmarks_where_there_are_both(tmp_path: Path) -> None:
    frames = [
        {"pose_landmarks": to_marks(image), "pose_world_landmarks": to_marks(world)}
        for image, world in zip(make_image_landmarks(), make_world_landmarks())
    ]
    frames[4] = {"pose_landmarks": None, "pose_world_landmarks": None}
    motion = read(tmp_path, "a.json", {"frame_rate": 50, "frames": frames})
    assert (motion.fps, motion.n_frames) == (50, 30)
    assert measure_wave(motion) == pytest.approx(0.8, abs=0.05)


def test_mediapipe_landmarks_of_the_image(tmp_path: Path) -> None:
    frames = [{"landmarks": to_marks(pose)} for pose in make_image_landmarks()]
    with pytest.warns(KinemeWarning, match="unknown size, assumed square"):
        motion = read(tmp_path, "a.json", frames, fps=25)
    assert is_standing(motion)
    wide = {"width": 2000, "height": 1000, "frames": frames}
    ratio = np.ptp(read(tmp_path, "a.json", wide, fps=25).positions[0], axis=0)
    assert ratio[0] / ratio[1] == pytest.approx(2 * np.divide(*np.ptp(motion.positions[0], 0)[:2]))


def to_csv(pattern: str, first: int = 0, **more: list) -> str:
    names = [pattern.format(f=f, i=i + first, name=MEDIAPIPE[i]) for i in range(33) for f in "xyzv"]
    lines = [",".join([*more, *names])]
    for row, pose in enumerate(make_world_landmarks()):
        cells = np.column_stack([pose, np.full(33, 0.9)]).ravel()
        lines.append(",".join([*(str(c[row]) for c in more.values()), *map(str, cells)]))
    return "\n".join(lines) + "\n"


def test_mediapipe_frames_without_anybody_keep_their_time(tmp_path: Path) -> None:
    poses = make_world_landmarks(40)
    frames = [to_marks(pose) if not 10 <= i < 20 else [] for i, pose in enumerate(poses)]
    with pytest.warns(KinemeWarning, match="frames 10 to 19"):
        numbered = read(tmp_path, "a.json", frames, fps=25)
    assert (numbered.n_frames, numbered.gaps) == (40, ((10, 20),))
    lines = to_csv("{f}{i}").splitlines()
    nobody = [lines[0], *["," * 131] * 10, *lines[1:]]
    with pytest.warns(KinemeWarning, match="frames 0 to 9"):
        empty = read(tmp_path, "a.csv", "\n".join(f"{i},{x}" for i, x in enumerate(nobody)), fps=25)
    assert (empty.n_frames, empty.gaps) == (40, ((0, 10),))


def test_mediapipe_at_uneven_times_says_so(tmp_path: Path) -> None:
    times = [i / 25 + 0.012 * (i % 3) for i in range(30)]
    motion = read(tmp_path, "a.csv", to_csv("{f}{i}", time=times))
    assert (motion.n_frames, motion.duration) == (30, pytest.approx(times[-1], abs=0.05))
    assert motion.provenance.notes[0].startswith("times are uneven")


@pytest.mark.parametrize(
    ("pattern", "first"),
    [
        ("{f}{i}", 0),
        ("{f}{i}", 1),
        ("landmark_{i}_{f}", 0),
        ("{f}_{i}", 0),
        ("{name}_{f}", 0),
        ("lm{i}.{f}", 0),
    ],
)
def test_mediapipe_csv(tmp_path: Path, pattern: str, first: int) -> None:
    text = to_csv(pattern, first, time=[i / 25 for i in range(30)], **{"class": ["wave"] * 30})
    motion = read(tmp_path, "a.csv", text)
    check_sample(motion, "MediaPipe")
    assert motion.fps == 25
    assert measure_wave(motion) == pytest.approx(0.8, abs=0.05)
    head, rows = text.split("\n", 1)
    german = f"{head.replace(',', ';')}\n{rows.replace(',', ';').replace('.', ',')}"
    assert np.array_equal(read(tmp_path, "b.csv", german).positions, motion.positions)
    text = to_csv(pattern, first, frame=[*range(20), *range(22, 32)])
    assert read(tmp_path, "a.csv", text, fps=25).n_frames == 32


@pytest.mark.parametrize("named", [True, False])
def test_a_row_for_each_landmark_is_refused(tmp_path: Path, named: bool) -> None:
    lines = ["frame,timestamp,landmark,x,y,z"]
    for i, pose in enumerate(make_world_landmarks(4)):
        rows = zip(MEDIAPIPE if named else range(33), pose.tolist(), strict=True)
        lines += [",".join(map(str, [i, i / 25, landmark, *point])) for landmark, point in rows]
    with pytest.raises(ReadError, match=r"alternate \(column 'landmark': (nose|0), "):
        read(tmp_path, "a.csv", "\n".join(lines))


@pytest.mark.parametrize("world", [True, False])
def test_a_body_seen_from_the_side_is_read(tmp_path: Path, world: bool) -> None:
    """MediaPipe hides the far side: its places are estimated all the same."""
    poses = make_world_landmarks() if world else make_image_landmarks()
    key = "pose_world_landmarks" if world else "pose_landmarks"
    far = [i for i, name in enumerate(MEDIAPIPE) if name.startswith("right")]
    frames = [to_marks(pose) for pose in poses]
    for frame in frames:
        for i in far:
            frame[i]["visibility"] = 0.15
    data = {"fps": 30, "width": 1000, "height": 1000, "frames": [{key: f} for f in frames]}
    motion = read(tmp_path, "a.json", data)
    assert not motion.gaps
    assert is_standing(motion)
    sure = read(tmp_path, "a.json", data, confidence=0.5)
    assert any("below confidence 0.5" in note for note in sure.provenance.notes)


def test_frames_of_zeros_are_no_poses(tmp_path: Path) -> None:
    poses = 1000 * make_image_landmarks(60)
    poses[20:40] = 0
    with pytest.warns(KinemeWarning, match="20 frames with zeros only"):
        motion = read(tmp_path, "a.json", {"fps": 30, "frames": [to_marks(pose) for pose in poses]})
    assert motion.gaps == ((20, 40),)
    assert is_standing(motion)


def test_landmarks_of_freemocap_are_in_space(tmp_path: Path) -> None:
    """Without a clock, millimetres, z up: as ``mediapipe_body_3d_xyz.csv``."""
    points = 1000 * make_person(MEDIAPIPE)[:, :, [0, 2, 1]] * (1, -1, 1) + (300, 2000, 50)
    head = ",".join(f"{name}_{axis}" for name in MEDIAPIPE for axis in "xyz")
    rows = [",".join(f"{v:.2f}" for v in frame.ravel()) for frame in points]
    motion = read(tmp_path, "a.csv", "\n".join([head, *rows]), fps=30)
    assert is_standing(motion)
    assert 0.75 < measure_wave(motion) < 0.82
    notes = " ".join(motion.provenance.notes)
    assert "unit mm inferred" in notes
    assert "up axis z inferred" in notes


def test_freemocap_counts_nanoseconds(tmp_path: Path) -> None:
    joints = ("nose", "left_hip", "right_hip", "left_ankle", "right_ankle")
    heights = (1600, 900, 900, 100, 100)
    names = [f"body_{joint}_{axis}" for joint in joints for axis in "xyz"]
    rows = (
        ",".join(
            [f"{1e11 + i * 1e9 / 30:.1f}", *(f"{i % 3},{10 * k},{heights[k]}" for k in range(5))]
        )
        for i in range(60)
    )
    motion = read(tmp_path, "a.csv", "\n".join([",".join(["timestamp", *names]), *rows]))
    assert motion.fps == pytest.approx(30)
    head = motion.positions[0, motion.joint("nose")]
    assert head[1] == pytest.approx(1.6)
