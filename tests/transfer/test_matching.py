"""Mutual warping costs: a naive twin, and the laws of runs and labels."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kineme.transfer import matching
from kineme.transfer.matching import Primitives, label_costs

DIMS = 3


def naive_cost(distances: np.ndarray) -> float:
    """Mean node of the cheapest path from the first row to the last, from any column to any."""
    n, m = distances.shape
    best = [[(0.0, 0)] * m for _ in range(n)]
    for i in range(n):
        for j in range(m):
            before = [(0.0, 0)] if i == 0 else []
            for a, b in ((1, 1), (1, 0), (0, 1)):
                if i >= a and j >= b:
                    before.append(best[i - a][j - b])
            cost, nodes = min(before)
            best[i][j] = (cost + distances[i, j], nodes + 1)
    cost, nodes = min(best[-1])
    return cost / nodes


def naive_label_costs(unknown: Primitives, known: Primitives, codes, n_labels: int) -> np.ndarray:
    costs = np.full((len(unknown), n_labels), np.inf)

    def frames_of(side: Primitives, run: int) -> np.ndarray:
        return side.features[side.frame_runs == run]

    def one(side: Primitives, p: int) -> np.ndarray:
        return side.features[side.starts[p] : side.starts[p + 1]]

    def between(rows: np.ndarray, columns: np.ndarray) -> float:
        return naive_cost(np.linalg.norm(rows[:, None] - columns[None], axis=2))

    for u in range(len(unknown)):
        for k in range(len(known)):
            there = between(one(unknown, u), frames_of(known, known.runs[k]))
            back = between(one(known, k), frames_of(unknown, unknown.runs[u]))
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
    costs = label_costs(unknown, known, codes, 3, radius=1e3)
    expected = naive_label_costs(unknown, known, codes, 3)
    np.testing.assert_allclose(costs, expected, rtol=1e-5, atol=1e-5)


@settings(max_examples=30)
@given(primitives(), primitives(9), st.integers(1, 40))
def test_blocks_change_nothing(unknown: Primitives, known: Primitives, frames: int) -> None:
    codes = known.runs % 4
    whole = label_costs(unknown, known, codes, 4, radius=2.0)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(matching, "BATCH_FRAMES", frames)
        np.testing.assert_allclose(label_costs(unknown, known, codes, 4, radius=2.0), whole)


def cycles(n: int, *, phase: float = 0.0, frames: int = 12) -> np.ndarray:
    angles = 2 * np.pi * (np.arange(n * frames) / frames + phase)
    return np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)


def test_a_cycle_cut_at_another_phase_matches_inside_a_run_only() -> None:
    unknown = Primitives(cycles(2, phase=0.5), np.array([12, 12]), np.array([0, 0]))
    for runs, cost in (([0, 0, 0], 0.0), ([0, 1, 2], np.inf)):
        known = Primitives(cycles(3), np.array([12] * 3), np.array(runs))
        found = label_costs(unknown, known, np.zeros(3, int), 1, radius=0.2)
        np.testing.assert_allclose(found, cost, atol=1e-5)


def test_a_part_of_a_movement_is_not_that_movement() -> None:
    whole = np.linspace([0, 0, 0], [3, 0, 0], 30)
    short, long = (Primitives(f, np.array([len(f)]), np.array([0])) for f in (whole[:8], whole))
    for unknown, known in ((short, long), (long, short)):
        found = label_costs(unknown, known, np.zeros(1, int), 1, radius=0.3)
        assert np.isinf(found).all()
    assert label_costs(long, long, np.zeros(1, int), 1, radius=0.3).item() < 1e-5
