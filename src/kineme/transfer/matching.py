"""What it costs to warp unlabelled primitives onto labelled ones, and those back.

A primitive u matches a run L of labelled ones if all of u can be warped onto successive samples
of L, at half to twice its speed (subsequence warping), and all of a primitive of L onto the run
of u. The match costs the larger of the two. With one of them alone, a part of a movement would
match the whole.

A *run* is of primitives that touch and are of one kind. Cyclic movements may be cut at another
phase, so a warping may lead from one primitive to the next of its run, but never into another.

Source: Vögele, Krüger and Klein 2014, section 6.1; the backward match is our own, the warping that
of `kineme.transfer.subsequences`.
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

# Which primitive, in which run of the other side, at what cost.
Matches = tuple[Ints, Ints, Floats]

_WALL = 1e6  # so far is what lies between two runs from any feature


@dataclass(frozen=True, eq=False)
class Primitives:
    """Frames of primitives end to end: primitive p is ``features[starts[p]:starts[p + 1]]``.

    Parameters
    ----------
    features : (frames, dims) array
    lengths : (primitives,) array of int
        Frames of each.
    runs : (primitives,) array of int
        Number of the run that each is in, from 0, rising.
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
    """``costs[u, c]``: of the cheapest match of primitive u with one of label c; inf without.

    ``codes`` are the labels of the examples, from 0, one for all of a run; a match that costs more
    than the radius is none.
    """
    costs = np.full((len(unknown), n_labels), np.inf)
    of_run = np.empty(int(examples.runs[-1]) + 1, np.int64)
    of_run[examples.runs] = codes
    u, run, cost = find_mutual_matches(unknown, examples, radius)
    np.minimum.at(costs, (u, of_run[run]), cost)
    return costs


def find_mutual_matches(unknown: Primitives, examples: Primitives, radius: float) -> Matches:
    """Return every match of an unknown primitive with a run of known ones: number, run, cost."""
    u, example_run, forward = _matches_within(unknown, examples, np.arange(len(unknown)), radius)
    reached = np.flatnonzero(np.isin(examples.runs, example_run))
    k, unknown_run, backward = _matches_within(examples, unknown, reached, radius)
    n = int(examples.runs[-1]) + 1
    most = np.bincount(examples.runs)
    pairs, medians = _compute_medians(unknown_run * n + examples.runs[k], backward, most)
    keys = unknown.runs[u] * n + example_run
    at = np.searchsorted(pairs, keys)
    both = at < len(pairs)
    both[both] = pairs[at[both]] == keys[both]
    return u[both], example_run[both], np.maximum(forward[both], medians[at[both]])


def number_movements(primitives: Primitives, radius: float) -> Ints:
    """A number for each primitive, equal for those that match, by themselves or through others."""
    one, run, _ = find_mutual_matches(primitives, primitives, radius)
    n = len(primitives)
    size = n + int(primitives.runs[-1]) + 1
    links = coo_array((np.ones(len(one)), (one, n + run)), shape=(size, size))
    numbers: Ints = connected_components(links, directed=False)[1][:n].astype(np.int64)
    return numbers


def _matches_within(
    examples: Primitives, others: Primitives, numbers: Ints, radius: float
) -> Matches:
    """Cheapest warping of each of some examples inside each run of others, within the radius."""
    separated, first = _append_walls(others)
    starts = examples.starts
    features = np.asarray(examples.features, np.float32)

    def matches_of(p: np.int64) -> tuple[Ints, Floats]:
        costs, _ = warp(features[starts[p] : starts[p + 1]], separated)
        cheapest = np.minimum.reduceat(costs, first)
        runs = np.flatnonzero(cheapest <= radius)
        return runs, cheapest[runs].astype(np.float64)

    found = map_threads(matches_of, numbers)
    if not found:
        return np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0)
    runs, costs = (np.concatenate(part) for part in zip(*found, strict=True))
    return np.repeat(numbers, [len(part) for part, _ in found]), runs, costs


def _append_walls(primitives: Primitives) -> tuple[NDArray[np.float32], Ints]:
    """Return the features with a wall after each run, and where each run begins among them."""
    frames = np.arange(len(primitives.frame_runs)) + primitives.frame_runs
    n_runs = int(primitives.runs[-1]) + 1
    separated = np.full((len(frames) + n_runs, primitives.features.shape[1]), _WALL, np.float32)
    separated[frames] = primitives.features
    first = np.searchsorted(primitives.frame_runs, np.arange(n_runs)) + np.arange(n_runs)
    return separated, first


def _compute_medians(keys: Ints, costs: Floats, sizes: Ints) -> tuple[Ints, Floats]:
    """Return each key once, ascending, with the lower median of its costs.

    ``keys % len(sizes)`` is a run, of so many primitives; where less than half of them have a
    cost, the key is left out.
    """
    order = np.lexsort((costs, keys))
    unique, first, counts = np.unique(keys[order], return_index=True, return_counts=True)
    middle = (sizes[unique % len(sizes)] - 1) // 2
    matched = middle < counts
    return unique[matched], costs[order][(first + middle)[matched]]
