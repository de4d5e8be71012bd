"""Compiled comparison of windows. The naive twin is in ``tests/helpers/naive``."""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS

MOST = np.int32(np.iinfo(np.int32).max)


@njit("void(Array(int8, 2, 'C', readonly=True), int32[:, ::1], int32, int32[::1])", **OPTIONS)
def find_smallest_distances(windows, parts, finer, least):
    """The square of each window's distance from the nearest part of an example.

    ``windows`` (n, numbers) are whole numbers, ``parts`` (m, numbers) those of an example, as much
    ``finer``, and so is what is left in ``least`` (n), squared.
    """
    for i in range(len(windows)):
        window = windows[i]
        best = MOST
        for j in range(len(parts)):
            other = parts[j]
            total = np.int32(0)
            for k in range(len(other)):
                apart = np.int32(finer * window[k] - other[k])
                total = np.int32(total + np.int32(apart * apart))  # whole numbers: in any order
            best = min(best, total)
        least[i] = best
