"""From features to counted actions: what is known is found, and what changes nothing."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache
from itertools import groupby, pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import ortho_group

from kineme.datasets import random_recording
from kineme.errors import ParameterError
from kineme.methods.presets import resolve_preset
from kineme.methods.recurrence.analysis import analyze_actions
from kineme.methods.recurrence.found import RecurrenceFound
from kineme.methods.recurrence.preset import KINEME
from kineme.segmentation.bodies import motion_features
from loops import swing

few = settings(max_examples=8)


@cache
def recorded(seed: int) -> np.ndarray:
    return motion_features(random_recording(seed).motion, KINEME)


@cache
def analysis_of(seed: int) -> RecurrenceFound:
    return analyze_actions(recorded(seed), KINEME)


def assert_same(found: RecurrenceFound, expected: RecurrenceFound) -> None:
    for name in ("borders", "labels", "primitives", "clusters"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name), name)
    for name in ("links", "counts", "borders", "cuts"):
        probabilities = (getattr(each.confidence, name) for each in (found, expected))
        np.testing.assert_allclose(*probabilities, atol=1e-2)


def repetitions_of(found: RecurrenceFound) -> list[int]:
    """How many repetitions each activity has; transitions left out."""
    parents = np.searchsorted(found.borders, found.primitives[:-1], side="right") - 1
    return np.bincount(parents[found.clusters >= 0], minlength=len(found.labels))[
        found.labels >= 0
    ].tolist()


# --- what is known is found -------------------------------------------------------------------


@st.composite
def sequences(draw: st.DrawFn) -> list[tuple[int, float, int]]:
    """Which of three movements, its period, how often: for at least 5 s and four times each."""
    axes = draw(st.lists(st.integers(0, 2), min_size=2, max_size=5))
    axes = [axis for axis, _ in groupby(axes)]
    periods = [draw(st.integers(18, 60)) / 30 for _ in range(3)]
    return [
        (axis, periods[axis], draw(st.integers(max(4, round(5 / periods[axis] + 0.5)), 18)))
        for axis in axes
    ]


@given(sequences())
@settings(max_examples=60)
def test_actions_their_borders_and_counts_are_found(sequence) -> None:
    parts = [swing(times, period=period, axis=2 * axis) for axis, period, times in sequence]
    rows = np.concatenate(parts)
    found = analyze_actions(rows, KINEME)
    activities = found.labels >= 0
    order = list(dict.fromkeys(axis for axis, _, _ in sequence))
    assert found.labels[activities].tolist() == [order.index(axis) for axis, _, _ in sequence]
    borders = np.cumsum([0, *map(len, parts)])
    assert np.abs(found.borders[:-1][activities] - borders[:-1]).max() <= 6
    assert np.abs(found.borders[1:][activities] - borders[1:]).max() <= 6
    assert repetitions_of(found) == [times for _, _, times in sequence]


def test_an_action_that_returns_after_minutes_is_known_again() -> None:
    """Beyond the window of 60 s, and beyond what the band reaches."""
    walk, turn = swing(12, period=1), [swing(50, period=2, axis=2), swing(12, period=1, axis=4)]
    found = analyze_actions(np.concatenate([walk, *turn, walk, turn[1]]), KINEME)
    assert found.labels[found.labels >= 0].tolist() == [0, 1, 2, 0, 2]
    assert repetitions_of(found) == [12, 50, 12, 12, 12]


def test_similarity_is_looked_for_no_farther_away_than_asked() -> None:
    walk, turn = swing(12, period=1), swing(12, period=1.2, axis=2)
    rows = np.concatenate([walk, turn, walk])
    near = analyze_actions(rows, KINEME.replace(max_lag=8.0))
    assert near.labels[near.labels >= 0].tolist() == [0, 1, 2]
    assert_same(
        analyze_actions(rows, KINEME.replace(max_lag=1000.0)), analyze_actions(rows, KINEME)
    )


# --- what changes nothing ---------------------------------------------------------------------


@given(st.integers(0, 3), st.integers(0, 2**32 - 1), st.floats(-100, 100))
@few
def test_moving_and_turning_the_features_changes_nothing(seed, turn, shift) -> None:
    rows = recorded(seed)
    stacked = rows.reshape(len(rows), len(KINEME.offsets), -1)
    turn_of_poses = ortho_group.rvs(stacked.shape[2], random_state=turn)
    turned = (stacked @ turn_of_poses).reshape(rows.shape) + shift
    assert_same(analyze_actions(turned, KINEME), analysis_of(seed))


PRINT_DIGEST = """
import hashlib, numpy as np
from kineme.datasets import random_recording
from kineme.methods.recurrence.analysis import analyze_actions
from kineme.methods.recurrence.preset import KINEME
from kineme.segmentation.bodies import motion_features
for _ in range(2):
    found = analyze_actions(motion_features(random_recording(2).motion, KINEME), KINEME)
    digest = hashlib.sha256()
    for part in (found.recurrence.near, found.recurrence.similarity, found.borders, found.labels,
                 found.confidence.links, found.confidence.counts, found.confidence.borders,
                 found.primitives, found.confidence.cuts):
        digest.update(np.ascontiguousarray(part).tobytes())
    print(digest.hexdigest())
"""


def test_threads_and_repetition_change_nothing() -> None:
    digests = {
        line
        for threads in ("1", "2", "5")
        for line in subprocess.run(
            [sys.executable, "-c", PRINT_DIGEST],
            env={**os.environ, "KINEME_THREADS": threads},
            capture_output=True,
            text=True,
            check=True,
        ).stdout.split()
    }
    assert len(digests) == 1


# --- what holds for every input ---------------------------------------------------------------


def assert_whole(found: RecurrenceFound, frames: int) -> None:
    for borders in (found.borders, found.primitives):
        assert borders[0] == 0
        assert borders[-1] == frames
        assert (np.diff(borders) > 0).all()
    assert set(found.borders.tolist()) <= set(found.primitives.tolist())
    labels = found.labels.tolist()
    assert len(labels) == len(found.borders) - 1
    assert all(a != b for a, b in pairwise(labels))
    known = [label for label in dict.fromkeys(labels) if label >= 0]
    assert known == list(range(len(known)))
    assert set(labels) <= {-1, *known}
    moving, sure = found.labels >= 0, found.confidence
    periodic = moving & ~np.isin(found.labels, found.not_periodic)
    for probabilities, known in ((sure.links, moving), (sure.counts, periodic)):
        assert np.isfinite(probabilities).tolist() == known.tolist()
    assert np.isnan(sure.borders[0])
    for probabilities in (sure.links, sure.counts, sure.borders, sure.cuts):
        given = probabilities[np.isfinite(probabilities)]
        assert ((given >= 0) & (given <= 1)).all()
    assert np.isfinite(sure.borders[1:]).all()
    begins = np.isin(found.primitives[:-1], found.borders) | periodic[found.evidence.parents]
    assert np.isfinite(sure.cuts[1:][begins[1:]]).all()
    assert len(sure.cuts) == len(found.primitives) - 1


def test_activities_alternate_and_are_counted_by_first_appearance() -> None:
    for seed in range(4):
        found = analysis_of(seed)
        assert_whole(found, len(recorded(seed)))
        assert (found.labels >= 0).sum() >= 4


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
    found = analyze_actions(rows, KINEME)
    assert_whole(found, frames)
    if kind == "held" or frames <= 2:
        assert found.borders.tolist() == found.primitives.tolist() == [0, frames]


def test_what_never_comes_back_is_one_transition() -> None:
    for seconds in (3, 10, 40, 150):
        found = analyze_actions(np.arange(30 * seconds)[:, None] * [0.01, 0.02], KINEME)
        assert found.labels.tolist() == [-1]
        assert found.primitives.tolist() == [0, 30 * seconds]


@st.composite
def constants(draw: st.DrawFn) -> dict[str, float | None]:
    some = st.sampled_from([0.01, 0.1, 1.0, 50.0])
    none_or_some = st.sampled_from([0.0, 0.01, 0.1, 1.0, 50.0])
    choices = {
        "max_lag": st.none() | some,
        "resolution": st.sampled_from([0.001, 0.1, 0.5]),
        "window": some,
        "phase": none_or_some,
        "recurrence_time": some,
        "min_scale": st.sampled_from([1e-6, 0.1]),
        "max_scale": st.sampled_from([0.1, 1e4]),
        "softness": st.sampled_from([0.01, 1.0, 100.0]),
        "border_cost": none_or_some,
        "min_segment": none_or_some,
        "merge_gap": none_or_some,
        "merge_softness": some,
        "merge_share": st.sampled_from([0.01, 1.0]),
        "link_similarity": st.sampled_from([0.01, 0.5, 1.0]),
        "min_repetition": none_or_some,
        "switch_cost": none_or_some,
        "no_action_cost": none_or_some,
        "min_action": none_or_some,
        "transition_factor": some,
        "max_transition": none_or_some,
    }
    return {name: draw(choices[name]) for name in draw(st.sets(st.sampled_from(sorted(choices))))}


@given(constants(), st.integers(1, 400))
@settings(max_examples=60)
def test_segments_tile_whatever_the_constants(overrides, frames) -> None:
    rows = np.concatenate([swing(5, period=1), swing(6, period=1.2, axis=2)])[:frames]
    found = analyze_actions(rows, resolve_preset("kineme", **overrides))
    assert_whole(found, len(rows))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("resolution", 0),
        ("window", -1.0),
        ("max_lag", 0),
        ("softness", float("nan")),
        ("phase", -0.1),
        ("min_scale", 0.5),
        ("link_similarity", 0),
        ("link_similarity", 1.5),
        ("radius", 0.64),
    ],
)
def test_a_constant_out_of_range_is_named(name: str, value: object) -> None:
    with pytest.raises(ParameterError, match=name):
        resolve_preset("kineme", **{name: value})


@pytest.mark.parametrize("shape", [(0, 3), (50, 0), (50,)])
def test_features_of_another_shape_are_refused(shape) -> None:
    with pytest.raises(ParameterError, match="frames x dims"):
        analyze_actions(np.zeros(shape), KINEME)


def test_a_gap_in_the_features_is_named() -> None:
    rows = np.zeros((50, 2))
    rows[20, 1] = np.nan
    with pytest.raises(ParameterError, match="not finite, first in frame 20"):
        analyze_actions(rows, KINEME)


def test_progress_and_timings_name_the_stages() -> None:
    names: list[str] = []
    found = analyze_actions(np.zeros((40, 2)), KINEME, progress=names.append)
    stages = ["recurrence", "activities", "paces", "occurrences", "confidence"]
    assert names == [*found.timings] == stages
