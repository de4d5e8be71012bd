"""Compiled loops of the description of a segment by one repetition, and similarity of movements.

Naive twins are in ``tests/helpers/naive``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS

SUMS = {**OPTIONS, "fastmath": {"reassoc", "contract"}}
LEAST = 2
"""Repetitions of a movement, at least."""
ROUGH = 0.02
"""Share of their variance that repetitions of one movement differ by in any case."""


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
def share_by_times(
    visits, fps, max_repetition, chance_period, uneven, chance_count, chance_duration
):
    """Return the share that a division saves at most, by number and durations of repetitions."""
    count = len(visits)
    # Two visits enclose one repetition, which nothing else can explain.
    if count < 3:
        return 0.0
    durations = np.diff(visits) / fps
    if durations.max() > max_repetition:
        return 0.0
    fast = min(chance_period / durations.mean(), 1.0) ** 2
    # Logarithms, since twice as long and half as long are equally uneven.
    even = 1 - min(np.log(durations).std() / uneven, 1.0) ** 2
    chance = min(chance_count, chance_duration / durations.mean())
    return even * (1 - max(fast, min(chance / count, 1.0)))


@njit("float64(float64[:, ::1], float64[::1], int64[::1], float64[:, :, ::1])", **SUMS)
def explain_variance(poses, path, visits, centered):
    """Return share of the variance of repetitions that the mean of the others explains, in time.

    The variance is about the mean of each repetition. The mean of the others is scaled by the
    factor that fits best. ``centered`` are the repetitions, each with a mean of 0.
    """
    count, places, dims = centered.shape
    total = centered.sum(axis=0)
    mean = np.empty((places, dims))
    expected, rest = np.empty(dims), np.empty(dims)
    left = 0.0
    for k in range(count):
        # The mean of the others, and its best size for this repetition.
        product = mean_square = 0.0
        for p in range(places):
            for d in range(dims):
                # The sum of all, less itself, is that of the others.
                mean[p, d] = (total[p, d] - centered[k, p, d]) / (count - 1)
                product += centered[k, p, d] * mean[p, d]
                mean_square += mean[p, d] * mean[p, d]
        # A negative factor would turn the mean round: 0 is the least.
        size = max(product, 0.0) / max(mean_square, 1e-12)
        # What is left of each frame: the mean is interpolated at the place that it has reached.
        first, last = visits[k], visits[k + 1]
        length = max(path[last] - path[first], 1e-12)
        residuals = np.empty((last - first, dims))
        for f in range(first, last):
            # Places are at the middles of their parts, hence half a place less.
            phase = (path[f] - path[first]) / length * places - 0.5
            low = min(max(int(np.floor(phase)), 0), places - 1)
            high = min(low + 1, places - 1)
            share = min(max(phase - low, 0.0), 1.0)
            for d in range(dims):
                fitted = mean[low, d] * (1 - share) + mean[high, d] * share
                residuals[f - first, d] = poses[f, d] - size * fitted
        # Variances of what is left and of the poses, each about its mean.
        # The variance begins just above 0, so that it can divide.
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
        # A repetition that the mean makes worse counts as unexplained; frames weigh the same.
        left += min(residual * noise / variance, 1.0) * (last - first)
    return 1 - left / (visits[-1] - visits[0])


@njit("float64(float64[:, ::1], float64[::1], int64, int64)", **SUMS)
def _measure_residual(rows, total, start, stop):
    """Squares that the best multiple of the mean of the others leaves of rows, summed over rows.

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
        # Squares left by the best multiple, corrected for the noise of the mean of few others.
        left += (square - max(product, 0.0) ** 2 / max(mean_square, 1e-12)) * (count - 1) / count
    return left


@njit("float64(float64[:, :, ::1])", **OPTIONS)
def find_best_parting(centered):
    """What two means leave of repetitions, as a share of what one mean leaves; the least share.

    One mean is of the first repetitions, the other of the last. 1 where there are too few.
    """
    count = len(centered)
    # Sums up to each repetition, so that a total is one difference.
    rows = centered.copy().reshape(count, -1)
    sums = np.zeros((count + 1, rows.shape[1]))
    for k in range(count):
        for e in range(rows.shape[1]):
            sums[k + 1, e] = sums[k, e] + rows[k, e]
    # Added to both, so that repetitions that are nearly equal are one movement.
    rough = 1e-12
    for k in range(count):
        for e in range(rows.shape[1]):
            rough += ROUGH * rows[k, e] * rows[k, e]
    one_mean = _measure_residual(rows, sums[count], 0, count)
    best = 1.0
    for cut in range(LEAST, count - LEAST + 1):
        # Both parts have as many repetitions as a movement needs.
        two_means = _measure_residual(rows, sums[cut], 0, cut)
        two_means += _measure_residual(rows, sums[count] - sums[cut], cut, count)
        best = min(best, (two_means + rough) / (one_mean + rough))
    return best


@njit("float64(float32[:, ::1], int64, int64, int64)", **SUMS)
def measure_spread(view, start, stop, most):
    """Return cost of a span: half the mean distance of two samples, times its number of samples.

    It is estimated from ``most`` of its samples at most.
    """
    stop = min(stop, len(view))
    count = min(most, stop - start)
    total = 0.0
    for i in range(count):
        for j in range(i):
            # Evenly spread samples of the span.
            a, b = start + i * (stop - start) // count, start + j * (stop - start) // count
            square = 0.0
            for d in range(view.shape[1]):
                difference = view[a, d] - view[b, d]
                square += difference * difference
            total += np.sqrt(square)
    # The mean over all ordered pairs is twice the sum over count²; half of it is left.
    return (stop - start) * total / max(count * count, 1)


@njit("float64[:, ::1](float64[:, :, ::1])", **SUMS)
def measure_similarities(movements):
    """Similarity of each two movements (movements, places, dims) at the phase that fits best.

    It is 1 minus their squared distance over the sum of their variances.
    """
    count, places, dims = movements.shape
    varied = np.zeros(count)
    for k in range(count):
        for d in range(dims):
            mean = 0.0
            for p in range(places):
                mean += movements[k, p, d] / places
            for p in range(places):
                varied[k] += (movements[k, p, d] - mean) ** 2
    # Each phase in turn: the one is shifted by so many places against the other.
    found = np.ones((count, count))
    for k in range(count):
        for other in range(k):
            least = np.inf
            for by in range(places):
                apart = 0.0
                for p in range(places):
                    for d in range(dims):
                        # Phases go round: beyond the end is the beginning.
                        difference = movements[k, (p + by) % places, d] - movements[other, p, d]
                        apart += difference * difference
                least = min(least, apart)
            similarity = 1 - least / max(varied[k] + varied[other], 1e-12)
            found[k, other] = found[other, k] = similarity
    return found
