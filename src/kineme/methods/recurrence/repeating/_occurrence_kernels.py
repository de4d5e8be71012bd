"""Compiled loops over pairs of samples: warping paths anywhere.

A pair of samples scores ``1 - distance² / scale²`` less what stillness costs, a
path the sum over its pairs; a step that passes over a sample counts its pair one
and a half times. Samples are columns. Naive twins are in ``tests/naive.py``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._compiled import OPTIONS

SUMS = {**OPTIONS, "fastmath": {"reassoc", "contract"}}


@njit("void(float64[:, ::1], float64[::1], int64, int64, float64, float64, float64[::1])", **SUMS)
def pair_scores(samples, costs, i, start, scale, worst, found):
    """Scores of a sample with so many from ``start`` on.

    1 where two are equal, falling with the square of their distance to ``worst``.
    """
    found[:] = 0
    for d in range(len(samples)):
        own, others = samples[d, i], samples[d, start : start + len(found)]
        for j in range(len(found)):
            difference = own - others[j]
            found[j] += difference * difference
    cost, others = costs[i], costs[start : start + len(found)]
    for j in range(len(found)):
        found[j] = max(1 - found[j] / (scale * scale) - (cost + others[j]) / 2, worst)


@njit(
    "Tuple((int64[:, ::1], float64[::1], int64[:, ::1]))(float64[:, ::1], float64[::1],"
    " boolean[::1], int64, int64, int64, float64, float64, float64)",
    **OPTIONS,
)
def local_paths(samples, costs, begins, gap, width, leg, scale, worst, least):
    """First and last pair (i, j, i, j) and score of the best path from each first pair.

    Pairs are ``gap`` to ``width`` samples apart. A path steps by one sample on
    both sides or by two on one of them, never into a sample that ``begins`` a
    stretch, and goes on for as long as its score is above 0. Of those that score
    ``least`` or more, one for each branch of each first pair is kept, at its best.
    Beside its ends is the latest of the pairs that it passed, one after so many samples
    (``leg``), -1 if there is none; these are (i, j, the one before).
    """
    n = len(costs)
    line = np.empty(n)
    scores = np.zeros((3, n))
    firsts = np.zeros((3, n), np.int64)
    records = np.full((3, n), -1, np.int64)
    passes = np.full((3, n), -1, np.int64)
    since = np.zeros((3, n), np.int64)  # the first sample, or that of the latest pair passed
    found = [(0, 0, 0, 0, np.int64(-1), 0.0)]
    passed = [(0, 0, np.int64(-1))]
    for i in range(n):
        row, one, two = i % 3, (i - 1) % 3, (i - 2) % 3
        for j in range(max(i + gap - 3, 0), min(i + gap, n)):
            scores[row, j] = 0
        go, skip = i > 0 and not begins[i], i > 1 and not (begins[i] or begins[i - 1])
        near, far = min(i + gap, n), min(i + width + 1, n)
        pair_scores(samples, costs, i, near, scale, worst, line[near:far])
        for j in range(near, far):
            score = line[j]
            best, source, column = score, -1, -1
            if go and not begins[j]:
                before = scores[one, j - 1]
                if before > 0 and before + score > best:
                    best, source, column = before + score, one, j - 1
                before = scores[one, j - 2]
                if not begins[j - 1] and before > 0 and before + 1.5 * score > best:
                    best, source, column = before + 1.5 * score, one, j - 2
                before = scores[two, j - 1]
                if skip and before > 0 and before + 1.5 * score > best:
                    best, source, column = before + 1.5 * score, two, j - 1
            scores[row, j] = max(best, 0)
            if best <= 0:
                continue
            first, record, latest, start = i * n + j, np.int64(-1), np.int64(-1), i
            if source >= 0:
                first, record = firsts[source, column], records[source, column]
                latest, start = passes[source, column], since[source, column]
            firsts[row, j], records[row, j] = first, record
            if best >= least:
                if record < 0:
                    records[row, j] = len(found)
                    found.append((first // n, first % n, i, j, latest, best))
                elif best > found[record][5]:
                    found[record] = (first // n, first % n, i, j, latest, best)
            if i - start >= leg:
                passed.append((i, j, latest))
                latest, start = np.int64(len(passed) - 2), i
            passes[row, j], since[row, j] = latest, start
    ends = np.empty((len(found) - 1, 5), np.int64)
    totals = np.empty(len(found) - 1)
    for k in range(len(totals)):
        ends[k, 0], ends[k, 1], ends[k, 2], ends[k, 3], ends[k, 4], totals[k] = found[k + 1]
    pairs = np.empty((len(passed) - 1, 3), np.int64)
    for k in range(len(pairs)):
        pairs[k, 0], pairs[k, 1], pairs[k, 2] = passed[k + 1]
    return ends, totals, pairs


@njit(
    "Tuple((float64[::1], float64[::1], float64[::1], float64[::1]))(float64[:, ::1],"
    " float64[::1], int64[::1], float64, float64)",
    **OPTIONS,
)
def follow(samples, costs, ends, scale, worst):
    """The best path between two pairs: its partner of each sample, and its score up to there.

    Both seen from the first side and from the second.
    """
    i0, j0 = ends[0], ends[1]
    rows, columns = ends[2] - i0 + 1, ends[3] - j0 + 1
    scores = np.full((rows, columns), -np.inf)
    steps = np.zeros((rows, columns), np.int8)
    line = np.empty(columns)
    pair_scores(samples, costs, i0, j0, scale, worst, line[:1])
    scores[0, 0] = line[0]
    for i in range(1, rows):
        ahead = rows - 1 - i  # only what can be reached, and from where the end can be
        first = max(1, (i + 1) // 2, columns - 1 - 2 * ahead)
        last = min(columns, 2 * i + 1, columns - (ahead + 1) // 2)
        pair_scores(samples, costs, i0 + i, j0 + first, scale, worst, line[first:last])
        for j in range(first, last):
            score = line[j]
            scores[i, j], steps[i, j] = scores[i - 1, j - 1] + score, 1
            if j > 1 and scores[i - 1, j - 2] + 1.5 * score > scores[i, j]:
                scores[i, j], steps[i, j] = scores[i - 1, j - 2] + 1.5 * score, 2
            if i > 1 and scores[i - 2, j - 1] + 1.5 * score > scores[i, j]:
                scores[i, j], steps[i, j] = scores[i - 2, j - 1] + 1.5 * score, 3
    partners, sums = np.empty(rows), np.empty(rows)
    other_partners, other_sums = np.empty(columns), np.empty(columns)
    i, j = rows - 1, columns - 1
    while True:
        partners[i] = j0 + j
        other_partners[j] = i0 + i
        sums[i] = other_sums[j] = scores[i, j]
        if steps[i, j] == 0:
            return partners, sums, other_partners, other_sums
        if steps[i, j] == 1:
            i, j = i - 1, j - 1
        elif steps[i, j] == 2:
            other_partners[j - 1] = i0 + i - 0.5
            other_sums[j - 1] = (scores[i, j] + scores[i - 1, j - 2]) / 2
            i, j = i - 1, j - 2
        else:
            partners[i - 1] = j0 + j - 0.5
            sums[i - 1] = (scores[i, j] + scores[i - 2, j - 1]) / 2
            i, j = i - 2, j - 1
