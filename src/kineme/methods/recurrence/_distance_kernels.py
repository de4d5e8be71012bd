"""Compiled loops over single frames: spans far apart, and visits of a pose.

Naive twins are in ``tests/naive.py``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._compiled import OPTIONS

SUMS = {**OPTIONS, "fastmath": {"reassoc", "contract"}}
MINIMA = {**OPTIONS, "fastmath": {"nnan", "nsz"}}
FAR = np.float32(np.inf)


@njit("void(float32[:, ::1], int64, int64, float32[::1])", **SUMS)
def squares(columns, frame, start, found):
    """Squared distances of a frame to so many from ``start`` on; a column is a frame."""
    found[:] = 0
    for d in range(len(columns)):
        own, others = columns[d, frame], columns[d, start : start + len(found)]
        for f in range(len(found)):
            difference = own - others[f]
            found[f] += difference * difference


@njit("float32(float32[::1], float32)", **MINIMA)
def least_of(values, value):
    """The least of the values, and of one more."""
    for other in values:
        value = min(value, other)
    return value


@njit("float32[:, :, ::1](float32[:, ::1], int64[::1], int64[::1], int64[::1])", **SUMS)
def nearest_around(columns, frames, centers, reaches):
    """Distance from each of the frames to the nearest one within each reach of each center.

    Ascending frames and centers; the widest reach is the first. A column is a frame.
    """
    low = max(0, centers[0] - reaches[0])
    high = min(columns.shape[1], centers[-1] + reaches[0] + 1)
    line = np.empty(high - low, np.float32)
    nearest = np.empty((len(reaches), len(frames), len(centers)), np.float32)
    for r in range(len(frames)):
        squares(columns, frames[r], low, line)
        for c in range(len(centers)):
            first = last = centers[c] - low
            square = FAR
            for w in range(len(reaches) - 1, -1, -1):  # each holds the one before
                start = max(centers[c] - low - reaches[w], 0)
                stop = min(centers[c] - low + reaches[w] + 1, len(line))
                square = least_of(line[last:stop], least_of(line[start:first], square))
                first, last = start, stop
                nearest[w, r, c] = np.sqrt(square)
    return nearest


@njit(
    "float64(float32[:, ::1], int64[::1], int64[::1], int64[::1], float32[::1], float32[::1],"
    " float64, int64)",
    **SUMS,
)
def mean_similarity(columns, frames, others, reaches, scales, other_scales, softness, gap):
    """Mean similarity of the pairs of frames and others that lie apart by more than the gap."""
    there = nearest_around(columns, frames, others, reaches)
    back = nearest_around(columns, others, frames, reaches)
    total = 0.0
    count = 0
    for r in range(len(frames)):
        for c in range(len(others)):
            if abs(frames[r] - others[c]) <= gap:
                continue
            count += len(reaches)
            unit = softness * softness * scales[r] * other_scales[c]
            for w in range(len(reaches)):
                distance = max(there[w, r, c], back[w, c, r])
                total += np.exp(-distance * distance / unit)
    return total / count if count else 0.0


@njit("float64(float32[:, ::1], int64[::1], float32[::1], int64, int64, float64)", **SUMS)
def mean_recurrence(columns, frames, scales, start, stop, softness):
    """Mean similarity of the frames to the nearest one of ``[start, stop)``, at any distance."""
    line = np.empty(min(stop, columns.shape[1]) - start, np.float32)
    total = 0.0
    for r in range(len(frames)):
        squares(columns, frames[r], start, line)
        total += np.exp(-least_of(line, FAR) / (softness * scales[r]) ** 2)
    return total / len(frames)


@njit("float32[:, ::1](float32[:, ::1], int64[::1], int64, int64)", **SUMS)
def distances_to(features, references, start, stop):
    """Distance of each reference frame to each frame of ``[start, stop)``."""
    distances = np.empty((len(references), stop - start), np.float32)
    for r in range(len(references)):
        row = features[references[r]]
        for f in range(start, stop):
            square = np.float32(0)
            for d in range(features.shape[1]):
                difference = row[d] - features[f, d]
                square += difference * difference
            distances[r, f - start] = np.sqrt(square)
    return distances


@njit("int64[::1](float32[::1], float32)", **OPTIONS)
def turning_points(row, least):
    """Lowest, highest, ..., lowest columns of a row that rises and falls by ``least`` between."""
    turns = np.empty(len(row) + 1, np.int64)
    count = low = high = 0
    rising = falling = False
    for c in range(len(row)):
        low = c if row[c] < row[low] else low
        high = c if row[c] > row[high] else high
        if not rising and row[c] - row[low] >= least:
            turns[count] = low
            count += 1
            rising, falling, high = True, False, c
        elif not falling and row[high] - row[c] >= least:
            if count > 0:  # begin with a lowest
                turns[count] = high
                count += 1
            rising, falling, low = False, True, c
    if falling or count == 0:
        turns[count] = low
        count += 1
    return turns[:count]


@njit("Tuple((float32[:, ::1], int64[:, ::1]))(float32[:, ::1], float32[::1])", **OPTIONS)
def dips(distances, least):
    """Depths of the dips of each row, deepest first, and their columns; zero where no more.

    A dip is as deep as one must climb to reach a deeper one, the deepest as
    deep as the row is high (topological persistence). Those shallower than
    ``least``, and those lowest at either end of the row, do not count.
    """
    rows, columns = distances.shape
    depths = np.zeros((rows, columns // 2 + 1), np.float32)
    lowest = np.zeros((rows, columns // 2 + 1), np.int64)
    for r in range(rows):
        row = distances[r]
        turns = turning_points(row, least[r])
        n = len(turns)
        found = np.zeros(n // 2 + 1, np.float32)
        where = np.zeros(n // 2 + 1, np.int64)
        count = 0
        while n > 1:
            # The smallest climb is that out of the shallowest dip: take both away.
            at, climb = 0, FAR
            for t in range(n - 1):
                if abs(row[turns[t + 1]] - row[turns[t]]) < climb:
                    at, climb = t, abs(row[turns[t + 1]] - row[turns[t]])
            found[count], where[count] = climb, turns[at + at % 2]
            count += 1
            n -= 2
            for t in range(at, n):
                turns[t] = turns[t + 2]
        top = row[0]
        for c in range(columns):
            top = max(top, row[c])
        found[count], where[count] = top - row[turns[0]], turns[0]
        place = 0
        for _ in range(len(found)):
            i = 0
            for other in range(1, len(found)):
                i = other if found[other] > found[i] else i
            if found[i] >= least[r] and 0 < where[i] < columns - 1:
                depths[r, place], lowest[r, place] = found[i], where[i]
                place += 1
            found[i] = -FAR
    return depths, lowest
