"""Activities: blocks of the self-similarity matrix that repeat themselves.

A region grows along the diagonal for as long as it finds new neighbours away
from the diagonal. Grown forward from the first frame it ends where an activity
ends; grown backward from the last frame it ends where an activity starts. What
lies between an end and the next start is a transition.

Two forms: the region is a square, and its content is counted (2014), or the
region is scanned line by line (2017).

Sources: Vögele, Krüger and Klein 2014, section 3.1, figure 2; Krüger et al.
2017; constants and details as in the authors' program.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kineme.methods.region_growing import _kernels
from kineme.methods.region_growing.neighbors import NeighborGraph

Cuts = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class ActivityCuts:
    """Where activities end (``forward``) and start (``backward``): ascending frames."""

    forward: Cuts
    backward: Cuts

    @property
    def all(self) -> Cuts:
        """Return every cut once, ascending."""
        return np.union1d(self.forward, self.backward)


def find_square_cuts(
    graph: NeighborGraph,
    *,
    min_gap: int,
    min_count: int,
    min_distance: int,
) -> ActivityCuts:
    """Cuts where a growing square region stops finding new neighbours (2014).

    Forward cuts are the peaks of the number of neighbours inside the region,
    which is dropped and begun anew once ``min_gap`` frames in a row added
    none. Backward cuts likewise, ``min_gap`` frames after the region grown
    from the end was given up.

    Parameters
    ----------
    graph : NeighborGraph
        Of n frames, main diagonal removed.
    min_gap : int
        Frames in a row without a new neighbour that end a region.
    min_count : int
        Neighbours a region must hold more than.
    min_distance : int
        Frames; of two peaks no farther apart the higher stays.
    """
    n = len(graph)
    # Grouped by their later frame (True), at which the square takes them in.
    indptr, earlier = _kernels.group_pairs(graph.indptr, graph.indices, True)
    counts = _kernels.grow_squares_forward(indptr, earlier, min_gap, min_count)
    forward = _find_peaks(counts, min_count, min_distance)
    mask = np.zeros(n, np.bool_)
    mask[forward] = True
    indptr, later = _kernels.group_pairs(graph.indptr, graph.indices, False)
    counts = _kernels.grow_squares_backward(indptr, later, mask, min_gap, min_count)
    # The peak is where the region was given up; it stopped growing `min_gap` frames later in time.
    backward = np.minimum(_find_peaks(counts, min_count, min_distance) + min_gap, n - 1)
    return ActivityCuts(forward, backward)


def find_scan_line_cuts(graph: NeighborGraph, *, min_gap: int, min_count: int) -> ActivityCuts:
    """Cuts where a region scanned line by line stops finding neighbours (2017).

    Each frame adds its own neighbours inside the region. A region ends after
    ``min_gap`` frames in a row without any, provided it holds more than
    ``min_count``; the cut is at the last frame that had one. Backward regions
    also end at forward cuts.

    Parameters
    ----------
    graph : NeighborGraph
        Of n frames, main diagonal removed.
    min_gap : int
        Frames in a row without a neighbour that end a region.
    min_count : int
        Neighbours a region must hold more than.
    """
    forward = _kernels.scan_lines_forward(graph.indptr, graph.indices, min_gap, min_count)
    mask = np.zeros(len(graph), np.bool_)
    mask[forward] = True
    backward = _kernels.scan_lines_backward(graph.indptr, graph.indices, mask, min_gap, min_count)
    return ActivityCuts(forward, backward)


def _find_peaks(counts: Cuts, min_height: int, min_distance: int) -> Cuts:
    """First frames of the plateaus that rise before and fall after, higher than a height.

    In descending height a peak kept removes those within ``min_distance``.
    """
    changes = np.flatnonzero(np.diff(counts))
    # Rises that are followed by a fall; equal counts between them are a plateau.
    rises = np.diff(counts)[changes] > 0
    # The frame after the rise, where the plateau begins.
    peaks = changes[:-1][rises[:-1] & ~rises[1:]] + 1
    peaks = peaks[counts[peaks] > min_height]
    kept: list[int] = []
    # Highest first; stable, so of equal peaks the earlier one is kept.
    for peak in peaks[np.argsort(-counts[peaks], kind="stable")]:
        if all(abs(peak - other) > min_distance for other in kept):
            kept.append(int(peak))
    return np.array(sorted(kept), np.int64)
