"""Compiled comparison of windows. ``tests/helpers/naive`` has a plain reference version."""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS

MOST = np.int32(np.iinfo(np.int32).max)


@njit("void(Array(int8, 2, 'C', readonly=True), int32[:, ::1], int32, int32[::1])", **OPTIONS)
def find_smallest_distances(windows, parts, scale, least):
    """Write the squared distance of each window from the nearest part of an example to ``least``.

    ``windows`` (n, numbers) are integers. ``parts`` (m, numbers) of the example and the distances
    are ``scale`` times as large.
    """
    for i in range(len(windows)):
        window = windows[i]
        best = MOST
        for j in range(len(parts)):
            other = parts[j]
            total = np.int32(0)
            for k in range(len(other)):
                difference = np.int32(scale * window[k] - other[k])
                # Integer sums can be vectorised.
                total = np.int32(total + np.int32(difference * difference))
            best = min(best, total)
        least[i] = best
