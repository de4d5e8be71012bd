"""Clips as files: each is its stretch of the recording, loops close, nothing is half-written."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

import kineme
from kineme.clips.loops import Carry, make_loop
from kineme.clips.split import split
from kineme.errors import MotionError, ParameterError, WriteError
from kineme.formats.channels.writing import write_signals
from kineme.recordings import Motion
from kineme.recordings.operations import cut, move, turn
from segmentations import make_activities


def measure_largest_step(motion: Motion) -> float:
    """How far a joint moves at most from one frame to the next."""
    return float(np.linalg.norm(np.diff(motion.positions, axis=0), axis=-1).max())


def measure_seam(motion: Motion, carry: Carry) -> float:
    again = carry.apply(motion.positions[0])
    return float(np.linalg.norm(again - motion.positions[-1], axis=-1).max())


def test_each_clip_is_its_stretch_of_the_recording(tmp_path: Path, motion, truth) -> None:
    (tmp_path / "clips").mkdir()  # an empty folder is filled
    paths = split(motion, truth, tmp_path / "clips", level="primitive", cluster=1)
    manifest = pd.read_csv(tmp_path / "clips" / "manifest.csv")
    rows = [row for row in truth.primitives if row.cluster == 1]
    assert [path.name for path in paths] == manifest.file.tolist()
    assert manifest.start_frame.tolist() == [row.start_frame for row in rows]
    assert manifest.stop_s.tolist() == [row.stop_s for row in rows]
    assert set(manifest.source) == {str(kineme.bundled_recording())}
    assert manifest.label.fillna("").tolist() == [row.label for row in rows]
    assert "turn_deg" not in manifest
    for path, row in zip(paths, rows, strict=True):
        clip = kineme.read(path)
        assert clip.fps == motion.fps
        expected = motion.positions[row.start_frame : row.stop_frame]
        assert np.abs(clip.positions - expected).max() < 1e-6


def test_a_motion_without_rotations_becomes_tables(tmp_path, motion, truth) -> None:
    bare = Motion(motion.skeleton, motion.positions, motion.fps)
    for loops in (False, True):
        paths = split(bare, truth, tmp_path / f"clips{loops}", loops=loops)
        assert {path.suffix for path in paths} == {".csv"}
    first = pd.read_csv(tmp_path / "clipsFalse" / paths[0].name)
    assert first.columns[:4].tolist() == ["time", "Hips_x", "Hips_y", "Hips_z"]
    assert first["Hips_y"].to_numpy() == pytest.approx(
        motion.positions[: len(first), 0, 1], abs=1e-6
    )


def test_a_glb_holds_all_clips_as_animations(tmp_path, motion, truth) -> None:
    paths = split(motion, truth, tmp_path / "clips", format="glb", loops=True)
    assert {path.name for path in paths} == {"exercises.glb"}
    assert len(paths) == len(truth.activities)
    manifest = pd.read_csv(tmp_path / "clips" / "manifest.csv")
    assert manifest.columns[-4:].tolist() == ["turn_deg", "x_m", "z_m", "animation"]
    assert manifest.animation[0] == "exercises_0000_walk"
    for index, row in enumerate(truth.activities[:3]):  # a transition is no loop
        expected = cut(motion, row.start_frame, row.stop_frame)
        if row.kind != "transition":
            expected, _ = make_loop(expected)
        clip = kineme.read(paths[index], take=manifest.animation[index])
        assert clip.fps == motion.fps
        assert np.abs(clip.positions - expected.positions).max() < 1e-5


def test_clips_in_any_format_that_motions_are_written_in(tmp_path, motion, truth) -> None:
    for suffix in ("amc", "trc"):
        paths = split(motion, truth, tmp_path / suffix, cluster=0, format=suffix)
        assert {path.suffix for path in paths} == {f".{suffix}"}
        assert kineme.read(paths[0]).n_frames == truth.activities[0].stop_frame
    with pytest.raises(ParameterError, match="format is 'mvnx': motions are written as amc, bvh"):
        split(motion, truth, tmp_path / "mvnx", format="mvnx")
    bare = Motion(motion.skeleton, motion.positions, motion.fps)
    with pytest.raises(WriteError, match="a glTF needs rotations"):
        split(bare, truth, tmp_path / "bare", format="glb")
    signals = kineme.Signals(motion.positions[:, 0], motion.fps)
    with pytest.raises(ParameterError, match="signals are rows of their file"):
        split(signals, truth, tmp_path / "signals", format="glb")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["amc", "trc"]


def test_a_loop_keeps_bones_and_says_what_was_done(repetitions) -> None:
    clip = repetitions[0]
    looped, _ = make_loop(clip)
    assert looped.provenance.notes[-1] == "ends blended into a loop"

    def lengths(motion: Motion) -> np.ndarray:
        parents = list(motion.skeleton.parents[1:])
        return np.linalg.norm(motion.positions[:, 1:] - motion.positions[:, parents], axis=-1)

    assert np.abs(lengths(looped) - lengths(clip)).max() < 1e-9


@given(st.floats(-3.1, 3.1), st.floats(-5, 5), st.floats(-5, 5))
def test_a_turned_and_moved_recording_loops_alike(motion, angle, x, z) -> None:
    clip = cut(motion, 354, 524)
    there = move(turn(clip, angle), [x, 0, z])
    (here, carry), (looped, far) = make_loop(clip), make_loop(there)
    assert np.abs(move(turn(here, angle), [x, 0, z]).positions - looped.positions).max() < 1e-8
    assert far.turn == pytest.approx(carry.turn, abs=1e-9)


def test_the_manifest_tells_how_a_loop_goes_on(tmp_path, motion, truth) -> None:
    paths = split(motion, truth, tmp_path / "loops", level="primitive", cluster=1, loops=True)
    manifest = pd.read_csv(tmp_path / "loops" / "manifest.csv")
    for path, row in zip(paths, manifest.itertuples(), strict=True):
        looped = kineme.read(path)
        carry = Carry(np.radians(row.turn_deg), row.x_m, row.z_m)
        assert measure_seam(looped, carry) <= measure_largest_step(looped) + 1e-6
        again = move(turn(looped, carry.turn), [carry.x, 0, carry.z])
        assert np.abs(again.positions - carry.apply(looped.positions)).max() < 1e-12


@pytest.mark.parametrize("n", [1, 2, 3])
def test_the_shortest_clips_loop(motion, n) -> None:
    looped, carry = make_loop(cut(motion, 100, 100 + n))
    assert looped.n_frames == n
    assert np.isfinite(carry.apply(looped.positions)).all()


def test_names_are_safe_in_every_file_system(tmp_path, motion) -> None:
    label = "über/..\\ <a>:*?|" + "ß" * 300
    one = make_activities(motion.n_frames, fps=motion.fps, label=[label])
    (path,) = split(motion, one, tmp_path / "clips")
    assert path.name.startswith("exercises_0000_über_____")
    assert len(os.fsencode(path.name)) < 255
    assert pd.read_csv(tmp_path / "clips" / "manifest.csv").label[0] == label


def test_what_is_there_is_not_touched_and_nothing_is_left_half_written(
    tmp_path, motion, truth, monkeypatch
) -> None:
    (tmp_path / "clips").mkdir()
    (tmp_path / "clips" / "mine.txt").write_text("mine")
    with pytest.raises(WriteError, match="exists already"):
        split(motion, truth, tmp_path / "clips")
    with pytest.raises(WriteError, match="cannot be created"):
        split(motion, truth, tmp_path / "no" / "clips")
    with pytest.raises(ParameterError, match=r"no primitive is in cluster 99; there are 0, 1, "):
        split(motion, truth, tmp_path / "new", level="primitive", cluster=99)
    with pytest.raises(MotionError, match="segments have 2898 frames, but the recording has 10"):
        split(cut(motion, 0, 10), truth, tmp_path / "new")

    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("kineme.clips.split.write_manifests", full)
    with pytest.raises(WriteError, match="No space left on device"):
        split(motion, truth, tmp_path / "new", level="primitive", cluster=1)
    assert [path.name for path in tmp_path.iterdir()] == ["clips"]
    assert [path.name for path in (tmp_path / "clips").iterdir()] == ["mine.txt"]


def test_clips_of_arrays_hold_their_values_and_gaps(tmp_path) -> None:
    values = np.random.default_rng(0).normal(size=(60, 2)) * 1e-7
    signals = kineme.Signals(values, 30, ("a", "b"), gaps=[(40, 45)])
    paths = split(signals, make_activities(30, 60), tmp_path / "clips")
    back = pd.concat([pd.read_csv(path) for path in paths])
    assert back.columns.tolist() == ["time", "a", "b"]
    values[40:45] = np.nan
    assert np.array_equal(back[["a", "b"]].to_numpy(), values, equal_nan=True)
    assert kineme.read(paths[1]).fps == 30


def test_changed_channels_are_written_as_they_were_changed(tmp_path) -> None:
    (tmp_path / "imu.csv").write_text(
        "time,acc_x\n" + "".join(f"{i / 10},{i}\n" for i in range(30))
    )
    signals = kineme.read(tmp_path / "imu.csv")
    write_signals(replace(signals, values=np.multiply(2, signals.values)), tmp_path / "twice.csv")
    assert pd.read_csv(tmp_path / "twice.csv").acc_x.tolist() == [2 * i for i in range(30)]
