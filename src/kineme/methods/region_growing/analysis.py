"""The published methods: what each stage finds, in frames of the working rate.

Nothing here knows what a skeleton is: any array of frames × dims will do.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import repeat
from math import ceil

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._checks import as_features
from kineme._threads import map_threads
from kineme.errors import ParameterError
from kineme.graph import NeighborGraph, component_labels, neighbor_graph
from kineme.methods.presets import RegionPreset
from kineme.methods.region_growing import _kernels
from kineme.methods.region_growing.activities import (
    ActivityCuts,
    scan_line_cuts,
    square_cuts,
)
from kineme.methods.region_growing.clustering import Clustering, cluster_segments
from kineme.methods.region_growing.mirroring import merged_cuts, symmetry_type
from kineme.methods.region_growing.primitives import PrimitiveCuts, primitive_cuts
from kineme.methods.stages import Progress, stopwatch

Frames = NDArray[np.int64]
Mirror = Callable[[NDArray[np.float64]], NDArray[np.float64]]


@dataclass(frozen=True, eq=False)
class Analysis:
    """What the stages found, stage by stage.

    Parameters
    ----------
    graph : neighbours of every frame, main diagonal included
    activity_cuts : where activities end and start
    blocks : (blocks + 1,) borders of activities and transitions, from 0 to n
    repeats : (blocks,) whether a block is an activity (or else a transition)
    repetition : (blocks,) share of its frames that look like others of the block
    segments : (segments + 1,) borders of the primitives, from 0 to n, blocks' included
    clustering : cluster and score of each segment
    symmetry : (blocks,) how left and right go together in each activity, ``symmetric``,
        ``alternating`` or ``one-sided`` (see `kineme.methods.region_growing.mirroring`); empty in
        transitions; None where the preset does not mirror
    timings : seconds per stage
    """

    graph: NeighborGraph
    activity_cuts: ActivityCuts
    blocks: Frames
    repeats: NDArray[np.bool_]
    repetition: NDArray[np.float64]
    segments: Frames
    clustering: Clustering
    symmetry: NDArray[np.str_] | None = None
    timings: dict[str, float] = field(default_factory=dict)


def analyze_regions(
    features: ArrayLike,
    preset: RegionPreset,
    *,
    mirror: Mirror | None = None,
    progress: Progress | None = None,
) -> Analysis:
    """Neighbour graph, activities, primitives and clusters of a sequence of features.

    Parameters
    ----------
    features : (frames, dims)
        Stacked search vectors at the working rate, in metres where the
        preset's radius is to mean what its source means.
    preset : RegionPreset
    mirror : exchanges left and right in such features; `kineme.features.mirror_features`
        for those of motions
    progress : called with the name of each stage before it runs

    Raises
    ------
    ParameterError : features of another shape, empty or not finite, or the preset mirrors, and
        nothing says how
    """
    features = as_features(features)
    if preset.mirror and mirror is None:
        raise ParameterError("these features have no left and right: they take mirror=False")
    timings: dict[str, float] = {}
    stage = stopwatch(timings, progress)
    if preset.bundling is not None:
        from kineme.features.bundling import bundle  # compiled code that few need

        with stage("bundling"):
            features = bundle(features, neighbors=preset.bundling)
    with stage("neighbors"):
        graph = _neighbors(features, None, preset)
    with stage("activities"):
        off_diagonal = _growth_graph(graph, preset)
        cuts = _activity_cuts(off_diagonal, preset)
        blocks = _borders(cuts.all, len(graph))
        inner = _kernels.inner_neighbors(off_diagonal.indptr, off_diagonal.indices, blocks)
        repeats = _repeats(blocks, cuts, np.add.reduceat(inner, blocks[:-1]), preset)
        repetition = np.add.reduceat(inner > 0, blocks[:-1]) / np.diff(blocks)
    with stage("primitives"):
        primitives = _primitives(graph, blocks, preset)
    cuts_inside = [block.cuts for block in primitives]
    symmetry = None
    if preset.mirror and mirror is not None:
        with stage("mirroring"):
            graph_across = _neighbors(mirror(features), features, preset)
            mirrored = _primitives(graph_across, blocks, preset)
            cuts_inside = _merged(primitives, mirrored, preset)
            symmetry = _symmetry(blocks, repeats, primitives, mirrored, preset)
    with stage("clusters"):
        segments = _borders(np.concatenate([blocks, *cuts_inside]), len(graph))
        clustering = _clusters(graph, segments, preset)
    return Analysis(
        graph, cuts, blocks, repeats, repetition, segments, clustering, symmetry, timings
    )


def _neighbors(
    features: ArrayLike, others: ArrayLike | None, preset: RegionPreset
) -> NeighborGraph:
    return neighbor_graph(
        features,
        others,
        radius=preset.radius,
        k=preset.max_neighbors,
        max_lag=None if preset.max_lag is None else max(1, preset.frames(preset.max_lag)),
    )


def _growth_graph(graph: NeighborGraph, preset: RegionPreset) -> NeighborGraph:
    """The pairs that growing regions count: near enough, and off the main diagonal."""
    if preset.growth_neighbors is not None:
        graph = graph.nearest(preset.growth_neighbors)
    if preset.diagonal == "component":
        labels = component_labels(graph)
        graph = graph.select(labels != labels[0])
        return graph.restrict(radius=preset.growth_radius)
    return graph.restrict(radius=preset.growth_radius, min_lag=preset.frames(preset.diagonal_width))


def _activity_cuts(graph: NeighborGraph, preset: RegionPreset) -> ActivityCuts:
    gap = max(1, preset.frames(preset.growth_gap))
    if preset.growth == "squares":
        return square_cuts(
            graph,
            min_gap=gap,
            min_count=preset.growth_count,
            min_distance=preset.frames(preset.growth_distance),
        )
    return scan_line_cuts(graph, min_gap=gap, min_count=preset.growth_count)


def _borders(cuts: Frames, n: int) -> Frames:
    """0, the cuts that leave at least a frame on either side, n."""
    inner = np.unique(cuts)
    return np.concatenate([[0], inner[(inner > 0) & (inner < n - 1)], [n]])


def _repeats(
    blocks: Frames, cuts: ActivityCuts, pairs: Frames, preset: RegionPreset
) -> NDArray[np.bool_]:
    """Blocks that repeat themselves; those from an end to the next start do not."""
    ends_only = np.isin(blocks[:-1], cuts.forward) & ~np.isin(blocks[:-1], cuts.backward)
    return (pairs > preset.growth_count) & ~(ends_only & np.isin(blocks[1:], cuts.backward))


def _primitives(graph: NeighborGraph, blocks: Frames, preset: RegionPreset) -> list[PrimitiveCuts]:
    frames = np.minimum(blocks, len(graph) - 1).tolist()

    def cuts_of(block: int) -> PrimitiveCuts:
        return primitive_cuts(
            graph,
            (frames[block], frames[block + 1]),
            steps=preset.steps,
            skip_penalty=preset.skip_penalty * preset.radius,
            zero_cost=preset.zero_cost,
            min_nodes=ceil(preset.min_path * preset.working_fps),
            separation=_separation(preset),
            max_slope=preset.max_slope,
            symmetry=preset.symmetry,
            min_length=preset.min_primitive * preset.working_fps,
        )

    return map_threads(cuts_of, range(len(blocks) - 1))


def _merged(
    main: list[PrimitiveCuts], mirrored: list[PrimitiveCuts], preset: RegionPreset
) -> list[Frames]:
    gap = preset.min_primitive * preset.working_fps
    return [merged_cuts(a.cuts, b.cuts, gap) for a, b in zip(main, mirrored, strict=True)]


def _symmetry(
    blocks: Frames,
    repeats: NDArray[np.bool_],
    main: list[PrimitiveCuts],
    mirrored: list[PrimitiveCuts],
    preset: RegionPreset,
) -> NDArray[np.str_]:
    """How left and right go together in each block that repeats; empty in the others."""
    gap = preset.min_primitive * preset.working_fps
    last = (blocks[1:] - 1).tolist()
    types = map(
        symmetry_type, zip(blocks.tolist(), last, strict=False), main, mirrored, repeat(gap)
    )
    return np.where(repeats, list(types), "")


def _clusters(graph: NeighborGraph, segments: Frames, preset: RegionPreset) -> Clustering:
    if preset.cluster_neighbors is not None:
        graph = graph.nearest(preset.cluster_neighbors)
    return cluster_segments(
        graph,
        np.minimum(segments, len(graph) - 1),
        steps=preset.steps,
        skip_penalty=preset.skip_penalty * preset.radius,
        zero_cost=preset.zero_cost,
        min_nodes=ceil(preset.cluster_min_path * preset.working_fps),
        separation=_separation(preset),
        max_slope=preset.max_slope,
        coverage=preset.coverage,
        interpolate=preset.interpolate,
        connection=preset.connection,
    )


def _separation(preset: RegionPreset) -> int | None:
    return None if preset.path_separation is None else preset.frames(preset.path_separation)
