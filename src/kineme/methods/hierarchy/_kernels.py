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
    for i in range(start, stop):
        for lag in range(width):
            j = i + lag
            if j >= n:
                similarity[i, lag] = 0.0
                continue
            square = 0.0
            for d in range(features.shape[1]):
                difference = features[i, d] - features[j, d]
                square += difference * difference
            similarity[i, lag] = 1.0 - np.sqrt(square) / unit


@njit(
    "void(float32[:, ::1], int64[::1], int64[::1], float64, int64, int64, float64[:, ::1])", **SUMS
)
def mean_distances(features, chosen, borders, unit, start, stop, means):
    """Mean distance of the chosen samples of each two segments, in units, for some rows.

    Segment g has ``chosen[borders[g]:borders[g + 1]]``. Columns before the row
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
            means[g, h] = total / (pairs * unit)
