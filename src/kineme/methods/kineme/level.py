"""The segments of a stretch of samples: its tree, and the level of it that fits.

A long recording is cut into equal parts, for the shortest description of hours is coarser than
that of their minutes, and takes the square of the time. Each part has the level that it would have
alone. Then clusters of different parts are one, the cheapest first, as long as telling them as one
costs less than a cluster does in a part. What a part tells apart stays apart.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme.methods.kineme import tree
from kineme.methods.kineme.repeating import Repeating
from kineme.methods.samples import spread
from kineme.methods.segments import by_first_appearance

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Floats = NDArray[np.float64]
Samples = NDArray[np.int64]

COMPARED = 64
"""Samples at most that stand for one cluster."""


@dataclass(frozen=True, eq=False)
class Level:
    """Segments of samples or frames, from the first to the end.

    Attributes
    ----------
    fine : (pieces + 1,) array
        Borders of the finest segments.
    borders : (segments + 1,) array
    labels : (segments,) array
        Cluster of each.
    preference : (segments,) array
        How much nearer each is to its own cluster than to the next, 0 to 1.
    """

    fine: Samples
    borders: Samples
    labels: Samples
    preference: NDArray[np.float64]

    def per_sample(self) -> Samples:
        """The cluster of each sample."""
        return np.repeat(self.labels, np.diff(self.borders))

    def in_frames(self, span: slice, preset: KinemeConstants) -> Level:
        """The level of samples as one of the frames of this part of a recording."""

        def frames(samples: Samples) -> Samples:
            found = span.start + np.rint(samples * (preset.working_fps / preset.rate))
            return np.append(found[:-1].astype(np.int64), span.stop)

        return replace(self, fine=frames(self.fine), borders=frames(self.borders))


def level_of(
    features: NDArray[np.float32], preset: KinemeConstants, repeating: Repeating | None = None
) -> Level:
    """The segments of the features at the level of the shortest description.

    Parameters
    ----------
    features : (samples, dims) array
        A view.
    preset : KinemeConstants
    repeating : Repeating, optional
        What tells how much a span saves by repeating itself; by default nothing does.
    """
    unit = tree.median_distance(features, preset.near)

    def saved(start: int, stop: int) -> float:
        return repeating.saved(features, unit, start, stop) if repeating else 0.0

    fine = tree.fine_borders(
        features,
        unit,
        width=preset.near,
        cost=preset.samples(preset.fine_cost),
    )
    sums = tree.between_segments(features, fine, unit)
    prices = tree.Prices(
        segment=preset.samples(preset.segment_cost),
        cluster=preset.samples(preset.cluster_cost),
        spread_share=preset.spread_share,
        most_clusters=preset.max_clusters,
        shortest=round(preset.samples(preset.min_action)),
    )
    level = tree.best_level(fine, sums, prices, saved)
    at = np.searchsorted(fine, level.borders[:-1])
    preference = preferences(tree.added(sums, at), np.diff(level.borders), level.labels)
    return Level(fine, level.borders, level.labels, preference)


def preferences(sums: Floats, lengths: Samples, labels: Samples) -> Floats:
    """How much nearer each segment is to its own cluster than to the next, 0 to 1.

    Parameters
    ----------
    sums : (segments, segments) array
        Summed distances of their samples.
    lengths, labels : (segments,) array
    """
    members = np.eye(int(labels.max()) + 1)[labels]
    means = (sums @ members) / np.outer(lengths, lengths @ members)
    each = np.arange(len(labels))
    own = means[each, labels]
    means[each, labels] = np.inf
    return np.asarray(np.clip(1 - own / np.maximum(means.min(axis=1), 1e-12), 0, 1), np.float64)


def part_ends(n: int, longest: int) -> list[int]:
    """Ends of equal parts of n samples, from 0 to n, none longer than `longest`.

    Examples
    --------
    >>> part_ends(10, 4)
    [0, 3, 7, 10]
    """
    count = max(1, -(-n // longest))
    return [round(n * part / count) for part in range(count + 1)]


def linked(
    features: NDArray[np.float32],
    at: Samples,
    parts: Sequence[Level],
    *,
    unit: float,
    price: float,
) -> Level:
    """The parts one after the other, with clusters that mean the same in all of them.

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
    own = np.concatenate([part.labels + first for part, first in zip(parts, firsts, strict=False)])
    ends = np.concatenate([[0], *(part.borders[1:] for part in parts)])
    fine = np.concatenate([[0], *(part.fine[1:] for part in parts)])
    per_sample = own[np.searchsorted(ends, at, side="right") - 1]
    means = _mean_distances(features, per_sample, int(firsts[-1])) / unit
    sizes = np.bincount(per_sample, minlength=len(means))
    part_of = np.repeat(np.arange(len(parts)), np.diff(firsts))
    labels = by_first_appearance(link(means, sizes, part_of, price)[own])
    first = np.flatnonzero(np.diff(labels, prepend=-1))
    surest = np.concatenate([part.preference for part in parts])
    return Level(fine, np.append(ends[first], ends[-1]), labels[first], surest[first])


def link(means: NDArray[np.float64], sizes: Samples, part_of: Samples, price: float) -> Samples:
    """Which clusters of different parts are one: a number for each.

    Parameters
    ----------
    means : (clusters, clusters) array
        Mean distances of their samples, in units.
    sizes : (clusters,) array
        Samples of each.
    part_of : (clusters,) array
        The part that each is of.
    price : float
        Of a cluster: two are one where that costs less.

    Examples
    --------
    >>> places = np.array([0.0, 1.0, 0.1, 3.0])
    >>> apart = np.abs(places - places[:, None])
    >>> link(apart, np.full(4, 10), np.array([0, 0, 1, 1]), price=2.0).tolist()
    [0, 1, 0, 3]
    """
    means, lengths = means.copy(), sizes.astype(np.float64)
    parts = np.eye(int(part_of.max()) + 1, dtype=bool)[part_of]
    owner = np.arange(len(means))
    while True:
        within = np.diag(means)
        gaps = means - np.add.outer(within, within) / 2
        costs = gaps * np.outer(lengths, lengths) / np.maximum(np.add.outer(lengths, lengths), 1)
        costs[parts @ parts.T] = np.inf
        a, b = sorted(divmod(int(np.argmin(costs)), len(costs)))
        if not costs[a, b] < price:
            return owner
        share = lengths[b] / (lengths[a] + lengths[b])
        means[a] += share * (means[b] - means[a])
        means[:, a] += share * (means[:, b] - means[:, a])
        lengths[a] += lengths[b]
        parts[a] |= parts[b]
        parts[b] = True  # it is part of a, and compared with nothing any more
        owner[owner == b] = a


def _mean_distances(
    features: NDArray[np.float32], per_sample: Samples, clusters: int
) -> NDArray[np.float64]:
    """Mean distances of the samples of each two clusters."""
    groups = [np.flatnonzero(per_sample == cluster) for cluster in range(clusters)]
    return tree.mean_distances(
        features, [group[spread(0, len(group), COMPARED)] for group in groups]
    )
