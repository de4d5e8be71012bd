"""Compiled loops that tell whether a segment repeats; twins are in ``tests/helpers/naive.py``."""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._compiled import OPTIONS

SUMS = {**OPTIONS, "fastmath": {"reassoc", "contract"}}
LEAST = 2
"""Repetitions of a movement."""
ROUGH = 0.02
"""Share of their variance by which repetitions of one movement differ anyhow."""


@njit("void(float64[:, :, ::1])", **OPTIONS)
def center(repetitions):
    """Takes its mean pose off each repetition, (repetitions, places, dims)."""
    count, places, dims = repetitions.shape
    for k in range(count):
        for d in range(dims):
            mean = 0.0
            for p in range(places):
                mean += repetitions[k, p, d]
            for p in range(places):
                repetitions[k, p, d] -= mean / places


@njit("float64(float64[:, ::1], float64[::1], int64[::1], float64[:, :, ::1])", **SUMS)
def explained(poses, path, visits, centered):
    """The share of repetitions' variance that the mean of the others explains, in time.

    Each about its own mean, and the mean of the others as large as fits it best.
    """
    count, places, dims = centered.shape
    total = centered.sum(axis=0)
    mean = np.empty((places, dims))
    expected, rest = np.empty(dims), np.empty(dims)
    left = 0.0
    for k in range(count):
        product = square = 0.0
        for p in range(places):
            for d in range(dims):
                mean[p, d] = (total[p, d] - centered[k, p, d]) / (count - 1)
                product += centered[k, p, d] * mean[p, d]
                square += mean[p, d] * mean[p, d]
        size = max(product, 0.0) / max(square, 1e-12)
        first, last = visits[k], visits[k + 1]
        length = max(path[last] - path[first], 1e-12)
        residuals = np.empty((last - first, dims))
        for f in range(first, last):
            phase = (path[f] - path[first]) / length * places - 0.5
            low = min(max(int(np.floor(phase)), 0), places - 1)
            high = min(low + 1, places - 1)
            share = min(max(phase - low, 0.0), 1.0)
            for d in range(dims):
                there = mean[low, d] * (1 - share) + mean[high, d] * share
                residuals[f - first, d] = poses[f, d] - size * there
        residual, variance = 0.0, 1e-12
        for d in range(dims):
            expected[d] = rest[d] = 0.0
            for f in range(first, last):
                expected[d] += poses[f, d] / (last - first)
                rest[d] += residuals[f - first, d] / (last - first)
            for f in range(first, last):
                residual += (residuals[f - first, d] - rest[d]) ** 2
                variance += (poses[f, d] - expected[d]) ** 2
        noise = (count - 1) / count  # the mean of few others has noise of its own
        left += min(residual * noise / variance, 1.0) * (last - first)
    return 1 - left / (visits[-1] - visits[0])


@njit("float64(float64[:, ::1], float64[::1], int64, int64)", **SUMS)
def _left(rows, total, start, stop):
    """What the mean of the others leaves of each of the rows, which have that total, summed."""
    count = stop - start
    left = 0.0
    for k in range(start, stop):
        product = square = own = 0.0
        for e in range(rows.shape[1]):
            mean = (total[e] - rows[k, e]) / (count - 1)
            product += mean * rows[k, e]
            square += mean * mean
            own += rows[k, e] * rows[k, e]
        left += (own - max(product, 0.0) ** 2 / max(square, 1e-12)) * (count - 1) / count
    return left


@njit("float64(float64[:, :, ::1])", **OPTIONS)
def best_parted(centered):
    """The least share of what their mean leaves of repetitions that two means leave.

    One mean is of the first repetitions, one of the last. 1 where there are too few.
    """
    count = len(centered)
    rows = centered.copy().reshape(count, -1)
    sums = np.zeros((count + 1, rows.shape[1]))
    for k in range(count):
        for e in range(rows.shape[1]):
            sums[k + 1, e] = sums[k, e] + rows[k, e]
    rough = 1e-12
    for k in range(count):
        for e in range(rows.shape[1]):
            rough += ROUGH * rows[k, e] * rows[k, e]
    whole = _left(rows, sums[count], 0, count)
    best = 1.0
    for cut in range(LEAST, count - LEAST + 1):
        parted = _left(rows, sums[cut], 0, cut)
        parted += _left(rows, sums[count] - sums[cut], cut, count)
        best = min(best, (parted + rough) / (whole + rough))
    return best


@njit("float64(float32[:, ::1], int64, int64, int64)", **SUMS)
def spread(view, start, stop, most):
    """Half the summed distances of samples to the mean others of the span, by so many of them."""
    stop = min(stop, len(view))
    count = min(most, stop - start)
    total = 0.0
    for i in range(count):
        for j in range(i):
            a, b = start + i * (stop - start) // count, start + j * (stop - start) // count
            square = 0.0
            for d in range(view.shape[1]):
                difference = view[a, d] - view[b, d]
                square += difference * difference
            total += np.sqrt(square)
    return (stop - start) * total / max(count * count, 1)


@njit("float64[:, ::1](float64[:, :, ::1])", **SUMS)
def likenesses(movements):
    """Of each two movements, (movements, places, dims), at the phase at which they fit best."""
    count, places, dims = movements.shape
    varied = np.zeros(count)
    for k in range(count):
        for d in range(dims):
            mean = 0.0
            for p in range(places):
                mean += movements[k, p, d] / places
            for p in range(places):
                varied[k] += (movements[k, p, d] - mean) ** 2
    found = np.ones((count, count))
    for k in range(count):
        for other in range(k):
            least = np.inf
            for by in range(places):
                apart = 0.0
                for p in range(places):
                    for d in range(dims):
                        difference = movements[k, (p + by) % places, d] - movements[other, p, d]
                        apart += difference * difference
                least = min(least, apart)
            alike = 1 - least / max(varied[k] + varied[other], 1e-12)
            found[k, other] = found[other, k] = alike
    return found
