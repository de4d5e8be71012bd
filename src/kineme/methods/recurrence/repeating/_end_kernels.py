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


@njit(
    "void(float32[:, ::1], int64, int64, float64, float64, float64[:, ::1], int64, float64[::1])",
    **SUMS,
)
def distances(rows, start, stop, first, length, mean, reach, found):
    """How far the rows from start to stop are from the mean repetition near their phase.

    The one that begins at ``first`` is so long; places of the mean so far on either side
    are compared.
    """
    places, dims = mean.shape
    for f in range(start, stop):
        at = int(np.floor((f + 0.5 - first) / length * places))
        nearest = np.inf
        for place in range(at - reach, at + reach + 1):
            square = 0.0
            for d in range(dims):
                difference = rows[f, d] - mean[place % places, d]
                square += difference * difference
            nearest = min(nearest, square)
        found[f - start] = np.sqrt(nearest)


@njit("float64[::1](float32[:, ::1], int64[::1], float64[:, :, ::1], int64)", **OPTIONS)
def distances_to_others(rows, cuts, repetitions, reach):
    """How far the rows between the cuts are from the mean of the other repetitions."""
    total = np.zeros(repetitions.shape[1:])
    for repetition in repetitions:
        total += repetition
    found = np.empty(cuts[-1] - cuts[0])
    for k in range(len(repetitions)):
        start, stop = cuts[k], cuts[k + 1]
        others = (total - repetitions[k]) / (len(repetitions) - 1)
        own = found[start - cuts[0] : stop - cuts[0]]
        distances(rows, start, stop, float(start), float(stop - start), others, reach, own)
    return found
