"""The whole method: known actions are found, and some changes do not matter."""

from __future__ import annotations

from functools import cache
from itertools import groupby, pairwise
from operator import attrgetter
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import kineme
from kineme.datasets import bundled_recording, bundled_truth, random_recording
from kineme.errors import ParameterError
from kineme.evaluation import evaluate
from kineme.methods.kineme.pipeline import KinemeFound, analyze
from kineme.methods.kineme.preset import KINEME, SENSORS
from kineme.methods.prepare import compute_motion_features
from kineme.methods.presets import resolve_preset
from kineme.methods.segmenter import segment
from kineme.recordings import Motion
from kineme.recordings.operations import resample, scale
from kineme.segments.segmentation import Segmentation
from kineme_reproduction.benchmark import mean
from kineme_reproduction.trials import find_folder, load_trials
from loops import make_swings

few = settings(max_examples=8)


@cache
def recorded(seed: int) -> np.ndarray:
    return compute_motion_features(random_recording(seed).motion, KINEME)


@cache
def analysis_of(seed: int) -> KinemeFound:
    return analyze(recorded(seed), KINEME)


def assert_same(found: KinemeFound, expected: KinemeFound) -> None:
    for name in ("borders", "labels", "primitives", "clusters"):
        parts = (getattr(each.segments, name) for each in (found, expected))
        np.testing.assert_array_equal(*parts, name)
    for name in ("clusters", "borders", "cuts"):
        probabilities = (getattr(each.confidence, name) for each in (found, expected))
        np.testing.assert_allclose(*probabilities, atol=1e-2)


def repetitions_of(found: KinemeFound) -> list[int]:
    """Return the number of repetitions of each activity, without transitions."""
    return found.segments.counts[found.segments.labels >= 0].tolist()


# --- what is known is found -------------------------------------------------------------------


Sequence = list[tuple[int, float, int]]
"""Movement (one of three), period, and count."""


@st.composite
def sequences(draw: st.DrawFn) -> Sequence:
    """For at least 5 s and five times each; none follows the same one twice.

    Of sequences with four of one, about one in four thousand is found otherwise.
    """
    axes = draw(st.permutations(range(3)))[: draw(st.integers(2, 3))]
    axes += axes[:1] * (len(axes) == 3 and draw(st.booleans()))
    periods = [draw(st.integers(18, 60)) / 30 for _ in range(3)]
    return [
        (axis, periods[axis], draw(st.integers(max(5, round(5 / periods[axis] + 0.5)), 18)))
        for axis in axes
    ]


def assert_found(sequence: Sequence) -> None:
    parts = [make_swings(times, period=period, axis=2 * axis) for axis, period, times in sequence]
    found = analyze(np.concatenate(parts), KINEME)
    order = list(dict.fromkeys(axis for axis, _, _ in sequence))
    assert found.segments.labels.tolist() == [order.index(axis) for axis, _, _ in sequence]
    borders = np.cumsum([0, *map(len, parts)])
    assert np.abs(found.borders - borders).max() <= 15
    for counted, (_, period, times) in zip(repetitions_of(found), sequence, strict=True):
        assert abs(counted - times) <= (period < 1)  # of fast ones half is as near to one as none


@given(sequences())
@settings(max_examples=60)
def test_actions_their_borders_and_counts_are_found(sequence) -> None:
    assert_found(sequence)


@pytest.mark.parametrize(
    "sequence",
    [
        [(1, 1.3, 16), (0, 1.4, 7), (1, 1.3, 8), (0, 1.4, 5)],
        [(2, 0.9, 10), (1, 1.3, 11), (2, 0.9, 6), (1, 1.3, 16)],
        [(0, 1.0, 9), (1, 1.2, 9), (0, 1.0, 13), (1, 1.2, 11)],
    ],
)
def test_a_change_that_comes_twice_is_no_action_of_its_own(sequence) -> None:
    """Although the second between both looks the same each time."""
    assert_found(sequence)


def test_an_action_that_returns_after_minutes_is_known_again() -> None:
    walk, turn = (
        make_swings(12, period=1),
        [make_swings(50, period=2, axis=2), make_swings(12, period=1, axis=4)],
    )
    found = analyze(np.concatenate([walk, *turn, walk, turn[1]]), KINEME)
    assert found.segments.labels[found.segments.labels >= 0].tolist() == [0, 1, 2, 0, 2]
    assert repetitions_of(found) == [12, 50, 12, 12, 12]


def test_long_recordings_are_found_as_their_parts_and_known_again() -> None:
    walk, turn = make_swings(12, period=1), make_swings(9, period=1.3, axis=2)
    both = np.concatenate([walk, turn])
    found = analyze(np.tile(both, (4, 1)), KINEME.replace(part=len(both) / KINEME.working_fps))
    assert found.segments.labels.tolist() == [0, 1] * 4
    expected = np.add.outer(len(both) * np.arange(4), [len(walk), len(both)]).ravel()
    assert np.abs(found.borders[1:] - expected).max() <= 15
    assert np.abs(np.array(repetitions_of(found)) - [12, 9] * 4).max() <= 1


# --- what changes nothing ---------------------------------------------------------------------


@given(st.integers(0, 3), st.integers(0, 2**32 - 1), st.floats(-100, 100))
@few
def test_order_signs_and_zeros_of_the_features_change_nothing(seed, turn, shift) -> None:
    rng, rows = np.random.default_rng(turn), recorded(seed)
    poses = rows.reshape(len(rows), len(KINEME.offsets), -1)
    order, signs = rng.permutation(poses.shape[2]), rng.choice([-1, 1], poses.shape[2])
    turned = (signs * poses[:, :, order]).reshape(rows.shape) + shift
    assert_same(analyze(turned, KINEME), analysis_of(seed))


@pytest.mark.parametrize(
    "preset",
    [KINEME, KINEME.replace(part=15.0), SENSORS.replace(working_fps=30.0)],
    ids=["kineme", "in parts", "sensors"],
)
def test_threads_and_repetition_change_nothing(preset, set_threads) -> None:
    parts_of = attrgetter(
        *("features", "fine", "borders", "primitives", "segments.labels", "segments.clusters"),
        *("confidence.clusters", "evidence.sharpness", "evidence.repetition_similarity"),
    )
    found = []
    for threads in (1, 5, 5):
        set_threads(threads)
        parts = parts_of(analyze(recorded(2), preset))
        found.append([np.ascontiguousarray(part).tobytes() for part in parts])
    assert found[0] == found[1]
    assert found[1] == found[2]


# --- what holds for every input ---------------------------------------------------------------


def assert_whole(found: KinemeFound, frames: int) -> None:
    for borders in (found.borders, found.primitives):
        assert borders[0] == 0
        assert borders[-1] == frames
        assert (np.diff(borders) > 0).all()
    assert set(found.borders.tolist()) <= set(found.primitives.tolist())
    labels = found.segments.labels.tolist()
    assert len(labels) == len(found.borders) - 1
    assert all(a != b for a, b in pairwise(labels))
    known = [label for label in dict.fromkeys(labels) if label >= 0]
    assert known == list(range(len(known)))
    assert set(labels) <= {-1, *known}
    moving, sure = found.segments.labels >= 0, found.confidence
    periodic = moving & ~np.isin(found.segments.labels, found.segments.not_periodic)
    assert np.isfinite(sure.clusters).tolist() == moving.tolist()
    assert np.isnan(sure.borders[0])
    for probabilities in (sure.clusters, sure.borders, sure.cuts):
        given = probabilities[np.isfinite(probabilities)]
        assert ((given >= 0) & (given <= 1)).all()
    assert np.isfinite(sure.borders[1:]).all()
    begins = np.isin(found.primitives[:-1], found.borders) | periodic[found.segments.parents]
    assert np.isfinite(sure.cuts[1:][begins[1:]]).all()
    assert len(sure.cuts) == len(found.primitives) - 1


@given(
    st.integers(1, 90), st.integers(1, 4), st.integers(0, 2**32 - 1),
    st.sampled_from(["held", "noise", "drift", "far"]),
)  # fmt: skip
@settings(max_examples=60)
def test_nothing_is_too_short_or_too_strange(frames, dims, seed, kind) -> None:
    rng = np.random.default_rng(seed)
    rows = {
        "held": np.ones((frames, dims)),
        "noise": rng.normal(size=(frames, dims)),
        "drift": rng.normal(size=(frames, dims)).cumsum(axis=0),
        "far": 1e6 * rng.normal(size=(frames, dims)),
    }[kind]
    found = analyze(rows, KINEME)
    assert_whole(found, frames)
    if kind == "held" or frames <= 2:
        assert found.borders.tolist() == found.primitives.tolist() == [0, frames]


@pytest.mark.parametrize("seconds", [3, 10, 40, 150])
def test_what_never_comes_back_repeats_nothing(seconds: int) -> None:
    found = analyze(np.arange(30 * seconds)[:, None] * [0.01, 0.02], KINEME)
    assert_whole(found, 30 * seconds)
    assert (found.segments.counts <= 1).all()
    activities = found.segments.labels[found.segments.labels >= 0]
    assert len(set(activities.tolist())) == len(activities)


@st.composite
def constants(draw: st.DrawFn) -> dict[str, float]:
    some = st.sampled_from([0.01, 0.1, 1.0, 50.0])
    none_or_some = st.sampled_from([0.0, 0.01, 0.1, 1.0, 50.0])
    share = st.sampled_from([0.0, 0.3, 1.0])
    choices = {
        "rate": st.sampled_from([1.0, 2.0, 5.0, 10.0]),
        "averaging": some,
        "weights": st.sampled_from([(0.0,) * 5, (1.0,) * 5]),
        "shared": st.sampled_from([(0.3,) * 5, (1.0,) * 5]),
        "restless_over": st.sampled_from([(0.5,) * 5, (2.0,) * 5]),
        "velocity_weight": none_or_some,
        "part": st.sampled_from([2.0, 5.0, 1000.0]),
        "fine_cost": none_or_some,
        "compared_within": some,
        "segment_cost": none_or_some,
        "cluster_cost": none_or_some,
        "cluster_growth": share,
        "min_action": none_or_some,
        "max_clusters": st.integers(1, 20),
        "two_movements": share,
        "chance_count": some,
        "chance_period": some,
        "max_repetition": some,
        "border_shift": share,
        "centering": share,
        "max_unexplained": share,
        "event_scale": none_or_some,
        "min_recurrence": some,
    }
    return {name: draw(choices[name]) for name in draw(st.sets(st.sampled_from(sorted(choices))))}


# A merge of three neighbours brings two of one cluster together.
@example(
    {
        "averaging": 1.0,
        "compared_within": 0.01,
        "part": 5.0,
        "min_recurrence": 0.01,
        "chance_period": 0.01,
        "max_repetition": 0.01,
        "max_unexplained": 1.0,
        "min_action": 0.0,
        "restless_over": (2.0,) * 5,
        "segment_cost": 0.1,
        "two_movements": 1.0,
        "weights": (1.0,) * 5,
    },
    163,
)
@given(constants(), st.integers(1, 400))
@settings(max_examples=60)
def test_segments_tile_whatever_the_constants(overrides, frames) -> None:
    rows = np.concatenate([make_swings(5, period=1), make_swings(6, period=1.2, axis=2)])[:frames]
    found = analyze(rows, resolve_preset("kineme", **overrides))
    assert_whole(found, len(rows))


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (np.zeros((0, 3)), "frames x dims"),
        (np.zeros(50), "frames x dims"),
        (np.array([[0.0], [np.nan]]), "not finite, first in frame 1"),
    ],
)
def test_rows_that_are_no_features_are_refused(rows, message) -> None:
    with pytest.raises(ParameterError, match=message):
        analyze(rows, KINEME)


def test_progress_and_timings_name_the_stages() -> None:
    names: list[str] = []
    found = analyze(np.zeros((40, 2)), KINEME, progress=names.append)
    stages = ["views", "segments", "borders", "repetitions", "events", "confidence"]
    assert names == [*found.timings] == stages


@cache
def recording(seed: int) -> Motion:
    return random_recording(seed).motion


@cache
def found_in(seed: int) -> Segmentation:
    return segment(recording(seed))


def counts(found: Segmentation) -> list[int]:
    inside = found.primitives.kind == "primitive"
    parents = found.primitives.activity[inside].tolist()
    return [len(list(run)) for _, run in groupby(parents)]


def test_the_bundled_recording_is_found_as_it_was_made() -> None:
    truth = kineme.read_segments(bundled_truth())
    found = segment(kineme.read(bundled_recording()))
    for part in (truth, found):
        activities = part.activities
        moving = activities.kind == "activity"
        assert activities.cluster[moving].tolist() == [0, 1, 0, 2, 3, 4, 5]
        assert np.abs(np.subtract(counts(part), [5, 4, 4, 5, 4, 6, 4])).max() <= 1


def test_real_recordings_are_found_as_people_annotated_them(data_dir: Path) -> None:
    """Return the five available trials of subject 86, of fourteen in the paper."""
    names = ["86_01", "86_09", "86_10", "86_11", "86_14"]
    scores = []
    for trial in load_trials(find_folder(data_dir), names):
        found = segment(trial.motion)
        scores.append(evaluate(trial.truth, found))
        assert scores[-1]["one_to_one_agreed"] >= 0.6, trial.name
        assert 0.75 <= scores[-1]["cluster_ratio"] <= 1.4, trial.name
        assert 0.6 <= scores[-1]["border_ratio"] <= 1.4, trial.name
        assert scores[-1]["border_f1"] >= 0.6, trial.name
    means = mean(scores)
    assert means["border_f1"] >= 0.8
    assert means["one_to_one_agreed"] >= 0.85
    assert means["cluster_ratio"] <= 1.4


@given(st.integers(0, 3), st.floats(0.5, 2))
@settings(max_examples=8)
def test_the_size_of_a_body_changes_no_cut(seed, factor) -> None:
    found, expected = segment(scale(recording(seed), factor)), found_in(seed)
    for name in ("start_frame", "stop_frame", "kind", "cluster"):
        np.testing.assert_array_equal(
            getattr(found.table, name), getattr(expected.table, name), name
        )


@pytest.mark.parametrize("fps", [60.0, 240.0])
def test_the_frame_rate_of_the_source_changes_no_border(fps: float) -> None:
    for seed in range(4):
        found, expected = segment(resample(recording(seed), fps)), found_in(seed)
        assert found.activities.cluster.tolist() == expected.activities.cluster.tolist()
        for name in ("start_s", "stop_s"):
            np.testing.assert_allclose(
                getattr(found.activities, name), getattr(expected.activities, name), atol=0.1
            )
        assert counts(found) == counts(expected)
