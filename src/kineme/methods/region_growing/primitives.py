"""Find primitives: the repetitions inside an activity.

Every repetition of an activity appears as a minor diagonal in the self-similarity
matrix: a connected component of the neighbour graph, with a cheapest warping path
through it. A repetition begins at the column where such a path meets the first rows
of the activity.

Sources: Vögele, Krüger and Klein 2014, section 3.2, figure 3; Krüger et al.
2017 and the authors' program for the choice between close cuts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kineme.methods.region_growing import _kernels
from kineme.methods.region_growing.neighbors import NeighborGraph
from kineme.methods.region_growing.warping import Step, WarpingPaths, warping_paths


@dataclass(frozen=True, eq=False)
class PrimitiveCuts:
    """Starts of repetitions inside one activity, and the warping paths that give them.

    ``cuts[i]`` is the start of path ``sources[i]``.
    """

    cuts: NDArray[np.int64]
    sources: NDArray[np.int64]
    paths: WarpingPaths


def find_primitive_cuts(
    graph: NeighborGraph,
    activity: tuple[int, int],
    *,
    steps: Sequence[Step],
    skip_penalty: float,
    zero_cost: float,
    min_nodes: int,
    separation: int | None,
    max_slope: float,
    symmetry: float,
    min_length: float,
) -> PrimitiveCuts:
    """Find the frames at which repetitions start inside an activity, ascending.

    Parameters
    ----------
    graph : NeighborGraph
        With the main diagonal.
    activity : (int, int)
        (first, last), both inclusive; neighbouring activities share the border frame.
    steps, skip_penalty, zero_cost, min_nodes, separation, max_slope
        As in `kineme.methods.region_growing.warping.warping_paths`.
    symmetry : float
        Share of a path's rows and columns that another path (or itself) must match with rows and
        columns exchanged (symmetry coherence).
    min_length : float
        Frames; cuts closer than this to a border of the activity are dropped. Of two cuts closer
        than this, the one with the shorter path is dropped.
    """
    first, last = activity
    # Rows and columns have the same box: the activity is compared with itself.
    box = (first, last + 1)
    paths = warping_paths(
        graph,
        box,
        box,
        steps=steps,
        skip_penalty=skip_penalty,
        zero_cost=zero_cost,
        min_nodes=min_nodes,
        separation=separation,
    )
    coherent = _kernels.mark_coherent_paths(paths.ptr, paths.rows, paths.columns, symmetry)
    paths = paths.select(coherent & paths.is_within_slope(max_slope))
    return _choose_cuts(paths, first + min_length, last - min_length, min_length)


def _choose_cuts(paths: WarpingPaths, low: float, high: float, min_length: float) -> PrimitiveCuts:
    starts = paths.starts[1].astype(np.int64)
    cuts: list[int] = []
    sources: list[int] = []
    # Longest path first, so that of close cuts the one with the longer path is kept.
    for p in np.argsort(-paths.n_nodes, kind="stable"):
        cut = int(starts[p])
        if low <= cut <= high and all(abs(cut - other) >= min_length for other in cuts):
            cuts.append(cut)
            sources.append(int(p))
    # Sort cuts and their paths by frame.
    order = np.argsort(cuts)
    return PrimitiveCuts(np.array(cuts, np.int64)[order], np.array(sources, np.int64)[order], paths)
