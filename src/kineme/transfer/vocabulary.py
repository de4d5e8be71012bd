"""One vocabulary for the signals of a collection: clusters of its samples, which segments take.

Clusters of single recordings differ by what their recordings hold: the one that only walks tells
fast from slow, the one that walks and sits does not. So these are not joined. The samples of all
recordings are clustered together (k-means, the best of several starts), and each segment takes the
cluster that its samples are nearest to in the mean.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.spatial.distance import cdist
from threadpoolctl import threadpool_limits

from kineme._util.arrays import Float32s, Floats
from kineme.segments.segmentation import Segmentation
from kineme.transfer.channel_samples import ChannelSamples, by_content, in_common_units

STARTS = 5
MOST = 100_000
"""Samples that are clustered; of more, as many at equal steps."""
WORTH = 0.02
"""Share of the variance of all samples that one more cluster must explain."""
TRIED = 10_000
"""Samples of which is found out how many clusters there are."""
PATIENCE = 3
"""Numbers that are tried beyond the best."""


def share_by_samples(
    samples: Sequence[ChannelSamples],
    segmentations: Sequence[Segmentation],
    *,
    n_clusters: int | None = None,
) -> list[Segmentation]:
    """Return the same segments, in which equal cluster numbers are equal movements everywhere.

    Repetitions have the cluster of their activity, transitions none. Where no number of clusters is
    given, `likely_number` tells it.
    """
    features = in_common_units(samples)
    typical = [_typical(*each) for each in zip(samples, features, segmentations, strict=True)]
    points = np.concatenate([features[i] for i in by_content(samples)])
    count = likely_number(points) if n_clusters is None else n_clusters
    centres = centres_of(points[:: -(-len(points) // MOST)], count)
    shared = []
    for found, of_segments in zip(segmentations, typical, strict=True):
        nearest = cdist(of_segments, centres).argmin(axis=1)
        actions = np.where(found.activities.kind == "activity", nearest, -1)
        table = found.table
        action = actions[table.activity]
        cluster = np.where(table.kind != "transition", action, -1)
        changed = table.with_columns(cluster=cluster, action=action)
        shared.append(replace(found, table=changed, hierarchy=None))
    return shared


def centres_of(points: Float32s, n_clusters: int) -> Float32s:
    """Return the best centres of `STARTS` runs of k-means; fewer where no so many points differ."""
    from sklearn.cluster import KMeans

    count = min(n_clusters, len(np.unique(points, axis=0)))
    with threadpool_limits(1):  # the order of sums does not depend on the number of cores
        centres: Float32s = (
            KMeans(count, n_init=STARTS, random_state=0).fit(points).cluster_centers_
        )
    return centres


def _typical(samples: ChannelSamples, features: Float32s, found: Segmentation) -> Floats:
    """Return the mean features of each activity; of a short one those of the sample before."""
    rows = found.activities
    sums = np.concatenate([np.zeros((1, features.shape[1])), np.cumsum(features, 0, np.float64)])
    first = np.searchsorted(samples.frames, rows.start_frame)
    first = np.minimum(first, len(features) - 1)
    stop = np.maximum(np.searchsorted(samples.frames, rows.stop_frame), first + 1)
    means: Floats = (sums[stop] - sums[first]) / (stop - first)[:, None]
    return means


def likely_number(points: Float32s) -> int:
    """Return how many clusters points have: one more must explain `WORTH` of their variance.

    Examples
    --------
    >>> points = np.repeat([[0.0, 0], [9, 0], [0, 9]], 20, axis=0).astype(np.float32)
    >>> likely_number(points)
    3
    """
    points = points[:: -(-len(points) // TRIED)]
    total = float(((points - points.mean(axis=0)) ** 2).sum(dtype=np.float64))
    best, least = 1, 1.0 + WORTH
    for count in range(2, int(1 / WORTH)):
        if count > best + PATIENCE or best * WORTH + 1e-9 > least:
            break
        centres = centres_of(points, count)
        left = float((cdist(points, centres, "sqeuclidean").min(axis=1)).sum())
        cost = left / max(total, 1e-12) + count * WORTH
        if cost < least:
            best, least = count, cost
    return best
