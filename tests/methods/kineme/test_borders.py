"""Borders to the frame, first and last repetitions, and neighbours that are one set."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import naive
from kineme.methods.kineme import _repetition_kernels as kernels
from kineme.methods.kineme.borders import Ends, Sets, fit_ends, join_sets, refine_borders
from kineme.methods.kineme.pipeline import analyze
from kineme.methods.kineme.preset import KINEME, SENSORS
from kineme.methods.kineme.repetitions import find_repetitions
from loops import make_swings

FPS = round(SENSORS.working_fps)
SECOND = round(SENSORS.averaging * FPS)


def quiet_and_loud(seed: int, ends: list[int]) -> np.ndarray:
    """Make four channels that alternate between quiet and loud, up to each end."""
    rng = np.random.default_rng(seed)
    lengths = np.diff([0, *ends])
    deviations = np.repeat(np.where(np.arange(len(ends)) % 2, 1.0, 0.1), lengths)
    return deviations[:, None] * rng.standard_normal((ends[-1], 4))


@given(seed=st.integers(0, 99), late=st.integers(-SECOND // 2, SECOND // 2))
@settings(max_examples=30)
def test_a_border_moves_towards_where_quiet_ends(seed, late) -> None:
    true = 6 * FPS
    channels = quiet_and_loud(seed, [true, 12 * FPS])
    borders = np.array([0, true + late, 12 * FPS])
    starts, _ = refine_borders(channels, borders, SENSORS)
    assert abs(starts[1] - (true + (1 - SENSORS.border_shift) * late)) <= 2


@given(seed=st.integers(0, 99), lengths=st.lists(st.integers(1, 200), min_size=1, max_size=8))
@settings(max_examples=60)
def test_no_segment_comes_or_goes(seed, lengths) -> None:
    ends = np.cumsum(lengths).tolist()
    borders = np.array([0, *ends])
    channels = quiet_and_loud(seed, ends)
    for preset in (SENSORS, KINEME.replace(transition_cost=1e-9)):
        starts, stops = refine_borders(channels, borders, preset)
        assert starts[0] == 0
        assert stops[-1] == borders[-1]
        assert (starts < stops).all()
        assert (stops[:-1] <= starts[1:]).all()
        assert (np.abs(starts - borders[:-1]) <= SECOND).all()
        assert (np.abs(stops - borders[1:]) <= SECOND).all()
        again = refine_borders(-8 * channels[:, ::-1] + 64, borders, preset)
        assert (starts == again[0]).all()
        assert (stops == again[1]).all()


@pytest.mark.parametrize("off", [-6, 0, 6])
def test_what_neither_side_explains_is_a_transition(off: int) -> None:
    """A change of pose over half a second is a transition; a border at a single change is not."""
    fps = round(KINEME.working_fps)
    noise = 0.05 * np.random.default_rng(0).standard_normal((12 * fps, 4))
    at = np.arange(12 * fps)
    going = np.clip((at - 5.75 * fps) / (0.5 * fps), 0, 1)[:, None]
    borders = np.array([0, 6 * fps + off, 12 * fps])
    starts, stops = refine_borders(noise + going, borders, KINEME)
    assert abs(stops[0] - 5.75 * fps) <= 4
    assert abs(starts[1] - 6.25 * fps) <= 4
    starts, stops = refine_borders(noise + (at >= 6 * fps)[:, None], borders, KINEME)
    assert starts[1] == stops[0]


PERIOD = 36
AWAY = np.repeat([[0.0, 0.0, 0.0, 0.0, 2.0, 2.0]], 60, axis=0)


def fit_alone(
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
    """Check that ends do not depend on the borders of the activity."""
    for found in (
        fit_alone(shaken(1), 60 + late, STOP - late, CUTS),
        fit_alone(shaken(2), 60 + late, STOP + late, CUTS),
    ):
        assert abs(int(found.firsts[0]) - 60) <= 2
        assert abs(int(found.lasts[0]) - STOP) <= 2


def test_a_part_of_a_repetition_stays_in_the_activity_and_is_no_repetition() -> None:
    """Let the movement continue for twelve frames beyond both ends."""
    more = make_swings(10, period=PERIOD / 30)[PERIOD - 12 : -PERIOD + 12]
    rows = np.concatenate([AWAY, more, AWAY])
    rows += np.random.default_rng(4).normal(0, 0.02, rows.shape)
    found = fit_alone(rows, 60, 60 + len(more), [cut + 12 for cut in CUTS])
    assert (found.starts[0], found.stops[0]) == (60, 60 + len(more))
    assert abs(int(found.firsts[0]) - 72) <= 2
    assert abs(int(found.lasts[0]) - 60 - len(more) + 12) <= 2


def test_an_activity_that_begins_late_takes_nothing_from_its_neighbour() -> None:
    found = fit_alone(shaken(5), 72, STOP, CUTS, (STOP, STOP + 60, 1))
    assert found.starts[0] == found.firsts[0] == pytest.approx(60, abs=2)
    late = fit_alone(shaken(5), 60, STOP - 12, CUTS, (STOP - 12, STOP + 60, 1))
    assert late.stops[0] == late.starts[1] == STOP - 12


def test_two_of_one_action_stay_apart() -> None:
    found = fit_alone(shaken(6), 60, STOP - 12, CUTS, (STOP - 3, STOP + 60, 0))
    assert (found.stops[0], found.starts[1]) == (STOP - 12, STOP - 3)


@given(st.integers(0, 400), st.integers(1, 400), st.sets(st.integers(1, 399), max_size=9))
@settings(max_examples=60)
def test_repetitions_lie_in_their_activity_whatever_is_cut(start, length, places) -> None:
    rows = shaken(8)
    start = min(start, len(rows) - 1)
    stop = min(start + length, len(rows))
    cuts = sorted(start + place for place in places if start + place < stop)
    found = fit_alone(rows, start, stop, cuts)
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


FAST = 18
HALF = 6 * FAST


def make_fast_set(channel: int, count: int = 6) -> np.ndarray:
    """Make make_fast_set of one of four channels, each with a small one of another."""
    angle = 2 * np.pi * np.arange(count * FAST) / FAST
    rows = np.zeros((len(angle), 4))
    rows[:, channel], rows[:, channel - 1] = np.sin(angle), 0.3 * np.sin(2 * angle)
    return rows


def joined(left: np.ndarray, right: np.ndarray) -> Sets:
    """Return two halves of a recording as separate clusters."""
    rows = np.concatenate([left, right])
    rows = rows + np.random.default_rng(0).normal(0, 0.02, rows.shape)
    rows, ends = np.ascontiguousarray(rows, np.float32), np.array([0, len(left), len(rows)])
    cuts = [
        find_repetitions(rows, 0, ends[1], KINEME),
        find_repetitions(rows, ends[1], ends[2], KINEME),
    ]
    return join_sets(rows, Sets(ends[:-1], ends[1:], np.arange(2), cuts), KINEME)


@pytest.mark.parametrize("moved", [0.0, 0.5, 3.0])
def test_a_fast_set_is_one_wherever_the_hand_moves(moved: float) -> None:
    found = joined(make_fast_set(1), make_fast_set(1, 7) + moved)
    assert found.starts.tolist() == [0]
    assert found.stops.tolist() == [13 * FAST]
    assert found.labels.tolist() == [0]


@pytest.mark.parametrize(
    "other",
    [make_fast_set(3), -make_fast_set(1), np.zeros((HALF, 4)), make_fast_set(1)[::2]],
    ids=["other channels", "other way round", "rest", "twice as fast"],
)
def test_two_activities_stay_apart(other: np.ndarray) -> None:
    assert joined(make_fast_set(1), other).labels.tolist() == [0, 1]
