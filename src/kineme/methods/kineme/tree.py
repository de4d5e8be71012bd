"""Build a tree of segments and choose its level with the shortest description.

1. Find fine borders: change points of the distances, by the cheapest division into segments of
   similar samples.
2. Merge the two neighbours whose union costs least, repeatedly, until one segment is left. Each
   number of segments is a level of the tree.
3. At each level, group the segments by agglomerative clustering. The distance of two clusters is
   the mean distance of their samples, less half of the mean distance within them. This corrects
   for varied activities, whose samples are far from each other and from all others.
4. Views are averaged over a second, so a change of activity looks like a short activity. Assign
   clusters that are shorter than an action to their neighbours.
5. Choose the level and the number of clusters with the shortest description: the distances of
   samples within clusters, plus a price for each segment and cluster.

A long recording is cut into parts of similar length, where it changes most, and each part is
segmented on its own. The shortest description of the whole recording would be coarser, and its run
time quadratic. Then clusters of different parts are merged, the nearest first, if they are nearer
to each other than to the other clusters of their own parts. Clusters of one part stay apart.

Sources: change points after Arlot, Celisse and Harchaoui 2019; bottom-up segmentation after Keogh,
Chu, Hart and Pazzani 2001; with all of the distance within them, the distance of clusters would be
Székely and Rizzo's energy distance (2005); the rest is ours.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.parallel import make_even_slices, map_threads
from kineme.methods.kineme import _tree_kernels as kernels
from kineme.methods.kineme.repetitions import measure_saving
from kineme.methods.segments import find_segments, number_by_appearance

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Rows = NDArray[np.float32]
Samples = NDArray[np.int64]

MEDIAN_SAMPLES = 1000
"""Number of samples whose distances give the median distance."""
MAX_SAMPLES = 12_000
"""Largest number of samples that represent all segments of a recording."""
MIN_PER_SEGMENT, MAX_PER_SEGMENT = 4, 24
"""Smallest and largest number of samples that represent one segment."""
MAX_PER_CLUSTER = 64
"""Largest number of samples that represent one cluster of a part."""
MAX_SHIFT = 1 / 6
"""Largest shift of the end of a part, as a share of the part."""
TINY = 1e-12
"""Smallest divisor."""
EXHAUSTIVE_UP_TO, SPARSE_LEVELS = 150, 60
"""Number of segments up to which every level is tried, and number of sparser levels above it."""


@dataclass(frozen=True, eq=False)
class Level:
    """Segments in samples or frames, from the start of a recording or part to its end."""

    fine: Samples
    """Borders of the finest segments."""
    borders: Samples
    labels: Samples
    """Cluster of each segment, numbered by appearance."""

    def to_frames(self, span: slice, preset: KinemeConstants) -> Level:
        """Convert borders from samples to frames, for the part of a recording in this span."""
        per_sample = preset.working_fps / preset.rate
        inner = (
            span.start + np.rint(samples[:-1] * per_sample).astype(np.int64)
            for samples in (self.fine, self.borders)
        )
        fine, borders = (np.append(frames, span.stop) for frames in inner)
        return replace(self, fine=fine, borders=borders)


class FineLevel(NamedTuple):
    """Finest segments of a view (samples, dims), and their distances."""

    features: Rows
    unit: float
    """Unit of distances."""
    borders: Samples
    sums: Floats
    """As returned by `sum_between_segments`."""


def find_fine_level(features: Rows, preset: KinemeConstants) -> FineLevel:
    """Return the finest segments of a view, (samples, dims)."""
    width = preset.comparison_width
    unit = compute_median_distance(features, width)
    similarity = np.empty((len(features), min(width, len(features))), np.float32)
    map_threads(
        lambda part: kernels.compute_similarity_band(
            features, unit, part.start, part.stop, similarity
        ),
        make_even_slices(len(features)),
    )
    # Cheapest division into segments of similar samples, at most `width` long. The kernel counts
    # each pair twice, so a border must cost twice as much there.
    borders = kernels.find_change_points(similarity, 2 * preset.samples(preset.fine_cost))
    return FineLevel(features, unit, borders, sum_between_segments(features, borders, unit))


def find_level(fine: FineLevel, preset: KinemeConstants, rows: Rows | None = None) -> Level:
    """Return the segments of a view at the level of the shortest description.

    With ``rows``, the poses or channels (frames, dims) at the working rate, segments that repeat
    save a part of their cost. Savings reduce the cost of a level, but do not change its grouping.
    """
    borders, sums = fine.borders, fine.sums
    tree = list_levels(borders, sums.copy())
    # Levels with few segments differ most, so all of them are tried, and fewer of the others.
    tried = {*range(min(len(tree), EXHAUSTIVE_UP_TO))}
    tried |= {
        int(index) for index in np.geomspace(1, len(tree), SPARSE_LEVELS).astype(np.int64) - 1
    }
    chosen = [tree[index] for index in sorted(tried)]
    levels = [group_segments(borders[each], sum_runs(sums, each[:-1]), preset) for each in chosen]

    segment_cost = preset.samples(preset.segment_cost)
    savings: dict[tuple[int, int], float] = {}
    best, cheapest = levels[0], np.inf
    # Best first by a lower bound of the cost, in which each segment saves its whole cost.
    for level in sorted(levels, key=lambda level: level.cost - level.alone.sum()):
        if level.cost - level.alone.sum() >= cheapest:  # no later level can be cheaper
            break
        cost = level.cost
        for span, alone in zip(pairwise(level.borders.tolist()), level.alone, strict=True):
            if alone > segment_cost:  # smaller savings are not worth a border
                if rows is not None and span not in savings:
                    savings[span] = measure_saving(rows, fine.features, fine.unit, span, preset)
                cost -= min(savings.get(span, 0.0), alone)
        if cost < cheapest:
            best, cheapest = level, cost
    return Level(borders, best.borders, best.labels)


class Grouped(NamedTuple):
    """A level of the tree, with its segments grouped into clusters."""

    borders: Samples
    """From 0 to the end."""
    labels: Samples
    """Cluster of each segment, numbered by appearance."""
    cost: float
    """Cost of the description, without the savings of segments that repeat."""
    alone: Floats
    """Cost of each segment as a cluster of its own: the largest possible saving."""


def compute_median_distance(features: Rows, width: int) -> float:
    """Return the median distance of samples at most ``width`` samples apart; 1 if all are equal.

    The median of all distances would grow with the length of a recording, as an hour varies more
    than each of its minutes.
    """
    chosen = spread_samples(0, len(features), MEDIAN_SAMPLES)
    # In a very long recording, neighbours among the chosen samples must still be a pair.
    width = max(width, 2 * len(features) // MEDIAN_SAMPLES)
    distances = kernels.measure_near_distances(features, chosen, width)
    median = float(np.median(distances)) if len(distances) else 0.0
    return median if median > 1e-9 else 1.0


def sum_between_segments(features: Rows, borders: Samples, unit: float) -> Floats:
    """Return summed distances between samples of two segments, (segments, segments), in units."""
    k = len(borders) - 1
    # Fewer samples per segment if there are many segments, to bound the run time.
    most = max(MIN_PER_SEGMENT, min(MAX_PER_SEGMENT, MAX_SAMPLES // k))
    groups = [spread_samples(start, stop, most) for start, stop in pairwise(borders.tolist())]
    lengths = np.diff(borders)
    # A mean distance times the number of pairs estimates the sum over all samples.
    sums = compute_mean_distances(features, groups) * np.outer(lengths, lengths)
    return np.asarray(sums / unit, np.float64)


def compute_mean_distances(features: Rows, groups: Sequence[Samples]) -> Floats:
    """Return the mean distances between samples of two groups, (groups, groups)."""
    ends = np.concatenate([[0], np.cumsum([len(group) for group in groups])])
    chosen = np.concatenate(groups)
    means = np.zeros((len(groups), len(groups)))
    map_threads(
        lambda part: kernels.compute_mean_distances(
            features, chosen, ends, part.start, part.stop, means
        ),
        make_even_slices(len(groups)),
    )
    # The kernel fills the upper triangle only.
    return np.triu(means) + np.triu(means, 1).T


def compute_energy_distances(means: Floats) -> Floats:
    """Return the mean distances of groups (groups, groups), less the means within both groups.

    Examples
    --------
    >>> compute_energy_distances(np.array([[1.0, 4.0], [4.0, 3.0]])).tolist()
    [[0.0, 2.0], [2.0, 0.0]]
    """
    within = np.diag(means)
    return np.asarray(means - np.add.outer(within, within) / 2)


def list_levels(borders: Samples, sums: Floats) -> list[Samples]:
    """Return the borders of each level, as indices of `borders`, from one segment to all.

    ``sums`` are those of `sum_between_segments`; they are overwritten.
    """
    lengths = np.diff(borders).astype(np.float64)
    alive = list(range(len(lengths)))
    levels = [np.append(alive, len(lengths))]

    def compute_loss(g: int, h: int) -> float:
        # Cost of the union less the costs of both segments (Ward's criterion for distances).
        union = (sums[g, g] + sums[h, h] + 2 * sums[g, h]) / (lengths[g] + lengths[h])
        return float(union - sums[g, g] / lengths[g] - sums[h, h] / lengths[h])

    losses = [compute_loss(g, h) for g, h in pairwise(alive)]
    while losses:
        index = int(np.argmin(losses))
        g, h = alive[index], alive[index + 1]
        # Row and column g become those of the union; those of h are not read again.
        sums[g] += sums[h]
        sums[:, g] += sums[:, h]
        lengths[g] += lengths[h]
        del alive[index + 1], losses[index]
        # Only the losses of the union with its two neighbours have changed.
        for left in (index - 1, index):
            if 0 <= left < len(losses):
                losses[left] = compute_loss(alive[left], alive[left + 1])
        levels.append(np.append(alive, len(lengths)))
    return levels[::-1]


def group_segments(borders: Samples, sums: Floats, preset: KinemeConstants) -> Grouped:
    """Group segments into clusters that are long enough, at the least cost.

    ``sums`` (segments, segments) are summed distances of their samples.
    """
    lengths = np.diff(borders).astype(np.float64)
    labels = np.empty(len(lengths), np.int64)
    segment_cost = preset.samples(preset.segment_cost)
    cluster_cost = preset.cluster_price(int(borders[-1]))
    most = preset.max_clusters
    kernels.find_cheapest_grouping(
        sums.copy(), lengths.copy(), most, segment_cost, cluster_cost, labels
    )
    shortest = round(preset.samples(preset.min_action))
    labels = absorb_short_clusters(labels, lengths, sums, shortest)
    # Merge neighbours of one cluster.
    run_starts = np.flatnonzero(np.diff(labels, prepend=-1))
    lengths, sums = np.add.reduceat(lengths, run_starts), sum_runs(sums, run_starts)
    labels = number_by_appearance(labels[run_starts])
    # One-hot rows (segments, clusters): products with them sum over clusters.
    members = np.eye(int(labels.max()) + 1)[labels]
    within = np.einsum("sc,st,tc->c", members, sums, members) / (2 * lengths @ members)
    cost = within.sum() + segment_cost * len(labels) + cluster_cost * len(within)
    return Grouped(
        np.append(borders[run_starts], borders[-1]), labels, cost, np.diag(sums) / (2 * lengths)
    )


def absorb_short_clusters(
    labels: Samples, lengths: Floats, sums: Floats, shortest: float
) -> Samples:
    """Assign the segments of short clusters to neighbouring clusters.

    A cluster is short if no run of its segments is `shortest` samples long. A run of short
    segments is split in two: its first part gets the cluster before it, the rest the cluster after
    it. The split minimises the summed distances to these clusters. If all clusters are short, all
    segments get cluster 0.

    Examples
    --------
    >>> places = np.array([0.0, 1.0, 4.0, 5.0])
    >>> lengths = np.array([9.0, 2.0, 2.0, 9.0])
    >>> sums = np.abs(places - places[:, None]) * np.outer(lengths, lengths)
    >>> absorb_short_clusters(np.arange(4), lengths, sums, 7).tolist()
    [0, 0, 3, 3]
    """
    run_starts = np.flatnonzero(np.diff(labels, prepend=-1))
    longest = np.zeros(int(labels.max()) + 1)
    np.maximum.at(longest, labels[run_starts], np.add.reduceat(lengths, run_starts))
    long = np.flatnonzero(longest[labels] >= shortest)
    if not len(long):
        return np.zeros_like(labels)
    absorbed = labels.copy()
    # Segments before the first long one and after the last have only one neighbour.
    absorbed[: long[0]], absorbed[long[-1] :] = labels[long[0]], labels[long[-1]]
    members = np.eye(len(longest))[labels]
    distances = (sums @ members) / np.maximum(lengths @ members, 1.0)
    for before, after in pairwise(long.tolist()):
        short = slice(before + 1, after)
        gained = distances[short, labels[after]] - distances[short, labels[before]]
        # The cumulative sum of the gains of the cluster before is largest at the best split.
        border = before + 1 + int(np.cumsum([0.0, *-gained]).argmin())
        absorbed[before + 1 : border] = labels[before]
        absorbed[border:after] = labels[after]
    return absorbed


def sum_runs(sums: Floats, starts: Samples) -> Floats:
    """Sum a matrix (segments, segments) over runs of segments that begin at `starts`."""
    return np.asarray(np.add.reduceat(np.add.reduceat(sums, starts, 0), starts, 1), np.float64)


def spread_samples(start: int, stop: int, most: int) -> Samples:
    """Choose at most `most` evenly spaced samples of a segment.

    Examples
    --------
    >>> spread_samples(0, 10, 2)
    array([2, 7])
    """
    n = min(stop - start, most)
    return start + (2 * np.arange(n) + 1) * (stop - start) // (2 * n)


def choose_part_ends(rows: Rows | Floats, longest: int, side: int) -> list[int]:
    """Divide rows (frames, dims) into parts of similar length, where they change most.

    The result starts with 0 and ends with the number of rows. Ends of equal parts of at most
    `longest` frames are shifted by up to `MAX_SHIFT` of a part, to where means and mean changes of
    `side` frames before and after them differ most.

    Examples
    --------
    >>> choose_part_ends(np.repeat([0.0, 1.0, 0.0], [85, 40, 75])[:, None], 100, 10)
    [0, 85, 200]
    """
    n = len(rows)
    count = max(1, -(-n // longest))
    ends = [0]
    reach = int(MAX_SHIFT * n / count)
    for part in range(1, count):
        middle = round(n * part / count)
        candidates = np.arange(max(middle - reach, ends[-1] + 1), middle + reach + 1)
        candidates = candidates[(candidates >= side) & (candidates <= n - side)]
        ends.append(
            int(candidates[_measure_changes(rows, candidates, side).argmax()])
            if len(candidates)
            else middle
        )
    return [*ends, n]


def _measure_changes(rows: Rows | Floats, frames: Samples, side: int) -> Floats:
    """Measure how much the mean of rows, and their mean change, differ before and after frames."""
    first, last = int(frames[0]) - side, int(frames[-1]) + side
    span = np.asarray(rows[first:last], np.float64)
    values = np.hstack([span, np.abs(np.diff(span, axis=0, prepend=span[:1]))])
    values /= np.maximum(values.std(axis=0), TINY)
    sums = np.vstack([np.zeros(values.shape[1]), np.cumsum(values, axis=0)])
    middle = frames - first
    # Second differences of cumulative sums: sum after minus sum before.
    return np.asarray(
        np.linalg.norm(sums[middle + side] - 2 * sums[middle] + sums[middle - side], axis=1)
    )


def link_parts(
    features: Rows, at: Samples, parts: Sequence[Level], *, unit: float, price: float
) -> Level:
    """Concatenate the parts of a recording, and merge clusters of different parts.

    ``features`` (samples, dims) are a view of the whole recording in which distances have the unit
    ``unit``, and ``at`` the frame of each sample. Parts are in frames. ``price`` is the cost of a
    cluster in a part, in samples at a distance of one unit.
    """
    if len(parts) == 1:
        return parts[0]
    # First cluster number of each part, so that numbers are unique.
    firsts = np.concatenate([[0], np.cumsum([part.labels.max() + 1 for part in parts])])
    numbers = zip(parts, firsts[:-1], strict=True)
    labels = np.concatenate([part.labels + number for part, number in numbers])
    ends = np.concatenate([[0], *(part.borders[1:] for part in parts)])
    fine = np.concatenate([[0], *(part.fine[1:] for part in parts)])
    # Cluster of each sample; some samples of each cluster are compared.
    per_sample = labels[find_segments(ends, at)]
    sizes = np.bincount(per_sample, minlength=int(firsts[-1]))
    if sizes.all():  # clusters without a sample cannot be compared
        groups = [np.flatnonzero(per_sample == cluster) for cluster in range(len(sizes))]
        chosen = [group[spread_samples(0, len(group), MAX_PER_CLUSTER)] for group in groups]
        means = compute_mean_distances(features, chosen) / unit
        part_of = np.repeat(np.arange(len(parts)), np.diff(firsts))
        labels = match_clusters_across_parts(means, sizes, part_of, price)[labels]
    labels = number_by_appearance(labels)
    run_starts = np.flatnonzero(np.diff(labels, prepend=-1))
    return Level(fine, np.append(ends[run_starts], ends[-1]), labels[run_starts])


def match_clusters_across_parts(
    means: Floats, sizes: Samples, part_of: Samples, price: float
) -> Samples:
    """Merge clusters of different parts that are similar; return a number for each cluster.

    Two clusters are merged if they are nearer to each other than either is to any other cluster of
    its own part. If both parts have one cluster only, they are merged if this costs less than
    ``price``. ``means`` (clusters, clusters) are mean distances of samples in units, ``sizes`` the
    numbers of samples, ``part_of`` the part of each cluster.

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
    same_part = part_of[:, None] == part_of  # includes each cluster with itself
    while True:
        distances = compute_energy_distances(means)
        gaps_in_part = np.where(same_part, distances, np.inf)
        np.fill_diagonal(gaps_in_part, np.inf)
        nearest = gaps_in_part.min(axis=1)
        limits = np.minimum.outer(nearest, nearest)
        # A union costs distance / (1 / length + 1 / other length).
        alone = price * np.add.outer(1 / lengths, 1 / lengths)
        ratios = distances / np.maximum(np.where(np.isfinite(limits), limits, alone), TINY)
        ratios[same_part] = np.inf
        a, b = sorted(divmod(int(np.argmin(ratios)), len(ratios)))
        if not ratios[a, b] < 1:
            return owner
        # Distances of the union are means weighted by the lengths.
        share = lengths[b] / (lengths[a] + lengths[b])
        means[a] += share * (means[b] - means[a])
        means[:, a] += share * (means[:, b] - means[:, a])
        lengths[a] += lengths[b]
        same_part[a] |= same_part[b]
        same_part[:, a] = same_part[a]
        owner[owner == numbers[b]] = numbers[a]
        # Remove the merged cluster from all arrays.
        numbers, lengths = np.delete(numbers, b), np.delete(lengths, b)
        means, same_part = (np.delete(np.delete(m, b, 0), b, 1) for m in (means, same_part))
