"""Compiled loops of the ``kineme`` method, on bands along the diagonal.

Bands are stored by row and lag. A two-sided band holds the pair (i, j) at
``[i, j - i + width]``, a one-sided band at ``[i, j - i]`` for j from i on.
Naive twins are in ``tests/naive.py``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._compiled import OPTIONS

SUMS = {**OPTIONS, "fastmath": {"reassoc", "contract"}}
FAR = np.float32(np.inf)


@njit("void(float32[:, ::1], int64, int64, int64, int64, float32[:, ::1])", **SUMS)
def nearest_in_bins(features, step, width, start, stop, near):
    """Distances from every ``step``-th frame to the nearest frame of each bin around it.

    Row i is frame ``i step``; bin j holds the ``step`` frames around frame
    ``j step``. Fills rows ``[start, stop)`` of a two-sided band; pairs beyond
    the ends are infinite.
    """
    frames, dims = features.shape
    bins = near.shape[0]
    reach = step // 2
    for i in range(start, stop):
        row = features[i * step]
        for lag in range(-width, width + 1):
            j = i + lag
            nearest = FAR
            if 0 <= j < bins:
                for f in range(max(0, j * step - reach), min(frames, j * step + step - reach)):
                    square = np.float32(0)
                    for d in range(dims):
                        difference = row[d] - features[f, d]
                        square += difference * difference
                    nearest = min(nearest, square)
            near[i, lag + width] = np.sqrt(nearest)


@njit("void(float32[:, ::1], int64, int64, int64, float32[:, ::1])", **OPTIONS)
def blur_rows(near, blur, start, stop, blurred):
    """Least value of each row within ``blur`` lags, in rows ``[start, stop)``.

    The window is cut into blocks of its own size: every window is the end of
    one block and the start of the next (van Herk 1992).
    """
    lags = near.shape[1]
    size = 2 * blur + 1
    padded = np.full(lags + 2 * size, FAR)
    from_start = padded.copy()
    to_end = padded.copy()
    for i in range(start, stop):
        padded[blur : blur + lags] = near[i]
        for p in range(len(padded)):
            from_start[p] = padded[p] if p % size == 0 else min(from_start[p - 1], padded[p])
        for p in range(len(padded) - 1, -1, -1):
            last = p % size == size - 1 or p == len(padded) - 1
            to_end[p] = padded[p] if last else min(to_end[p + 1], padded[p])
        for lag in range(lags):
            blurred[i, lag] = min(to_end[lag], from_start[lag + size - 1])


@njit(
    "void(float32[:, ::1], int64, int64, int64, int64, float32, float32, float32[::1])", **OPTIONS
)
def local_scales(blurred, gap, rank, start, stop, low, high, scales):
    """For each row the ``rank``-th smallest symmetric distance beyond the gap, clipped."""
    bins, lags = blurred.shape
    width = lags // 2
    row = np.empty(lags, np.float32)
    for i in range(start, stop):
        count = 0
        for lag in range(-width, width + 1):
            j = i + lag
            if abs(lag) > gap and 0 <= j < bins:
                distance = max(blurred[i, lag + width], blurred[j, width - lag])
                if distance < high:
                    row[count] = distance
                    count += 1
        scales[i] = high
        if count > rank:
            scales[i] = max(low, np.partition(row[:count], rank)[rank])


@njit("void(float32[:, ::1], float32[::1], float32, int64, int64, float32[:, ::1])", **SUMS)
def similarities(blurred, scales, softness, start, stop, similarity):
    """Similarity of each pair, from 0 to 1, as a one-sided band."""
    bins, lags = blurred.shape
    width = lags // 2
    for i in range(start, stop):
        for lag in range(width + 1):
            similarity[i, lag] = 0
            if i + lag < bins:
                distance = max(blurred[i, width + lag], blurred[i + lag, width - lag])
                unit = softness * softness * scales[i] * scales[i + lag]
                similarity[i, lag] = np.exp(-distance * distance / unit)


@njit("int64[::1](float32[:, ::1], float64, int64)", **OPTIONS)
def change_points(similarity, penalty, min_length):
    """Borders of the segments whose frames are most alike, ends included.

    Minimises, by dynamic programming, the sum over segments of
    ``length - (sum of similarities of all pairs) / length + penalty``. No
    segment is longer than the band is wide.
    """
    bins, width = similarity.shape
    best = np.full(bins + 1, np.inf)
    best[0] = 0
    before = np.zeros(bins + 1, np.int64)
    # row_sums[s]: similarities of s with the later bins of the segment so far.
    row_sums = np.zeros(bins)
    for end in range(1, bins + 1):
        last = end - 1
        inside = 0.0
        for start in range(last, max(-1, last - width), -1):
            if start < last:
                row_sums[start] += similarity[start, last - start]
            inside += similarity[start, 0] + 2 * row_sums[start]
            length = end - start
            if length >= min_length or start == 0:
                cost = best[start] + length - inside / length + penalty
                if cost < best[end]:
                    best[end] = cost
                    before[end] = start
    borders = [bins]
    while borders[-1] > 0:
        borders.append(before[borders[-1]])
    return np.array(borders[::-1], dtype=np.int64)


@njit("float64(float32[:, ::1], float32[::1], int64, int64, int64, int64, int64, float64)", **SUMS)
def coverage(near, scales, g_start, g_stop, h_start, h_stop, gap, softness):
    """How well the frames of g recur in h, ``gap`` or more away: mean similarity, 0 to 1."""
    width = near.shape[1] // 2
    total = 0.0
    for i in range(g_start, g_stop):
        nearest = FAR
        for j in range(max(h_start, i - width), min(h_stop, i + width + 1)):
            if abs(j - i) > gap:
                nearest = min(nearest, near[i, j - i + width])
        if nearest < FAR:
            total += np.exp(-((nearest / (softness * scales[i])) ** 2))
    return total / (g_stop - g_start)


@njit("float64(float32[:, ::1], int64, int64, int64, int64, int64)", **SUMS)
def mean_similarity(similarity, g_start, g_stop, h_start, h_stop, gap):
    """Mean similarity of the pairs of g and h that lie apart by more than the gap."""
    width = similarity.shape[1]
    total = 0.0
    count = 0
    for i in range(g_start, g_stop):
        for j in range(h_start, h_stop):
            lag = abs(j - i)
            if gap < lag < width:
                total += similarity[min(i, j), lag]
                count += 1
    return total / count if count else 0.0


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


@njit("void(float32[:, ::1], int64[::1], int64, int64, int64, int64, float64[:, ::1])", **SUMS)
def class_affinities(similarity, labels, gap, min_count, start, stop, affinity):
    """Mean similarity of each bin to the bins of each class, within the band and off the gap.

    Zero where fewer than ``min_count`` bins of the class are within reach.
    """
    bins, width = similarity.shape
    counts = np.empty(affinity.shape[1], np.int64)
    for i in range(start, stop):
        affinity[i] = 0
        counts[:] = 0
        for j in range(max(0, i - width + 1), min(bins, i + width)):
            lag = abs(j - i)
            if lag > gap:
                affinity[i, labels[j]] += similarity[min(i, j), lag]
                counts[labels[j]] += 1
        for c in range(len(counts)):
            affinity[i, c] = affinity[i, c] / counts[c] if counts[c] >= min_count else 0.0


@njit("int64[::1](float64[:, ::1], float64)", **OPTIONS)
def cheapest_labels(costs, switch_cost):
    """One label per row: least sum of costs plus ``switch_cost`` for every change (Viterbi)."""
    n, k = costs.shape
    arrival = costs[0].copy()
    before = np.empty((n, k), np.int32)
    for t in range(1, n):
        best = np.argmin(arrival)
        switched = arrival[best] + switch_cost
        for c in range(k):
            before[t, c] = c
            if switched < arrival[c]:
                before[t, c] = best
                arrival[c] = switched
            arrival[c] += costs[t, c]
    labels = np.empty(n, np.int64)
    labels[n - 1] = np.argmin(arrival)
    for t in range(n - 1, 0, -1):
        labels[t - 1] = before[t, labels[t]]
    return labels


@njit("float32[::1](float32[:, ::1], int64, int64, int64)", **OPTIONS)
def recurrence_distances(near, start, stop, gap):
    """For each bin of a segment the distance to its nearest other bin beyond the gap."""
    width = near.shape[1] // 2
    nearest = np.full(stop - start, FAR)
    for i in range(start, stop):
        for j in range(max(start, i - width), min(stop, i + width + 1)):
            if abs(j - i) > gap:
                nearest[i - start] = min(nearest[i - start], near[i, j - i + width])
    return nearest


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
