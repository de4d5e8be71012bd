"""Build a motion graph from recordings and their primitives.

Jumps lead from the end of one node to the start of another: to frames within a quarter of the node,
and within the window, of its border. Candidates are neighbours in feature space, found by one
sparse search. For each pair of nodes the nearest candidates are compared as point clouds. The best
one becomes an edge if it is below the threshold.

Frames are compared at the working rate of the ``kineme`` preset, 30 Hz; edges store frames at the
rate of the sources.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Ints
from kineme._util.checks import check_type, is_number
from kineme.errors import ParameterError
from kineme.features.point_clouds import fit_clouds
from kineme.methods.kineme.preset import KINEME
from kineme.methods.prepare import compute_motion_features
from kineme.methods.region_growing.neighbors import neighbor_graph
from kineme.methods.segmenter import segment
from kineme.recordings import Motion
from kineme.recordings.motion import check_motion
from kineme.recordings.operations import resample
from kineme.segments.segmentation import Segmentation
from kineme.synthesis.graph import Edge, MotionGraph, Node, Source
from kineme.transfer.sharing import share_clusters

RADIUS = 0.25
"""Radius of the neighbour search in feature space, in body sizes."""
CANDIDATES = 12
"""Pairs of frames compared for each pair of nodes; this finds 99.8 % of the jumps that comparing
all pairs of frames finds on three takes of subject 86 and the bundled recording."""
POSES = KINEME.replace(offsets=(-0.2, -0.1, 0.0, 0.1, 0.2))
"""Preset whose features include neighbouring poses, so that jumps preserve movement."""
THRESHOLD = 0.08
"""Largest distance of a jump in metres, RMS over the joints. On three takes of subject 86 and the
bundled recording, 0.05 already connects all but at most two nodes of each."""
WINDOW = 1 / 3
"""Window of a jump in seconds, as used by Kovar and Gleicher."""

OFFSET = 1e-3
"""Metres by which offsets of one skeleton may differ, due to rounding in the files."""


def motion_graph(
    motions: Sequence[Motion],
    segmentations: Sequence[Segmentation] | None = None,
    *,
    threshold: float = THRESHOLD,
    window: float = WINDOW,
    prune: bool = True,
) -> MotionGraph:
    """Return the graph whose nodes are the primitives of all motions.

    Parameters
    ----------
    motions : sequence of Motion
        With rotations, of one skeleton and one frame rate.
    segmentations : sequence of Segmentation, optional
        One for each motion; computed by `kineme.segment` by default. Matching clusters of
        several recordings get the same number.
    threshold : float
        Largest point-cloud distance of a jump, metres.
    window : float
        Seconds that are compared and blended around a jump.
    prune : bool
        Whether to keep only the largest strongly connected component, which has no dead ends.

    Raises
    ------
    ParameterError
        Motions or segments do not match, threshold or window are not above 0, or nothing is left
        after pruning.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_recording, bundled_truth
    >>> motion = kineme.read(bundled_recording())
    >>> truth = kineme.read_segments(bundled_truth(), fps=motion.fps, n_frames=motion.n_frames)
    >>> list(kineme.motion_graph([motion], [truth], prune=False).names)[:3]
    ['walk', 'squat', 'arm circles']
    """
    _check_inputs(motions, threshold, window)
    if segmentations is not None:
        check_type(segmentations, Iterable, "motion_graph", "give one segmentation per motion")
    tables = [segment(m) for m in motions] if segmentations is None else list(segmentations)
    for each in tables:
        check_type(each, Segmentation, "motion_graph", "kineme.segment(motion) gives one")
    if [s.n_frames for s in tables] != [m.n_frames for m in motions]:
        raise ParameterError(
            f"segments of {[s.n_frames for s in tables]} frames do not belong to motions "
            f"of {[m.n_frames for m in motions]}"
        )
    if len(tables) > 1:
        # Give matching clusters of different recordings the same number.
        tables = share_clusters(motions, tables)
    nodes, successors = _make_nodes(tables)
    best = {(e.tail, e.head): e for e in find_jumps(motions, nodes, threshold, window)}
    # The recording's own successor replaces a jump between the same nodes.
    best |= {(e.tail, e.head): e for e in successors}
    graph = MotionGraph(
        tuple(Source(m.provenance.path, m.provenance.sha256, m.n_frames) for m in motions),
        tuple(nodes),
        edges=tuple(best[pair] for pair in sorted(best)),
        fps=motions[0].fps,
        threshold=float(threshold),
        window=float(window),
    )
    return graph.pruned() if prune else graph


def _check_inputs(motions: Sequence[Motion], threshold: float, window: float) -> None:
    for name, value in (("threshold", threshold), ("window", window)):
        if not (is_number(value) and value > 0):
            raise ParameterError(f"{name} must be a number above 0, not {value!r:.60}")
    check_type(motions, Sequence, "motion_graph", "give a list of motions")
    for motion in motions:
        check_motion(motion, "motion_graph")
    if not motions:
        raise ParameterError("a motion graph needs at least one recording")
    for motion in motions:
        check_source(motion, motions[0])


def check_source(motion: Motion, first: Motion) -> None:
    """Raise ParameterError if a motion cannot be in one graph with the first.

    Parameters
    ----------
    motion, first : Motion

    Raises
    ------
    ParameterError
        No rotations, or another skeleton or frame rate.

    Examples
    --------
    >>> import kineme
    >>> from kineme.synthesis import check_source
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> check_source(motion[:100], motion)
    """
    where = motion.provenance.path or "a motion"
    if motion.rotations is None:
        raise ParameterError(f"{where} has no rotations: give BVH or AMC files")
    same = (
        motion.skeleton.names == first.skeleton.names
        and motion.skeleton.parents == first.skeleton.parents
        and _have_equal_bones(motion, first)
    )
    if not same or motion.fps != first.fps:
        raise ParameterError(
            f"{where} has another skeleton or frame rate than "
            f"{first.provenance.path or 'the first motion'}: build one graph for each"
        )


def _have_equal_bones(motion: Motion, first: Motion) -> bool:
    """Return whether offsets are equal up to rounding, except those of joints that slide."""
    parents = np.array(first.skeleton.parents)
    rigid = parents >= 0
    for each in (motion, first):
        lengths = np.linalg.norm(each.positions - each.positions[:, parents], axis=2)
        rigid &= np.ptp(lengths, axis=0) <= OFFSET
    offsets = motion.skeleton.offsets[rigid], first.skeleton.offsets[rigid]
    return np.allclose(*offsets, atol=OFFSET)


def _make_nodes(segmentations: Sequence[Segmentation]) -> tuple[list[Node], list[Edge]]:
    """Return all primitives as nodes, and the edges to their successors in the recording."""
    nodes: list[Node] = []
    edges: list[Edge] = []
    for source, segmentation in enumerate(segmentations):
        rows = segmentation.primitives if len(segmentation.primitives) else segmentation.activities
        first_node = len(nodes)
        nodes += [
            Node(source, row.start_frame, row.stop_frame, row.cluster, row.label) for row in rows
        ]
        for a, b in pairwise(range(first_node, len(nodes))):
            edges.append(Edge(a, b, nodes[a].stop, nodes[b].start, jump=False))
    return nodes, edges


def find_jumps(
    motions: Sequence[Motion], nodes: Sequence[Node], threshold: float, window: float
) -> list[Edge]:
    """Return the best jump below the threshold for each pair of nodes."""
    rate = POSES.working_fps
    slow = [resample(motion, rate) for motion in motions]
    # Sources are concatenated: first frame of each, and the end of the last.
    firsts = np.cumsum([0, *(motion.n_frames for motion in slow)])
    points = np.concatenate([motion.positions[:, motion.skeleton.body] for motion in slow])
    # Features are at the working rate, like `slow`.
    features = np.concatenate([compute_motion_features(motion, POSES) for motion in motions])
    half = round(window * rate / 2)
    ratio = motions[0].fps / rate
    # Frames at which nodes may be left and entered, and the nodes of these frames.
    (ends, tails), (starts, heads) = (
        _sample_ends(nodes, firsts, ratio, half, window * rate, side) for side in (1, 0)
    )
    if not (len(ends) and len(starts)):
        return []
    near = neighbor_graph(features[ends], features[starts], radius=RADIUS)
    # Row of each neighbour pair, from the counts of the sparse search.
    rows = np.repeat(np.arange(len(near)), near.counts)
    # Encode each pair of nodes as one number.
    pairs = _find_nearest(
        tails[rows] * len(nodes) + heads[near.indices], near.distances, CANDIDATES
    )
    leave, enter = rows[pairs], near.indices[pairs]
    ends, tails, starts, heads = ends[leave], tails[leave], starts[enter], heads[enter]
    distances, angles, shifts = fit_clouds(points, ends, starts, half=half)
    # Of the measured pairs below the threshold, the best of each pair of nodes becomes an edge.
    accepted = np.flatnonzero(distances <= threshold)
    key = tails[accepted] * len(nodes) + heads[accepted]
    edges = []
    for i in accepted[_find_nearest(key, distances[accepted], 1)].tolist():
        tail, head = int(tails[i]), int(heads[i])
        # Frames are counted within their own recording again, at its own rate.
        stop, start = (
            round(float(frame - firsts[nodes[node].source]) * ratio)
            for frame, node in ((ends[i], tail), (starts[i], head))
        )
        shift = (float(shifts[i, 0]), float(shifts[i, 1]))
        edges.append(Edge(tail, head, stop, start, float(distances[i]), float(angles[i]), shift))
    return edges


def _sample_ends(
    nodes: Sequence[Node], firsts: Ints, ratio: float, half: int, max_reach: float, side: int
) -> tuple[Ints, Ints]:
    """Return frames near the starts (side 0) or ends (side 1) of all nodes, and their nodes.

    Frames count over all recordings in a row, at the working rate. ``firsts`` are the first frames
    of the recordings, and the end of the last. ``ratio`` is the frame rate of the nodes divided by
    the working rate. A frame has ``half`` a window on both sides within its recording, and lies
    within ``max_reach`` frames and a quarter of the node from the border.
    """
    frames, owners = [], []
    for number, node in enumerate(nodes):
        # In frames of the working rate, possibly fractional.
        border = (node.start, node.stop)[side] / ratio
        # With a quarter of the node, entries near its start are before all exits near its end.
        reach = min((node.stop - node.start) / ratio / 4, max_reach)
        low, high = half, firsts[node.source + 1] - firsts[node.source] - half
        frames_of_node = np.arange(
            max(low, int(np.ceil(border - reach))), min(high, int(border + reach) + 1)
        )
        frames.append(frames_of_node + firsts[node.source])
        owners.append(np.full(len(frames_of_node), number))
    return np.concatenate(frames), np.concatenate(owners)


def _find_nearest(groups: Ints, distances: NDArray[np.floating], count: int) -> Ints:
    """Return the indices of the ``count`` smallest distances of each group."""
    # Sorted by group, and by distance within each group: the last key counts first.
    order = np.lexsort((distances, groups))
    sizes = np.unique(groups[order], return_counts=True)[1]
    # Index at which the group of each entry begins.
    starts = np.repeat(np.cumsum(sizes) - sizes, sizes)
    # The rank within the group.
    chosen: Ints = order[np.arange(len(order)) - starts < count]
    return chosen
