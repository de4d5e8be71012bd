"""Segments: a tree of fine ones, and the level of it with the shortest description.

1. Fine borders are change points of the distances: the cheapest division into
   segments whose samples are near each other.
2. The two neighbours whose union costs least are joined, again and again, until
   one segment is left: each number of segments is a level of the tree.
3. At each level segments are grouped, the nearest clusters first. Their distance is the
   mean one of their samples, less a share of the mean distance within each: samples of a varied
   activity are far from each other, and from those of any other.
4. Views are means over a second and change slowly, so a change between two activities looks like
   an activity of its own. Clusters that are shorter than an action are given to their neighbours.
5. The level and the number of clusters are those of the shortest description: the
   distances of samples within clusters, and a price for each segment and cluster.

A long recording is cut into about equal parts, where it changes most, each of which has the level
that it would have alone: the shortest description of hours is coarser than that of their minutes,
and takes the square of the time. Then clusters of different parts are joined, the nearest first,
while they are nearer to each other than either is to another cluster of its own part. Clusters of
one part stay apart.

Sources: change points after Arlot, Celisse and Harchaoui 2019; bottom-up
segmentation after Keogh, Chu, Hart and Pazzani 2001; distances of clusters less those
within are Székely and Rizzo's energy distance (2005) where the share is 1; the rest is ours.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.parallel import make_even_slices, map_threads
from kineme.methods.kineme import _tree_kernels as kernels
from kineme.methods.segments import number_by_appearance

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants
    from kineme.methods.kineme.repeating import Repeating

Rows = NDArray[np.float32]
Samples = NDArray[np.int64]

PAIRED = 1000
"""Samples whose distances give the median one."""
COMPARED = 12_000
"""Samples that stand for all segments of a long recording."""
LEAST, MOST = 4, 24
"""Samples that stand for one segment."""
OF_CLUSTER = 64
"""Samples that stand for one cluster of a part, at most."""
MOVED = 1 / 6
"""Share of a part by which its end moves to where the recording changes."""
TINY = 1e-12
"""Least distance that something is divided by."""
EACH_LEVEL, LEVELS = 150, 60
"""Levels up to so many segments are tried one by one; of the others so many."""


@dataclass(frozen=True, eq=False)
class Level:
    """Segments of samples or frames, from the first to the end.

    Attributes
    ----------
    fine : (segments + 1,) array
        Borders of the finest segments.
    borders : (segments + 1,) array
    labels : (segments,) array
        Cluster of each, numbered as they appear.
    preference : (segments,) array
        How much nearer each is to its own cluster than to the next, 0 to 1.
    """

    fine: Samples
    borders: Samples
    labels: Samples
    preference: Floats

    def per_sample(self) -> Samples:
        """Return the cluster of each sample."""
        return np.repeat(self.labels, np.diff(self.borders))

    def in_frames(self, span: slice, preset: KinemeConstants) -> Level:
        """Return the level of samples as one of the frames of this part of a recording."""

        def frames(samples: Samples) -> Samples:
            found = span.start + np.rint(samples * (preset.working_fps / preset.rate))
            return np.append(found[:-1].astype(np.int64), span.stop)

        return replace(self, fine=frames(self.fine), borders=frames(self.borders))


class FineLevel(NamedTuple):
    """Finest segments of a view, and how far they are from each other.

    Attributes
    ----------
    features : (samples, dims) array
    unit : float
        The distance that counts as 1.
    borders : (segments + 1,) array
    sums : (segments, segments) array
        Of `sum_between_segments`.
    """

    features: Rows
    unit: float
    borders: Samples
    sums: Floats


def find_fine_level(features: Rows, preset: KinemeConstants) -> FineLevel:
    """Return the finest segments of a view, (samples, dims)."""
    unit = compute_median_distance(features, preset.near)
    cost = preset.samples(preset.fine_cost)
    borders = find_fine_borders(features, unit, width=preset.near, cost=cost)
    return FineLevel(features, unit, borders, sum_between_segments(features, borders, unit))


def find_level(
    fine: FineLevel, preset: KinemeConstants, repeating: Repeating | None = None
) -> Level:
    """Return the segments of a view at the level of the shortest description.

    Parameters
    ----------
    fine : FineLevel
    preset : KinemeConstants
    repeating : Repeating, optional
        Gives what a span saves by repeating itself; by default no span saves anything.
    """

    def saved(start: int, stop: int) -> float:
        return repeating.saved(fine.features, fine.unit, start, stop) if repeating else 0.0

    level = choose_level(fine.borders, fine.sums, preset, saved)
    at = np.searchsorted(fine.borders, level.borders[:-1])
    preference = measure_preferences(sum_runs(fine.sums, at), np.diff(level.borders), level.labels)
    return Level(fine.borders, level.borders, level.labels, preference)


class Grouped(NamedTuple):
    """A level of the tree, grouped.

    Attributes
    ----------
    borders : (segments + 1,) array
        Samples, from 0 to the end.
    labels : (segments,) array
        Cluster of each, numbered as they appear.
    cost : float
        Of its description, without what segments save by repeating themselves.
    alone : (segments,) array
        What each segment costs as a cluster of its own: it can save no more by repeating.
    """

    borders: Samples
    labels: Samples
    cost: float
    alone: Floats


def compute_median_distance(features: Rows, width: int) -> float:
    """Return the median distance of two samples that are so near in time; 1 where all are equal.

    An hour varies more than each of its minutes: the median distance of all samples would grow
    with the length of a recording.

    Parameters
    ----------
    features : (samples, dims) array
    width : int
        Samples that two are apart, at most.
    """
    at = spread_samples(0, len(features), PAIRED)
    # Samples stand 1/PAIRED of the recording apart: of hours, neighbours must still be a pair.
    apart = kernels.measure_near_distances(features, at, max(width, 2 * len(features) // PAIRED))
    middle = float(np.median(apart)) if len(apart) else 0.0
    return middle if middle > 1e-9 else 1.0


def find_fine_borders(features: Rows, unit: float, *, width: int, cost: float) -> Samples:
    """Borders of the segments whose samples are near each other, ends included.

    Parameters
    ----------
    features : (samples, dims) array
    unit : float
        The distance that counts as 1.
    width : int
        Samples of the longest segment.
    cost : float
        Of a border: samples at that distance.
    """
    similarity = np.empty((len(features), min(width, len(features))), np.float32)

    def fill(rows: slice) -> None:
        kernels.compute_similarity_band(features, unit, rows.start, rows.stop, similarity)

    map_threads(fill, make_even_slices(len(features)))
    # The cost of a span is half the sum over ordered pairs, so a border costs twice as much there.
    borders: Samples = kernels.find_change_points(similarity, 2 * cost)
    return borders


def sum_between_segments(features: Rows, borders: Samples, unit: float) -> Floats:
    """Summed distances of the samples of each two segments, (segments, segments), in units."""
    k = len(borders) - 1
    # Few samples stand for a segment where there are many: time and memory stay bounded.
    most = max(LEAST, min(MOST, COMPARED // k))
    groups = [spread_samples(start, stop, most) for start, stop in pairwise(borders.tolist())]
    lengths = np.diff(borders)
    # A mean distance times the number of pairs estimates the sum over all samples.
    sums = compute_mean_distances(features, groups) * np.outer(lengths, lengths)
    return np.asarray(sums / unit, np.float64)


def compute_mean_distances(features: Rows, groups: Sequence[Samples]) -> Floats:
    """Mean distances of the samples of each two groups, (groups, groups)."""
    ends = np.concatenate([[0], np.cumsum([len(group) for group in groups])])
    chosen = np.concatenate(groups)
    means = np.zeros((len(groups), len(groups)))

    def fill(rows: slice) -> None:
        kernels.compute_mean_distances(features, chosen, ends, rows.start, rows.stop, means)

    map_threads(fill, make_even_slices(len(groups)))
    # Kernels fill the upper half only.
    return np.triu(means) + np.triu(means, 1).T


def list_levels(borders: Samples, sums: Floats) -> list[Samples]:
    """Borders of each level, indices of `borders`, from one segment to all.

    Parameters
    ----------
    borders : (segments + 1,) array
    sums : (segments, segments) array
        Of `sum_between_segments`; is used up.
    """
    lengths = np.diff(borders).astype(np.float64)
    alive = list(range(len(lengths)))
    found = [np.append(alive, len(lengths))]

    def loss(g: int, h: int) -> float:
        # What two segments cost as one, less what they cost apart (Ward's criterion for distances).
        union = (sums[g, g] + sums[h, h] + 2 * sums[g, h]) / (lengths[g] + lengths[h])
        return float(union - sums[g, g] / lengths[g] - sums[h, h] / lengths[h])

    losses = [loss(g, h) for g, h in pairwise(alive)]
    while losses:
        at = int(np.argmin(losses))
        g, h = alive[at], alive[at + 1]
        # Row and column g become the union; those of h are not read again.
        sums[g] += sums[h]
        sums[:, g] += sums[:, h]
        lengths[g] += lengths[h]
        del alive[at + 1], losses[at]
        # Only the losses of the union with its two neighbours have changed.
        for left in (at - 1, at):
            if 0 <= left < len(losses):
                losses[left] = loss(alive[left], alive[left + 1])
        found.append(np.append(alive, len(lengths)))
    return found[::-1]


def choose_level(
    borders: Samples, sums: Floats, preset: KinemeConstants, saved: Callable[[int, int], float]
) -> Grouped:
    """Return the level and clusters of the shortest description.

    Parameters
    ----------
    borders : (segments + 1,) array
        Of the finest level.
    sums : (segments, segments) array
        Of `sum_between_segments`.
    preset : KinemeConstants
    saved : callable
        Samples that a segment, from one to another, saves by repeating itself. They are subtracted
        from the cost of a level, and do not change its grouping.
    """
    tree = list_levels(borders, sums.copy())
    # Levels of few segments differ most: each is tried; of many segments, ever sparser ones.
    tried = {*range(min(len(tree), EACH_LEVEL))}
    tried |= {int(at) for at in np.geomspace(1, len(tree), LEVELS).astype(np.int64) - 1}
    chosen = [tree[at] for at in sorted(tried)]
    found = [group_segments(borders[each], sum_runs(sums, each[:-1]), preset) for each in chosen]
    segment_cost = preset.samples(preset.segment_cost)
    savings: dict[tuple[int, int], float] = {}
    best, cheapest = found[0], np.inf
    # Best first: no level can cost less than if each segment saved all that it costs alone.
    for level in sorted(found, key=lambda level: level.cost - level.alone.sum()):
        if level.cost - level.alone.sum() >= cheapest:  # of those that follow none is cheaper
            break
        cost = level.cost
        for span, alone in zip(pairwise(level.borders.tolist()), level.alone, strict=True):
            if alone > segment_cost:  # to save less would not pay for a border
                if span not in savings:
                    savings[span] = saved(*span)
                cost -= min(savings[span], alone)
        if cost < cheapest:
            best, cheapest = level, cost
    return best


def group_segments(borders: Samples, sums: Floats, preset: KinemeConstants) -> Grouped:
    """Segments in clusters, without clusters that are too short, and what that costs.

    Parameters
    ----------
    borders : (segments + 1,) array
    sums : (segments, segments) array
        Summed distances of their samples.
    preset : KinemeConstants
    """
    lengths = np.diff(borders).astype(np.float64)
    labels = np.empty(len(lengths), np.int64)
    segment_cost = preset.samples(preset.segment_cost)
    cluster_cost = preset.cluster_price(int(borders[-1]))
    most, share = preset.max_clusters, preset.spread_share
    kernels.find_cheapest_grouping(
        sums.copy(), lengths.copy(), most, segment_cost, cluster_cost, share, labels
    )
    shortest = round(preset.samples(preset.min_action))
    labels = absorb_short_clusters(labels, lengths, sums, shortest)
    # Neighbours of one cluster are one segment.
    first = np.flatnonzero(np.diff(labels, prepend=-1))
    lengths, sums = np.add.reduceat(lengths, first), sum_runs(sums, first)
    labels = number_by_appearance(labels[first])
    # (segments, clusters): 1 where a segment is in a cluster.
    members = np.eye(int(labels.max()) + 1)[labels]
    within = np.einsum("sc,st,tc->c", members, sums, members) / (2 * lengths @ members)
    cost = within.sum() + segment_cost * len(labels) + cluster_cost * len(within)
    return Grouped(
        np.append(borders[first], borders[-1]), labels, cost, np.diag(sums) / (2 * lengths)
    )


def absorb_short_clusters(
    labels: Samples, lengths: Floats, sums: Floats, shortest: float
) -> Samples:
    """Return the clusters of segments, where segments of short clusters have that of a neighbour.

    A cluster is short if no run of its segments is `shortest` samples long. Of short segments
    between two others, the first get the cluster before and the rest the cluster after, such that
    their summed distance to these is least.

    Examples
    --------
    >>> places = np.array([0.0, 1.0, 4.0, 5.0])
    >>> lengths = np.array([9.0, 2.0, 2.0, 9.0])
    >>> sums = np.abs(places - places[:, None]) * np.outer(lengths, lengths)
    >>> absorb_short_clusters(np.arange(4), lengths, sums, 7).tolist()
    [0, 0, 3, 3]
    """
    first = np.flatnonzero(np.diff(labels, prepend=-1))
    longest = np.zeros(int(labels.max()) + 1)
    np.maximum.at(longest, labels[first], np.add.reduceat(lengths, first))
    long = np.flatnonzero(longest[labels] >= shortest)
    if not len(long):
        return np.zeros_like(labels)
    kept = labels.copy()
    # Before the first long segment and after the last there is one neighbour only.
    kept[: long[0]], kept[long[-1] :] = labels[long[0]], labels[long[-1]]
    members = np.eye(len(longest))[labels]
    apart = (sums @ members) / np.maximum(lengths @ members, 1.0)
    for before, after in pairwise(long.tolist()):
        short = slice(before + 1, after)
        gained = apart[short, labels[after]] - apart[short, labels[before]]
        # The sum is least where the segments so far prefer the cluster before, the rest the other.
        border = before + 1 + int(np.cumsum([0.0, *-gained]).argmin())
        kept[before + 1 : border] = labels[before]
        kept[border:after] = labels[after]
    return kept


def sum_runs(sums: Floats, first: Samples) -> Floats:
    """Sums (segments, segments) added up to those of runs of segments that begin at `first`."""
    return np.asarray(np.add.reduceat(np.add.reduceat(sums, first, 0), first, 1), np.float64)


def measure_preferences(sums: Floats, lengths: Samples, labels: Samples) -> Floats:
    """Return how much nearer each segment is to its own cluster than to the next, 0 to 1.

    Parameters
    ----------
    sums : (segments, segments) array
        Summed distances of their samples.
    lengths, labels : (segments,) array
    """
    members = np.eye(int(labels.max()) + 1)[labels]
    means = (sums @ members) / np.outer(lengths, lengths @ members)
    each = np.arange(len(labels))
    inside = means[each, labels]
    # The nearest other cluster, not the own one.
    means[each, labels] = np.inf
    return np.asarray(np.clip(1 - inside / np.maximum(means.min(axis=1), 1e-12), 0, 1), np.float64)


def spread_samples(start: int, stop: int, most: int) -> Samples:
    """Samples of a segment, evenly spread, so many at most.

    Examples
    --------
    >>> spread_samples(0, 10, 2)
    array([2, 7])
    """
    n = min(stop - start, most)
    return start + (2 * np.arange(n) + 1) * (stop - start) // (2 * n)


def choose_part_ends(rows: Rows | Floats, longest: int, side: int) -> list[int]:
    """Return the ends of about equal parts, each where the rows change most nearby.

    The first is 0 and the last the number of rows. Equal parts are at most `longest`; their ends
    move by up to `MOVED` of that.

    Parameters
    ----------
    rows : (frames, dims) array
    longest : int
        Frames.
    side : int
        Frames before and after an end whose means and mean changes are compared.

    Examples
    --------
    >>> choose_part_ends(np.repeat([0.0, 1.0, 0.0], [85, 40, 75])[:, None], 100, 10)
    [0, 85, 200]
    """
    n = len(rows)
    count = max(1, -(-n // longest))
    ends = [0]
    reach = int(MOVED * n / count)
    for part in range(1, count):
        middle = round(n * part / count)
        near = np.arange(max(middle - reach, ends[-1] + 1), middle + reach + 1)
        near = near[(near >= side) & (near <= n - side)]
        ends.append(int(near[_measure_changes(rows, near, side).argmax()]) if len(near) else middle)
    return [*ends, n]


def _measure_changes(rows: Rows | Floats, at: Samples, side: int) -> Floats:
    """Return how much the mean of rows, and their mean change, differ before and after frames."""
    first, last = int(at[0]) - side, int(at[-1]) + side
    span = np.asarray(rows[first:last], np.float64)
    values = np.hstack([span, np.abs(np.diff(span, axis=0, prepend=span[:1]))])
    values /= np.maximum(values.std(axis=0), TINY)
    sums = np.vstack([np.zeros(values.shape[1]), np.cumsum(values, axis=0)])
    middle = at - first
    return np.asarray(
        np.linalg.norm(sums[middle + side] - 2 * sums[middle] + sums[middle - side], axis=1)
    )


def link_parts(
    features: Rows, at: Samples, parts: Sequence[Level], *, unit: float, price: float
) -> Level:
    """Return the parts one after the other, with clusters that mean the same in all of them.

    Parameters
    ----------
    features : (samples, dims) array
        Of the whole recording.
    at : (samples,) array
        The frame of each.
    parts : sequence of Level
        In frames.
    unit : float
        The distance that counts as 1.
    price : float
        Of a cluster in a part: samples at that distance.
    """
    if len(parts) == 1:
        return parts[0]
    firsts = np.concatenate([[0], np.cumsum([part.labels.max() + 1 for part in parts])])
    numbers = zip(parts, firsts[:-1], strict=True)
    labels = np.concatenate([part.labels + number for part, number in numbers])
    ends = np.concatenate([[0], *(part.borders[1:] for part in parts)])
    fine = np.concatenate([[0], *(part.fine[1:] for part in parts)])
    # A cluster is compared by some of its samples, so each sample needs its cluster.
    per_sample = labels[np.searchsorted(ends, at, side="right") - 1]
    sizes = np.bincount(per_sample, minlength=int(firsts[-1]))
    if sizes.all():  # a part shorter than a sample has nothing to compare: parts stay apart
        groups = [np.flatnonzero(per_sample == cluster) for cluster in range(len(sizes))]
        chosen = [group[spread_samples(0, len(group), OF_CLUSTER)] for group in groups]
        means = compute_mean_distances(features, chosen) / unit
        part_of = np.repeat(np.arange(len(parts)), np.diff(firsts))
        labels = match_clusters_across_parts(means, sizes, part_of, price)[labels]
    labels = number_by_appearance(labels)
    first = np.flatnonzero(np.diff(labels, prepend=-1))
    preference = np.concatenate([part.preference for part in parts])
    return Level(fine, np.append(ends[first], ends[-1]), labels[first], preference[first])


def match_clusters_across_parts(
    means: Floats, sizes: Samples, part_of: Samples, price: float
) -> Samples:
    """Return clusters of all parts, where those of different parts may be one: a number for each.

    Two are one if they are nearer to each other than either is to any other cluster of its own
    part: there, what is so far apart was told apart. Of parts with one cluster only, two are one
    if that costs less than a cluster.

    Parameters
    ----------
    means : (clusters, clusters) array
        Mean distances of their samples, in units.
    sizes : (clusters,) array
        Samples of each.
    part_of : (clusters,) array
        The part that each is of.
    price : float
        Of a cluster in a part: samples at the distance of one unit.

    Examples
    --------
    >>> places = np.array([0.0, 1.0, 0.1, 3.0])
    >>> apart = np.abs(places - places[:, None])
    >>> part_of = np.array([0, 0, 1, 1])
    >>> match_clusters_across_parts(apart, np.full(4, 10), part_of, price=2.0).tolist()
    [0, 1, 0, 3]
    """
    means, lengths = means.copy(), sizes.astype(np.float64)
    numbers, owner = np.arange(len(means)), np.arange(len(means))
    together = part_of[:, None] == part_of  # clusters that share a part, and each with itself
    while True:
        within = np.diag(means)
        # The energy distance: between two clusters, less the mean of what is within them.
        gaps = means - np.add.outer(within, within) / 2
        told_apart = np.where(together, gaps, np.inf)
        np.fill_diagonal(told_apart, np.inf)
        nearest = told_apart.min(axis=1)
        limits = np.minimum.outer(nearest, nearest)
        # A union costs gap / (1 / one length + 1 / other length).
        alone = price * np.add.outer(1 / lengths, 1 / lengths)
        ratios = gaps / np.maximum(np.where(np.isfinite(limits), limits, alone), TINY)
        ratios[together] = np.inf
        a, b = sorted(divmod(int(np.argmin(ratios)), len(ratios)))
        if not ratios[a, b] < 1:
            return owner
        # Mean distances of the union are means weighted by the lengths.
        share = lengths[b] / (lengths[a] + lengths[b])
        means[a] += share * (means[b] - means[a])
        means[:, a] += share * (means[:, b] - means[:, a])
        lengths[a] += lengths[b]
        together[a] |= together[b]
        together[:, a] = together[a]
        owner[owner == numbers[b]] = numbers[a]
        # What is left shrinks with each union, and so does the work.
        numbers, lengths = np.delete(numbers, b), np.delete(lengths, b)
        means, together = (np.delete(np.delete(m, b, 0), b, 1) for m in (means, together))
