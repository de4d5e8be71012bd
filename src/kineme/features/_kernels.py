"""Compiled loop of the bundling: points drawn to where their neighbours are densest.

The naive twin is in ``tests/helpers/naive``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS

PRECISION = 1e-10  # of the neighbours' mean distance; a shorter step is the last
MOST_STEPS = 1000


@njit(
    "void(float64[:, ::1], float64[:, ::1], int64[:, ::1], int64, int64, float64[:, ::1])",
    fastmath={"reassoc", "contract"},
    **OPTIONS,
)
def move_to_medians(points, directions, neighbors, start, stop, moved):
    """Rows ``[start, stop)`` of the points, each moved to its neighbours' geometric median.

    Among the positions that it reaches at right angles to its direction, the
    one with the least mean distance to its neighbours. Weiszfeld's iteration;
    where a position meets a neighbour, as Vardi and Zhang (2000) extend it.
    """
    dims = points.shape[1]
    count = neighbors.shape[1]
    across = np.empty((count, dims))
    projections = np.empty(count)
    at, pull = np.empty(dims), np.empty(dims)
    for i in range(start, stop):
        # Offset from the point, which starts at the mean of the projected neighbours.
        for d in range(dims):
            at[d] = 0
        for k in range(count):
            projections[k] = 0
            # Neighbours relative to the point: along its direction, and across it.
            for d in range(dims):
                across[k, d] = points[neighbors[i, k], d] - points[i, d]
                projections[k] += across[k, d] * directions[i, d]
            for d in range(dims):
                across[k, d] -= projections[k] * directions[i, d]
                at[d] += across[k, d] / count
        # Weiszfeld: step to the mean of the neighbours, each weighted by the inverse of its
        # distance.
        for _ in range(MOST_STEPS):
            weights = distances = strength = 0.0
            coincident = 0
            for d in range(dims):
                pull[d] = 0
            for k in range(count):
                # The part along the direction is fixed, but counts in the distance.
                square = projections[k] * projections[k]
                for d in range(dims):
                    square += (across[k, d] - at[d]) ** 2
                # The weight of a neighbour at the position itself is infinite: it is counted apart.
                if square == 0:
                    coincident += 1
                    continue
                distance = np.sqrt(square)
                distances += distance
                weights += 1 / distance
                for d in range(dims):
                    pull[d] += (across[k, d] - at[d]) / distance
            for d in range(dims):
                strength += pull[d] * pull[d]
            strength = np.sqrt(strength)
            # Vardi and Zhang: neighbours here hold the position against the pull of the others.
            if strength <= coincident:
                break
            share = (1 - coincident / strength) / weights
            for d in range(dims):
                # The pull, shortened by what coinciding neighbours hold back.
                at[d] += share * pull[d]
            if share * strength <= PRECISION * distances / count:
                break
        for d in range(dims):
            moved[i, d] = points[i, d] + at[d]
