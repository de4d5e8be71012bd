"""Find activities: blocks of the self-similarity matrix that repeat themselves.

A region grows along the diagonal while it finds new neighbours away from the
diagonal. Grown forward from the first frame, it ends where an activity ends. Grown
backward from the last frame, it ends where an activity starts. The span between an
end and the next start is a transition.

There are two variants: the region is a square whose neighbours are counted (2014),
or it is scanned line by line (2017).

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
    """Frames at which activities end (``forward``) and start (``backward``), ascending."""

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
    """Find the frames where a growing square region stops finding new neighbours (2014).

    Forward cuts are the peaks of the number of neighbours inside the region. A new
    region starts when ``min_gap`` frames in a row have added none. Backward cuts are
    found in the same way from the end, ``min_gap`` frames after the peaks.

    Parameters
    ----------
    graph : NeighborGraph
        Of n frames, without the main diagonal.
    min_gap : int
        Number of frames without a new neighbour that ends a region.
    min_count : int
        A region must have more neighbours than this.
    min_distance : int
        Frames; of two peaks within this distance only the higher is kept.
    """
    n = len(graph)
    # Grouped by the later frame (True), at which the square includes both.
    indptr, earlier = _kernels.group_pairs(graph.indptr, graph.indices, True)
    counts = _kernels.grow_squares_forward(indptr, earlier, min_gap, min_count)
    forward = _find_peaks(counts, min_count, min_distance)
    mask = np.zeros(n, np.bool_)
    mask[forward] = True
    indptr, later = _kernels.group_pairs(graph.indptr, graph.indices, False)
    counts = _kernels.grow_squares_backward(indptr, later, mask, min_gap, min_count)
    # A peak is where the region ended; it stopped growing `min_gap` frames later in time.
    backward = np.minimum(_find_peaks(counts, min_count, min_distance) + min_gap, n - 1)
    return ActivityCuts(forward, backward)


def find_scan_line_cuts(graph: NeighborGraph, *, min_gap: int, min_count: int) -> ActivityCuts:
    """Find the frames where a region scanned line by line stops finding neighbours (2017).

    Each frame adds its own neighbours inside the region. A region with more than
    ``min_count`` neighbours ends after ``min_gap`` frames in a row without any. The cut
    is at the last frame that had one. Backward regions also end at forward cuts.

    Parameters
    ----------
    graph : NeighborGraph
        Of n frames, without the main diagonal.
    min_gap : int
        Number of frames without a neighbour that ends a region.
    min_count : int
        A region must have more neighbours than this.
    """
    forward = _kernels.scan_lines_forward(graph.indptr, graph.indices, min_gap, min_count)
    mask = np.zeros(len(graph), np.bool_)
    mask[forward] = True
    backward = _kernels.scan_lines_backward(graph.indptr, graph.indices, mask, min_gap, min_count)
    return ActivityCuts(forward, backward)


def _find_peaks(counts: Cuts, min_height: int, min_distance: int) -> Cuts:
    """Return the first frames of plateaus above a height, with a rise before and a fall after.

    In descending order of height, each peak removes the others within ``min_distance``.
    """
    changes = np.flatnonzero(np.diff(counts))
    # A peak is a rise followed by a fall; equal counts between them form a plateau.
    rises = np.diff(counts)[changes] > 0
    # + 1: the plateau begins with the frame after the rise.
    peaks = changes[:-1][rises[:-1] & ~rises[1:]] + 1
    peaks = peaks[counts[peaks] > min_height]
    kept: list[int] = []
    # Highest first; a stable sort, so that the earlier of two equal peaks is kept.
    for peak in peaks[np.argsort(-counts[peaks], kind="stable")]:
        if all(abs(peak - other) > min_distance for other in kept):
            kept.append(int(peak))
    return np.array(sorted(kept), np.int64)
