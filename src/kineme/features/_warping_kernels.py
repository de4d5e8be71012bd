"""Compiled dynamic time warping (Sakoe and Chiba 1978).

The naive version is in ``tests/helpers/naive``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS


@njit("Tuple((float64, int64[:], int64[:]))(float64[:, ::1], float64)", **OPTIONS)
def find_cheapest_path(cost, step):
    """Return the least sum of ``cost`` from the first to the last corner, and its path.

    The path is given by its rows and columns. A move along one axis alone costs ``step`` in
    addition. Infinite costs block the path.
    """
    n, m = cost.shape
    # One more row and column than costs: index 0 is the state before the first pair.
    sums = np.full((n + 1, m + 1), np.inf)
    sums[0, 0] = 0
    for i in range(n):
        for j in range(m):
            aside = min(sums[i, j + 1], sums[i + 1, j]) + step
            sums[i + 1, j + 1] = cost[i, j] + min(sums[i, j], aside)
    rows, columns = np.empty(n + m, np.int64), np.empty(n + m, np.int64)
    i, j, first = n, m, n + m
    while i > 0 and j > 0:  # backtrack
        first -= 1
        rows[first], columns[first] = i - 1, j - 1
        both, down, right = sums[i - 1, j - 1], sums[i - 1, j] + step, sums[i, j - 1] + step
        if both <= min(down, right):
            i, j = i - 1, j - 1
        elif down <= right:
            i -= 1
        else:
            j -= 1
    return sums[n, m], rows[first:], columns[first:]
