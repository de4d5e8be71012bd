"""Segment a motion: allowed recordings, gaps, and changes that must not affect cuts."""

from __future__ import annotations

import multiprocessing
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from presets import OWN

import kineme
from kineme.datasets import Action, bundled_recording, random_recording, synthesize
from kineme.errors import ParameterError
from kineme.features import end_effectors
from kineme.methods import resolve_preset
from kineme.methods.kineme.preset import KINEME
from kineme.methods.segmenter import analyze, segment
from kineme.recordings import Motion
from kineme.recordings.operations import cut, move, resample, turn
from kineme.segments.segmentation import Segmentation

presets = pytest.mark.parametrize("preset", OWN)
few = settings(max_examples=5)


@cache
def recording(seed: int) -> Motion:
    return random_recording(seed).motion


@cache
def found_in(seed: int, preset: str) -> Segmentation:
    return segment(recording(seed), preset=preset)


def cut_start(motion: Motion, frames: int) -> Motion:
    return cut(motion, 0, frames)


def still(motion: Motion, frames: int) -> Motion:
    """Repeat the first pose."""
    return Motion(motion.skeleton, np.repeat(motion.positions[:1], frames, axis=0), motion.fps)


def growing(motion: Motion, frames: int) -> Motion:
    """Make a body whose arms grow all the time, so that no pose recurs."""
    held = still(motion, frames)
    found = end_effectors(held)
    positions = held.positions.copy()
    for wrist in (found.left_wrist, found.right_wrist):
        positions[:, wrist] *= np.linspace(1, 80, frames)[:, None]
    return replace(held, positions=positions)


def assert_one_segment(found: Segmentation, n_frames: int) -> None:
    for level in (found.activities, found.primitives):
        assert [(row.start_frame, row.stop_frame) for row in level] == [(0, n_frames)]


@presets
@given(st.integers(0, 2), st.floats(-7, 7), st.tuples(*[st.floats(-500, 500)] * 3))
@few
def test_moving_and_turning_a_recording_changes_no_cut(preset, seed, angle, offset) -> None:
    moved = segment(move(turn(recording(seed), angle), offset), preset=preset)
    expected = found_in(seed, preset)
    for level in ("activities", "primitives"):
        rows, wanted = getattr(moved, level), getattr(expected, level)
        np.testing.assert_array_equal(rows.start_frame, wanted.start_frame)
        np.testing.assert_array_equal(rows.cluster, wanted.cluster)
        np.testing.assert_array_equal(rows.kind, wanted.kind)


@presets
@pytest.mark.parametrize(
    ("take", "n_frames"),
    [*((cut_start, n) for n in (1, 2, 5, 40)), *((still, n) for n in (1, 100, 5000))],
)
def test_what_is_short_or_still_is_one_segment(preset: str, take, n_frames: int) -> None:
    assert_one_segment(segment(take(recording(0), n_frames), preset=preset), n_frames)


@pytest.mark.parametrize("preset", ["voegele2014", "krueger2017"])
def test_what_never_repeats_is_one_transition(preset: str) -> None:
    found = segment(growing(recording(0), 4000), preset=preset)
    assert_one_segment(found, 4000)
    assert found.activities[0].kind == "transition"
    assert found.activities[0].cluster == -1


def test_what_never_repeats_is_counted_once_at_most() -> None:
    """It is divided by position, and no part of it recurs."""
    found = segment(growing(recording(0), 4000))
    assert max(found.repetitions().values(), default=0) <= 1
    clusters = found.activities.cluster.tolist()
    assert len(set(clusters)) == len(clusters)


@presets
@pytest.mark.parametrize("fps", [5.0, 12.5, 29.97, 59.94])
def test_segments_tile_at_any_frame_rate(preset: str, fps: float) -> None:
    motion = resample(recording(0), fps)
    found = segment(motion, preset=preset)
    for level in (found.activities, found.primitives):
        assert level.start_frame[0] == 0
        assert level.stop_frame[-1] == motion.n_frames
        assert (level.start_frame < level.stop_frame).all()
        np.testing.assert_array_equal(level.stop_frame[:-1], level.start_frame[1:])
    assert set(found.activities.start_frame) <= set(found.primitives.start_frame)


def test_a_walk_between_slow_and_fast_squats_is_known_again() -> None:
    slow, fast = Action("squat", 4, speed=0.6), Action("squat", 5, speed=1.7)
    made = synthesize([slow, Action("walk", 4), fast, Action("walk", 5)], fps=60, seed=1)
    rows = segment(made.motion).activities
    squat, walk, fast_squat, again = rows.cluster[rows.kind == "activity"].tolist()
    assert walk == again
    assert walk not in (squat, fast_squat)


def test_presets_that_are_none_and_presets_for_signals_are_refused() -> None:
    motion = cut(recording(0), 0, 60)
    with pytest.raises(ParameterError, match="no preset 'best'; there are kineme"):
        analyze(np.zeros((30, 2)), "best")
    with pytest.raises(
        ParameterError, match="a preset is a name or a Preset, not float: there are"
    ):
        segment(motion, preset=0.5)
    with pytest.raises(ParameterError, match="is for signals"):
        segment(motion, preset=resolve_preset("krueger2017", signals=True))
    told = "radius must be a number above 0 to 10000 metres, not 'big'"
    with pytest.raises(ParameterError, match=told):
        segment(motion, preset="krueger2017", radius="big")


def test_provenance_says_how_it_was_made() -> None:
    found = segment(cut(recording(0), 0, 90), segment_cost=0.4)
    assert found.provenance["preset"] == "kineme"
    assert found.provenance["parameters"]["segment_cost"] == 0.4
    assert any("end effectors" in note for note in found.provenance["notes"])
    published = segment(cut(recording(0), 0, 90), preset="voegele2014", radius=0.5)
    assert published.provenance["preset"] == "voegele2014"
    assert published.provenance["parameters"]["radius"] == 0.5
    assert [*published.timings] == ["features", "neighbors", "activities", "primitives", "clusters"]


def test_what_is_no_motion_is_refused_with_the_way_to_one() -> None:
    with pytest.raises(ParameterError, match=r"takes a Motion or Signals, not \w+: kineme.read"):
        segment("take.bvh")


def test_an_unknown_constant_is_refused() -> None:
    with pytest.raises(
        ParameterError, match=r"no parameter 'min_acton'; did you mean min_action\?"
    ):
        segment(recording(0), min_acton=2)
    with pytest.raises(ParameterError, match="no parameter 'radios'; there are"):
        segment(recording(0), radios=0.5)


def _segment_in_child(seed: int) -> list[int]:
    return segment(recording(seed), preset="krueger2017").primitives.start_frame.tolist()


@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
@pytest.mark.skipif(sys.platform == "win32", reason="there is no fork")
def test_a_forked_process_segments_as_well() -> None:
    expected = found_in(0, "krueger2017").primitives.start_frame.tolist()
    with multiprocessing.get_context("fork").Pool(1) as pool:
        assert pool.apply_async(_segment_in_child, (0,)).get(timeout=300) == expected


def test_another_detail_is_that_of_the_same_result() -> None:
    assert segment(recording(0), detail=0.5) == segment(recording(0)).at_detail(0.5)
    with pytest.raises(ParameterError, match="detail must be a number above 0"):
        segment(recording(0), detail=0)


@settings(max_examples=5)
@given(st.data())
def test_a_gap_anywhere_is_a_transition(data: st.DataObject) -> None:
    motion = kineme.read(bundled_recording())
    start = data.draw(st.integers(60, motion.n_frames - 120))
    gap = (start, start + data.draw(st.integers(10, 60)))
    broken = kineme.segment(replace(motion, gaps=(gap,)))
    assert broken.provenance["gaps"] == [list(gap)]
    row = broken.activities.start_frame.tolist().index(gap[0])
    assert broken.activities[row].kind == "transition"
    assert broken.activities[row].stop_frame == gap[1]
    assert broken.n_frames == motion.n_frames


def test_a_gap_in_a_real_recording(data_dir: Path, tmp_path: Path) -> None:
    motion = kineme.read(data_dir / "cmu86" / "86_01.amc")
    whole = kineme.segment(motion)
    gap = (1500, 1900)  # inside a walk, 3.3 s of 38 s
    holed = replace(motion, gaps=(gap,))
    broken = kineme.segment(holed, preset=KINEME)
    far = [cut for cut in whole.cuts() if not gap[0] - 120 <= cut <= gap[1] + 120]
    assert max(np.abs(broken.cuts() - cut).min() for cut in far) <= 0.5 * motion.fps
    before, after = (broken.per_frame("cluster", level="activity")[f] for f in (1499, 1900))
    assert before == after >= 0
    kineme.plot_segmentation(broken, holed, tmp_path / "a.png")


def test_a_clock_that_is_set_leaves_no_crumbs_beside_the_jump() -> None:
    t = np.arange(2000) / 50
    rng = np.random.default_rng(0)
    one = np.column_stack([np.sin(6 * t), np.cos(6 * t)])
    two = np.column_stack([np.sin(11 * t) ** 3, np.cos(11 * t)])
    values = np.where((t < 20)[:, None], one, two) + 0.05 * rng.standard_normal((2000, 2))
    segments = kineme.segment(kineme.Signals(values, 50, gaps=[(999, 1000)]))
    assert segments.cuts().tolist() == [999, 1000]
