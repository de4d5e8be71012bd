"""Find activities, their repetitions (primitives), and clusters of similar segments.

*Activities* are blocks of the self-similarity matrix that repeat themselves. A region grows along
the diagonal while it finds new neighbours away from the diagonal. Grown forward from the first
frame, it ends where an activity ends. Grown backward from the last frame, it ends where an activity
starts. The span between an end and the next start is a transition. There are two variants: the
region is a square whose neighbours are counted (2014), or it is scanned line by line (2017).

*Primitives.* Every repetition of an activity appears as a minor diagonal in the self-similarity
matrix: a connected component of the neighbour graph, with a cheapest warping path through it. A
repetition begins at the column where such a path meets the first rows of the activity.

*Clusters.* A segment g is linked to a segment h if a warping path through the rows of g covers
enough of both. Clusters are the connected components of these links, so their number is a result
and not a parameter.

*Mirrored cuts.* A step with the right foot is similar to the mirrored step with the left. So
warping paths between mirrored and original frames divide double steps into left and right ones.
Activities and clusters do not use them. The symmetry of an activity follows from the positions of
its mirrored paths:

- ``symmetric``: on the other paths; left and right do the same at once (squats);
- ``alternating``: between the other paths; left and right take turns (walking);
- ``one-sided``: in less than half of the frames; the sides differ (punches with one
  arm). Limitations: long rests between kicks count as symmetric, and a limp larger
  than the radius as one-sided.

Sources: Vögele, Krüger and Klein 2014, sections 3.1 (figure 2), 3.2 (figure 3) and 4; Krüger et al.
2017, also section V for mirrored cuts. There the type of symmetry decides which cuts are added; the
authors' program and this module decide for each cut. Constants, the choice between close cuts,
coverage and strong components are as in the program.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from kineme._util.parallel import map_threads
from kineme.methods.region_growing import _kernels
from kineme.methods.region_growing.neighbors import NeighborGraph
from kineme.methods.region_growing.warping import WarpingPaths, warping_paths
from kineme.methods.segments import number_by_appearance

if TYPE_CHECKING:
    from kineme.methods.region_growing.constants import RegionGrowingConstants

Cuts = NDArray[np.int64]
HALF = 0.5
"""Share of frames or nodes that counts as a majority."""


@dataclass(frozen=True, eq=False)
class ActivityCuts:
    """Frames at which activities end (``forward``) and start (``backward``), ascending."""

    forward: Cuts
    backward: Cuts

    @property
    def all(self) -> Cuts:
        """Return every cut once, ascending."""
        return np.union1d(self.forward, self.backward)


def find_activity_cuts(graph: NeighborGraph, preset: RegionGrowingConstants) -> ActivityCuts:
    """Find the frames at which a growing region stops finding new neighbours.

    The graph is without its main diagonal. A region must have more than ``growth_count``
    neighbours, and ends after ``growth_gap`` without a new one.
    """
    min_gap = max(1, preset.frames(preset.growth_gap))
    if preset.growth == "squares":
        min_distance = preset.frames(preset.growth_distance)
        return _grow_squares(graph, min_gap, preset.growth_count, min_distance)
    return _scan_lines(graph, min_gap, preset.growth_count)


def _grow_squares(
    graph: NeighborGraph, min_gap: int, min_count: int, min_distance: int
) -> ActivityCuts:
    """Find the cuts of a growing square (2014).

    Forward cuts are the peaks of the number of neighbours inside the square. A new square starts
    when ``min_gap`` frames in a row have added none. Backward cuts are found in the same way from
    the end, ``min_gap`` frames after the peaks. Of two peaks within ``min_distance`` frames only
    the higher is kept.
    """
    n = len(graph)
    # Grouped by the later frame (True), at which the square includes both.
    indptr, earlier = _kernels.group_pairs(graph.indptr, graph.indices, True)
    counts = _kernels.grow_squares_forward(indptr, earlier, min_gap, min_count)
    forward = _find_peaks(counts, min_count, min_distance)
    is_forward_cut = np.zeros(n, np.bool_)
    is_forward_cut[forward] = True
    indptr, later = _kernels.group_pairs(graph.indptr, graph.indices, False)
    counts = _kernels.grow_squares_backward(indptr, later, is_forward_cut, min_gap, min_count)
    # A peak is where the region ended; it stopped growing `min_gap` frames later in time.
    backward = np.minimum(_find_peaks(counts, min_count, min_distance) + min_gap, n - 1)
    return ActivityCuts(forward, backward)


def _scan_lines(graph: NeighborGraph, min_gap: int, min_count: int) -> ActivityCuts:
    """Find the cuts of a region that is scanned line by line (2017).

    Each frame adds its neighbours inside the region. After ``min_gap`` frames without any, a region
    of more than ``min_count`` neighbours ends: the cut is at its last frame that had a neighbour.
    Regions grown backward also end at forward cuts.
    """
    forward = _kernels.scan_lines_forward(graph.indptr, graph.indices, min_gap, min_count)
    is_forward_cut = np.zeros(len(graph), np.bool_)
    is_forward_cut[forward] = True
    backward = _kernels.scan_lines_backward(
        graph.indptr, graph.indices, is_forward_cut, min_gap, min_count
    )
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


@dataclass(frozen=True, eq=False)
class PrimitiveCuts:
    """Starts of repetitions inside one activity, and the warping paths that give them.

    ``cuts[i]`` is the start of path ``sources[i]``.
    """

    cuts: NDArray[np.int64]
    sources: NDArray[np.int64]
    paths: WarpingPaths


def find_primitive_cuts(
    graph: NeighborGraph, activity: tuple[int, int], preset: RegionGrowingConstants
) -> PrimitiveCuts:
    """Find the frames at which repetitions start inside an activity, ascending.

    The graph is with its main diagonal. The activity is (first, last), both inclusive; neighbouring
    activities share the border frame. A path must have a mirror image: another path, or itself,
    matches enough of its rows and columns with rows and columns exchanged (symmetry coherence).
    Cuts closer to a border of the activity than the shortest primitive are dropped. Of two cuts
    closer than this, the one with the shorter path is dropped.
    """
    first, last = activity
    # Rows and columns have the same box: the activity is compared with itself.
    box = (first, last + 1)
    paths = _find_paths(graph, box, box, preset, shortest=preset.min_path)
    coherent = _kernels.mark_coherent_paths(paths.ptr, paths.rows, paths.columns, preset.symmetry)
    paths = paths.select(coherent & paths.is_within_slope(preset.max_slope))
    min_length = preset.min_primitive * preset.working_fps
    return _choose_cuts(paths, first + min_length, last - min_length, min_length)


def _find_paths(
    graph: NeighborGraph,
    rows: tuple[int, int],
    columns: tuple[int, int],
    preset: RegionGrowingConstants,
    *,
    shortest: float,
    max_slope: float | None = None,
) -> WarpingPaths:
    """Return the warping paths in a box that last ``shortest`` seconds or longer."""
    separation = preset.path_separation
    return warping_paths(
        graph,
        rows,
        columns,
        steps=preset.steps,
        skip_penalty=preset.skip_penalty * preset.radius,  # the constant is in radii
        zero_cost=preset.zero_cost,
        min_nodes=ceil(shortest * preset.working_fps),
        separation=None if separation is None else preset.frames(separation),
        max_slope=max_slope,
    )


def _choose_cuts(paths: WarpingPaths, low: float, high: float, min_length: float) -> PrimitiveCuts:
    """Return the starts of paths as cuts between ``low`` and ``high``, ``min_length`` apart."""
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


@dataclass(frozen=True, eq=False)
class Clustering:
    """Cluster and score of each segment.

    ``labels[g]`` is the cluster of segment g, numbered from 0 by appearance.
    ``scores[g]`` is the largest share of g and another segment of its cluster
    that a path covers; 0 if g is alone.
    """

    labels: NDArray[np.int64]
    scores: NDArray[np.float64]


def cluster_segments(
    graph: NeighborGraph, borders: NDArray[np.int64], preset: RegionGrowingConstants
) -> Clustering:
    """Group the segments that are linked by warping paths.

    The graph has its main diagonal, along which a path links each segment to itself; these links
    are dropped later. Segment g is ``borders[g]..borders[g + 1]``, both inclusive.
    """
    if preset.cluster_neighbors is not None:
        graph = graph.nearest(preset.cluster_neighbors)

    def find_links(g: int) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Return the segments that paths link to segment g, and the share that each path covers."""
        # Rows are those of segment g, columns those of the whole recording.
        rows, columns = (int(borders[g]), int(borders[g + 1]) + 1), (0, graph.n_columns)
        paths = _find_paths(
            graph,
            rows,
            columns,
            preset,
            shortest=preset.cluster_min_path,
            max_slope=preset.max_slope,
        )
        linked: tuple[NDArray[np.int64], NDArray[np.float64]] = _kernels.find_linked_segments(
            paths.ptr,
            paths.rows,
            paths.columns,
            borders,
            g,
            preset.coverage,
            preset.interpolate,
        )
        return linked

    targets, shares = zip(*map_threads(find_links, range(len(borders) - 1)), strict=True)
    links = _make_link_matrix(targets, shares)
    _, components = connected_components(links, directed=True, connection=preset.connection)
    return Clustering(number_by_appearance(components), _find_best_shares(links, components))


def _make_link_matrix(
    targets: Sequence[NDArray[np.int64]], shares: Sequence[NDArray[np.float64]]
) -> csr_array:
    """Return a sparse matrix of the largest share of each ordered pair of different segments."""
    n = len(targets)
    # Row of each link: the segment whose paths were searched.
    g = np.repeat(np.arange(n), [len(linked) for linked in targets])
    h, share = np.concatenate(targets), np.concatenate(shares)
    # Sort by pair, the largest share first.
    order = np.lexsort((-share, h, g))
    g, h, share = g[order], h[order], share[order]
    keep = g != h
    # Keep the first of each pair, which is the largest.
    keep[1:] &= (np.diff(g) != 0) | (np.diff(h) != 0)
    return csr_array((share[keep], (g[keep], h[keep])), shape=(n, n))


def _find_best_shares(links: csr_array, components: NDArray[np.int32]) -> NDArray[np.float64]:
    """Return the largest share by which each segment is linked to another of its cluster."""
    coo = links.tocoo()
    same = components[coo.row] == components[coo.col]
    # Both segments of a link within a cluster get its share.
    scores = np.zeros(len(components))
    np.maximum.at(scores, coo.row[same], coo.data[same])
    np.maximum.at(scores, coo.col[same], coo.data[same])
    return scores


def merge_cuts(
    main: NDArray[np.int64], mirrored: NDArray[np.int64], gap: float
) -> NDArray[np.int64]:
    """Add the mirrored cuts that are more than ``gap`` frames from all main cuts.

    Mirrored cuts are not compared with each other.
    """
    is_far = ~(np.abs(mirrored[:, None] - main) <= gap).any(axis=1)
    return np.union1d(main, mirrored[is_far])


def classify_symmetry(
    activity: tuple[int, int], main: PrimitiveCuts, mirrored: PrimitiveCuts, gap: float
) -> str:
    """Return the symmetry of an activity: ``symmetric``, ``alternating`` or ``one-sided``.

    The activity has a start and a stop frame. ``main`` and ``mirrored`` are the cuts for the
    original and the mirrored frames. A mirrored path that is farther than ``gap`` frames from all
    main ones lies between them.
    """
    start, stop = activity
    # Paths in less than half of the frames: the mirrored movement does not occur.
    if len(np.unique(mirrored.paths.rows)) <= HALF * (stop - start):
        return "one-sided"
    between = _measure_distances(mirrored.paths, main.paths) > gap
    return "alternating" if between.mean() > HALF else "symmetric"


def _measure_distances(paths: WarpingPaths, others: WarpingPaths) -> NDArray[np.float64]:
    """Return the distance in columns from each node to the nearest node of others in its row."""
    order = np.lexsort((others.columns, others.rows))
    # Map (row, column) to one number, so that a single sorted search handles all rows. Nodes of
    # one row differ by less than ``stride``, nodes of different rows by more.
    stride = max(paths.columns.max(), others.columns.max(initial=0)) + 1
    positions = np.concatenate(
        [[-np.inf], 2 * stride * others.rows[order] + others.columns[order], [np.inf]]
    )
    nodes = 2.0 * stride * paths.rows + paths.columns
    after = np.searchsorted(positions, nodes)
    nearest: NDArray[np.float64] = np.minimum(
        nodes - positions[after - 1], positions[after] - nodes
    )
    return nearest
