"""Compiled loops over single frames: stretches far apart, and visits of a pose.

Naive twins are in ``tests/naive.py``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._compiled import OPTIONS

SUMS = {**OPTIONS, "fastmath": {"reassoc", "contract"}}
FAR = np.float32(np.inf)


@njit("float32[:, ::1](float32[:, ::1], int64, int64, int64, int64, int64, int64, int64)", **SUMS)
def nearest_within(features, step, phase, stride, g_start, g_stop, h_start, h_stop):
    """Distances from moments of g to the nearest frame in the phase window around those of h.

    Moments are every ``stride``-th bin, frames every ``stride``-th frame.
    """
    frames, dims = features.shape
    low, high = max(0, (h_start - phase) * step), min(frames, (h_stop + phase) * step)
    line = np.empty((high - low + stride - 1) // stride, np.float32)
    nearest = np.full(
        ((g_stop - g_start + stride - 1) // stride, (h_stop - h_start + stride - 1) // stride), FAR
    )
    for r in range(nearest.shape[0]):
        row = features[(g_start + r * stride) * step]
        for f in range(len(line)):
            square = np.float32(0)
            for d in range(dims):
                difference = row[d] - features[low + f * stride, d]
                square += difference * difference
            line[f] = square
        for c in range(nearest.shape[1]):
            center = (h_start + c * stride) * step - low
            first = max(0, (center - phase * step) // stride)
            for f in range(first, min(len(line), (center + phase * step) // stride + 1)):
                nearest[r, c] = min(nearest[r, c], line[f])
            nearest[r, c] = np.sqrt(nearest[r, c])
    return nearest


@njit(
    "float64(float32[:, ::1], float32[::1], int64, int64, int64, float32, int64, int64, int64,"
    " int64)",
    **SUMS,
)
def distant_similarity(
    features, scales, step, phase, stride, softness, g_start, g_stop, h_start, h_stop
):
    """Mean similarity of two stretches that the band does not reach across."""
    there = nearest_within(features, step, phase, stride, g_start, g_stop, h_start, h_stop)
    back = nearest_within(features, step, phase, stride, h_start, h_stop, g_start, g_stop)
    total = 0.0
    for r in range(there.shape[0]):
        for c in range(there.shape[1]):
            distance = max(there[r, c], back[c, r])
            unit = scales[g_start + r * stride] * scales[h_start + c * stride]
            total += np.exp(-distance * distance / (softness * softness * unit))
    return total / there.size


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


@njit("Tuple((int64[::1], int64[:, ::1]))(float32[:, ::1], float32[::1])", **OPTIONS)
def visit_centers(distances, limits):
    """How often each row comes within its limit, and the nearest column of each visit.

    A visit cut off by either end before it is nearest does not count.
    """
    rows, columns = distances.shape
    counts = np.zeros(rows, np.int64)
    centers = np.zeros((rows, columns // 2 + 1), np.int64)
    for r in range(rows):
        inside = False
        nearest = 0
        for c in range(columns + 1):
            if c < columns and distances[r, c] < limits[r]:
                if not inside or distances[r, c] < distances[r, nearest]:
                    nearest = c
                inside = True
            elif inside:
                inside = False
                if 0 < nearest < columns - 1:
                    centers[r, counts[r]] = nearest
                    counts[r] += 1
    return counts, centers
