"""Compiled loops over warping paths: the sets of stretches that recur as each other.

Paths are those of ``_occurrence_kernels``, seen from either side. Naive twins are in
``tests/naive.py``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._compiled import OPTIONS

# Starts of stretches whose largest gain is known together.
BLOCK = 512


@njit("int64(boolean[::1], int64, int64)", **OPTIONS)
def set_in(marks, start, stop):
    """How many marks of ``[start, stop)`` are set."""
    count = 0
    for i in range(start, stop):
        count += marks[i]
    return count


@njit(
    "Tuple((float64, int64))(int64, int64, int64[::1], int64[::1], float64[::1], float64[::1],"
    " int64[::1], int64[::1], boolean[::1], float64, int64[:, ::1], float64[::1])",
    **OPTIONS,
)
def recurrences(
    start, stop, starts, ptr, partners, sums, row_ptr, row_paths, free, cover, spans, gains
):
    """Where ``[start, stop)`` recurs, written to spans and gains: their sum and their number.

    Each is the partner of what a path covers of it, ``cover`` at least, and that comes
    after it; the strongest are first, none reaches into another, into itself or into
    samples that are not free.
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
        clear = True
        for other in range(count):
            clear = clear and (end <= spans[other, 0] or begin >= spans[other, 1])
        if clear and 5 * set_in(free, begin, end) >= 4 * (end - begin):
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


@njit("void(float64[::1], float64[::1], int64, int64)", **OPTIONS)
def renew(tops, values, start, stop):
    """Have the largest value of each block that holds some of these places."""
    for block in range(start // BLOCK, (stop + BLOCK - 1) // BLOCK):
        first = block * BLOCK
        tops[block] = values[first + largest(values[first:], min(BLOCK, len(values) - first))]


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
    of_stretch = np.zeros((n, sizes))
    known = np.zeros((n, sizes), np.int64)
    best = np.zeros(n)
    found = [(0, 0, 0.0, 0)]
    rank = 0
    for start in range(n):
        for k in range(sizes):
            stop = start + lengths[k]
            if stop <= n and set_in(free, start, stop) == lengths[k]:
                of_stretch[start, k] = recurrences(
                    start, stop, starts, ptr, partners, sums, row_ptr, row_paths, free, cover,
                    spans, gains,
                )[0]  # fmt: skip
        best[start] = of_stretch[start, largest(of_stretch[start], sizes)]
    tops = np.empty((n + BLOCK - 1) // BLOCK)
    renew(tops, best, 0, n)
    while n > 0:
        block = largest(tops, len(tops)) * BLOCK
        start = block + largest(best[block:], min(BLOCK, n - block))
        if best[start] <= 0:
            break
        k = largest(of_stretch[start], sizes)
        stop = start + lengths[k]
        total, count = recurrences(
            start, stop, starts, ptr, partners, sums, row_ptr, row_paths, free, cover, spans, gains
        )
        if known[start, k] == rank and count > 0:
            covered, stop = stop, start  # what recurs of it
            for other in range(count):
                covered, stop = min(covered, spans[other, 2]), max(stop, spans[other, 3])
            found.append((covered, stop, gains[largest(gains, count)], rank))
            for other in range(count):
                found.append((spans[other, 0], spans[other, 1], gains[other], rank))  # noqa: PERF401
            for covered, stop, _, _ in found[-1 - count :]:
                free[covered:stop] = False
                for begin in range(max(covered - lengths[sizes - 1] + 1, 0), stop):
                    for k in range(sizes):  # what reaches into it gains nothing any more
                        of_stretch[begin, k] *= begin + lengths[k] <= covered
                    best[begin] = of_stretch[begin, largest(of_stretch[begin], sizes)]
                renew(tops, best, max(covered - lengths[sizes - 1] + 1, 0), stop)
            rank += 1
        else:
            of_stretch[start, k], known[start, k] = total, rank
            best[start] = of_stretch[start, largest(of_stretch[start], sizes)]
            renew(tops, best, start, start + 1)
    places = np.empty((len(found) - 1, 2), np.int64)
    scores, ranks = np.empty(len(places)), np.empty(len(places), np.int64)
    for k in range(len(places)):
        places[k, 0], places[k, 1], scores[k], ranks[k] = found[k + 1]
    return places, scores, ranks
