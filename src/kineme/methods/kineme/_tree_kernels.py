"""Compiled loops for change points, distances of samples, and agglomerative clustering.

Naive versions of the kernels are in ``tests/helpers/naive``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS

SUMS = {**OPTIONS, "fastmath": {"reassoc", "contract"}}


@njit("void(float32[:, ::1], float64, int64, int64, float32[:, ::1])", **SUMS)
def compute_similarity_band(features, unit, start, stop, similarity):
    """Set ``similarity[i, j - i] = 1 - |x_i - x_j| / unit`` for the rows from start to stop."""
    n, width = similarity.shape
    # Single precision throughout: doubles take twice as long.
    one, units = np.float32(1.0), np.float32(1.0 / unit)
    for i in range(start, stop):
        for lag in range(width):
            j = i + lag
            if j >= n:
                # Beyond the last sample.
                similarity[i, lag] = 0.0
                continue
            square = np.float32(0.0)
            for d in range(features.shape[1]):
                difference = features[i, d] - features[j, d]
                square += difference * difference
            similarity[i, lag] = one - np.sqrt(square) * units


@njit("float64[::1](float32[:, ::1], int64[::1], int64)", **OPTIONS)
def measure_near_distances(features, chosen, width):
    """Return the distances of pairs of chosen samples that are less than `width` apart in time."""
    # `chosen` is ascending. First pass: count the pairs.
    count = 0
    for i in range(len(chosen)):
        for j in range(i + 1, len(chosen)):
            if chosen[j] - chosen[i] >= width:
                break
            count += 1
    distances = np.empty(count)
    pair = 0
    for i in range(len(chosen)):
        for j in range(i + 1, len(chosen)):
            if chosen[j] - chosen[i] >= width:
                break
            square = 0.0
            for d in range(features.shape[1]):
                difference = np.float64(features[chosen[i], d]) - features[chosen[j], d]
                square += difference * difference
            distances[pair] = np.sqrt(square)
            pair += 1
    return distances


@njit("int64[::1](float32[:, ::1], float64)", **OPTIONS)
def find_change_points(similarity, penalty):
    """Return the borders of the cheapest division into segments of similar samples, with ends.

    Minimise, by dynamic programming, the sum over segments of
    ``length - (sum of similarities of all pairs) / length + penalty``. The width of the band
    limits the length of a segment.
    """
    samples, width = similarity.shape
    best = np.full(samples + 1, np.inf)
    best[0] = 0
    before = np.zeros(samples + 1, np.int64)
    # row_sums[s]: similarity of s to itself, plus twice those to later samples of the segment.
    row_sums = np.zeros(samples)
    inverse = np.empty(samples + 1)
    for length in range(1, samples + 1):
        inverse[length] = 1 / length
    for end in range(1, samples + 1):
        # Add the last sample to the sums of all samples within the band.
        last = end - 1
        first = max(0, end - width)
        row_sums[last] = similarity[last, 0]
        for start in range(first, last):
            row_sums[start] += 2 * similarity[start, last - start]
        # Find the cheapest last segment; the sum of its similarities grows as its start moves back.
        inside = 0.0
        for start in range(last, first - 1, -1):
            inside += row_sums[start]
            length = end - start
            cost = best[start] + length - inside * inverse[length] + penalty
            if cost < best[end]:
                best[end] = cost
                before[end] = start
    # Backtrack from the last border.
    borders = [samples]
    while borders[-1] > 0:
        borders.append(before[borders[-1]])
    return np.array(borders[::-1], dtype=np.int64)


@njit("void(float32[:, ::1], int64[::1], int64[::1], int64, int64, float64[:, ::1])", **SUMS)
def compute_mean_distances(features, chosen, borders, start, stop, means):
    """Compute the mean distances between samples of two groups, for the rows from start to stop.

    Group g has ``chosen[borders[g]:borders[g + 1]]``. Only the upper triangle is written, as the
    matrix is symmetric.
    """
    for g in range(start, stop):
        for h in range(g, len(borders) - 1):
            total = 0.0
            for a in range(borders[g], borders[g + 1]):
                for b in range(borders[h], borders[h + 1]):
                    square = 0.0
                    for d in range(features.shape[1]):
                        difference = features[chosen[a], d] - features[chosen[b], d]
                        square += difference * difference
                    total += np.sqrt(square)
            pairs = (borders[g + 1] - borders[g]) * (borders[h + 1] - borders[h])
            means[g, h] = total / pairs


@njit("float64(float64[:, ::1], float64[::1], int64, int64)", **OPTIONS)
def _measure_distance(sums, lengths, g, h):
    """Return the mean distance of two clusters, less half of the mean distance within them.

    ``sums`` are summed distances between samples of two clusters, ``lengths`` numbers of samples.
    """
    # `sums[g, g]` is the sum over all n² ordered pairs, including each sample with itself.
    within = sums[g, g] / lengths[g] ** 2 + sums[h, h] / lengths[h] ** 2
    return sums[g, h] / (lengths[g] * lengths[h]) - within / 4


@njit(
    "void(float64[:, ::1], float64[::1], int64[::1], int64, int64[::1], float64[::1])",
    **OPTIONS,
)
def _find_nearest(sums, lengths, owner, g, nearest, gaps):
    """Set ``nearest[g]`` to the cluster nearest to cluster g, and ``gaps[g]`` to its distance."""
    gaps[g] = np.inf
    # A cluster exists while it owns itself.
    for h in range(len(lengths)):
        if h != g and owner[h] == h:
            distance = _measure_distance(sums, lengths, g, h)
            if distance < gaps[g]:
                gaps[g] = distance
                nearest[g] = h


@njit(
    "float64(float64[:, ::1], float64[::1], int64, float64, float64, int64[::1])",
    **OPTIONS,
)
def find_cheapest_grouping(sums, lengths, most, segment_cost, cluster_cost, labels):
    """Find the cheapest grouping of segments, write it to `labels`, and return its cost.

    Merge the two nearest clusters repeatedly (see `_measure_distance`). The cost of a grouping is
    half of the distances within clusters, plus a price for each run of segments of one cluster
    and for each cluster. It has at most `most` clusters. `sums` (summed distances between
    segments) and `lengths` are overwritten.
    """
    # For each cluster: its first segment, the nearest other cluster, and the distance to it.
    k = len(lengths)
    owner = np.arange(k)
    nearest = np.zeros(k, np.int64)
    gaps = np.full(k, np.inf)
    for g in range(k):
        _find_nearest(sums, lengths, owner, g, nearest, gaps)
    cheapest = np.inf
    for clusters in range(k, 0, -1):
        # Cost of this grouping.
        if clusters <= most:
            cost = cluster_cost * clusters
            for g in range(k):
                if owner[g] == g:
                    cost += sums[g, g] / (2 * lengths[g])
                # Neighbours of one cluster count as one segment.
                if g == 0 or owner[g] != owner[g - 1]:
                    cost += segment_cost
            if cost < cheapest:
                cheapest = cost
                for g in range(k):
                    labels[g] = owner[g]
        if clusters == 1:
            break
        # Merge the two nearest clusters, h into g; the smaller number stays the owner.
        g = int(np.argmin(gaps))
        h = nearest[g]
        if h < g:
            g, h = h, g
        lengths[g] += lengths[h]
        # h is gone: it is never chosen by `argmin` again.
        gaps[h] = np.inf
        for other in range(k):
            sums[g, other] += sums[h, other]
            if owner[other] == h:
                owner[other] = g
        for other in range(k):
            sums[other, g] += sums[other, h]
        # Only distances to g have changed.
        _find_nearest(sums, lengths, owner, g, nearest, gaps)
        for other in range(k):
            if owner[other] != other or other == g:
                continue
            if nearest[other] in (g, h):
                _find_nearest(sums, lengths, owner, other, nearest, gaps)
                continue
            distance = _measure_distance(sums, lengths, other, g)
            if distance < gaps[other]:  # a union can be nearer than both of its parts
                gaps[other] = distance
                nearest[other] = g
    return cheapest
