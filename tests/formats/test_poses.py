"""Tables of poses, and the motions read from them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from pyarrow import parquet

import kineme
from kineme.errors import ReadError
from kineme.formats.keypoints.mediapipe import NAMES
from kineme.formats.keypoints.poses import KEY
from kineme.formats.listing import scan_folder
from kineme.pose import Pose
from squats import squat, write_squats

AT_30_HZ = np.arange(300) / 30


def test_a_table_is_a_motion_in_metres(tmp_path: Path) -> None:
    motion = kineme.read(write_squats(tmp_path / "poses.parquet", AT_30_HZ + 0.5))
    assert (motion.fps, motion.n_frames, motion.gaps) == (30.0, 300, ())
    knee = motion.positions[:, motion.joint("left_knee")]
    pelvis = motion.positions[:, motion.joint("pelvis")]
    expected = [squat(time + 0.5).metres[NAMES.index("left_knee")] for time in AT_30_HZ]
    np.testing.assert_allclose((knee - pelvis)[15:-15], expected[15:-15], atol=0.005)


def test_others_can_read_it(tmp_path: Path) -> None:
    table = parquet.read_table(write_squats(tmp_path / "poses.parquet", AT_30_HZ))
    fields = [f"left_knee_{field}" for field in ("u", "v", "x", "y", "z", "confidence")]
    assert {"time", "person", *fields} <= set(table.column_names)
    np.testing.assert_allclose(table["time"], AT_30_HZ)
    assert table["left_knee_confidence"][0].as_py() == pytest.approx(0.9)
    assert table["left_knee_u"][0].as_py() == pytest.approx(340)


def test_variable_rates_keep_their_times(tmp_path: Path) -> None:
    # Half of the frames are lost in the dark, as phones do, and all come a little late or early.
    rng = np.random.default_rng(0)
    times = np.concatenate([np.arange(90) / 30, 3 + np.arange(45) / 15, 6 + np.arange(120) / 30])
    times[1:-1] += rng.uniform(-0.005, 0.005, len(times) - 2)
    motion = kineme.read(write_squats(tmp_path / "a.parquet", times))
    assert motion.fps == pytest.approx(30, rel=0.02)
    assert motion.duration == pytest.approx(10, abs=0.1)
    ankle = motion.positions[:, motion.joint("left_ankle"), 1]
    lowest = 0.1 * np.arange(100)
    expected = [squat(time).metres[NAMES.index("left_ankle"), 1] for time in lowest]
    found = np.interp(lowest, motion.times, ankle - motion.positions[:, 0, 1])
    assert np.corrcoef(expected, found)[0, 1] > 0.99


def test_jitter_is_filtered(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)

    def shaking(time: float) -> list[Pose]:
        pose = squat(time)
        return [Pose(pose.image, pose.confidence, pose.metres + rng.normal(0, 0.02, (33, 3)))]

    motion = kineme.read(write_squats(tmp_path / "a.parquet", AT_30_HZ, shaking))
    knee = motion.positions[:, motion.joint("left_wrist")]
    steps = np.linalg.norm(np.diff(knee, n=2, axis=0), axis=1)
    assert steps.mean() < 0.02  # without a filter .07
    assert np.ptp(knee[:, 2]) > 0.38
    assert any("Butterworth" in note for note in motion.provenance.notes)


def test_without_depth_it_is_the_picture(tmp_path: Path) -> None:
    path = write_squats(
        tmp_path / "a.parquet",
        AT_30_HZ,
        lambda time: [Pose(squat(time).image, squat(time).confidence)],
    )
    motion = kineme.read(path)
    assert motion.positions[..., 2].max() == 0
    head = motion.positions[:, motion.joint("nose"), 1]
    assert (head > motion.positions[:, motion.joint("left_knee"), 1]).all()
    assert "left_knee_z" not in parquet.read_schema(path).names


def test_confidence_leaves_out_keypoints(tmp_path: Path) -> None:
    def hidden(time: float) -> list[Pose]:
        pose = squat(time)
        pose.confidence[NAMES.index("left_elbow")] = 0.1
        return [pose]

    path = write_squats(tmp_path / "a.parquet", AT_30_HZ, hidden)
    assert "left_elbow" in kineme.read(path).skeleton.names
    assert "left_elbow" not in kineme.read(path, confidence=0.5).skeleton.names


@pytest.mark.parametrize("head", [b"{", b"[]", b'{"keypoints": ["a"]}', b"null", None])
def test_damaged_tables_are_refused(tmp_path: Path, head: bytes | None) -> None:
    path = write_squats(tmp_path / "a.parquet", AT_30_HZ)
    table = parquet.read_table(path)
    if head is None:
        sound = json.loads(table.schema.metadata[KEY])
        head = json.dumps(sound | {"camera_moves": [[1.0, "late"]]}).encode()
    parquet.write_table(table.replace_schema_metadata({KEY: head}), path)
    with pytest.raises(ReadError, match="damaged table of poses"):
        kineme.read(path)


def test_a_folder_of_videos(tmp_path: Path) -> None:
    """A video beside a recording of its name shows it, and its poses are read with it."""
    write_squats(tmp_path / "a.mp4.poses.parquet", AT_30_HZ)
    write_squats(tmp_path / "b.parquet", AT_30_HZ)
    for name in ("a.mp4", "b.mp4", "c.MOV"):
        (tmp_path / name).write_bytes(b"\0\0\0\0ftyp")
    found = [path.name for path in scan_folder(tmp_path).recordings]
    assert found == ["a.mp4", "b.parquet", "c.MOV"]


def test_a_cut_splits_the_recording_and_is_said(tmp_path: Path) -> None:
    def cut(time: float) -> list[Pose]:
        return [squat(time, 200 if time < 5 else 520)]

    path = write_squats(tmp_path / "a.parquet", AT_30_HZ, cut)
    with pytest.warns(kineme.errors.KinemeWarning, match=r"camera cuts at 5\.0 s"):
        motion = kineme.read(path)
    assert motion.gaps == ((150, 151),)


def test_fast_movement_is_no_cut(tmp_path: Path) -> None:
    def leap(time: float) -> list[Pose]:  # 10 m/s from one side to the other
        return [squat(6 * time, 200 + 2000 * min(max(time - 5, 0), 0.2))]

    assert kineme.read(write_squats(tmp_path / "a.parquet", AT_30_HZ, leap)).gaps == ()


def test_an_unsure_keypoint_counts_less(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    elbow = NAMES.index("left_elbow")

    def hidden(time: float, unsure: float) -> list[Pose]:
        pose = squat(time)
        if round(30 * time) % 30 < 6:  # it is guessed wrongly now and then
            pose.metres[elbow] += rng.normal(0, 0.08, 3)
            pose.confidence[elbow] = unsure
        return [pose]

    errors = []
    for unsure in (0.9, 0.1):
        path = write_squats(tmp_path / "a.parquet", AT_30_HZ, lambda t, c=unsure: hidden(t, c))
        motion = kineme.read(path)
        joint = motion.joint("left_elbow")
        true = [squat(time).metres[elbow] for time in AT_30_HZ]
        off = motion.positions[:, joint] - motion.positions[:, 0] - true
        errors.append(np.sqrt((off**2).mean()))
    assert errors[1] < 0.5 * errors[0]
