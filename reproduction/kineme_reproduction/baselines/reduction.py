"""Temporal reduction and frame kernel, the first steps of ACA and HACA.

A recording at 120 Hz is thinned to blocks of like poses, each stood for by its
first frame, and the kernel compares these. Source: Zhou, De la Torre and
Hodgins, TPAMI 35(3), 2013, and their program (``tempoReduce``, ``conKnl``).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist
from sklearn.cluster import KMeans
from threadpoolctl import threadpool_limits

if TYPE_CHECKING:
    from kineme_reproduction.baselines.constants import AlignedConstants

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def block_starts(features: Floats, preset: AlignedConstants, random: np.random.RandomState) -> Ints:
    """Return the first frames of blocks of similar poses.

    A block ends where the nearest of the k-means centres changes, or when it
    has ``preset.longest_block`` frames.

    Parameters
    ----------
    features : ndarray of shape (frames, dims)
    preset : AlignedConstants
    random : RandomState
        Of the starts of k-means.
    """
    nearest = tightest_clusters(features, preset.centres, preset.kmeans_starts, random)
    changes = np.flatnonzero(np.diff(nearest, prepend=-1))
    runs = zip(changes, [*changes[1:], len(features)], strict=True)
    return np.concatenate([np.arange(start, stop, preset.longest_block) for start, stop in runs])


def frame_kernel(features: Floats, nearest: float) -> Floats:
    """``kernel[a, b] = exp(-|x_a - x_b|^2 / 2 sigma^2)``, (frames, frames).

    sigma is the mean distance of a frame to its nearest frames, itself among
    them; ``nearest`` is their share of all frames.
    """
    distance = cdist(features, features)
    n = len(features)
    count = max(1, int(n * nearest))
    sigma = np.partition(distance, count - 1, axis=0)[:count].mean()
    kernel: Floats = np.exp(-(distance**2) / (2 * sigma**2 + np.finfo(float).eps))
    return kernel


def tightest_clusters(
    points: Floats, count: int, starts: int, random: np.random.RandomState
) -> Ints:
    """Return the cluster of each point, from the best of several runs of k-means.

    In single precision, which tells poses apart well enough and takes half the
    time. On one thread: the order of sums, and so the result, would change with
    the number of cores, and arrays this small gain nothing from more.
    """
    means = KMeans(count, init="random", n_init=starts, random_state=random)
    with threadpool_limits(1):
        labels: Ints = means.fit_predict(points.astype(np.float32)).astype(np.int64)
    return labels
