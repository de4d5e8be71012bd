"""The segments of a stretch of samples: its tree, and the level of it that fits.

Change points are averaged over a second, so what lies between two activities
can look like one of its own: clusters that are too short to be an action are
given to their neighbours.

A long recording is cut into equal parts, for the shortest description of hours is coarser than
that of their minutes, and takes the square of the time. Each part has the level that it would have
alone. Then clusters of different parts are one, the nearest first, as long as they are nearer to
each other than two samples of the recording usually are. What a part tells apart stays apart.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme.methods.kineme import tree
from kineme.methods.kineme.repeating import Repeating
from kineme.methods.samples import spread
from kineme.methods.segments import by_first_appearance

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Samples = NDArray[np.int64]

COMPARED = 64
"""Samples at most that stand for one cluster."""


@dataclass(frozen=True, eq=False)
class Level:
    """Segments of samples, from 0 to the end.

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
    unit = tree.median_distance(features)

    def saved(start: int, stop: int) -> float:
        return repeating.saved(features, unit, start, stop) if repeating else 0.0

    fine = tree.fine_borders(
        features,
        unit,
        width=max(1, round(preset.samples(preset.max_fine))),
        cost=preset.samples(preset.fine_cost),
    )
    sums = tree.between_segments(features, fine, unit)
    level = tree.best_level(
        fine,
        sums,
        segment_cost=preset.samples(preset.segment_cost),
        cluster_cost=preset.cluster_price(len(features)),
        spread_share=preset.spread_share,
        most_clusters=preset.max_clusters,
        saved=saved,
    )
    borders, labels = joined(
        level.borders, level.labels, shortest=round(preset.samples(preset.min_action))
    )
    return Level(fine, borders, labels, _preference(fine, sums, level, borders))


def joined(borders: Samples, labels: Samples, *, shortest: int = 0) -> tuple[Samples, Samples]:
    """Borders and labels with neighbours of one cluster as one segment.

    A cluster of which no segment has `shortest` samples is what a change looks like while
    it is averaged over: its segments are parted between their neighbours.
    """
    lengths = np.diff(borders)
    longest = np.zeros(int(labels.max()) + 1, np.int64)
    np.maximum.at(longest, labels, lengths)
    rare = longest[labels] < shortest
    if rare.all():
        return borders[[0, -1]], np.zeros(1, np.int64)
    per_sample = np.repeat(np.where(rare, -1, labels), lengths)
    known = np.flatnonzero(per_sample >= 0)
    samples = np.arange(len(per_sample))
    after = np.minimum(np.searchsorted(known, samples), len(known) - 1)
    before = np.maximum(after - 1, 0)
    later = np.abs(known[after] - samples) <= np.abs(samples - known[before])
    per_sample = per_sample[known[np.where(later, after, before)]]
    first = np.flatnonzero(np.diff(per_sample, prepend=-1))
    return np.append(first, len(samples)), by_first_appearance(per_sample[first])


def _preference(
    fine: Samples, sums: NDArray[np.float64], level: tree.Grouped, borders: Samples
) -> NDArray[np.float64]:
    """How much nearer each segment is to its own cluster than to the next, where it began."""
    at = np.searchsorted(fine, level.borders[:-1])
    lengths = np.diff(level.borders).astype(np.float64)
    inner = np.add.reduceat(np.add.reduceat(sums, at, 0), at, 1)
    members = np.eye(int(level.labels.max()) + 1)[level.labels]
    means = (inner @ members) / np.outer(lengths, lengths @ members)
    own = means[np.arange(len(lengths)), level.labels]
    means[np.arange(len(lengths)), level.labels] = np.inf
    surer = np.clip(1 - own / np.maximum(means.min(axis=1), 1e-12), 0, 1)
    middles = (borders[:-1] + borders[1:]) // 2
    return np.asarray(surer[np.searchsorted(level.borders, middles, "right") - 1], np.float64)


def part_ends(n: int, longest: int) -> list[int]:
    """Ends of equal parts of n samples, from 0 to n, none longer than `longest`.

    Examples
    --------
    >>> part_ends(10, 4)
    [0, 3, 7, 10]
    """
    count = max(1, -(-n // longest))
    return [round(n * part / count) for part in range(count + 1)]


def linked(features: NDArray[np.float32], parts: Sequence[Level]) -> Level:
    """The parts one after the other, with clusters that mean the same in all of them.

    Parameters
    ----------
    features : (samples, dims) array
        Of the whole recording.
    parts : sequence of Level
    """
    if len(parts) == 1:
        return parts[0]
    starts = np.concatenate([[0], np.cumsum([part.borders[-1] for part in parts])])
    firsts = np.concatenate([[0], np.cumsum([part.labels.max() + 1 for part in parts])])
    own = np.concatenate([part.labels + first for part, first in zip(parts, firsts, strict=False)])
    ends = np.concatenate(
        [[0], *(part.borders[1:] + start for part, start in zip(parts, starts, strict=False))]
    )
    fine = np.concatenate(
        [[0], *(part.fine[1:] + start for part, start in zip(parts, starts, strict=False))]
    )
    per_sample = np.repeat(own, np.diff(ends))
    means = _mean_distances(features, per_sample, int(firsts[-1]))
    part_of = np.repeat(np.arange(len(parts)), np.diff(firsts))
    borders, labels = joined(
        ends, by_first_appearance(link(means, part_of, tree.median_distance(features))[own])
    )
    surest = np.concatenate([part.preference for part in parts])
    middles = (borders[:-1] + borders[1:]) // 2
    return Level(fine, borders, labels, surest[np.searchsorted(ends, middles, "right") - 1])


def link(means: NDArray[np.float64], part_of: Samples, unit: float) -> Samples:
    """Which clusters of different parts are one: a number for each.

    Parameters
    ----------
    means : (clusters, clusters) array
        Mean distances of their samples.
    part_of : (clusters,) array
        The part that each is of.
    unit : float
        Clusters farther apart are not linked.
    """
    apart = np.where(part_of[:, None] == part_of, np.inf, means)
    sizes = np.ones(len(means))
    owner = np.arange(len(means))
    while True:
        a, b = sorted(divmod(int(np.argmin(apart)), len(apart)))
        if not apart[a, b] < unit:
            return owner
        apart[a] = (sizes[a] * apart[a] + sizes[b] * apart[b]) / (sizes[a] + sizes[b])
        sizes[a] += sizes[b]
        owner[owner == b] = a
        apart[:, a] = apart[a]
        apart[b] = apart[:, b] = np.inf


def _mean_distances(
    features: NDArray[np.float32], per_sample: Samples, clusters: int
) -> NDArray[np.float64]:
    """Mean distances of the samples of each two clusters."""
    groups = [np.flatnonzero(per_sample == cluster) for cluster in range(clusters)]
    return tree.mean_distances(
        features, [group[spread(0, len(group), COMPARED)] for group in groups]
    )
