"""Match unlabelled primitives with labelled ones by warping in both directions.

A primitive u matches a run L of labelled primitives if all of u can be warped onto successive
samples of L, at half to twice its speed (subsequence warping), and if primitives of L can be warped
onto the run of u. The cost of the match is the larger of both. With one direction alone, a part of
a movement would match the whole.

A *run* consists of adjacent primitives with the same label or cluster. Cyclic movements may be cut
at another phase, so a warping may cross from one primitive to the next of a run, but not to another
run.

Source: Vögele, Krüger and Klein 2014, section 6.1; the backward match is our own, and the warping
is that of `kineme.transfer.subsequences`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from kineme._util.arrays import Floats, Ints
from kineme._util.parallel import map_threads
from kineme.transfer.subsequences import warp

Matches = tuple[Ints, Ints, Floats]
"""Primitive, run of the other side, and cost of each match."""

_WALL = 1e6
"""Value of the features of a separator between two runs, far from all others."""


@dataclass(frozen=True, eq=False)
class Primitives:
    """Primitives end to end: primitive p is ``features[starts[p]:starts[p + 1]]``.

    Parameters
    ----------
    features : (frames, dims) array
    lengths : (primitives,) array of int
        Number of frames of each.
    runs : (primitives,) array of int
        Run of each, numbered from 0, ascending.
    """

    features: NDArray[np.floating]
    lengths: Ints
    runs: Ints

    @cached_property
    def starts(self) -> Ints:
        return np.concatenate([[0], np.cumsum(self.lengths)])

    @cached_property
    def frame_runs(self) -> Ints:
        """Return the run of each frame."""
        return np.repeat(self.runs, self.lengths)

    def __len__(self) -> int:
        return len(self.lengths)


def compute_label_costs(
    unknown: Primitives, examples: Primitives, codes: Ints, n_labels: int, *, radius: float
) -> Floats:
    """Return the cost of the cheapest match of each primitive with each label; inf without one.

    ``codes`` are the labels of the examples, from 0, equal within a run. Matches that cost more
    than the radius are ignored.
    """
    costs = np.full((len(unknown), n_labels), np.inf)
    run_codes = np.empty(int(examples.runs[-1]) + 1, np.int64)
    run_codes[examples.runs] = codes
    u, run, cost = find_mutual_matches(unknown, examples, radius)
    np.minimum.at(costs, (u, run_codes[run]), cost)
    return costs


def find_mutual_matches(unknown: Primitives, examples: Primitives, radius: float) -> Matches:
    """Return every match of an unknown primitive with a run of examples, in both directions."""
    u, example_run, forward = _find_matches(unknown, examples, np.arange(len(unknown)), radius)
    reached = np.flatnonzero(np.isin(examples.runs, example_run))
    k, unknown_run, backward = _find_matches(examples, unknown, reached, radius)
    n = int(examples.runs[-1]) + 1
    run_sizes = np.bincount(examples.runs)
    # Pairs of runs as one number: unknown run * n + example run.
    pairs, medians = _compute_medians(unknown_run * n + examples.runs[k], backward, run_sizes)
    keys = unknown.runs[u] * n + example_run
    # Keep forward matches whose pair of runs also has backward matches.
    positions = np.searchsorted(pairs, keys)
    both = positions < len(pairs)
    both[both] = pairs[positions[both]] == keys[both]
    return u[both], example_run[both], np.maximum(forward[both], medians[positions[both]])


def number_movements(primitives: Primitives, radius: float) -> Ints:
    """Number the movements of primitives: those that match, directly or indirectly, are equal."""
    one, run, _ = find_mutual_matches(primitives, primitives, radius)
    # Connected components of a graph of primitives and runs.
    n = len(primitives)
    size = n + int(primitives.runs[-1]) + 1
    links = coo_array((np.ones(len(one)), (one, n + run)), shape=(size, size))
    numbers: Ints = connected_components(links, directed=False)[1][:n].astype(np.int64)
    return numbers


def _find_matches(
    examples: Primitives, others: Primitives, numbers: Ints, radius: float
) -> Matches:
    """Find the cheapest warping of some examples inside each run of others, within the radius."""
    separated, first = _append_walls(others)
    starts = examples.starts
    features = np.asarray(examples.features, np.float32)

    def match_one(p: np.int64) -> tuple[Ints, Floats]:
        costs, _ = warp(features[starts[p] : starts[p + 1]], separated)
        # Cheapest warping that ends in each run.
        cheapest = np.minimum.reduceat(costs, first)
        runs = np.flatnonzero(cheapest <= radius)
        return runs, cheapest[runs].astype(np.float64)

    matches = map_threads(match_one, numbers)
    if not matches:
        return np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0)
    runs, costs = (np.concatenate(part) for part in zip(*matches, strict=True))
    return np.repeat(numbers, [len(part) for part, _ in matches]), runs, costs


def _append_walls(primitives: Primitives) -> tuple[NDArray[np.float32], Ints]:
    """Append a separator to each run; return the features and the start of each run in them."""
    # Each frame is shifted by the number of separators before it: its run.
    frames = np.arange(len(primitives.frame_runs)) + primitives.frame_runs
    n_runs = int(primitives.runs[-1]) + 1
    separated = np.full((len(frames) + n_runs, primitives.features.shape[1]), _WALL, np.float32)
    separated[frames] = primitives.features
    first = np.searchsorted(primitives.frame_runs, np.arange(n_runs)) + np.arange(n_runs)
    return separated, first


def _compute_medians(keys: Ints, costs: Floats, sizes: Ints) -> tuple[Ints, Floats]:
    """Return the distinct keys, ascending, with the lower median of their costs.

    ``keys % len(sizes)`` is a run with ``sizes`` primitives. Primitives without a match count as
    infinite costs: a key is left out if less than half of its primitives have a match.
    """
    order = np.lexsort((costs, keys))
    unique, first, counts = np.unique(keys[order], return_index=True, return_counts=True)
    middle = (sizes[unique % len(sizes)] - 1) // 2
    matched = middle < counts
    return unique[matched], costs[order][(first + middle)[matched]]
