"""Long recordings in parts: each has the level that it would have alone; clusters are linked.

The shortest description of hours is coarser than that of their minutes, and
takes the square of the time. So a long recording is cut into equal parts. Then
clusters of different parts are one, the nearest first, as long as they are
nearer to each other than two samples of the recording usually are. What a part
tells apart stays apart.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kineme.methods.hierarchy import tree
from kineme.methods.hierarchy.level import Segments, joined
from kineme.methods.samples import spread
from kineme.methods.segments import by_first_appearance

Samples = NDArray[np.int64]

COMPARED = 64
"""Samples at most that stand for one cluster."""


def part_ends(n: int, longest: int) -> list[int]:
    """Ends of equal parts of n samples, from 0 to n, none longer than `longest`.

    Examples
    --------
    >>> part_ends(10, 4)
    [0, 3, 7, 10]
    """
    count = max(1, -(-n // longest))
    return [round(n * part / count) for part in range(count + 1)]


def linked(features: NDArray[np.float32], parts: Sequence[Segments]) -> Segments:
    """The parts one after the other, with clusters that mean the same in all of them.

    Parameters
    ----------
    features : (samples, dims) array
        Of the whole recording.
    parts : sequence of Segments
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
    return Segments(fine, borders, labels, surest[np.searchsorted(ends, middles, "right") - 1])


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
