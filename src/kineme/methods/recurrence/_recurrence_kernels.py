"""Compiled loops over a band along the diagonal: distances, scales and similarities.

Bands are stored by row and lag. A two-sided band holds the pair (i, j) at
``[i, j - i + width]``, a one-sided band at ``[i, j - i]`` for j from i on.
Naive twins are in ``tests/naive.py``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._compiled import OPTIONS
from kineme._rank_kernels import smallest

SUMS = {**OPTIONS, "fastmath": {"reassoc", "contract"}}
FAR = np.float32(np.inf)


@njit("void(float32[:, ::1], int64, int64, int64, int64, float32[:, ::1])", **SUMS)
def nearest_frames(features, step, width, start, stop, near):
    """Distances from every ``step``-th frame to the nearest frame at each sample around it.

    Row i is frame ``i step``; sample j is the ``step`` frames around frame
    ``j step``. Fills rows ``[start, stop)`` of a two-sided band; pairs beyond
    the ends are infinite.
    """
    frames, dims = features.shape
    samples = near.shape[0]
    reach = step // 2
    for i in range(start, stop):
        row = features[i * step]
        for lag in range(-width, width + 1):
            j = i + lag
            nearest = FAR
            if 0 <= j < samples:
                for f in range(max(0, j * step - reach), min(frames, j * step + step - reach)):
                    square = np.float32(0)
                    for d in range(dims):
                        difference = row[d] - features[f, d]
                        square += difference * difference
                    nearest = min(nearest, square)
            near[i, lag + width] = np.sqrt(nearest)


@njit("void(float32[::1], float32[::1], int64, float32[::1])", **OPTIONS)
def lesser(one, other, n, found):
    """The lesser of each of the first n values of both."""
    for i in range(n):
        found[i] = min(one[i], other[i])


@njit("void(float32[:, ::1], int64, int64, int64, float32[:, ::1])", **OPTIONS)
def blur_rows(near, blur, start, stop, blurred):
    """Least value of each row within ``blur`` lags, in rows ``[start, stop)``, but beyond the ends.

    The least of two values, of four, of eight, ... from each lag on; the window is two
    such stretches that overlap.
    """
    samples, lags = near.shape
    width = lags // 2
    size = 2 * blur + 1
    least = np.full(lags + 2 * blur, FAR)
    other = np.empty_like(least)
    for i in range(start, stop):
        first, last = max(width - i, 0), min(width + samples - i, lags)
        inside = last - first
        least[:blur] = FAR
        for lag in range(inside):
            least[blur + lag] = near[i, first + lag]
        least[blur + inside : inside + 2 * blur] = FAR
        length = 1  # of the stretch that each value is the least of
        while 2 * length <= size:
            lesser(least, least[length:], inside + 2 * blur - 2 * length + 1, other)
            least, other = other, least
            length *= 2
        lesser(least, least[size - length :], inside, blurred[i, first:])


@njit(
    "void(float32[:, ::1], int64, int64, int64, int64, float32, float32, float32[::1])", **OPTIONS
)
def local_scales(blurred, gap, rank, start, stop, low, high, scales):
    """For each row the ``rank``-th smallest symmetric distance beyond the gap, clipped."""
    samples, lags = blurred.shape
    width = lags // 2
    row = np.empty(lags, np.float32)
    for i in range(start, stop):
        count = 0
        sides = (max(0, i - width), i - gap), (i + gap + 1, min(samples, i + width + 1))
        for first, last in sides:
            for j in range(first, last):
                distance = max(blurred[i, j - i + width], blurred[j, i - j + width])
                row[count] = distance
                count += distance < high
        scales[i] = high
        if count > rank:
            scales[i] = max(low, smallest(row, count, rank))


@njit(
    "void(float32[:, ::1], float32[::1], float32, float32, int64, int64, float32[:, ::1])", **SUMS
)
def add_similarities(blurred, scales, softness, weight, start, stop, similarity):
    """Adds the similarity of each pair, from 0 to 1, times a weight to a one-sided band."""
    samples, lags = blurred.shape
    width = lags // 2
    for i in range(start, stop):
        for lag in range(min(width + 1, samples - i)):
            distance = max(blurred[i, width + lag], blurred[i + lag, width - lag])
            unit = softness * softness * scales[i] * scales[i + lag]
            similarity[i, lag] += weight * np.exp(-distance * distance / unit)


@njit("void(float32[:, ::1], int64[::1], int64[::1], int64, int64, int64, float32[::1])", **OPTIONS)
def class_distances(near, labels, wanted, gap, start, stop, nearest):
    """For each sample the distance to the nearest sample of the class wanted there, beyond the gap.

    Fills ``nearest[start:stop]``; where no class is wanted (-1) it is infinite.
    """
    samples = len(labels)
    width = near.shape[1] // 2
    for i in range(start, stop):
        nearest[i] = FAR
        if wanted[i] >= 0:
            for j in range(max(0, i - width), min(samples, i + width + 1)):
                if labels[j] == wanted[i] and abs(j - i) > gap:
                    nearest[i] = min(nearest[i], near[i, j - i + width])


@njit("float64(float32[:, ::1], float32[::1], int64, int64, int64, int64, int64, float64)", **SUMS)
def coverage(near, scales, g_start, g_stop, h_start, h_stop, gap, softness):
    """How well the samples of g recur in h beyond the gap: mean similarity, 0 to 1.

    Of a long g no more samples are looked at than the band has lags.
    """
    width = near.shape[1] // 2
    step = 1 + (g_stop - g_start - 1) // near.shape[1]
    total = 0.0
    count = 0
    for i in range(g_start, g_stop, step):
        count += 1
        nearest = FAR
        for j in range(max(h_start, i - width), min(h_stop, i + width + 1)):
            if abs(j - i) > gap:
                nearest = min(nearest, near[i, j - i + width])
        if nearest < FAR:
            total += np.exp(-((nearest / (softness * scales[i])) ** 2))
    return total / count


@njit("float64(float32[:, ::1], int64[::1], int64[::1], int64)", **SUMS)
def mean_in_band(similarity, rows, columns, gap):
    """Mean similarity of the pairs farther apart than the gap, in a one-sided band; 0 if none."""
    width = similarity.shape[1]
    total = 0.0
    count = 0
    for i in rows:
        for j in columns:
            lag = abs(j - i)
            if gap < lag < width:
                total += similarity[min(i, j), lag]
                count += 1
    return total / max(count, 1)
