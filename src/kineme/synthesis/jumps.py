"""Jumps between the nodes of a motion graph: where one may be left for another.

Candidates are neighbours in feature space, found by one sparse search. Of each pair of nodes the
few nearest are measured as point clouds. The best becomes an edge if it is below the threshold.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Ints
from kineme.features.point_clouds import fit_clouds
from kineme.methods.kineme.preset import KINEME
from kineme.methods.prepare import compute_motion_features
from kineme.methods.region_growing.neighbors import neighbor_graph
from kineme.recordings import Motion
from kineme.recordings.operations import resample
from kineme.synthesis.graph import Edge, Node

RADIUS = 0.25
"""Body sizes, in the features of the preset."""
CANDIDATES = 12
"""Pairs of frames measured for each pair of nodes; with this radius, 99.8 % of the jumps are found
that measuring all pairs of frames finds on these four recordings."""

POSES = KINEME.replace(offsets=(-0.2, -0.1, 0.0, 0.1, 0.2))
"""Poses with those before and after, so that a jump goes on as it came."""


@dataclass(frozen=True)
class _Ends:
    """Frames at which nodes may be left or entered, and whose they are."""

    frames: Ints
    nodes: Ints


def jumps(
    motions: Sequence[Motion], nodes: Sequence[Node], threshold: float, window: float
) -> list[Edge]:
    """Return the best jump of every pair of nodes that has one below the threshold."""
    rate = POSES.working_fps
    slow = [resample(motion, rate) for motion in motions]
    # Sources are laid end to end: their first frames, and the end of the last.
    firsts = np.cumsum([0, *(motion.n_frames for motion in slow)])
    points = np.concatenate([motion.positions[:, motion.skeleton.body] for motion in slow])
    # Features are at the working rate already, as `slow` is.
    features = np.concatenate([compute_motion_features(motion, POSES) for motion in motions])
    half = round(window * rate / 2)
    ratio = motions[0].fps / rate
    ends, starts = (_ends_of(nodes, firsts, ratio, half, window * rate, side) for side in (1, 0))
    if not (len(ends.frames) and len(starts.frames)):
        return []
    near = neighbor_graph(features[ends.frames], features[starts.frames], radius=RADIUS)
    # Row of each neighbour pair, from the counts of the sparse search.
    rows = np.repeat(np.arange(len(near)), near.counts)
    # One number for each pair of nodes.
    pairs = _nearest(
        ends.nodes[rows] * len(nodes) + starts.nodes[near.indices], near.distances, CANDIDATES
    )
    leave, enter = rows[pairs], near.indices[pairs]
    distances, angles, shifts = fit_clouds(
        points, ends.frames[leave], starts.frames[enter], half=half
    )
    # Of the measured pairs below the threshold, the best of each pair of nodes becomes an edge.
    below = np.flatnonzero(distances <= threshold)
    key = ends.nodes[leave[below]] * len(nodes) + starts.nodes[enter[below]]
    edges = []
    for i in below[_nearest(key, distances[below], 1)].tolist():
        tail, head = int(ends.nodes[leave[i]]), int(starts.nodes[enter[i]])
        at = (
            # Frames are counted within their own recording again, at its own rate.
            _convert_to_source(ends.frames[leave[i]] - firsts[nodes[tail].source], ratio),
            _convert_to_source(starts.frames[enter[i]] - firsts[nodes[head].source], ratio),
        )
        shift = (float(shifts[i, 0]), float(shifts[i, 1]))
        edges.append(Edge(tail, head, *at, float(distances[i]), float(angles[i]), shift))
    return edges


def _ends_of(
    nodes: Sequence[Node], firsts: Ints, ratio: float, half: int, widest: float, side: int
) -> _Ends:
    """Return the ends (side 1) or starts (side 0) of all nodes.

    Only frames with a whole window inside their recording, and never so many
    that a node entered late could be left before that.
    """
    frames, owners = [], []
    for number, node in enumerate(nodes):
        # In frames of the working rate; may lie between two of them.
        border = (node.start, node.stop)[side] / ratio
        # A quarter of the node: an entry at its start lies before any exit at its end.
        reach = min((node.stop - node.start) / ratio / 4, widest)
        # The cloud needs half a window on both sides.
        low, high = half, firsts[node.source + 1] - firsts[node.source] - half
        frames_of_node = np.arange(
            max(low, int(np.ceil(border - reach))), min(high, int(border + reach) + 1)
        )
        frames.append(frames_of_node + firsts[node.source])
        owners.append(np.full(len(frames_of_node), number))
    return _Ends(np.concatenate(frames), np.concatenate(owners))


def _nearest(groups: Ints, distances: NDArray[np.floating], count: int) -> Ints:
    """Return the indices of the ``count`` smallest distances of each group."""
    # Sorted by group, and by distance within each group: the last key counts first.
    order = np.lexsort((distances, groups))
    sizes = np.unique(groups[order], return_counts=True)[1]
    # Place at which the group of each entry begins.
    starts = np.repeat(np.cumsum(sizes) - sizes, sizes)
    # The rank within the group.
    kept: Ints = order[np.arange(len(order)) - starts < count]
    return kept


def _convert_to_source(frame: int, ratio: float) -> int:
    return round(float(frame) * ratio)
