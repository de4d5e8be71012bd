"""Compiled loops that compare stretches of a recording with a mean repetition.

Naive twins are in ``tests/naive.py``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._compiled import OPTIONS

SUMS = {**OPTIONS, "fastmath": {"reassoc", "contract"}}


@njit("void(float32[:, ::1], float64, float64[::1])", **OPTIONS)
def pose_at(rows, at, found):
    """The row at a time between two rows, in frames; the first or last one beyond them."""
    before = min(max(int(np.floor(at)), 0), len(rows) - 1)
    after = min(before + 1, len(rows) - 1)
    share = min(max(at - before, 0.0), 1.0)
    for d in range(rows.shape[1]):
        found[d] = rows[before, d] * (1 - share) + rows[after, d] * share


@njit("float64[:, :, ::1](float32[:, ::1], int64[::1], int64[::1], int64)", **OPTIONS)
def evenly_in_time(rows, starts, lengths, places):
    """(stretches, places, dims): rows evenly in time from each start on, over each length."""
    found = np.empty((len(starts), places, rows.shape[1]))
    for k in range(len(starts)):
        for p in range(places):
            at = starts[k] + lengths[k] * ((p + 0.5) / places) - 0.5
            pose_at(rows, at, found[k, p])
    return found


@njit("int64(float32[:, ::1], int64, int64, int64, float64[:, ::1])", **SUMS)
def best_length(rows, stop, shortest, longest, mean):
    """How long the stretch up to a frame is that is nearest to the mean, evenly in time."""
    places, dims = mean.shape
    pose = np.empty(dims)
    best, least = shortest, np.inf
    for length in range(shortest, longest + 1):
        misfit = 0.0
        for p in range(places):
            pose_at(rows, stop - length + length * ((p + 0.5) / places) - 0.5, pose)
            for d in range(dims):
                difference = pose[d] - mean[p, d]
                misfit += difference * difference
        if misfit < least:
            best, least = length, misfit
    return best
