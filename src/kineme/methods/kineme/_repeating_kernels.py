"""Compiled loops that test whether segments repeat, and measure the similarity of movements.

Naive versions of the kernels are in ``tests/helpers/naive``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS

SUMS = {**OPTIONS, "fastmath": {"reassoc", "contract"}}
MIN_COUNT = 2
"""Smallest number of repetitions of a movement."""
ROUGH = 0.02
"""Smallest unexplained share of the variance of repetitions that is significant."""


@njit("void(float64[:, :, ::1])", **OPTIONS)
def center_repetitions(repetitions):
    """Subtract its mean pose from each repetition, (repetitions, places, dims), in place."""
    count, places, dims = repetitions.shape
    for k in range(count):
        for d in range(dims):
            mean = 0.0
            for p in range(places):
                mean += repetitions[k, p, d]
            for p in range(places):
                repetitions[k, p, d] -= mean / places


@njit("float64(int64[::1], float64, float64, float64, float64, float64, float64)", **OPTIONS)
def score_durations(
    visits, fps, max_repetition, chance_period, uneven, chance_count, chance_duration
):
    """Return an upper bound of the share that a division saves, from its durations; 0 to 1."""
    count = len(visits)
    # Two visits enclose one repetition, which no other can explain.
    if count < 3:
        return 0.0
    durations = np.diff(visits) / fps
    if durations.max() > max_repetition:
        return 0.0
    fast = min(chance_period / durations.mean(), 1.0) ** 2
    # Logarithms, so that twice as long and half as long are equally uneven.
    even = 1 - min(np.log(durations).std() / uneven, 1.0) ** 2
    chance = min(chance_count, chance_duration / durations.mean())
    return even * (1 - max(fast, min(chance / count, 1.0)))


@njit("float64(float64[:, ::1], float64[::1], int64[::1], float64[:, :, ::1])", **SUMS)
def explain_variance(poses, path, visits, centered):
    """Return the share of the variance of repetitions that the mean of the others explains.

    The mean of the others is scaled by the factor that fits best, and compared frame by frame.
    ``centered`` are the centred repetitions.
    """
    count, places, dims = centered.shape
    total = centered.sum(axis=0)
    mean = np.empty((places, dims))
    expected, rest = np.empty(dims), np.empty(dims)
    left = 0.0
    for k in range(count):
        # Mean of the others, and the factor that fits it to this repetition.
        product = mean_square = 0.0
        for p in range(places):
            for d in range(dims):
                # Sum of all less this one is the sum of the others.
                mean[p, d] = (total[p, d] - centered[k, p, d]) / (count - 1)
                product += centered[k, p, d] * mean[p, d]
                mean_square += mean[p, d] * mean[p, d]
        # A negative factor would reverse the movement, so it is at least 0.
        size = max(product, 0.0) / max(mean_square, 1e-12)
        # Residual of each frame: the mean is interpolated at the frame's position on the path.
        first, last = visits[k], visits[k + 1]
        length = max(path[last] - path[first], 1e-12)
        residuals = np.empty((last - first, dims))
        for f in range(first, last):
            # Places are at the middles of equal parts of the path, hence - 0.5.
            phase = (path[f] - path[first]) / length * places - 0.5
            low = min(max(int(np.floor(phase)), 0), places - 1)
            high = min(low + 1, places - 1)
            share = min(max(phase - low, 0.0), 1.0)
            for d in range(dims):
                fitted = mean[low, d] * (1 - share) + mean[high, d] * share
                residuals[f - first, d] = poses[f, d] - size * fitted
        # Variances of residuals and of poses. The latter starts above 0, to avoid division by 0.
        residual, variance = 0.0, 1e-12
        for d in range(dims):
            expected[d] = rest[d] = 0.0
            for f in range(first, last):
                expected[d] += poses[f, d] / (last - first)
                rest[d] += residuals[f - first, d] / (last - first)
            for f in range(first, last):
                residual += (residuals[f - first, d] - rest[d]) ** 2
                variance += (poses[f, d] - expected[d]) ** 2
        noise = (count - 1) / count  # correction for the noise of a mean of few repetitions
        # Limited to 1: a repetition that does not fit at all is unexplained. Weighted by frames.
        left += min(residual * noise / variance, 1.0) * (last - first)
    return 1 - left / (visits[-1] - visits[0])


@njit("float64(float64[:, ::1], float64[::1], int64, int64)", **SUMS)
def _measure_residual(rows, total, start, stop):
    """Return the sum of squares of rows that the scaled mean of the other rows does not explain.

    ``total`` is the sum of the rows from start to stop.
    """
    count = stop - start
    left = 0.0
    for k in range(start, stop):
        product = mean_square = square = 0.0
        for e in range(rows.shape[1]):
            mean = (total[e] - rows[k, e]) / (count - 1)
            product += mean * rows[k, e]
            mean_square += mean * mean
            square += rows[k, e] * rows[k, e]
        # Residual of the best factor, corrected for the noise of a mean of few rows.
        left += (square - max(product, 0.0) ** 2 / max(mean_square, 1e-12)) * (count - 1) / count
    return left


@njit("float64(float64[:, :, ::1])", **OPTIONS)
def find_best_parting(centered):
    """Find the best split into first and last repetitions, each described by its own mean.

    Return the residual of two means as a share of that of one mean; 1 without a split.
    """
    count = len(centered)
    # Cumulative sums, so that the sum of a range is one difference.
    rows = centered.copy().reshape(count, -1)
    sums = np.zeros((count + 1, rows.shape[1]))
    for k in range(count):
        for e in range(rows.shape[1]):
            sums[k + 1, e] = sums[k, e] + rows[k, e]
    # Added to both residuals, so that nearly equal repetitions are one movement.
    rough = 1e-12
    for k in range(count):
        for e in range(rows.shape[1]):
            rough += ROUGH * rows[k, e] * rows[k, e]
    one_mean = _measure_residual(rows, sums[count], 0, count)
    best = 1.0
    for cut in range(MIN_COUNT, count - MIN_COUNT + 1):
        # Residuals of both parts, each with at least MIN_COUNT repetitions.
        two_means = _measure_residual(rows, sums[cut], 0, cut)
        two_means += _measure_residual(rows, sums[count] - sums[cut], cut, count)
        best = min(best, (two_means + rough) / (one_mean + rough))
    return best


@njit("float64(float32[:, ::1], int64, int64, int64)", **SUMS)
def measure_spread(view, start, stop, most):
    """Return the cost of a span: half the mean distance of its samples, times their number.

    It is estimated from at most ``most`` samples.
    """
    stop = min(stop, len(view))
    count = min(most, stop - start)
    total = 0.0
    for i in range(count):
        for j in range(i):
            # Evenly spaced samples of the span.
            a, b = start + i * (stop - start) // count, start + j * (stop - start) // count
            square = 0.0
            for d in range(view.shape[1]):
                difference = view[a, d] - view[b, d]
                square += difference * difference
            total += np.sqrt(square)
    # The mean over ordered pairs is 2 * total / count²; the cost is half of that per sample.
    return (stop - start) * total / max(count * count, 1)


@njit("float64[:, ::1](float64[:, :, ::1])", **SUMS)
def measure_similarities(movements):
    """Return the similarity of pairs of movements (movements, places, dims) at the best phase.

    It is 1 - squared distance / sum of variances.
    """
    count, places, dims = movements.shape
    variances = np.zeros(count)
    for k in range(count):
        for d in range(dims):
            mean = 0.0
            for p in range(places):
                mean += movements[k, p, d] / places
            for p in range(places):
                variances[k] += (movements[k, p, d] - mean) ** 2
    # Try each phase: a circular shift of one movement against the other.
    similarities = np.ones((count, count))
    for k in range(count):
        for other in range(k):
            min_distance = np.inf
            for shift in range(places):
                distance = 0.0
                for p in range(places):
                    for d in range(dims):
                        difference = movements[k, (p + shift) % places, d] - movements[other, p, d]
                        distance += difference * difference
                min_distance = min(min_distance, distance)
            similarity = 1 - min_distance / max(variances[k] + variances[other], 1e-12)
            similarities[k, other] = similarities[other, k] = similarity
    return similarities
