"""Mutual warping costs: the naive version, and rules of runs and labels."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

import naive
from kineme.transfer.matching import Primitives, compute_label_costs, number_movements

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
def test_equal_to_the_naive_version(unknown: Primitives, known: Primitives) -> None:
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
