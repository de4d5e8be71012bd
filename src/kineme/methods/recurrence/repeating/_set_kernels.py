"""Compiled loops over warping paths: the sets of stretches that recur as each other.

Paths are those of ``_occurrence_kernels``, seen from either side. Naive twins are in
``tests/naive.py``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._compiled import OPTIONS


@njit(
    "Tuple((float64, int64))(int64, int64, int64[::1], int64[::1], float64[::1], float64[::1],"
    " int64[::1], int64[::1], int64[::1], float64, int64[:, ::1], float64[::1])",
    **OPTIONS,
)
def recurrences(
    start, stop, starts, ptr, partners, sums, row_ptr, row_paths, room, cover, spans, gains
):
    """Where ``[start, stop)`` recurs, written to spans and gains: their sum and their number.

    Each is the partner of what a path covers of it, ``cover`` at least, and that comes
    after it; the strongest are first, none reaches into another, into itself or into
    samples that are not free. ``room`` is how many are before each.
    """
    length = stop - start
    middle = (start + stop) // 2
    n = 0
    for path in row_paths[row_ptr[middle] : row_ptr[middle + 1]]:
        first = starts[path]
        base = ptr[path] - first
        low, high = max(start, first), min(stop, first + ptr[path + 1] - ptr[path])
        if high - low < cover * length:
            continue
        while low < high and low > first and sums[base + low] <= sums[base + low - 1]:
            low += 1
        while high - 1 > low and sums[base + high - 1] <= sums[base + high - 2]:
            high -= 1
        if high - low < cover * length:
            continue
        score = sums[base + high - 1] - (sums[base + low - 1] if low > first else 0.0)
        begin, end = round(partners[base + low]), round(partners[base + high - 1]) + 1
        if score > 0 and (end <= start or begin >= stop) and 2 * (end - begin) >= length:
            place = n  # among those found before, the strongest first
            while place > 0 and gains[place - 1] < score:
                for column in range(4):
                    spans[place, column] = spans[place - 1, column]
                gains[place] = gains[place - 1]
                place -= 1
            spans[place, 0], spans[place, 1], gains[place] = begin, end, score
            spans[place, 2], spans[place, 3] = low, high
            n += 1
    total, count = 0.0, 0
    for k in range(n):
        begin, end = spans[k, 0], spans[k, 1]
        clear = 5 * (room[end] - room[begin]) >= 4 * (end - begin)
        for other in range(count):
            clear = clear and (end <= spans[other, 0] or begin >= spans[other, 1])
        if clear:
            for column in range(4):
                spans[count, column] = spans[k, column]
            gains[count] = gains[k]
            total += gains[k]
            count += 1
    return total, count


@njit("int64(float64[::1], int64)", **OPTIONS)
def largest(values, count):
    """The place of the largest of the first ``count`` values, the first if there are several."""
    best = 0
    for i in range(1, count):
        if values[i] > values[best]:
            best = i
    return best


@njit("void(boolean[::1], int64[::1])", **OPTIONS)
def count_before(marks, counts):
    """How many marks are set before each place, and in all."""
    counts[0] = 0
    for i in range(len(marks)):
        counts[i + 1] = counts[i] + marks[i]


@njit(
    "Tuple((int64[:, ::1], float64[::1], int64[::1]))(int64[::1], int64[::1], int64[::1],"
    " float64[::1], float64[::1], int64[::1], int64[::1], boolean[::1], float64)",
    **OPTIONS,
)
def best_sets(lengths, starts, ptr, partners, sums, row_ptr, row_paths, free, cover):
    """Spans, gains and set of each occurrence: of all stretches the one that gains most, and so on.

    Gains hardly ever rise as samples are taken, so that old ones do for all but the
    best (lazy greedy, after Minoux 1978). Changes ``free``.
    """
    n, sizes = len(free), len(lengths)
    most = 0
    for i in range(n):
        most = max(most, row_ptr[i + 1] - row_ptr[i])
    spans, gains = np.empty((most, 4), np.int64), np.empty(most)
    room = np.empty(n + 1, np.int64)
    count_before(free, room)
    of_stretch = np.zeros((n, sizes))
    known = np.zeros((n, sizes), np.int64)
    best = np.zeros(n)
    found = [(0, 0, 0.0, 0)]
    rank = 0
    for start in range(n):
        for k in range(sizes):
            stop = start + lengths[k]
            if stop <= n and room[stop] - room[start] == lengths[k]:
                of_stretch[start, k] = recurrences(
                    start, stop, starts, ptr, partners, sums, row_ptr, row_paths, room, cover,
                    spans, gains,
                )[0]  # fmt: skip
        best[start] = of_stretch[start, largest(of_stretch[start], sizes)]
    while n > 0:
        start = largest(best, n)
        if best[start] <= 0:
            break
        k = largest(of_stretch[start], sizes)
        stop = start + lengths[k]
        total, count = recurrences(
            start, stop, starts, ptr, partners, sums, row_ptr, row_paths, room, cover, spans, gains
        )
        if known[start, k] == rank and count > 0:
            covered, stop = stop, start  # what recurs of it
            for other in range(count):
                covered, stop = min(covered, spans[other, 2]), max(stop, spans[other, 3])
            found.append((covered, stop, gains[largest(gains, count)], rank))
            free[covered:stop] = False
            for other in range(count):
                found.append((spans[other, 0], spans[other, 1], gains[other], rank))
                free[spans[other, 0] : spans[other, 1]] = False
            rank += 1
            count_before(free, room)
            for begin in range(n):
                for size in range(sizes):
                    if of_stretch[begin, size] > 0:
                        taken = lengths[size] - room[begin + lengths[size]] + room[begin]
                        of_stretch[begin, size] *= taken == 0
                best[begin] = of_stretch[begin, largest(of_stretch[begin], sizes)]
        else:
            of_stretch[start, k], known[start, k] = total, rank
            best[start] = of_stretch[start, largest(of_stretch[start], sizes)]
    places = np.empty((len(found) - 1, 2), np.int64)
    scores, ranks = np.empty(len(places)), np.empty(len(places), np.int64)
    for k in range(len(places)):
        places[k, 0], places[k, 1], scores[k], ranks[k] = found[k + 1]
    return places, scores, ranks
