"""Compiled dynamic time warping; its literal twin is in ``tests/helpers/naive.py``."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit("float64(float64[:, ::1])", cache=True, nogil=True)
def warped_cost(cost: NDArray[np.float64]) -> float:
    """Return the least sum of ``cost`` along a path from the first to the last corner.

    Steps are (1, 1), (1, 0) and (0, 1), each counted once.
    """
    n, m = cost.shape
    # One row of the table at a time is enough; the first can only be reached from the left.
    row = np.empty(m)
    row[0] = cost[0, 0]
    for j in range(1, m):
        row[j] = row[j - 1] + cost[0, j]
    for i in range(1, n):
        # `corner` is the value above and left, which `row` has overwritten by then.
        corner = row[0]
        row[0] += cost[i, 0]
        for j in range(1, m):
            # Diagonal, from above (not yet overwritten), and from the left.
            best = min(corner, row[j], row[j - 1])
            corner = row[j]
            row[j] = best + cost[i, j]
    return row[m - 1]  # type: ignore[no-any-return]
