"""Search by example and mutual warping costs: the naive version, speeds, runs, and errors."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import cdist

import naive
from kineme.errors import ParameterError
from kineme.transfer.matching import (
    BLOCK,
    Primitives,
    compute_label_costs,
    number_movements,
    search,
    warp,
)


def make_directions(n: int, seed: int, dims: int = 6) -> np.ndarray:
    """Make a smooth random walk on the sphere."""
    values = np.cumsum(np.random.default_rng(seed).normal(size=(n, dims)), axis=0)
    return (values / np.linalg.norm(values, axis=1, keepdims=True)).astype(np.float32)


def change_speed(features: np.ndarray, speed: float) -> np.ndarray:
    at = np.arange(0, len(features) - 1, speed)
    before, share = at.astype(int), (at % 1)[:, None]
    return (1 - share) * features[before] + share * features[before + 1]


@given(st.integers(1, 12), st.integers(1, 6), st.integers(0, 99))
@settings(max_examples=60)
def test_equal_to_the_naive_version(n: int, m: int, seed: int) -> None:
    recording, example = make_directions(n, seed), make_directions(m, seed + 100)
    costs, starts = warp(example, recording)
    expected, begins = naive.find_warpings(cdist(recording, example))
    np.testing.assert_allclose(costs, expected, rtol=1e-5, atol=1e-3)  # float32
    possible = np.isfinite(expected)
    assert starts[possible].tolist() == np.array(begins)[possible].tolist()


def test_a_long_recording_is_one_whatever_the_block() -> None:
    recording = make_directions(2 * BLOCK + 50, 1)
    across = slice(BLOCK - 8, BLOCK + 12)
    found = search(recording[across], recording, threshold=0.01)
    assert (found.starts.tolist(), found.stops.tolist()) == ([across.start], [across.stop])


@pytest.mark.parametrize("speed", [0.55, 0.8, 1.0, 1.5, 1.9])
def test_found_at_half_to_twice_the_speed(speed: float) -> None:
    movement = np.stack([np.cos(np.arange(40) / 12), np.sin(np.arange(40) / 12)], axis=1)
    still = np.repeat([[-1.0, 0.0]], 30, axis=0)
    performed = change_speed(movement, speed)
    found = search(movement, np.concatenate([still, performed, still]), threshold=0.1)
    assert len(found.starts) == 1
    assert abs(found.starts[0] - 30) <= 3
    assert abs(found.stops[0] - 30 - len(performed)) <= 3


def test_matches_are_apart_within_the_threshold_and_the_best_come_first() -> None:
    angle = np.cumsum(np.random.default_rng(4).uniform(0.2, 0.4, 400))
    recording = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    found = search(recording[50:70], recording, threshold=0.2)
    assert len(found.starts) > 10
    assert (found.starts[0], found.stops[0]) == (50, 70)
    assert (np.diff(found.distances) >= 0).all()
    assert found.distances[-1] <= 0.2
    spans = sorted(zip(found.starts.tolist(), found.stops.tolist(), strict=True))
    assert all(one[1] <= other[0] for one, other in pairwise(spans))
    few = search(recording[50:70], recording, threshold=0.2, top=2)
    assert few.starts.tolist() == found.starts[:2].tolist()


def test_nothing_is_found_where_the_body_is_not_seen() -> None:
    recording = make_directions(100, 5)
    recording[40:60] = 0.0
    for start, stop in zip(*search(make_directions(10, 6), recording)[:2], strict=True):
        assert not (start < 60 and stop > 50)
    assert len(search(make_directions(10, 6), np.zeros((200, 6))).starts) == 0


@pytest.mark.parametrize(
    ("example", "options", "said"),
    [
        (np.zeros((5, 7)), {}, "same features"),
        (np.zeros((0, 6)), {}, "at least one sample"),
        (np.zeros(6), {}, "samples x dims"),
        ("walk", {}, "array of numbers"),
        (np.zeros((5, 6)), {"threshold": 0}, "above 0, not 0"),
        (np.zeros((5, 6)), {"top": 0}, "above 0, not 0"),
    ],
)
def test_what_cannot_be_searched_is_refused(example: object, options: dict, said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        search(example, make_directions(50, 8), **options)


DIMS = 3


def compute_naive_label_costs(
    unknown: Primitives, known: Primitives, codes, n_labels: int
) -> np.ndarray:
    costs = np.full((len(unknown), n_labels), np.inf)

    def frames_of(side: Primitives, run: int) -> np.ndarray:
        return side.features[side.frame_runs == run]

    def one(side: Primitives, p: int) -> np.ndarray:
        return side.features[side.starts[p] : side.starts[p + 1]]

    def between(example: np.ndarray, frames: np.ndarray) -> float:
        distances = np.linalg.norm(frames[:, None] - example[None], axis=2)
        return min(naive.find_warpings(distances)[0])

    for u in range(len(unknown)):
        for k in range(len(known)):
            there = between(one(unknown, u), frames_of(known, known.runs[k]))
            ways_back = [
                between(one(known, other), frames_of(unknown, unknown.runs[u]))
                for other in np.flatnonzero(known.runs == known.runs[k])
            ]
            back = sorted(ways_back)[(len(ways_back) - 1) // 2]
            costs[u, codes[k]] = min(costs[u, codes[k]], max(there, back))
    return costs


@st.composite
def primitives(draw: st.DrawFn, most: int = 5) -> Primitives:
    n = draw(st.integers(1, most))
    lengths = np.array(draw(st.lists(st.integers(2, 6), min_size=n, max_size=n)))
    follows = draw(st.lists(st.booleans(), min_size=n - 1, max_size=n - 1))
    runs = np.concatenate([[0], np.cumsum(~np.array(follows, bool))]).astype(np.int64)
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    return Primitives(rng.normal(size=(lengths.sum(), DIMS)), lengths, runs)


@settings(max_examples=60)
@given(primitives(), primitives())
def test_costs_are_those_of_the_naive_version(unknown: Primitives, known: Primitives) -> None:
    codes = known.runs % 3
    costs = compute_label_costs(unknown, known, codes, 3, radius=1e3)
    expected = compute_naive_label_costs(unknown, known, codes, 3)
    np.testing.assert_allclose(costs, expected, rtol=1e-4, atol=1e-3)  # of single precision


def make_cycles(n: int, *, phase: float = 0.0, frames: int = 12) -> np.ndarray:
    angles = 2 * np.pi * (np.arange(n * frames) / frames + phase)
    return np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)


def test_a_cycle_cut_at_another_phase_matches_inside_a_run_only() -> None:
    unknown = Primitives(make_cycles(2, phase=0.5), np.array([12, 12]), np.array([0, 0]))
    for runs, cost in (([0, 0, 0], 0.0), ([0, 1, 2], np.inf)):
        known = Primitives(make_cycles(3), np.array([12] * 3), np.array(runs))
        found = compute_label_costs(unknown, known, np.zeros(3, int), 1, radius=0.2)
        np.testing.assert_allclose(found, cost, atol=1e-5)


def test_a_part_of_a_movement_is_not_that_movement() -> None:
    whole = np.linspace([0, 0, 0], [3, 0, 0], 30)
    short, long = (Primitives(f, np.array([len(f)]), np.array([0])) for f in (whole[:8], whole))
    for unknown, known in ((short, long), (long, short)):
        found = compute_label_costs(unknown, known, np.zeros(1, int), 1, radius=0.3)
        assert np.isinf(found).all()
    assert compute_label_costs(long, long, np.zeros(1, int), 1, radius=0.3).item() < 1e-5


def test_a_fragment_does_not_stand_for_its_run() -> None:
    line = np.linspace([0, 0, 0], [3, 0, 0], 20)
    fragment = np.zeros((4, 3))
    run = Primitives(
        np.concatenate([line, fragment, line[::-1]]), np.array([20, 4, 20]), np.zeros(3, int)
    )
    still = Primitives(np.zeros((4, 3)), np.array([4]), np.array([0]))
    assert np.isinf(compute_label_costs(still, run, np.zeros(3, int), 1, radius=0.3)).all()


def test_what_matches_through_others_is_one_movement() -> None:
    heights = (0.0, 0.2, 0.4, 3.0)
    frames = np.concatenate([make_cycles(1) + [0, 0, height] for height in heights])
    four = Primitives(frames, np.array([12] * 4), np.arange(4))
    assert number_movements(four, 0.25).tolist() == [0, 0, 0, 1]
