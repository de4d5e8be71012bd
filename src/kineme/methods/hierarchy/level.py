"""The segments of a stretch of samples: its tree, and the level of it that fits.

Change points are averaged over a second, so what lies between two activities
can look like one of its own: clusters that are too short to be an action are
given to their neighbours.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kineme.methods.hierarchy import tree
from kineme.methods.hierarchy.constants import HierarchyConstants
from kineme.methods.segments import by_first_appearance

Samples = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Segments:
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


def segments_of(features: NDArray[np.float32], preset: HierarchyConstants) -> Segments:
    """The segments of the features at the level of the shortest description."""
    unit = tree.median_distance(features)
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
    )
    borders, labels = joined(
        level.borders, level.labels, shortest=round(preset.samples(preset.min_action))
    )
    return Segments(fine, borders, labels, _preference(fine, sums, level, borders))


def joined(borders: Samples, labels: Samples, *, shortest: int = 0) -> tuple[Samples, Samples]:
    """Borders and labels with neighbours of one cluster as one segment.

    A cluster of less than `shortest` samples is what a change looks like while it is
    averaged over: its segments are parted between their neighbours.
    """
    lengths = np.diff(borders)
    rare = np.bincount(labels, lengths)[labels] < shortest
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
    fine: Samples, sums: NDArray[np.float64], level: tree.Level, borders: Samples
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
