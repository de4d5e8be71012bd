"""A tree of segments: fine ones joined with their neighbours, the most similar first.

1. Fine borders are change points of the distances: the cheapest division into
   segments whose samples are near each other.
2. The two neighbours whose union costs least are joined, again and again, until
   one segment is left: each number of segments is a level of the tree.
3. At each level segments are grouped, the nearest clusters first. Their distance is the
   mean one of their samples, less a share of those within each: where much is going on,
   no two samples are near each other, whatever they are of.
4. The level and the number of clusters are those of the shortest description:
   what samples differ within clusters, and a price for each segment and cluster.

Sources: change points after Arlot, Celisse and Harchaoui 2019; bottom-up
segmentation after Keogh, Chu, Hart and Pazzani 2001; distances of clusters less those
within are Székely and Rizzo's energy distance (2005) where the share is 1; the rest is ours.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from kineme._threads import even_slices, map_threads
from kineme.methods.kineme import _tree_kernels as kernels
from kineme.methods.samples import spread
from kineme.methods.segments import by_first_appearance

Floats = NDArray[np.float64]
Samples = NDArray[np.int64]

PAIRS = 1000
"""Samples whose distances tell the median one."""
COMPARED = 12_000
"""Samples that stand for all segments of a long recording."""
LEAST, MOST = 4, 24
"""Samples that stand for one segment."""
EACH_LEVEL, LEVELS = 150, 60
"""Levels up to so many segments are tried one by one; of the others so many."""


@dataclass(frozen=True, eq=False)
class Grouped:
    """A level of the tree, grouped.

    Attributes
    ----------
    borders : (segments + 1,) array
        Samples, from 0 to the end.
    labels : (segments,) array
        Cluster of each.
    """

    borders: Samples
    labels: Samples


def median_distance(features: NDArray[np.float32]) -> float:
    """The median distance of two samples; 1 where all are equal."""
    from scipy.spatial.distance import pdist

    n = min(len(features), PAIRS)
    at = (np.arange(n) * len(features)) // n
    middle = float(np.median(pdist(features[at]))) if n > 1 else 0.0
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
    borders: Samples,
    sums: Floats,
    *,
    segment_cost: float,
    cluster_cost: float,
    spread_share: float,
    most_clusters: int,
    saved: Callable[[int, int], float],
) -> Grouped:
    """The level and clusters of the shortest description.

    Parameters
    ----------
    borders : (segments + 1,) array
        Of the finest level.
    sums : (segments, segments) array
        Of `between_segments`.
    segment_cost, cluster_cost : float
        What a segment and a cluster cost: samples at the median distance.
    spread_share : float
        Of the distances within two clusters, by which these are nearer than their samples.
    most_clusters : int
    saved : callable
        What a segment, from one sample to another, saves by repeating itself. Grouping does not
        see it: it is taken off the cost of a level, so it decides where segments end.

    Returns
    -------
    Grouped
    """
    best, cheapest = Grouped(borders[[0, -1]], np.zeros(1, np.int64)), np.inf
    tree = levels(borders, sums.copy())
    tried = {*range(min(len(tree), EACH_LEVEL))}
    tried |= {int(at) for at in np.geomspace(1, len(tree), LEVELS).astype(np.int64) - 1}
    known: dict[tuple[int, int], float] = {}
    for at in sorted(tried):
        level = tree[at]
        lengths = np.diff(borders[level]).astype(np.float64)
        inner = np.add.reduceat(np.add.reduceat(sums, level[:-1], 0), level[:-1], 1)
        cost = 0.0
        for span, alone in zip(
            pairwise(borders[level].tolist()), np.diag(inner) / (2 * lengths), strict=True
        ):
            if span not in known:  # what costs less than a segment saves no segment
                known[span] = min(saved(*span), alone) if alone > segment_cost else 0.0
            cost -= known[span]
        labels = np.empty(len(lengths), np.int64)
        cost += kernels.cheapest_grouping(
            inner, lengths, most_clusters, segment_cost, cluster_cost, spread_share, labels
        )
        if cost < cheapest:
            cheapest, best = cost, Grouped(borders[level], by_first_appearance(labels))
    return best
