"""A tree of segments: fine ones joined with their neighbours, the most similar first.

1. Fine borders are change points of the distances: the cheapest division into
   segments whose samples are near each other.
2. The two neighbours whose union costs least are joined, again and again, until
   one segment is left: each number of segments is a level of the tree.
3. At each level segments are grouped, the nearest clusters first. Their distance is the
   mean one of their samples, less a share of those within each: where much is going on,
   no two samples are near each other, whatever they are of.
4. Means over a second change slowly, so what lies between two activities looks like one of its
   own: segments of clusters that are too short to be an action are given to their neighbours.
5. The level and the number of clusters are those of the shortest description of what is
   left: what samples differ within clusters, and a price for each segment and cluster.

Sources: change points after Arlot, Celisse and Harchaoui 2019; bottom-up
segmentation after Keogh, Chu, Hart and Pazzani 2001; distances of clusters less those
within are Székely and Rizzo's energy distance (2005) where the share is 1; the rest is ours.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme._threads import even_slices, map_threads
from kineme.methods.kineme import _tree_kernels as kernels
from kineme.methods.samples import spread
from kineme.methods.segments import by_first_appearance

Floats = NDArray[np.float64]
Samples = NDArray[np.int64]

PAIRED = 1000
"""Samples whose distances tell the median one."""
COMPARED = 12_000
"""Samples that stand for all segments of a long recording."""
LEAST, MOST = 4, 24
"""Samples that stand for one segment."""
EACH_LEVEL, LEVELS = 150, 60
"""Levels up to so many segments are tried one by one; of the others so many."""


class Prices(NamedTuple):
    """What a description costs, in samples at the median distance, and what is told as one.

    Attributes
    ----------
    segment, cluster : float
        Of each.
    spread_share : float
        Of the distances within two clusters, by which these are nearer than their samples.
    most_clusters : int
    shortest : int
        Samples of the longest segment of a cluster, at least.
    """

    segment: float
    cluster: float
    spread_share: float
    most_clusters: int
    shortest: int


class Grouped(NamedTuple):
    """A level of the tree, grouped.

    Attributes
    ----------
    borders : (segments + 1,) array
        Samples, from 0 to the end.
    labels : (segments,) array
        Cluster of each, numbered as they appear.
    cost : float
        Of its description, by samples that stay alike.
    alone : (segments,) array
        What the samples of a segment cost, told by themselves: it can save no more by repeating.
    """

    borders: Samples
    labels: Samples
    cost: float
    alone: Floats


def median_distance(features: NDArray[np.float32], width: int) -> float:
    """The median distance of two samples that are so near in time; 1 where all are equal.

    What is done in an hour differs more than what is done in each of its minutes: of all samples,
    the distance would tell how long a recording is.

    Parameters
    ----------
    features : (samples, dims) array
    width : int
        Samples.
    """
    from scipy.spatial.distance import pdist

    at = spread(0, len(features), PAIRED)
    near = pdist(at[:, None]) < max(width, 2 * len(features) // PAIRED)
    apart = pdist(features[at])[near]
    middle = float(np.median(apart)) if len(apart) else 0.0
    return middle if middle > 1e-9 else 1.0


def fine_borders(features: NDArray[np.float32], unit: float, *, width: int, cost: float) -> Samples:
    """Borders of the segments whose samples are near each other, ends included.

    Parameters
    ----------
    features : (samples, dims) array
    unit : float
        The distance that counts as 1.
    width : int
        Samples of the longest segment.
    cost : float
        What a border must gain: samples at that distance.
    """
    similarity = np.empty((len(features), min(width, len(features))), np.float32)

    def fill(rows: slice) -> None:
        kernels.similarity_band(features, unit, rows.start, rows.stop, similarity)

    map_threads(fill, even_slices(len(features)))
    borders: Samples = kernels.change_points(similarity, 2 * cost, 1)
    return borders


def between_segments(features: NDArray[np.float32], borders: Samples, unit: float) -> Floats:
    """Summed distances of the samples of each two segments, (segments, segments), in units."""
    k = len(borders) - 1
    most = max(LEAST, min(MOST, COMPARED // k))
    groups = [spread(start, stop, most) for start, stop in pairwise(borders.tolist())]
    lengths = np.diff(borders)
    sums = mean_distances(features, groups) * np.outer(lengths, lengths)
    return np.asarray(sums / unit, np.float64)


def mean_distances(features: NDArray[np.float32], groups: Sequence[Samples]) -> Floats:
    """Mean distances of the samples of each two groups, (groups, groups)."""
    ends = np.concatenate([[0], np.cumsum([len(group) for group in groups])])
    chosen = np.concatenate(groups)
    means = np.zeros((len(groups), len(groups)))

    def fill(rows: slice) -> None:
        kernels.mean_distances(features, chosen, ends, rows.start, rows.stop, means)

    map_threads(fill, even_slices(len(groups)))
    return np.triu(means) + np.triu(means, 1).T


def levels(borders: Samples, sums: Floats) -> list[Samples]:
    """Borders of each level, indices of `borders`, from one segment to all.

    Parameters
    ----------
    borders : (segments + 1,) array
    sums : (segments, segments) array
        Of `between_segments`; is used up.
    """
    lengths = np.diff(borders).astype(np.float64)
    alive = list(range(len(lengths)))
    found = [np.append(alive, len(lengths))]

    def loss(g: int, h: int) -> float:
        union = (sums[g, g] + sums[h, h] + 2 * sums[g, h]) / (lengths[g] + lengths[h])
        return float(union - sums[g, g] / lengths[g] - sums[h, h] / lengths[h])

    losses = [loss(g, h) for g, h in pairwise(alive)]
    while losses:
        at = int(np.argmin(losses))
        g, h = alive[at], alive[at + 1]
        sums[g] += sums[h]
        sums[:, g] += sums[:, h]
        lengths[g] += lengths[h]
        del alive[at + 1], losses[at]
        for left in (at - 1, at):
            if 0 <= left < len(losses):
                losses[left] = loss(alive[left], alive[left + 1])
        found.append(np.append(alive, len(lengths)))
    return found[::-1]


def best_level(
    borders: Samples, sums: Floats, prices: Prices, saved: Callable[[int, int], float]
) -> Grouped:
    """The level and clusters of the shortest description.

    Parameters
    ----------
    borders : (segments + 1,) array
        Of the finest level.
    sums : (segments, segments) array
        Of `between_segments`.
    prices : Prices
    saved : callable
        What a segment, from one sample to another, saves by repeating itself. Grouping does not
        see it: it is taken off the cost of a level, so it decides where segments end.

    Returns
    -------
    Grouped
    """
    tree = levels(borders, sums.copy())
    tried = {*range(min(len(tree), EACH_LEVEL))}
    tried |= {int(at) for at in np.geomspace(1, len(tree), LEVELS).astype(np.int64) - 1}
    found = [grouped(borders[tree[at]], added(sums, tree[at][:-1]), prices) for at in sorted(tried)]
    known: dict[tuple[int, int], float] = {}
    best, cheapest = found[0], np.inf
    for level in sorted(found, key=lambda level: level.cost - level.alone.sum()):
        if level.cost - level.alone.sum() >= cheapest:  # nor are those that follow cheaper
            break
        cost = level.cost
        for span, alone in zip(pairwise(level.borders.tolist()), level.alone, strict=True):
            if alone > prices.segment:  # what costs less than a segment saves none
                if span not in known:
                    known[span] = saved(*span)
                cost -= min(known[span], alone)
        if cost < cheapest:
            best, cheapest = level, cost
    return best


def grouped(borders: Samples, sums: Floats, prices: Prices) -> Grouped:
    """Segments in clusters, without clusters that are too short, and what that costs.

    Parameters
    ----------
    borders : (segments + 1,) array
    sums : (segments, segments) array
        Summed distances of their samples.
    prices : Prices
    """
    lengths = np.diff(borders).astype(np.float64)
    labels = np.empty(len(lengths), np.int64)
    kernels.cheapest_grouping(
        sums.copy(),
        lengths.copy(),
        prices.most_clusters,
        prices.segment,
        prices.cluster,
        prices.spread_share,
        labels,
    )
    labels = without_short(labels, lengths, sums, prices.shortest)
    first = np.flatnonzero(np.diff(labels, prepend=-1))
    lengths, sums = np.add.reduceat(lengths, first), added(sums, first)
    labels = by_first_appearance(labels[first])
    members = np.eye(int(labels.max()) + 1)[labels]
    within = np.einsum("sc,st,tc->c", members, sums, members) / (2 * lengths @ members)
    cost = within.sum() + prices.segment * len(labels) + prices.cluster * len(within)
    return Grouped(
        np.append(borders[first], borders[-1]), labels, cost, np.diag(sums) / (2 * lengths)
    )


def without_short(labels: Samples, lengths: Floats, sums: Floats, shortest: float) -> Samples:
    """Clusters of segments, those of clusters of which no run is that long given to neighbours.

    Of those between two that are long enough the first go to the one before and the others to the
    one after, such that they are nearest to its cluster.

    Examples
    --------
    >>> places = np.array([0.0, 1.0, 4.0, 5.0])
    >>> lengths = np.array([9.0, 2.0, 2.0, 9.0])
    >>> sums = np.abs(places - places[:, None]) * np.outer(lengths, lengths)
    >>> without_short(np.arange(4), lengths, sums, 7).tolist()
    [0, 0, 3, 3]
    """
    first = np.flatnonzero(np.diff(labels, prepend=-1))
    longest = np.zeros(int(labels.max()) + 1)
    np.maximum.at(longest, labels[first], np.add.reduceat(lengths, first))
    known = np.flatnonzero(longest[labels] >= shortest)
    if not len(known):
        return np.zeros_like(labels)
    kept = labels.copy()
    kept[: known[0]], kept[known[-1] :] = labels[known[0]], labels[known[-1]]
    members = np.eye(len(longest))[labels]
    apart = (sums @ members) / np.maximum(lengths @ members, 1.0)
    for before, after in pairwise(known.tolist()):
        short = slice(before + 1, after)
        gained = apart[short, labels[after]] - apart[short, labels[before]]
        given = int(np.cumsum([0.0, *-gained]).argmin())
        kept[before + 1 : before + 1 + given] = labels[before]
        kept[before + 1 + given : after] = labels[after]
    return kept


def added(sums: Floats, first: Samples) -> Floats:
    """Sums of segments as those of runs of them that begin at `first`."""
    return np.asarray(np.add.reduceat(np.add.reduceat(sums, first, 0), first, 1), np.float64)
