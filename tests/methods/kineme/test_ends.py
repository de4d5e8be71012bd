"""The start of the first repetition, and the end of the last one."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import naive
from kineme.methods.kineme import _repetition_kernels as kernels
from kineme.methods.kineme.borders import Ends, fit_ends
from kineme.methods.kineme.pipeline import analyze
from kineme.methods.kineme.preset import KINEME
from loops import make_swings

PERIOD = 36
AWAY = np.repeat([[0.0, 0.0, 0.0, 0.0, 2.0, 2.0]], 60, axis=0)


def ends(
    rows: np.ndarray, start: int, stop: int, cuts: list[int], *others: tuple[int, int, int]
) -> Ends:
    """Fit the ends of an activity with these cuts, and of others without cuts."""
    starts, stops, labels = zip((start, stop, 0), *others, strict=True)
    every = [np.array(cuts, np.int64), *(np.empty(0, np.int64) for _ in others)]
    spans = (np.array(part, np.int64) for part in (starts, stops, labels))
    return fit_ends(np.ascontiguousarray(rows, np.float32), *spans, every, KINEME)


def shaken(seed: int) -> np.ndarray:
    """Make eight different swings between two rests in other poses."""
    rows = np.concatenate([AWAY, make_swings(8, period=PERIOD / 30), AWAY])
    return rows + np.random.default_rng(seed).normal(0, 0.02, rows.shape)


@given(st.integers(0, 10_000))
@settings(max_examples=60)
def test_stretches_are_compared_as_by_the_naive_versions(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rows = np.cumsum(rng.normal(0, 1, (60, 3)), axis=0).astype(np.float32)
    cuts = np.sort(rng.choice(np.arange(20, 60), 4, replace=False))
    lengths, places = np.diff(cuts), 7
    inner = kernels.sample_evenly(rows, cuts[:-1], lengths, places)
    for found, start, length in zip(inner, cuts, lengths):
        expected = naive.sample_evenly(rows, start, length, places)
        np.testing.assert_allclose(found, expected, atol=1e-5)
    mean = inner.mean(axis=0)
    assert kernels.find_best_length(rows, cuts[0], 4, 20, mean) == naive.find_best_length(
        rows, cuts[0], 4, 20, mean
    )


CUTS = [60 + PERIOD * k for k in range(1, 8)]
STOP = 60 + PERIOD * 8


@pytest.mark.parametrize("late", [-12, -6, 0, 6, 12])
def test_the_first_and_the_last_repetition_are_as_long_as_the_others(late: int) -> None:
    """The ends do not depend on the borders of the activity."""
    for found in (
        ends(shaken(1), 60 + late, STOP - late, CUTS),
        ends(shaken(2), 60 + late, STOP + late, CUTS),
    ):
        assert abs(int(found.firsts[0]) - 60) <= 2
        assert abs(int(found.lasts[0]) - STOP) <= 2


def test_a_part_of_a_repetition_stays_in_the_activity_and_is_no_repetition() -> None:
    """The movement continues for twelve frames beyond both ends."""
    more = make_swings(10, period=PERIOD / 30)[PERIOD - 12 : -PERIOD + 12]
    rows = np.concatenate([AWAY, more, AWAY])
    rows += np.random.default_rng(4).normal(0, 0.02, rows.shape)
    found = ends(rows, 60, 60 + len(more), [cut + 12 for cut in CUTS])
    assert (found.starts[0], found.stops[0]) == (60, 60 + len(more))
    assert abs(int(found.firsts[0]) - 72) <= 2
    assert abs(int(found.lasts[0]) - 60 - len(more) + 12) <= 2


def test_an_activity_that_begins_late_takes_nothing_from_its_neighbour() -> None:
    found = ends(shaken(5), 72, STOP, CUTS, (STOP, STOP + 60, 1))
    assert found.starts[0] == found.firsts[0] == pytest.approx(60, abs=2)
    late = ends(shaken(5), 60, STOP - 12, CUTS, (STOP - 12, STOP + 60, 1))
    assert late.stops[0] == late.starts[1] == STOP - 12


def test_two_of_one_action_stay_apart() -> None:
    found = ends(shaken(6), 60, STOP - 12, CUTS, (STOP - 3, STOP + 60, 0))
    assert (found.stops[0], found.starts[1]) == (STOP - 12, STOP - 3)


@given(st.integers(0, 400), st.integers(1, 400), st.sets(st.integers(1, 399), max_size=9))
@settings(max_examples=60)
def test_repetitions_lie_in_their_activity_whatever_is_cut(start, length, places) -> None:
    rows = shaken(8)
    start = min(start, len(rows) - 1)
    stop = min(start + length, len(rows))
    cuts = sorted(start + place for place in places if start + place < stop)
    found = ends(rows, start, stop, cuts)
    inside = [0, *found.starts, *found.firsts, *cuts, *found.lasts, *found.stops, len(rows)]
    assert inside == sorted(inside)


def test_what_is_part_of_no_repetition_is_a_transition_of_the_primitive_level() -> None:
    more = make_swings(9, period=PERIOD / 30)[PERIOD // 3 :]
    turn = make_swings(8, period=1, axis=2)
    columns = analyze(np.concatenate([turn, more, turn]), KINEME).columns()
    primitive = columns["level"] == "primitive"
    lengths = (columns["stop_frame"] - columns["start_frame"])[primitive]
    repetition = columns["kind"][primitive] == "activity"
    np.testing.assert_allclose(
        lengths[repetition], np.where(lengths[repetition] > 33, 36, 30), atol=6
    )
    assert (columns["cluster"][primitive][~repetition] == -1).all()
    assert np.isnan(columns["confidence"][primitive][~repetition]).all()
