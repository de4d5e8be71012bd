"""What it costs to warp unlabelled primitives onto labelled ones, and those back.

The similarity graph holds the frames of both that are within a radius. A
primitive u matches a run L of labelled ones if a warping path through the
graph leads from u's beginning to its end inside L (subsequence warping), and
another through a primitive of L inside the run of u. The match costs the
mean distance of the nodes of the dearer of the two paths. With one path alone,
a part of a movement would pass for the whole.

A *run* is of primitives that touch and are of one kind: cyclic movements may
be cut at another phase, so a path may cross from one primitive to the next of
its run, but never into another run.

Source: Vögele, Krüger and Klein 2014, section 6.1; the second path is our own.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from kineme._threads import map_threads
from kineme.graph import NeighborGraph, neighbor_graph, warping_paths

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

COVERAGE = 0.75
"""Share of a primitive's frames that a path must pass."""
BATCH_FRAMES = 8192
"""Labelled frames searched at a time: memory does not grow with the knowledge, time linearly."""

# Which primitive, in which run of the other side, at what cost per node.
Matches = tuple[Ints, Ints, Floats]


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
        """The run of each frame."""
        return np.repeat(self.runs, self.lengths)

    def __len__(self) -> int:
        return len(self.lengths)


def label_costs(
    unknown: Primitives, known: Primitives, codes: Ints, n_labels: int, *, radius: float
) -> Floats:
    """``costs[u, c]``: of the cheapest match of primitive u with one of label c; inf without.

    Parameters
    ----------
    unknown, known : Primitives
        Features of both in the same unit.
    codes : (known primitives,) array of int
        The label of each, from 0, one for all of a run.
    n_labels : int
    radius : float
        Frames farther apart than this do not match.

    Returns
    -------
    (unknown primitives, n_labels) array
    """
    costs = np.full((len(unknown), n_labels), np.inf)
    for batch, batch_codes in _batches(known, codes):
        of_run = np.empty(batch.runs[-1] + 1, np.int64)
        of_run[batch.runs] = batch_codes
        u, run, cost = mutual_matches(unknown, batch, radius)
        np.minimum.at(costs, (u, of_run[run]), cost)
    return costs


def mutual_matches(unknown: Primitives, known: Primitives, radius: float) -> Matches:
    """Every match of an unknown primitive with a run of known ones: number, run, cost."""
    graph = neighbor_graph(unknown.features, known.features, radius=radius)
    u, known_run, forward = _matches_within(graph, unknown, known, np.arange(len(unknown)))
    reached = np.flatnonzero(np.isin(known.runs, known_run))
    k, unknown_run, backward = _matches_within(_transposed(graph), known, unknown, reached)
    n = int(known.runs[-1]) + 1
    pairs, cheapest = _cheapest(unknown_run * n + known.runs[k], backward)
    wanted = unknown.runs[u] * n + known_run
    at = np.searchsorted(pairs, wanted)
    both = at < len(pairs)
    both[both] = pairs[at[both]] == wanted[both]
    return u[both], known_run[both], np.maximum(forward[both], cheapest[at[both]])


def _matches_within(
    graph: NeighborGraph, rows: Primitives, columns: Primitives, which: Ints
) -> Matches:
    """Cheapest warping path of each of some row primitives inside each run of columns."""
    # An empty column after each run: no step leads from one run into the next.
    shift = columns.frame_runs
    apart = NeighborGraph(
        graph.indptr,
        (graph.indices + shift[graph.indices]).astype(np.int32),
        graph.distances,
        len(shift) + int(shift[-1]),
        graph.radius,
    )
    run_at = np.zeros(apart.n_columns, np.int64)
    run_at[np.arange(len(shift)) + shift] = shift
    starts = rows.starts

    def paths_of(p: np.int64) -> tuple[Ints, Floats]:
        box = int(starts[p]), int(starts[p + 1])
        if graph.indptr[box[0]] == graph.indptr[box[1]]:
            return np.empty(0, np.int64), np.empty(0)
        paths = warping_paths(apart, box, (0, apart.n_columns))
        (first, column), (last, _) = paths.starts, paths.ends
        passed = last - first + 1 >= COVERAGE * rows.lengths[p]
        return _cheapest(run_at[column[passed]], (paths.costs / paths.n_nodes)[passed])

    found = map_threads(paths_of, which)
    if not found:
        return np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0)
    runs, costs = (np.concatenate(part) for part in zip(*found, strict=True))
    return np.repeat(which, [len(part) for part, _ in found]), runs, costs


def _cheapest(keys: Ints, costs: Floats) -> tuple[Ints, Floats]:
    """Each key once, ascending, with the least of its costs."""
    unique, inverse = np.unique(keys, return_inverse=True)
    least = np.full(len(unique), np.inf)
    np.minimum.at(least, inverse, costs)
    return unique, least


def _transposed(graph: NeighborGraph) -> NeighborGraph:
    """The graph with rows for columns."""
    flipped = graph.to_scipy().T.tocsr()
    flipped.sort_indices()
    return NeighborGraph(
        flipped.indptr.astype(np.int64),
        flipped.indices.astype(np.int32),
        flipped.data,
        len(graph),
        graph.radius,
    )


def _batches(known: Primitives, codes: Ints) -> Iterator[tuple[Primitives, Ints]]:
    """The known primitives in batches of whole runs, with their labels."""
    ends = np.flatnonzero(np.append(np.diff(known.runs) > 0, True)) + 1
    start = 0
    for end in ends.tolist():
        if known.starts[end] - known.starts[start] >= BATCH_FRAMES or end == ends[-1]:
            features = known.features[known.starts[start] : known.starts[end]]
            runs = known.runs[start:end] - known.runs[start]
            yield Primitives(features, known.lengths[start:end], runs), codes[start:end]
            start = end
