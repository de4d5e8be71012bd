"""Good loops before bad ones: seams that meet, ranks, root motion apart, and the manifest of it."""

from __future__ import annotations

from dataclasses import replace
from math import degrees
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

import kineme
from kineme.clips.loops import Carry, find_carry, make_loop, measure_loop
from kineme.clips.root_motion import (
    extract_root_motion,
    measure_root_motion,
    remove_root_motion,
    straighten,
)
from kineme.clips.split import split
from kineme.errors import ParameterError
from kineme.features import compute_heading
from kineme.recordings import Motion
from kineme.recordings.carriers import place_frames
from kineme.recordings.operations import cut
from manifests import read_manifest
from segmentations import make_activities


def play_rounds(motion: Motion, carry: Carry, n: int) -> np.ndarray:
    """Positions of a loop that is played so often."""
    played = [motion.positions]
    for _ in range(n - 1):
        played.append(carry.apply(played[-1]))
    return np.concatenate(played)


def test_speed_and_acceleration_meet_at_the_seam(repetitions) -> None:
    for clip in repetitions:
        bare = Motion(clip.skeleton, clip.positions, clip.fps)
        for closed, carry in (make_loop(clip), make_loop(bare)):
            twice, n = play_rounds(closed, carry, 2), closed.n_frames
            changes = np.linalg.norm(np.diff(twice, 2, axis=0), axis=-1).mean(axis=1)
            assert changes[n - 2 : n].max() <= 1.05 * changes[: n - 2].max()
            assert n == clip.n_frames


def test_planted_feet_that_are_dragged_slide(motion) -> None:
    still = np.repeat(motion.positions[:1], 60, axis=0)
    dragged = still + np.linspace(0, 0.6, 60)[:, None, None] * [1.0, 0.0, 0.0]
    feet = [((0, 1), np.ones(60, bool))]
    for positions, slide in ((still, 0.0), (dragged, 0.6)):
        carry = find_carry(Motion(motion.skeleton, positions, 60))
        found = measure_loop(positions, positions, carry, 60, usual=(0.01, 0.01), feet=feet)
        assert found.slide_m_s == pytest.approx(slide, abs=0.02)


def test_loops_in_place_close_where_they_are_and_their_root_motion_brings_them_back(
    repetitions,
) -> None:
    for clip in repetitions:
        closed, carry = make_loop(clip)
        still, root = remove_root_motion(closed, carry)
        n, fps = closed.n_frames, closed.fps
        step = np.linalg.norm(still.positions[0] - still.positions[-1], axis=-1).max()
        assert step <= 1.1 * np.linalg.norm(np.diff(still.positions, axis=0), axis=-1).max()
        assert np.abs(still.positions[:, 0, [0, 2]].mean(axis=0)).max() < 1e-9
        assert root.turn == pytest.approx(carry.turn * fps / n)
        # Put on its path again, it moves as before, seen from its first frame.
        # Floor positions are x + iz, which a turn multiplies by exp(-i turn).
        turn, parts = root.turn / fps, 200
        steps = np.exp(-1j * turn * (np.arange(n * parts) + 0.5) / parts) / fps / parts
        path = np.concatenate([[0], (root.x + 1j * root.z) * np.cumsum(steps)])[:-1:parts]
        turned = (still.positions @ [1, 0, 1j]) * np.exp(-1j * turn * np.arange(n))[:, None]
        there, here = turned + path[:, None], closed.positions @ [1, 0, 1j]
        apart = [np.abs(each - each[0, 0]) for each in (there, here)]
        assert np.abs(apart[0] - apart[1]).max() < 1e-4


def test_clips_of_uneven_speed_and_turn_stay_in_place(motion) -> None:
    n, frame = 300, motion[100:101]
    pose, axes = (np.repeat(each, n, axis=0) for each in (frame.positions, frame.rotations))
    # Go 3 m, faster and slower again, and turn left by 90 degrees towards the end.
    share = np.linspace(0, 1, n)
    target = pose[0, 0] * [1, 0, 1] + (3 * share**2 * (3 - 2 * share))[:, None] * [0, 0, 1.0]
    clip = replace(motion, positions=pose, rotations=axes, gaps=())
    clip = place_frames(clip, np.pi / 2 * share**3, pose[0, 0] * [1, 0, 1], target)
    still, root = remove_root_motion(clip, None)
    assert np.ptp(still.positions, axis=0).max() < 0.25
    even, _ = remove_root_motion(clip, find_carry(clip))
    assert np.ptp(even.positions[:, 0], axis=0).max() > 0.5
    assert degrees(root.turn) == pytest.approx(90 * motion.fps / (n - 1), rel=0.02)
    rooted = extract_root_motion(clip, None)
    np.testing.assert_allclose(rooted.positions[:, 1:], clip.positions, atol=1e-9)
    behind = (rooted.positions[:, 1] - rooted.positions[:, 0])[:, [0, 2]]
    assert np.linalg.norm(behind, axis=1).max() < 0.2
    straight, _ = straighten(clip, None)
    assert np.ptp(compute_heading(straight)[1]) < 0.2
    # A pose that changes does not travel.
    bent = np.array(clip.positions[:2])
    bent[1, 1:, 2] += 0.3
    assert measure_root_motion(replace(clip[:2], positions=bent), None).speed < 0.02


@given(st.floats(-3.1, 3.1), st.floats(-3, 3), st.floats(-3, 3))
def test_a_straightened_loop_goes_on_as_it_begins(motion, turn, x, z) -> None:
    clip = cut(motion, 354, 414)
    straight, carry = straighten(clip, Carry(turn, x, z))
    before, after = (
        measure_root_motion(clip, Carry(turn, x, z)),
        measure_root_motion(straight, carry),
    )
    assert carry.turn == 0
    assert after.speed == pytest.approx(before.speed, abs=1e-6)
    assert np.abs(straight.positions[0] - clip.positions[0]).max() < 1e-9


def test_the_best_loops_of_each_cluster_stand_first(tmp_path: Path, motion, truth) -> None:
    split(motion, truth, tmp_path / "all", level="primitive", loops=True)
    told = read_manifest(tmp_path / "all")
    loops = [clip for clip in told if clip["loop"]]
    assert told[: len(loops)] == loops
    assert all((clip["kind"] == "transition") != clip["loop"] for clip in told)
    for cluster in {clip["cluster"] for clip in loops}:
        of_cluster = [clip for clip in loops if clip["cluster"] == cluster]
        assert [clip["rank"] for clip in of_cluster] == list(range(1, len(of_cluster) + 1))
        costs = [clip["quality"]["cost"] for clip in of_cluster]
        assert costs == sorted(costs)
    split(motion, truth, tmp_path / "best", level="primitive", loops=True, best=1)
    best = read_manifest(tmp_path / "best")
    names = {clip["start_frame"]: (clip["name"], clip["file"]) for clip in told}
    assert all((clip["name"], clip["file"]) == names[clip["start_frame"]] for clip in best)
    assert [clip["start_frame"] for clip in best] == [
        clip["start_frame"] for clip in loops if clip["rank"] == 1
    ]
    table = pd.read_csv(tmp_path / "all" / "manifest.csv")
    assert table.start_frame.is_monotonic_increasing
    assert table.query("kind == 'transition'").turn_deg.isna().all()
    assert table.query("kind != 'transition'")["rank"].notna().all()


def test_the_manifest_knows_feet_poses_and_root_motion(tmp_path: Path, motion, truth) -> None:
    options = {"level": "primitive", "cluster": 0, "loops": True, "root_motion": "in-place"}
    paths = split(motion, truth, tmp_path / "walk", format="glb", **options)
    told = read_manifest(tmp_path / "walk")
    assert len(told) == len(paths)
    for clip in told:
        assert clip["changes"] == ["in place"]
        assert clip["carry"] == {"turn_deg": 0, "x_m": 0, "z_m": 0}
        assert 0.8 < clip["root"]["speed_m_s"] < 1.6
        assert clip["root"]["z_m_s"] > 0.95 * clip["root"]["speed_m_s"]
        planted = [sum(b - a for a, b in spans) for spans in clip["planted"].values()]
        assert all(0.4 < each / clip["n_frames"] < 0.8 for each in planted)
        assert clip["poses"]["first"]["left_ankle"][0] > clip["poses"]["first"]["right_ankle"][0]
        read = kineme.read(tmp_path / "walk" / clip["file"], take=clip["take"])
        assert read.n_frames == clip["n_frames"]


def test_a_mirrored_clip_plants_the_other_foot(tmp_path: Path, motion, truth) -> None:
    told = []
    for mirror in (False, True):
        folder = tmp_path / str(mirror)
        split(motion, truth, folder, level="primitive", cluster=5, mirror=mirror)
        told.append(read_manifest(folder)[0])
    assert told[0]["planted"]["left"] == told[1]["planted"]["right"]
    assert told[1]["changes"] == ["mirror"]


def test_clips_without_rotations_are_put_in_place_as_those_with(tmp_path, motion, truth) -> None:
    bare = Motion(motion.skeleton, motion.positions, motion.fps)
    options = {"level": "primitive", "cluster": 0, "root_motion": "in-place", "straight": True}
    (path, *_), (other, *_) = (
        split(each, truth, tmp_path / name, format="csv", **options)
        for each, name in ((bare, "bare"), (motion, "turned"))
    )
    positions, others = (kineme.read(each).positions for each in (path, other))
    # Without rotations the body faces where its hips lie, which is not quite the same.
    assert np.abs(positions - others).max() < 0.05


@pytest.mark.parametrize("root_motion", ["keep", "in-place"])
def test_a_closed_loop_ends_where_it_begins(tmp_path: Path, motion, truth, root_motion) -> None:
    options = {"level": "primitive", "cluster": 0, "loops": True, "root_motion": root_motion}
    opened = split(motion, truth, tmp_path / "open", **options)
    closed = split(motion, truth, tmp_path / "closed", close=True, **options)
    told = {clip["file"]: clip for clip in read_manifest(tmp_path / "closed")}
    for path, other in zip(closed, opened, strict=True):
        clip, before, after = told[path.name], kineme.read(other), kineme.read(path)
        assert after.n_frames == clip["n_frames"] == before.n_frames + 1
        assert clip["round_s"] == pytest.approx(before.duration, abs=1e-5)
        assert np.abs(after.positions[:-1] - before.positions).max() < 1e-5
        turn, x, z = clip["carry"].values()
        expected = Carry(np.radians(turn), x, z).apply(after.positions[0])
        assert np.abs(after.positions[-1] - expected).max() < 1e-4
    with pytest.raises(ParameterError, match="closed needs loops"):
        split(motion, truth, tmp_path / "none", close=True)


@pytest.mark.parametrize("best", [0, -1, 1.5, "2"])
def test_odd_numbers_of_loops_are_refused(tmp_path: Path, motion, truth, best) -> None:
    with pytest.raises(ParameterError, match="give a number of loops"):
        split(motion, truth, tmp_path / "clips", loops=True, best=best)
    with pytest.raises(ParameterError, match="best needs loops"):
        split(motion, truth, tmp_path / "clips", best=2)


def test_signals_have_no_place(tmp_path: Path) -> None:
    signals = kineme.Signals(np.zeros((60, 2)), 30)
    one = make_activities(60)
    with pytest.raises(ParameterError, match="signals have no pose: leave out root_motion"):
        split(signals, one, tmp_path / "clips", root_motion="in-place")
    split(signals, one, tmp_path / "clips")
    assert read_manifest(tmp_path / "clips")[0]["root"] is None
