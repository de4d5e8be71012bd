"""Compiled loops that divide a recording into actions.

Bands are those of ``_recurrence_kernels``. Naive twins are in ``tests/naive.py``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._compiled import OPTIONS

SUMS = {**OPTIONS, "fastmath": {"reassoc", "contract"}}


@njit("int64[::1](float32[:, ::1], float64, int64)", **OPTIONS)
def change_points(similarity, penalty, min_length):
    """Borders of the segments whose samples are most similar, ends included.

    Minimises, by dynamic programming, the sum over segments of
    ``length - (sum of similarities of all pairs) / length + penalty``. No
    segment is longer than the band is wide; where that leaves no division,
    there is one segment.
    """
    samples, width = similarity.shape
    best = np.full(samples + 1, np.inf)
    best[0] = 0
    before = np.zeros(samples + 1, np.int64)
    # row_sums[s]: similarity of s to itself, and twice those to the later samples of the segment.
    row_sums = np.zeros(samples)
    inverse = np.empty(samples + 1)
    for length in range(1, samples + 1):
        inverse[length] = 1 / length
    for end in range(1, samples + 1):
        last = end - 1
        first = max(0, end - width)
        row_sums[last] = similarity[last, 0]
        for start in range(first, last):
            row_sums[start] += 2 * similarity[start, last - start]
        inside = 0.0
        for start in range(last, first - 1, -1):
            inside += row_sums[start]
            length = end - start
            if length >= min_length or length == samples:
                cost = best[start] + length - inside * inverse[length] + penalty
                if cost < best[end]:
                    best[end] = cost
                    before[end] = start
    borders = [samples]
    while borders[-1] > 0:
        borders.append(before[borders[-1]])
    return np.array(borders[::-1], dtype=np.int64)


@njit("void(float32[:, ::1], int64[::1], int64, int64, int64, float64[:, ::1])", **SUMS)
def class_affinities(similarity, labels, gap, start, stop, affinity):
    """Mean similarity of each sample to the samples of each class, within the band and off the gap.

    Zero where none of the class is within reach.
    """
    samples, width = similarity.shape
    counts = np.empty(affinity.shape[1], np.int64)
    until = np.empty(samples, np.int64)  # where another class than that of the sample begins
    until[samples - 1] = samples
    for j in range(samples - 2, -1, -1):
        until[j] = until[j + 1] if labels[j] == labels[j + 1] else j + 1
    for i in range(start, stop):
        affinity[i] = 0
        counts[:] = 0
        first, end = max(0, i - width + 1), min(samples, i + width)
        while first < end:
            last = min(until[first], end)
            before, after = min(last, i - gap), max(first, i + gap + 1)
            total = 0.0
            for j in range(first, before):
                total += similarity[j, i - j]
            for j in range(after, last):
                total += similarity[i, j - i]
            affinity[i, labels[first]] += total
            counts[labels[first]] += max(before - first, 0) + max(last - after, 0)
            first = last
        for c in range(len(counts)):
            affinity[i, c] /= max(counts[c], 1)


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


@njit("void(float32[:, ::1], int64[::1], float64[:, ::1], float64[:, ::1])", **SUMS)
def sum_similarities(similarity, labels, sums, counts):
    """Adds the similarities of the samples of each two classes, and how many pairs there are.

    Over all ordered pairs within the band, a sample with itself among them; samples of
    class -1 count nowhere.
    """
    samples, width = similarity.shape
    for i in range(samples):
        if labels[i] >= 0:
            for j in range(i, min(samples, i + width)):
                if labels[j] >= 0:
                    sums[labels[i], labels[j]] += similarity[i, j - i]
                    counts[labels[i], labels[j]] += 1
                    if j > i:
                        sums[labels[j], labels[i]] += similarity[i, j - i]
                        counts[labels[j], labels[i]] += 1
