"""Compiled loops over distances of samples. Naive twins are in ``tests/naive.py``."""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._compiled import OPTIONS

SUMS = {**OPTIONS, "fastmath": {"reassoc", "contract"}}


@njit("void(float32[:, ::1], float64, int64, int64, float32[:, ::1])", **SUMS)
def similarity_band(features, unit, start, stop, similarity):
    """``similarity[i, j - i] = 1 - |x_i - x_j| / unit`` for the rows from start to stop."""
    n, width = similarity.shape
    one, units = np.float32(1.0), np.float32(1.0 / unit)  # sums in doubles take twice the time
    for i in range(start, stop):
        for lag in range(width):
            j = i + lag
            if j >= n:
                similarity[i, lag] = 0.0
                continue
            square = np.float32(0.0)
            for d in range(features.shape[1]):
                difference = features[i, d] - features[j, d]
                square += difference * difference
            similarity[i, lag] = one - np.sqrt(square) * units


@njit("void(float32[:, ::1], int64[::1], int64[::1], int64, int64, float64[:, ::1])", **SUMS)
def mean_distances(features, chosen, borders, start, stop, means):
    """Mean distance of the chosen samples of each two groups, for some rows.

    Group g has ``chosen[borders[g]:borders[g + 1]]``. Columns before the row
    are left as they are; the matrix is symmetric.
    """
    for g in range(start, stop):
        for h in range(g, len(borders) - 1):
            total = 0.0
            for a in range(borders[g], borders[g + 1]):
                for b in range(borders[h], borders[h + 1]):
                    square = 0.0
                    for d in range(features.shape[1]):
                        difference = features[chosen[a], d] - features[chosen[b], d]
                        square += difference * difference
                    total += np.sqrt(square)
            pairs = (borders[g + 1] - borders[g]) * (borders[h + 1] - borders[h])
            means[g, h] = total / pairs


@njit("void(float64[:, ::1], float64[::1], int64[::1], int64, int64[::1], float64[::1])", **OPTIONS)
def _find_nearest(sums, lengths, owner, g, nearest, apart):
    """The cluster whose mean distance to cluster g is least, and that distance."""
    apart[g] = np.inf
    for h in range(len(lengths)):
        if h != g and owner[h] == h:
            mean = sums[g, h] / (lengths[g] * lengths[h])
            if mean < apart[g]:
                apart[g] = mean
                nearest[g] = h


@njit("float64(float64[:, ::1], float64[::1], int64, float64, float64, int64[::1])", **OPTIONS)
def cheapest_grouping(sums, lengths, most, segment_cost, cluster_cost, labels):
    """The least cost of a grouping of segments by average linkage; `labels` gets the grouping.

    A grouping costs half the distances within clusters, and a price for each run of
    segments of one cluster and for each cluster, of which there are `most` at most.
    `sums` (summed distances of each two segments) and `lengths` are used up.
    """
    k = len(lengths)
    owner = np.arange(k)
    nearest = np.zeros(k, np.int64)
    apart = np.full(k, np.inf)
    for g in range(k):
        _find_nearest(sums, lengths, owner, g, nearest, apart)
    cheapest = np.inf
    for clusters in range(k, 0, -1):
        if clusters <= most:
            cost = cluster_cost * clusters
            for g in range(k):
                if owner[g] == g:
                    cost += sums[g, g] / (2 * lengths[g])
                if g == 0 or owner[g] != owner[g - 1]:
                    cost += segment_cost
            if cost < cheapest:
                cheapest = cost
                for g in range(k):
                    labels[g] = owner[g]
        if clusters == 1:
            break
        g = int(np.argmin(apart))
        h = nearest[g]
        if h < g:
            g, h = h, g
        lengths[g] += lengths[h]
        apart[h] = np.inf
        for other in range(k):
            sums[g, other] += sums[h, other]
            if owner[other] == h:
                owner[other] = g
        for other in range(k):
            sums[other, g] += sums[other, h]
        for other in range(k):
            if owner[other] == other and (other == g or nearest[other] in (g, h)):
                _find_nearest(sums, lengths, owner, other, nearest, apart)
    return cheapest
