"""Segments of both levels: activities, and the repetitions and occurrences in them.

Each segment is divided into its repetitions. Clusters whose mean repetitions are similar at any
phase and pace become one. Where a cluster does not repeat, its primitives are occurrences: spans
that recur anywhere. An occurrence is never cut: a border between activities that falls into one
moves to its nearer end.

Spans are frames of the working rate.
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
from kineme.methods.kineme import _repeating_kernels as kernels
from kineme.methods.kineme._repetition_kernels import sample_repetitions
from kineme.methods.kineme.ends import fit_ends
from kineme.methods.kineme.events import Occurrences, find_occurrences
from kineme.methods.kineme.joining import Sets, join_sets
from kineme.methods.kineme.repetitions import PLACES, Movement, find_repetitions, trace_movement
from kineme.methods.segments import number_by_appearance

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Bools = NDArray[np.bool_]
Frames = NDArray[np.int64]
Rows = NDArray[np.float32]

COMPARED = 8
"""Segments of a cluster that are compared with those of others, at most."""


@dataclass(frozen=True, eq=False)
class Segments:
    """Both levels of a recording, each from frame 0 to its end.

    Attributes
    ----------
    borders : (activities + 1,) array
        Of activities and the transitions between them.
    labels : (activities,) array
        Cluster of each; -1 for transitions.
    preference : (activities,) array
        How much nearer each is to its cluster than to the next, 0 to 1; nan for transitions.
    primitives : (primitives + 1,) array
        Borders of the primitives, those of activities among them.
    clusters : (primitives,) array
        Cluster of each; -1 for transitions. Numbers are those of `labels`, then those of
        repetitions that are another movement, then those of occurrences.
    not_periodic : array of int
        Clusters of activities whose primitives are occurrences.
    """

    borders: Frames
    labels: Frames
    preference: Floats
    primitives: Frames
    clusters: Frames
    not_periodic: Frames

    @cached_property
    def parents(self) -> Frames:
        """Return the activity or transition that each primitive lies in."""
        return _segment_at(self.borders, self.primitives[:-1])

    @cached_property
    def firsts(self) -> Frames:
        """First primitive of each activity or transition, and the number of primitives."""
        return np.searchsorted(self.parents, np.arange(len(self.labels) + 1))

    @cached_property
    def repeats(self) -> Bools:
        """Return whether each primitive is a repetition."""
        actions = self.labels[self.parents]
        found: Bools = (self.clusters >= 0) & (actions >= 0)
        return found & ~np.isin(actions, self.not_periodic)

    @cached_property
    def counts(self) -> Frames:
        """Repetitions of each activity."""
        return np.bincount(self.parents[self.repeats], minlength=len(self.labels))


def divide_into_repetitions(
    rows: Rows,
    starts: Frames,
    stops: Frames,
    labels: Frames,
    preference: Floats,
    preset: KinemeConstants,
) -> Segments:
    """Segments and their repetitions, the first and the last of which end where they fit.

    Neighbours that are one set are one segment.

    Parameters
    ----------
    rows : (frames, dims) array
        At the working rate.
    starts, stops : (segments,) array
        What lies between two segments is a transition.
    labels, preference : (segments,) array
        As in `Segments`.
    preset : KinemeConstants
    """
    spans = list(zip(starts.tolist(), stops.tolist(), strict=True))
    cuts = map_threads(lambda span: find_repetitions(rows, *span, preset), spans)
    if preset.same_set <= 1:
        sets = Sets(starts, stops, labels, preference, cuts)
        starts, stops, labels, preference, cuts = join_sets(rows, sets, preset)
    # Cuts of one activity do not depend on others; ends do, as they may fit another's repetition.
    ends = fit_ends(rows, starts, stops, labels, cuts, preset)
    borders, segment = _tile(len(rows), ends.starts, ends.stops)
    primitives, repeated = _tile(len(rows), ends.firsts, ends.lasts, [borders, *cuts])
    labels, preference = np.append(labels, -1), np.append(preference, np.nan)
    none = np.empty(0, np.int64)
    return Segments(
        borders, labels[segment], preference[segment], primitives, labels[repeated], none
    )


def merge_similar_clusters(rows: Rows, segments: Segments, preset: KinemeConstants) -> Segments:
    """Segments whose clusters are one movement at any pace; neighbours of one cluster are joined.

    Parameters
    ----------
    rows : (frames, dims) array
        At the working rate.
    segments : Segments
        With repetitions.
    preset : KinemeConstants
    """
    means = {}
    for segment in np.flatnonzero(segments.counts > 1).tolist():
        movement, _, repeated = _find_repeated(rows, segments, segment, preset)
        # Centred poses plus their mean: posture tells two movements apart, too.
        means[segment] = repeated.mean(axis=0) + movement.middle
    labels = link_clusters(segments.labels, means, preset.min_similarity)
    if (labels == segments.labels).all():
        return segments
    activities = np.flatnonzero(labels >= 0)
    first = np.flatnonzero(np.diff(labels[activities], prepend=-1))
    # Neighbours that are one cluster now are one segment, with repetitions found anew.
    starts = segments.borders[:-1][activities[first]]
    stops = segments.borders[1:][activities[np.append(first[1:], len(activities)) - 1]]
    groups = np.split(segments.preference[activities], first[1:])
    preference = np.array([group.mean() for group in groups])
    labels = number_by_appearance(labels[activities[first]])
    return divide_into_repetitions(rows, starts, stops, labels, preference, preset)


def link_clusters(labels: Frames, movements: dict[int, Floats], least: float) -> Frames:
    """Return the labels of segments; clusters whose movements are similar become one.

    The similarity of two movements is, at the phase at which they fit best,

        1 - mean square distance / (variance of the one + variance of the other)

    It is 1 where both are the same, 0 where they share their place only, and below where they are
    elsewhere. Small movements must be nearer to each other than large ones.

    Parameters
    ----------
    labels : (segments,) array
        Cluster of each.
    movements : dict of int to (places, dims) array
        By segment its mean repetition, evenly along its path.
    least : float
        Similarity from which two clusters are one, in the mean of their segments.
    """
    labels = labels.copy()
    repeating = np.array(sorted(movements), np.int64)
    if not len(repeating):
        return labels
    _, rank = np.unique(labels[repeating], return_inverse=True)
    first = np.argsort(rank, kind="stable")
    # Rank of each segment in its cluster; the first `COMPARED` of each stand for it.
    within = np.arange(len(repeating)) - np.searchsorted(rank[first], rank[first])
    compared = repeating[np.sort(first[within < COMPARED])]
    similarity = kernels.measure_similarities(np.stack([movements[at] for at in compared.tolist()]))
    while True:
        names, of = np.unique(labels[compared], return_inverse=True)
        members = np.eye(len(names))[of]
        sizes = members.sum(axis=0)
        # Mean linkage: all pairs of segments of two clusters weigh the same.
        means = (members.T @ similarity @ members) / np.outer(sizes, sizes)
        np.fill_diagonal(means, -np.inf)
        one, other = sorted(divmod(int(means.argmax()), len(names)))
        if means[one, other] < least:
            return labels
        labels[labels == names[other]] = names[one]


def find_events(rows: Rows, segments: Segments, preset: KinemeConstants) -> Segments:
    """Occurrences for primitives, where no segment repeats.

    A cluster whose repetitions explain each other keeps them. The others lose theirs where
    occurrences explain more. Segments that are one repetition in which nothing moves have no
    primitives.

    Parameters
    ----------
    rows : (frames, dims) array
        At the working rate, in body sizes.
    segments : Segments
    preset : KinemeConstants
    """
    shares = measure_explained(rows, segments, preset)
    shares = average_by_cluster(shares, np.ones_like(segments.labels), segments.labels)
    weak = shares < preset.min_explained
    if weak.any():
        lengths = np.diff(segments.borders)
        searched = np.repeat(weak | (weak & (segments.labels >= 0)).any(), lengths)
        # Where no activity is weak, transitions are not searched: there is nothing to recur with.
        found = find_occurrences(rows, searched, preset)
        recurring = found.within(segments.borders, weak).explained(segments.borders)
        recurring = average_by_cluster(recurring, lengths, segments.labels)
        # Repetitions give way only where occurrences cover more of the activity than they explain.
        free = weak & ((segments.labels < 0) | (recurring > shares))
        found = found.within(segments.borders, free)
        if len(found):
            segments = replace_by_occurrences(segments, found, free)
    return drop_still_clusters(segments, rows, preset.event_scale / 4)


def measure_explained(rows: Rows, segments: Segments, preset: KinemeConstants) -> Floats:
    """Return the share of each segment's repetitions that the mean of the others explains.

    0 of one.
    """
    found = np.zeros(len(segments.labels))

    def explain(segment: int) -> None:
        movement, visits, repeated = _find_repeated(rows, segments, segment, preset)
        kernels.center_repetitions(repeated)
        found[segment] = kernels.explain_variance(movement.poses, movement.path, visits, repeated)

    map_threads(explain, np.flatnonzero(segments.counts > 1).tolist())
    return found


def _find_repeated(
    rows: Rows, segments: Segments, segment: int, preset: KinemeConstants
) -> tuple[Movement, Frames, Floats]:
    """Return the span of a segment that repeats, the frames at which repetitions begin, and these.

    Repetitions are (repetitions, places, dims), evenly along their path.
    """
    first, last = segments.firsts[segment : segment + 2]
    inside = first + np.flatnonzero(segments.repeats[first:last])
    edges = segments.primitives[inside[0] : inside[-1] + 2]
    movement, visits = trace_movement(rows[edges[0] : edges[-1]], preset), edges - edges[0]
    return movement, visits, sample_repetitions(movement.poses, movement.path, visits, PLACES)


def average_by_cluster(shares: Floats, weights: NDArray[np.integer], labels: Frames) -> Floats:
    """Return for each segment the weighted mean share of its cluster; 0 of transitions."""
    in_cluster = labels >= 0
    clusters = labels[in_cluster]
    total = np.bincount(clusters, weights[in_cluster])
    means = np.zeros(len(labels))
    sums = np.bincount(clusters, (shares * weights)[in_cluster])
    means[in_cluster] = (sums / np.maximum(total, 1))[clusters]
    return means


def replace_by_occurrences(segments: Segments, found: Occurrences, free: Bools) -> Segments:
    """Return the segments with occurrences for primitives where no activity is periodic.

    Parameters
    ----------
    segments : Segments
    found : Occurrences
        Of the free segments; their clusters are numbered after those of the activities.
    free : (activities,) array of bool
        Transitions, and activities of clusters that are not periodic.
    """
    # A border inside an occurrence moves to its nearer end, which may empty a segment.
    borders, old = _drop_empty(_move_out_of(found, segments.borders), segments.labels)
    free = free[old]
    cuts = segments.primitives[:-1]
    cuts = cuts[~free[_segment_at(borders, cuts)]]
    primitives = np.unique(np.concatenate([borders, cuts, found.starts, found.stops]))
    begin = primitives[:-1]
    # Numbers begin with those of activities, by appearance, as some may have vanished.
    labels = number_by_appearance(segments.labels[old])
    numbers = np.full(segments.labels.max(initial=-1) + 2, -1)
    numbers[segments.labels[old] + 1] = labels
    actions = int(labels.max(initial=-1)) + 1
    # Repetitions keep the number of their activity, or get one after these.
    clusters = segments.clusters[_segment_at(segments.primitives, begin)]
    clusters[free[_segment_at(borders, begin)]] = -1
    parts = number_by_appearance(np.where(clusters < len(numbers) - 1, -1, clusters))
    clusters = np.where(parts < 0, numbers[np.where(parts < 0, clusters, -1) + 1], actions + parts)
    # Occurrences are numbered last.
    if len(found):
        before = np.maximum(_segment_at(found.starts, begin), 0)
        inside = (found.starts[before] <= begin) & (begin < found.stops[before])
        first = actions + int(parts.max(initial=-1)) + 1
        clusters[inside] = first + found.clusters[before[inside]]
    not_periodic = np.unique(labels[free & (labels >= 0)])
    return Segments(borders, labels, segments.preference[old], primitives, clusters, not_periodic)


def drop_still_clusters(segments: Segments, rows: Rows, near: float) -> Segments:
    """Return the segments without primitives in clusters that neither repeat nor move.

    Parameters
    ----------
    segments : Segments
    rows : (frames, dims) array
    near : float
        A repetition moves if one of its poses is farther than this from its mean pose.
    """
    actions, repeats = segments.labels[segments.parents], segments.repeats
    several = segments.counts[segments.parents] > 1
    # One small movement in any primitive of a cluster is enough to keep all of them.
    moves = np.array([_reach(part) > near for part in np.split(rows, segments.primitives[1:-1])])
    still = np.setdiff1d(actions[repeats], actions[repeats & (moves | several)])
    return drop_repetitions(segments, still)


def _reach(rows: Rows) -> float:
    """Return the largest distance of a row from their mean."""
    return float(np.linalg.norm(rows - rows.mean(axis=0), axis=1).max())


def drop_repetitions(segments: Segments, actions: Frames) -> Segments:
    """Return the segments without the repetitions of some clusters."""
    if not len(actions):
        return segments
    lost = segments.repeats & np.isin(segments.labels[segments.parents], actions)
    return replace(
        segments,
        clusters=np.where(lost, -1, segments.clusters),
        not_periodic=np.union1d(segments.not_periodic, actions),
    )


def _tile(
    n: int, starts: Frames, stops: Frames, cuts: Sequence[Frames] = ()
) -> tuple[Frames, Frames]:
    """Borders from 0 to n with these spans and cuts among them, and the span of each segment.

    What lies in no span is in span -1.
    """
    borders: Frames = np.unique(np.concatenate([[0, n], starts, stops, *cuts]))
    spans = _segment_at(starts, borders[:-1])
    # The span that began last may have ended; -1 indexes the 0 appended, which is never above.
    inside = (spans >= 0) & (borders[:-1] < np.append(stops, 0)[spans])
    return borders, np.where(inside, spans, -1)


def _segment_at(borders: Frames, frames: Frames) -> Frames:
    """Return the segment in which each frame lies; -1 before the first."""
    segments: Frames = np.searchsorted(borders, frames, side="right") - 1
    return segments


def _drop_empty(borders: Frames, labels: Frames) -> tuple[Frames, Frames]:
    """Borders of the segments that have frames, and which they are; equal neighbours are one."""
    kept = np.flatnonzero(np.diff(borders) > 0)
    # Segments that became neighbours and are of one cluster are one.
    kept = kept[np.append(True, labels[kept[1:]] != labels[kept[:-1]])]
    return np.append(borders[kept], borders[-1]), kept


def _move_out_of(found: Occurrences, borders: Frames) -> Frames:
    """Return the borders, those within an occurrence moved to its nearer end."""
    if not len(found):
        return borders
    before = np.maximum(_segment_at(found.starts, borders), 0)
    starts, stops = found.starts[before], found.stops[before]
    inside = (starts < borders) & (borders < stops)
    # Ties go to the start, so that no frame is lost from the occurrence before.
    nearer = np.where(borders - starts <= stops - borders, starts, stops)
    return np.where(inside, nearer, borders)
