"""Build the segments of both levels: activities, and their repetitions and occurrences.

Each segment is divided into repetitions. Clusters whose mean repetitions are similar at any phase
and pace are merged. Clusters that do not repeat get occurrences as primitives: spans that recur
anywhere. Occurrences are never cut: a border of activities inside one moves to its nearer end.

Spans are in frames at the working rate; ``rows`` (frames, dims) are at this rate, too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.parallel import map_threads
from kineme.methods.kineme import _repetition_kernels as kernels
from kineme.methods.kineme._repetition_kernels import sample_repetitions
from kineme.methods.kineme.borders import Sets, fit_ends, join_sets
from kineme.methods.kineme.events import (
    STILL,
    Occurrences,
    find_occurrences,
    measure_reaches,
)
from kineme.methods.kineme.repetitions import (
    MIN_EXPLAINED,
    PLACES,
    Movement,
    find_repetitions,
    trace_movement,
)
from kineme.methods.segments import find_segments, number_by_appearance

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Bools = NDArray[np.bool_]
Frames = NDArray[np.int64]
Rows = NDArray[np.float32]

MAX_COMPARED = 8
"""Largest number of segments of a cluster that are compared with other clusters."""


@dataclass(frozen=True, eq=False)
class Segments:
    """Segments of both levels, each from frame 0 to the end of the recording."""

    borders: Frames
    """Borders of activities and transitions, (activities + 1,)."""
    labels: Frames
    """Cluster of each activity; -1 for transitions."""
    primitives: Frames
    """Borders of the primitives, including those of activities."""
    clusters: Frames
    """Cluster of each primitive; -1 for transitions. The numbers of `labels` come first, then those
    of repetitions of other movements, then those of occurrences."""
    not_periodic: Frames
    """Clusters of activities whose primitives are occurrences."""

    @cached_property
    def parents(self) -> Frames:
        """Return the activity or transition that contains each primitive."""
        return find_segments(self.borders, self.primitives[:-1])

    @cached_property
    def firsts(self) -> Frames:
        """Return the first primitive of each activity or transition, then the total number."""
        return np.searchsorted(self.parents, np.arange(len(self.labels) + 1))

    @cached_property
    def repeats(self) -> Bools:
        """Return whether each primitive is a repetition."""
        actions = self.labels[self.parents]
        in_activity: Bools = (self.clusters >= 0) & (actions >= 0)
        return in_activity & ~np.isin(actions, self.not_periodic)

    @cached_property
    def counts(self) -> Frames:
        """Return the number of repetitions of each activity."""
        return np.bincount(self.parents[self.repeats], minlength=len(self.labels))


def divide_into_repetitions(
    rows: Rows,
    starts: Frames,
    stops: Frames,
    labels: Frames,
    preset: KinemeConstants,
) -> Segments:
    """Divide segments into repetitions, and merge neighbours that are one set.

    Frames between two segments are a transition.
    """
    spans = list(zip(starts.tolist(), stops.tolist(), strict=True))
    cuts = map_threads(lambda span: find_repetitions(rows, *span, preset), spans)
    if preset.same_set <= 1:
        sets = Sets(starts, stops, labels, cuts)
        starts, stops, labels, cuts = join_sets(rows, sets, preset)
    # Cuts of an activity do not depend on its neighbours; its ends do.
    ends = fit_ends(rows, starts, stops, labels, cuts, preset)
    borders, segment = _build_borders(len(rows), ends.starts, ends.stops)
    primitives, repeated = _build_borders(len(rows), ends.firsts, ends.lasts, [borders, *cuts])
    labels = np.append(labels, -1)  # for index -1: transitions
    not_periodic = np.empty(0, np.int64)
    return Segments(borders, labels[segment], primitives, labels[repeated], not_periodic)


def merge_similar_clusters(rows: Rows, segments: Segments, preset: KinemeConstants) -> Segments:
    """Merge clusters that are one movement at any pace.

    Neighbours that are now in one cluster become one segment, including a transition between them,
    and all segments are divided into repetitions again.
    """
    means = {}
    for segment in np.flatnonzero(segments.counts > 1).tolist():
        movement, _, repeated = _extract_repetitions(rows, segments, segment, preset)
        # Add the subtracted mean pose again: posture also distinguishes movements.
        means[segment] = repeated.mean(axis=0) + movement.middle
    labels = link_clusters(segments.labels, means, preset.min_similarity)
    if (labels == segments.labels).all():
        return segments
    activities = np.flatnonzero(labels >= 0)
    # Positions, in `activities`, at which a run of one cluster begins.
    run_starts = np.flatnonzero(np.diff(labels[activities], prepend=-1))
    # A run lasts from the start of its first activity to the stop of its last.
    starts = segments.borders[:-1][activities[run_starts]]
    stops = segments.borders[1:][activities[np.append(run_starts[1:], len(activities)) - 1]]
    labels = number_by_appearance(labels[activities[run_starts]])
    return divide_into_repetitions(rows, starts, stops, labels, preset)


def link_clusters(labels: Frames, movements: dict[int, Floats], least: float) -> Frames:
    """Merge clusters whose movements are similar; return the labels of segments.

    The similarity of two movements is, at the phase at which they fit best,

        1 - mean square distance / (variance of one + variance of the other)

    It is 1 for equal movements, 0 for movements with nothing in common but their mean pose, and
    negative if mean poses differ. Small movements must be nearer to each other than large ones.

    ``movements`` holds the mean repetition of each segment (places, dims), sampled evenly along its
    path. ``least`` is the smallest similarity, averaged over pairs of segments, at which two
    clusters are merged.
    """
    labels = labels.copy()
    repeating = np.array(sorted(movements), np.int64)
    if not len(repeating):
        return labels
    _, rank = np.unique(labels[repeating], return_inverse=True)
    by_cluster = np.argsort(rank, kind="stable")
    # Index of each segment in its cluster; the first `MAX_COMPARED` of a cluster represent it.
    within = np.arange(len(repeating)) - np.searchsorted(rank[by_cluster], rank[by_cluster])
    compared = repeating[np.sort(by_cluster[within < MAX_COMPARED])]
    similarity = kernels.measure_similarities(np.stack([movements[at] for at in compared.tolist()]))
    while True:
        names, cluster_index = np.unique(labels[compared], return_inverse=True)
        # One-hot rows: matrix products with them sum over clusters.
        members = np.eye(len(names))[cluster_index]
        sizes = members.sum(axis=0)
        # Average linkage: the mean over all pairs of segments of two clusters.
        means = (members.T @ similarity @ members) / np.outer(sizes, sizes)
        np.fill_diagonal(means, -np.inf)
        kept, merged = sorted(divmod(int(means.argmax()), len(names)))
        if means[kept, merged] < least:
            return labels
        labels[labels == names[merged]] = names[kept]


def find_events(rows: Rows, segments: Segments, preset: KinemeConstants) -> Segments:
    """Replace the repetitions of clusters that do not repeat by occurrences.

    A cluster keeps its repetitions if they explain enough of each other, or if occurrences explain
    less. It loses its primitives if each segment has one repetition and nothing moves in any. Rows
    are in body sizes.
    """
    shares = measure_explained(rows, segments, preset)
    shares = average_by_cluster(shares, np.ones_like(segments.labels), segments.labels)
    weak = shares < MIN_EXPLAINED
    if weak.any():
        lengths = np.diff(segments.borders)
        # Transitions are always weak. If an activity is weak, too, everything is searched.
        searched = np.repeat(weak | (weak & (segments.labels >= 0)).any(), lengths)
        occurrences = find_occurrences(rows, searched, preset)
        recurring = occurrences.select_within(segments.borders, weak)
        recurring_shares = average_by_cluster(
            recurring.compute_explained_shares(segments.borders), lengths, segments.labels
        )
        # Replace repetitions only if occurrences explain more of the cluster.
        free = weak & ((segments.labels < 0) | (recurring_shares > shares))
        occurrences = occurrences.select_within(segments.borders, free)
        if len(occurrences):
            segments = replace_by_occurrences(segments, occurrences, free)
    return drop_still_clusters(segments, rows, preset.event_scale / STILL)


def measure_explained(rows: Rows, segments: Segments, preset: KinemeConstants) -> Floats:
    """Return the share of each segment's repetitions that the mean of the others explains.

    It is 0 for a single repetition.
    """
    shares = np.zeros(len(segments.labels))

    def store_share(segment: int) -> None:
        """Write the explained share of a segment to ``shares``."""
        movement, visits, repeated = _extract_repetitions(rows, segments, segment, preset)
        kernels.center_repetitions(repeated)
        shares[segment] = kernels.explain_variance(movement.poses, movement.path, visits, repeated)

    map_threads(store_share, np.flatnonzero(segments.counts > 1).tolist())
    return shares


def _extract_repetitions(
    rows: Rows, segments: Segments, segment: int, preset: KinemeConstants
) -> tuple[Movement, Frames, Floats]:
    """Return the repeating span of a segment, the borders of its repetitions, and their poses.

    Poses are (repetitions, places, dims), sampled evenly along the path of each repetition.
    """
    first, last = segments.firsts[segment : segment + 2]
    inside = first + np.flatnonzero(segments.repeats[first:last])
    edges = segments.primitives[inside[0] : inside[-1] + 2]
    movement, visits = trace_movement(rows[edges[0] : edges[-1]], preset), edges - edges[0]
    return movement, visits, sample_repetitions(movement.poses, movement.path, visits, PLACES)


def average_by_cluster(shares: Floats, weights: NDArray[np.integer], labels: Frames) -> Floats:
    """Return the weighted mean share of the cluster of each segment; 0 for transitions."""
    in_cluster = labels >= 0
    clusters = labels[in_cluster]
    total = np.bincount(clusters, weights[in_cluster])
    means = np.zeros(len(labels))
    sums = np.bincount(clusters, (shares * weights)[in_cluster])
    means[in_cluster] = (sums / np.maximum(total, 1))[clusters]
    return means


def replace_by_occurrences(segments: Segments, found: Occurrences, free: Bools) -> Segments:
    """Replace the primitives of free segments by the occurrences found in them.

    Transitions are free, and so are activities of clusters that are not periodic. Clusters of
    occurrences are numbered after all others.
    """
    # A border inside an occurrence moves to its nearer end, which may empty a segment.
    borders, old = _drop_empty(_move_borders_out(found, segments.borders), segments.labels)
    free = free[old]
    cuts = segments.primitives[:-1]
    cuts = cuts[~free[find_segments(borders, cuts)]]
    primitives = np.unique(np.concatenate([borders, cuts, found.starts, found.stops]))
    begin = primitives[:-1]
    # Renumber clusters of activities, as some may have vanished. `numbers` maps old to new
    # numbers, shifted by one so that -1 maps to -1.
    labels = number_by_appearance(segments.labels[old])
    numbers = np.full(segments.labels.max(initial=-1) + 2, -1)
    numbers[segments.labels[old] + 1] = labels
    actions = int(labels.max(initial=-1)) + 1
    # Repetitions keep the number of their activity, or get one after these.
    clusters = segments.clusters[find_segments(segments.primitives, begin)]
    clusters[free[find_segments(borders, begin)]] = -1
    parts = number_by_appearance(np.where(clusters < len(numbers) - 1, -1, clusters))
    clusters = np.where(parts < 0, numbers[np.where(parts < 0, clusters, -1) + 1], actions + parts)
    # Occurrences are numbered last.
    if len(found):
        before = np.maximum(find_segments(found.starts, begin), 0)
        inside = (found.starts[before] <= begin) & (begin < found.stops[before])
        first_number = actions + int(parts.max(initial=-1)) + 1
        clusters[inside] = first_number + found.clusters[before[inside]]
    not_periodic = np.unique(labels[free & (labels >= 0)])
    return Segments(borders, labels, primitives, clusters, not_periodic)


def drop_still_clusters(segments: Segments, rows: Rows, near: float) -> Segments:
    """Drop the primitives of clusters that neither repeat nor move.

    A repetition moves if one of its poses is farther from its mean pose than ``near``.
    """
    actions, repeats = segments.labels[segments.parents], segments.repeats
    several = segments.counts[segments.parents] > 1
    # Movement in one primitive of a cluster is enough to keep all.
    moves = measure_reaches(rows, segments.primitives[:-1], segments.primitives[1:]) > near
    still = np.setdiff1d(actions[repeats], actions[repeats & (moves | several)])
    if not len(still):
        return segments
    return replace(
        segments,
        clusters=np.where(repeats & np.isin(actions, still), -1, segments.clusters),
        not_periodic=np.union1d(segments.not_periodic, still),
    )


def _build_borders(
    n: int, starts: Frames, stops: Frames, cuts: Sequence[Frames] = ()
) -> tuple[Frames, Frames]:
    """Return the borders of these spans and cuts, from 0 to n, and the span of each segment.

    The span is -1 for a segment outside all spans.
    """
    borders: Frames = np.unique(np.concatenate([[0, n], starts, stops, *cuts]))
    spans = find_segments(starts, borders[:-1])
    # The last span to begin may have ended before. Index -1 finds the appended 0: never inside.
    inside = (spans >= 0) & (borders[:-1] < np.append(stops, 0)[spans])
    return borders, np.where(inside, spans, -1)


def _drop_empty(borders: Frames, labels: Frames) -> tuple[Frames, Frames]:
    """Drop empty segments and merge equal neighbours; return borders and indices of the rest."""
    kept = np.flatnonzero(np.diff(borders) > 0)
    # Merge segments of one cluster that are now neighbours.
    kept = kept[np.append(True, labels[kept[1:]] != labels[kept[:-1]])]
    return np.append(borders[kept], borders[-1]), kept


def _move_borders_out(found: Occurrences, borders: Frames) -> Frames:
    """Move borders inside an occurrence to its nearer end."""
    if not len(found):
        return borders
    before = np.maximum(find_segments(found.starts, borders), 0)
    starts, stops = found.starts[before], found.stops[before]
    inside = (starts < borders) & (borders < stops)
    # At a tie the border moves to the start.
    nearer = np.where(borders - starts <= stops - borders, starts, stops)
    return np.where(inside, nearer, borders)
