"""Compiled loops that follow an end of an activity along the mean of its repetitions.

Poses are those of an activity, ``path`` their length of path up to each frame
and to the end. Naive twins are in ``tests/helpers/naive.py``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._compiled import OPTIONS

SUMS = {**OPTIONS, "fastmath": {"reassoc", "contract"}}


@njit("Tuple((int64, float64))(float64[:, ::1], float64)", **OPTIONS)
def matched(gains, whole):
    """Columns up to which the rows follow them, and how many of these count.

    They do so along the warped path of the largest gain. Paths begin before the first row and
    column and take steps of (1, 1), (1, 2) and (2, 1), weighed by their length. A column counts
    by its gain as a share of ``whole``, 0 to 1. None if no path gains.
    """
    rows, columns = gains.shape
    sums = np.full((rows + 2, columns + 2), -np.inf)
    sums[1, 1] = 0
    best, row, column = 0.0, -1, -1
    for i in range(rows):
        for j in range(columns):
            straight = sums[i + 1, j + 1] + 2 * gains[i, j]
            bent = max(sums[i, j + 1], sums[i + 1, j]) + 3 * gains[i, j]
            sums[i + 2, j + 2] = max(straight, bent)
            if sums[i + 2, j + 2] > best:
                best, row, column = sums[i + 2, j + 2], i, j
    length, count = column + 1, 0.0
    while row >= 0:
        share = min(max(gains[row, column] / whole, 0.0), 1.0)
        bent = max(sums[row, column + 1], sums[row + 1, column])
        if 2 * gains[row, column] + sums[row + 1, column + 1] >= 3 * gains[row, column] + bent:
            count, row, column = count + share, row - 1, column - 1
        elif sums[row, column + 1] >= sums[row + 1, column]:
            count, row, column = count + share, row - 2, column - 1
        else:
            count, row, column = count + 2 * share, row - 1, column - 2
    return length, count


@njit("float64[:, ::1](float64[:, ::1], float64[::1], float64[::1])", **OPTIONS)
def poses_at(poses, path, lengths):
    """The poses at these lengths along the path."""
    found = np.empty((len(lengths), poses.shape[1]))
    for i in range(len(lengths)):
        low, high = 0, len(path)  # the first frame that is farther
        while low < high:
            middle = (low + high) // 2
            if path[middle] <= lengths[i]:
                low = middle + 1
            else:
                high = middle
        frame = min(max(low - 1, 0), len(poses) - 1)
        for d in range(poses.shape[1]):
            found[i, d] = poses[frame, d]
    return found


@njit("float64[::1](float64, float64, int64, int64, float64)", **OPTIONS)
def steps_inside(begin, step, places, number, whole):
    """Lengths of so many steps from ``begin`` on, ``places`` a step, that lie on the path."""
    lengths = np.empty(number)
    count = 0
    for i in range(number):
        length = begin + (i + 0.5) / places * step
        if 0 <= length <= whole:
            lengths[count] = length
            count += 1
    return lengths[:count]


@njit(
    "Tuple((int64, float64))(float64[:, ::1], float64[::1], float64[::1], float64[:, ::1], float64,"
    " float64)",
    **SUMS,
)
def followed(poses, path, lengths, mean, near, alike):
    """Places of the mean that the poses at these lengths follow, and how many of these count.

    They gain by being nearer than ``near``, a squared distance; from ``alike`` on they count
    whole.
    """
    there = poses_at(poses, path, lengths)
    gains = np.full((len(there), len(mean)), near)
    for i in range(len(there)):
        for j in range(len(mean)):
            square = 0.0
            for d in range(mean.shape[1]):
                difference = there[i, d] - mean[j, d]
                square += difference * difference
            gains[i, j] -= square
    return matched(gains, near - alike)
