"""Run the stages of the published methods, in frames at the working rate.

Features are any array of frames × dims. `RegionsFound` holds the results of all stages.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise, repeat
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.checks import as_features
from kineme._util.parallel import map_threads
from kineme.errors import ParameterError
from kineme.methods.base import Columns, Mirror, Progress, time_stages
from kineme.methods.region_growing import _kernels
from kineme.methods.region_growing.activities import (
    ActivityCuts,
    Clustering,
    PrimitiveCuts,
    classify_symmetry,
    cluster_segments,
    find_activity_cuts,
    find_primitive_cuts,
    merge_cuts,
)
from kineme.methods.region_growing.neighbors import NeighborGraph, neighbor_graph
from kineme.methods.region_growing.warping import label_components
from kineme.methods.segments import find_segments, make_columns, number_by_appearance

if TYPE_CHECKING:
    from kineme.methods.region_growing.constants import RegionGrowingConstants

Frames = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class RegionsFound:
    """Results of the stages.

    Attributes
    ----------
    features : (frames, dims) array
        As given, or bundled.
    graph : NeighborGraph
        Neighbours of every frame, with the main diagonal.
    activity_cuts : ActivityCuts
        Ends and starts of activities.
    borders : (segments + 1,) array
        Borders of activities and transitions, from 0 to n.
    repeats : (segments,) array of bool
        True for activities, False for transitions.
    repetition : (segments,) array
        Share of the frames that are similar to other frames of the segment.
    primitives : (primitives + 1,) array
        Borders of primitives, from 0 to n, including those of activities.
    clustering : Clustering
        Cluster and score of each primitive.
    symmetry : (segments,) array of str, optional
        Symmetry of each activity: ``symmetric``, ``alternating`` or ``one-sided`` (see
        `kineme.methods.region_growing.activities`); empty for transitions; None if the preset
        does not mirror.
    timings : dict of str to float
        Seconds per stage.
    """

    features: NDArray[np.float64]
    graph: NeighborGraph
    activity_cuts: ActivityCuts
    borders: Frames
    repeats: NDArray[np.bool_]
    repetition: NDArray[np.float64]
    primitives: Frames
    clustering: Clustering
    symmetry: NDArray[np.str_] | None = None
    timings: dict[str, float] = field(default_factory=dict)

    def columns(self) -> Columns:
        """Return the segment table; an activity is in the cluster of most of its frames."""
        parents = find_segments(self.borders, self.primitives[:-1])
        labels = self.clustering.labels
        is_single = np.bincount(labels)[labels] == 1
        # Transitions that are similar to no other segment have no cluster.
        has_cluster = ~(is_single & ~self.repeats[parents])
        clusters = number_by_appearance(np.where(has_cluster, labels, -1))
        activity_clusters = _find_main_clusters(clusters, parents, np.diff(self.primitives))
        return make_columns(
            self.borders,
            self.primitives,
            is_activity=self.repeats,
            clusters=(activity_clusters, clusters),
            confidence=(self.repetition, self.clustering.scores),
        )

    def doubts(self, columns: Columns, fps: float) -> list[str]:  # noqa: ARG002
        """Return an empty list: the published methods estimate no confidence."""
        return []


def _find_main_clusters(clusters: Frames, parents: NDArray[np.intp], lengths: Frames) -> Frames:
    """Return the cluster with most frames of each activity; -1 if most have no cluster."""
    frames = np.zeros((int(parents.max()) + 1, int(clusters.max()) + 2), np.int64)
    np.add.at(frames, (parents, clusters), lengths)  # cluster -1 counts in the last column
    main = frames.argmax(axis=1)
    return np.where(main == frames.shape[1] - 1, -1, main)


def analyze_regions(
    features: ArrayLike,
    preset: RegionGrowingConstants,
    *,
    mirror: Mirror | None = None,
    progress: Progress | None = None,
) -> RegionsFound:
    """Find the neighbour graph, activities, primitives and clusters of a sequence of features.

    Parameters
    ----------
    features : (frames, dims) array
        Stacked poses at the working rate, in the unit of the preset's lengths.
    preset : RegionGrowingConstants
    mirror : callable, optional
        Swaps left and right in these features; `kineme.features.mirror_features` for
        features of motions.
    progress : callable, optional
        Called with the name of each stage before it runs.

    Raises
    ------
    ParameterError
        The features have another shape, are empty or not finite; or the preset mirrors, but no
        `mirror` is given.
    """
    rows = as_features(features)
    if preset.mirror and mirror is None:
        raise ParameterError("these features have no left and right: use mirror=False")
    timings: dict[str, float] = {}
    stage = time_stages(timings, progress)
    compared = rows
    if preset.bundling is not None:
        # Imported here: it loads compiled code.
        from kineme.features.bundling import bundle

        with stage("bundling"):
            compared = bundle(rows, neighbors=preset.bundling)
    with stage("neighbors"):
        graph = _find_neighbors(compared, None, preset)
    with stage("activities"):
        off_diagonal = _make_growth_graph(graph, preset)
        cuts = find_activity_cuts(off_diagonal, preset)
        borders = _make_borders(cuts.all, len(graph))
        # Neighbours of each frame within its own segment: a segment repeats if it has many.
        n_inside = _kernels.count_inner_neighbors(
            off_diagonal.indptr, off_diagonal.indices, borders
        )
        repeats = _find_repeats(borders, cuts, np.add.reduceat(n_inside, borders[:-1]), preset)
        # Share of the frames of each segment that have a neighbour in it.
        repetition = np.add.reduceat(n_inside > 0, borders[:-1]) / np.diff(borders)
    with stage("primitives"):
        divided = _find_primitives(graph, borders, preset)
    cuts_inside = [each.cuts for each in divided]
    symmetry = None
    if preset.mirror and mirror is not None:
        with stage("mirroring"):
            # Mirrored frames are compared with the original ones.
            graph_across = _find_neighbors(mirror(compared), compared, preset)
            mirrored = _find_primitives(graph_across, borders, preset)
            gap = preset.min_primitive * preset.working_fps
            cuts_inside = [
                merge_cuts(a.cuts, b.cuts, gap) for a, b in zip(divided, mirrored, strict=True)
            ]
            spans = pairwise(borders.tolist())
            types = list(map(classify_symmetry, spans, divided, mirrored, repeat(gap)))
            symmetry = np.where(repeats, types, "")
    with stage("clusters"):
        # Borders of activities are also borders of primitives.
        primitives = _make_borders(np.concatenate([borders, *cuts_inside]), len(graph))
        # Ends are inclusive, so the last border is the last frame.
        clustering = cluster_segments(graph, np.minimum(primitives, len(graph) - 1), preset)
    return RegionsFound(
        compared,
        graph,
        activity_cuts=cuts,
        borders=borders,
        repeats=repeats,
        repetition=repetition,
        primitives=primitives,
        clustering=clustering,
        symmetry=symmetry,
        timings=timings,
    )


def _find_neighbors(
    features: ArrayLike, others: ArrayLike | None, preset: RegionGrowingConstants
) -> NeighborGraph:
    return neighbor_graph(
        features,
        others,
        radius=preset.radius,
        k=preset.max_neighbors,
        max_lag=None if preset.max_lag is None else max(1, preset.frames(preset.max_lag)),
    )


def _make_growth_graph(graph: NeighborGraph, preset: RegionGrowingConstants) -> NeighborGraph:
    """Return the pairs that growing regions count: near, and off the main diagonal."""
    if preset.growth_neighbors is not None:
        graph = graph.nearest(preset.growth_neighbors)
    if preset.diagonal == "component":
        labels = label_components(graph)
        # The first stored pair is (0, 0), which lies on the main diagonal.
        graph = graph.select(labels != labels[0])
        return graph.restrict(radius=preset.growth_radius)
    return graph.restrict(radius=preset.growth_radius, min_lag=preset.frames(preset.diagonal_width))


def _make_borders(cuts: Frames, n: int) -> Frames:
    """Return 0, the cuts with at least one frame on each side, and n."""
    distinct = np.unique(cuts)
    return np.concatenate([[0], distinct[(distinct > 0) & (distinct < n - 1)], [n]])


def _find_repeats(
    borders: Frames, cuts: ActivityCuts, pairs: Frames, preset: RegionGrowingConstants
) -> NDArray[np.bool_]:
    """Mark the segments that repeat themselves."""
    # A span from an end to the next start is a transition.
    ends_only = np.isin(borders[:-1], cuts.forward) & ~np.isin(borders[:-1], cuts.backward)
    return (pairs > preset.growth_count) & ~(ends_only & np.isin(borders[1:], cuts.backward))


def _find_primitives(
    graph: NeighborGraph, borders: Frames, preset: RegionGrowingConstants
) -> list[PrimitiveCuts]:
    """Return the cuts inside each activity."""
    # Ends are inclusive, so the last border is the last frame.
    spans = list(pairwise(np.minimum(borders, len(graph) - 1).tolist()))
    return map_threads(lambda span: find_primitive_cuts(graph, span, preset), spans)
