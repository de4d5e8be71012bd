"""Compiled loops of bundling, filters and dynamic time warping.

Naive versions are in ``tests/helpers/naive``, except that of `filter_sections`: it replaces
`scipy.signal.sosfiltfilt`, which takes over a second to import.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS

PRECISION = 1e-10
"""Length of a step that ends the iteration, as a share of the mean distance of neighbours."""
MAX_STEPS = 1000
"""Largest number of steps."""


@njit(
    "void(float64[:, ::1], float64[:, ::1], int64[:, ::1], int64, int64, float64[:, ::1])",
    fastmath={"reassoc", "contract"},
    **OPTIONS,
)
def move_to_medians(points, directions, neighbors, start, stop, moved):
    """Move points ``[start, stop)`` to the geometric medians of their neighbours.

    The median is taken in the hyperplane orthogonal to the direction of each point.
    Weiszfeld's iteration, extended by Vardi and Zhang (2000) for positions that
    coincide with a neighbour.
    """
    dims = points.shape[1]
    count = neighbors.shape[1]
    across = np.empty((count, dims))
    projections = np.empty(count)
    at, pull = np.empty(dims), np.empty(dims)
    for i in range(start, stop):
        # `at` is the offset from the point; it starts at the mean of the projected neighbours.
        for d in range(dims):
            at[d] = 0
        for k in range(count):
            projections[k] = 0
            # Split neighbours, relative to the point, into parts along and across its direction.
            for d in range(dims):
                across[k, d] = points[neighbors[i, k], d] - points[i, d]
                projections[k] += across[k, d] * directions[i, d]
            for d in range(dims):
                across[k, d] -= projections[k] * directions[i, d]
                at[d] += across[k, d] / count
        # Weiszfeld: step to the mean of the neighbours, each weighted by the inverse of its
        # distance.
        for _ in range(MAX_STEPS):
            weights = distances = strength = 0.0
            coincident = 0
            for d in range(dims):
                pull[d] = 0
            for k in range(count):
                # The part along the direction is constant, but counts in the distance.
                square = projections[k] * projections[k]
                for d in range(dims):
                    square += (across[k, d] - at[d]) ** 2
                # Neighbours at the position itself would have infinite weight: count them apart.
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
            # Vardi and Zhang: coinciding neighbours hold the position against the others' pull.
            if strength <= coincident:
                break
            share = (1 - coincident / strength) / weights
            for d in range(dims):
                at[d] += share * pull[d]
            if share * strength <= PRECISION * distances / count:
                break
        for d in range(dims):
            moved[i, d] = points[i, d] + at[d]


@njit("void(float64[:, ::1], float64[:, ::1])", **OPTIONS)
def filter_sections(values, sections):
    """Filter (frames, channels) in place by sections (sections, 5): b0, b1, b2, a1, a2.

    The initial state of each section is that after a constant input of the first frame.
    """
    frames, channels = values.shape
    near, far = np.empty(channels), np.empty(channels)  # the state, direct form II transposed
    for s in range(len(sections)):
        b0, b1, b2, a1, a2 = sections[s]
        # Gain for a constant input, from which the steady state follows.
        gain = (b0 + b1 + b2) / (1 + a1 + a2)
        for c in range(channels):
            near[c] = (gain - b0) * values[0, c]
            far[c] = (b2 - a2 * gain) * values[0, c]
        for t in range(frames):
            for c in range(channels):
                x = values[t, c]
                y = b0 * x + near[c]
                near[c] = b1 * x - a1 * y + far[c]
                far[c] = b2 * x - a2 * y
                values[t, c] = y


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
