"""What it costs to warp unlabelled primitives onto labelled ones, and those back.

The similarity graph holds the frames of both that are within a radius. A
primitive u matches a stretch L of labelled ones if a warping path through the
graph leads from u's beginning to its end inside L (subsequence warping), and
another through a primitive of L inside the stretch of u. The match costs the
mean distance of the nodes of the dearer of the two paths. One way alone, a
part of a movement would pass for the whole.

A *stretch* is a run of primitives that touch and are of one kind: cyclic
movements may be cut at another phase, so a path may cross from one primitive
to the next of its stretch, but never into another stretch.

Source: Vögele, Krüger and Klein 2014, section 6.1; the way back is our own.
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
BLOCK_FRAMES = 8192
"""Labelled frames searched at a time: memory does not grow with the knowledge, time linearly."""

# Which primitive, in which stretch of the other side, at what cost per node.
Matches = tuple[Ints, Ints, Floats]


@dataclass(frozen=True, eq=False)
class Primitives:
    """Frames of primitives end to end: primitive p is ``features[starts[p]:starts[p + 1]]``.

    Parameters
    ----------
    features : (frames, dims)
    lengths : frames of each primitive
    stretches : number of the stretch each is in, from 0, rising
    """

    features: NDArray[np.floating]
    lengths: Ints
    stretches: Ints

    @cached_property
    def starts(self) -> Ints:
        return np.concatenate([[0], np.cumsum(self.lengths)])

    @cached_property
    def frame_stretches(self) -> Ints:
        """The stretch of each frame."""
        return np.repeat(self.stretches, self.lengths)

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
    codes : label of each known primitive, one per stretch, 0 to ``n_labels``
    radius : frames farther apart than this do not match
    """
    costs = np.full((len(unknown), n_labels), np.inf)
    for block, block_codes in _blocks(known, codes):
        of_stretch = np.empty(block.stretches[-1] + 1, np.int64)
        of_stretch[block.stretches] = block_codes
        u, stretch, cost = two_way_matches(unknown, block, radius)
        np.minimum.at(costs, (u, of_stretch[stretch]), cost)
    return costs


def two_way_matches(unknown: Primitives, known: Primitives, radius: float) -> Matches:
    """Every match of an unknown primitive with a stretch of known ones, and its cost."""
    graph = neighbor_graph(unknown.features, known.features, radius=radius)
    u, known_stretch, there = _one_way(graph, unknown, known, np.arange(len(unknown)))
    reached = np.flatnonzero(np.isin(known.stretches, known_stretch))
    k, unknown_stretch, back = _one_way(_transposed(graph), known, unknown, reached)
    n = int(known.stretches[-1]) + 1
    pairs, cheapest = _cheapest(unknown_stretch * n + known.stretches[k], back)
    wanted = unknown.stretches[u] * n + known_stretch
    at = np.searchsorted(pairs, wanted)
    both = at < len(pairs)
    both[both] = pairs[at[both]] == wanted[both]
    return u[both], known_stretch[both], np.maximum(there[both], cheapest[at[both]])


def _one_way(graph: NeighborGraph, rows: Primitives, columns: Primitives, which: Ints) -> Matches:
    """Cheapest warping path of each of some row primitives inside each stretch of columns."""
    # An empty column after each stretch: no step leads from one stretch into the next.
    shift = columns.frame_stretches
    apart = NeighborGraph(
        graph.indptr,
        (graph.indices + shift[graph.indices]).astype(np.int32),
        graph.distances,
        len(shift) + int(shift[-1]),
        graph.radius,
    )
    stretch_at = np.zeros(apart.n_columns, np.int64)
    stretch_at[np.arange(len(shift)) + shift] = shift
    starts = rows.starts

    def paths_of(p: np.int64) -> tuple[Ints, Floats]:
        box = int(starts[p]), int(starts[p + 1])
        if graph.indptr[box[0]] == graph.indptr[box[1]]:
            return np.empty(0, np.int64), np.empty(0)
        paths = warping_paths(apart, box, (0, apart.n_columns))
        (first, column), (last, _) = paths.starts, paths.ends
        passed = last - first + 1 >= COVERAGE * rows.lengths[p]
        return _cheapest(stretch_at[column[passed]], (paths.costs / paths.n_nodes)[passed])

    found = map_threads(paths_of, which)
    if not found:
        return np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0)
    stretches, costs = (np.concatenate(part) for part in zip(*found, strict=True))
    return np.repeat(which, [len(part) for part, _ in found]), stretches, costs


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


def _blocks(known: Primitives, codes: Ints) -> Iterator[tuple[Primitives, Ints]]:
    """The known primitives in blocks of whole stretches, with their labels."""
    ends = np.flatnonzero(np.append(np.diff(known.stretches) > 0, True)) + 1
    start = 0
    for end in ends.tolist():
        if known.starts[end] - known.starts[start] >= BLOCK_FRAMES or end == ends[-1]:
            features = known.features[known.starts[start] : known.starts[end]]
            stretches = known.stretches[start:end] - known.stretches[start]
            yield Primitives(features, known.lengths[start:end], stretches), codes[start:end]
            start = end
