"""Compiled loops over pairs of samples: warping paths anywhere, and sets of spans that recur.

A pair of samples scores ``1 - distance² / scale²`` less the mean cost of both. A path scores the
sum over its pairs; a step that passes over a sample counts its pair one and a half times. Samples
are columns. Naive twins are in ``tests/helpers/naive``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS

SUMS = {**OPTIONS, "fastmath": {"reassoc", "contract"}}
BLOCK = 512
"""Starts of spans that share one entry in the table of largest gains."""


@njit("void(float64[:, ::1], float64[::1], int64, int64, float64, float64, float64[::1])", **SUMS)
def score_pairs(samples, costs, i, start, scale, worst, found):
    """Scores of sample i with as many from ``start`` on as ``found`` holds.

    1 where two are equal, less by the square of their distance, ``worst`` at least.
    """
    # Square distances, dimension by dimension, as samples are columns.
    found[:] = 0
    for d in range(len(samples)):
        value, others = samples[d, i], samples[d, start : start + len(found)]
        for j in range(len(found)):
            difference = value - others[j]
            found[j] += difference * difference
    cost, others = costs[i], costs[start : start + len(found)]
    for j in range(len(found)):
        # Far pairs have a limited loss, so a single bad sample does not end a path.
        found[j] = max(1 - found[j] / (scale * scale) - (cost + others[j]) / 2, worst)


@njit(
    "Tuple((int64[:, ::1], float64[::1], int64[:, ::1]))(float64[:, ::1], float64[::1],"
    " boolean[::1], int64, int64, int64, float64, float64, float64)",
    **OPTIONS,
)
def find_local_paths(samples, costs, begins, gap, width, leg, scale, worst, least):
    """First and last pair (i, j, i, j) and score of the best path from each first pair.

    Pairs are ``gap`` to ``width`` samples apart. A path steps by one sample on
    both sides or by two on one of them, never into a sample that ``begins`` a
    span, and goes on for as long as its score is above 0. Of those that score
    ``least`` or more, one for each branch of each first pair is kept, at its best.
    Beside its ends is the latest of the pairs that it passed, one after so many samples
    (``leg``), -1 if there is none; these are (i, j, the one before).
    """
    # Three rows are enough, as a step goes back by two at most. Of the best path to each pair:
    # its score, first pair (i * n + j), place in `found`, and latest pair passed.
    n = len(costs)
    line = np.empty(n)
    scores = np.zeros((3, n))
    firsts = np.zeros((3, n), np.int64)
    records = np.full((3, n), -1, np.int64)
    passes = np.full((3, n), -1, np.int64)
    since = np.zeros((3, n), np.int64)  # the first sample, or that of the latest pair passed
    # The first entries only give the lists their types.
    found = [(0, 0, 0, 0, np.int64(-1), 0.0)]
    passed = [(0, 0, np.int64(-1))]
    for i in range(n):
        row, one, two = i % 3, (i - 1) % 3, (i - 2) % 3  # this row, and those before it
        # Pairs nearer than the gap hold scores of an earlier row.
        for j in range(max(i + gap - 3, 0), min(i + gap, n)):
            scores[row, j] = 0
        # A step must not lead into the start of a span; nor may a passed sample be one.
        go, skip = i > 0 and not begins[i], i > 1 and not (begins[i] or begins[i - 1])
        near, far = min(i + gap, n), min(i + width + 1, n)
        score_pairs(samples, costs, i, near, scale, worst, line[near:far])
        for j in range(near, far):
            # The best way here: a new path, or one of three steps.
            score = line[j]
            # A new path starts with its first pair.
            best, source, column = score, -1, -1
            if go and not begins[j]:
                before = scores[one, j - 1]
                if before > 0 and before + score > best:
                    best, source, column = before + score, one, j - 1
                before = scores[one, j - 2]
                if not begins[j - 1] and before > 0 and before + 1.5 * score > best:
                    # The passed sample's pair counts half as much again.
                    best, source, column = before + 1.5 * score, one, j - 2
                before = scores[two, j - 1]
                if skip and before > 0 and before + 1.5 * score > best:
                    best, source, column = before + 1.5 * score, two, j - 1
            scores[row, j] = max(best, 0)
            if best <= 0:
                continue
            # What the path brings along.
            first, record, latest, start = i * n + j, np.int64(-1), np.int64(-1), i
            if source >= 0:
                first, record = firsts[source, column], records[source, column]
                latest, start = passes[source, column], since[source, column]
            firsts[row, j], records[row, j] = first, record
            # Each branch has one record, its best pair so far.
            if best >= least:
                if record < 0:
                    records[row, j] = len(found)
                    found.append((first // n, first % n, i, j, latest, best))
                elif best > found[record][5]:
                    found[record] = (first // n, first % n, i, j, latest, best)
            # Every leg leaves a pair behind, so that the path can be followed in legs.
            # A leg is measured in samples of the first side.
            if i - start >= leg:
                passed.append((i, j, latest))
                latest, start = np.int64(len(passed) - 2), i
            passes[row, j], since[row, j] = latest, start
    # Lists as arrays, without the entry that gave them their type.
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
def trace_path(samples, costs, ends, scale, worst):
    """Return best path between two pairs: its partner of each sample, and its score up to there.

    Both from the first side and from the second.
    """
    i0, j0 = ends[0], ends[1]
    rows, columns = ends[2] - i0 + 1, ends[3] - j0 + 1
    # The best score up to each pair, and the step that leads to it: 1 straight, 2 and 3 bent.
    scores = np.full((rows, columns), -np.inf)
    steps = np.zeros((rows, columns), np.int8)
    line = np.empty(columns)
    score_pairs(samples, costs, i0, j0, scale, worst, line[:1])
    scores[0, 0] = line[0]
    for i in range(1, rows):
        ahead = rows - 1 - i  # only pairs that can be reached, and from which the end can be
        first = max(1, (i + 1) // 2, columns - 1 - 2 * ahead)
        last = min(columns, 2 * i + 1, columns - (ahead + 1) // 2)
        score_pairs(samples, costs, i0 + i, j0 + first, scale, worst, line[first:last])
        for j in range(first, last):
            score = line[j]
            scores[i, j], steps[i, j] = scores[i - 1, j - 1] + score, 1
            if j > 1 and scores[i - 1, j - 2] + 1.5 * score > scores[i, j]:
                scores[i, j], steps[i, j] = scores[i - 1, j - 2] + 1.5 * score, 2
            if i > 1 and scores[i - 2, j - 1] + 1.5 * score > scores[i, j]:
                scores[i, j], steps[i, j] = scores[i - 2, j - 1] + 1.5 * score, 3
    # Back from the end. A sample that is passed over lies between both pairs of the step.
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
            # The passed sample lies between the pairs: half a sample before this one.
            other_partners[j - 1] = i0 + i - 0.5
            other_sums[j - 1] = (scores[i, j] + scores[i - 1, j - 2]) / 2
            i, j = i - 1, j - 2
        else:
            partners[i - 1] = j0 + j - 0.5
            sums[i - 1] = (scores[i, j] + scores[i - 2, j - 1]) / 2
            i, j = i - 2, j - 1


@njit("int64(boolean[::1], int64, int64)", **OPTIONS)
def count_set_flags(flags, start, stop):
    """How many flags of ``[start, stop)`` are set."""
    count = 0
    for i in range(start, stop):
        count += flags[i]
    return count


@njit(
    "Tuple((float64, int64))(int64, int64, int64[::1], int64[::1], float64[::1], float64[::1],"
    " int64[::1], int64[::1], boolean[::1], float64, int64[:, ::1], float64[::1])",
    **OPTIONS,
)
def count_recurrences(
    start, stop, starts, ptr, partners, sums, row_ptr, row_paths, free, cover, spans, gains
):
    """Return the total gain and number of recurrences of ``[start, stop)``.

    Spans and gains hold them.

    Each is the partner of a part of the span, by a path that covers a share of ``cover`` at least
    of it. Spans hold (start, stop) of the partner and of the part, the strongest first. None
    reaches into another, into the span itself or into samples that are not free.
    """
    length = stop - start
    middle = (start + stop) // 2
    n = 0
    # All that paths through the middle give, in order of their gain.
    for path in row_paths[row_ptr[middle] : row_ptr[middle + 1]]:
        first = starts[path]
        # `sums[base + sample]` belongs to a sample of the path.
        base = ptr[path] - first
        # The part of the span that the path covers.
        low, high = max(start, first), min(stop, first + ptr[path + 1] - ptr[path])
        if high - low < cover * length:
            continue
        # Ends that gain nothing are left out.
        while low < high and low > first and sums[base + low] <= sums[base + low - 1]:
            low += 1
        while high - 1 > low and sums[base + high - 1] <= sums[base + high - 2]:
            high -= 1
        if high - low < cover * length:
            continue
        # Sums up to a sample: their difference is the gain of the part.
        score = sums[base + high - 1] - (sums[base + low - 1] if low > first else 0.0)
        begin, end = round(partners[base + low]), round(partners[base + high - 1]) + 1
        # The partner lies outside the span, and has half of its length at least.
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
    # Of these the strongest that do not overlap, and of which four fifths are free.
    total, count = 0.0, 0
    for k in range(n):
        begin, end = spans[k, 0], spans[k, 1]
        clear = True
        for other in range(count):
            clear = clear and (end <= spans[other, 0] or begin >= spans[other, 1])
        # In whole numbers: at least 4/5 of the samples are free.
        if clear and 5 * count_set_flags(free, begin, end) >= 4 * (end - begin):
            # `spans` is compacted in place; `count` never passes k.
            for column in range(4):
                spans[count, column] = spans[k, column]
            gains[count] = gains[k]
            total += gains[k]
            count += 1
    return total, count


@njit("int64(float64[::1], int64)", **OPTIONS)
def find_largest(values, count):
    """Return place of the largest of the first ``count`` values, the first if there are several."""
    best = 0
    for i in range(1, count):
        if values[i] > values[best]:
            best = i
    return best


@njit("void(float64[::1], float64[::1], int64, int64)", **OPTIONS)
def update_block_maxima(tops, values, start, stop):
    """Set the largest value of each block that holds some of these places."""
    # All blocks that the places touch; the last one may be incomplete.
    for block in range(start // BLOCK, (stop + BLOCK - 1) // BLOCK):
        first = block * BLOCK
        tops[block] = values[first + find_largest(values[first:], min(BLOCK, len(values) - first))]


@njit(
    "Tuple((int64[:, ::1], float64[::1], int64[::1]))(int64[::1], int64[::1], int64[::1],"
    " float64[::1], float64[::1], int64[::1], int64[::1], boolean[::1], float64)",
    **OPTIONS,
)
def choose_sets(lengths, starts, ptr, partners, sums, row_ptr, row_paths, free, cover):
    """Spans, gains and set of each occurrence: the sets with the largest total gain, one by one.

    Gains hardly ever rise as samples are taken, so that only that of the best span is computed
    anew (lazy greedy, after Minoux 1978). Changes ``free``.

    ``lengths`` are the lengths of spans that are tried. The other arrays are those of
    `events.find_matching_paths`, and ``cover`` is that of `count_recurrences`.
    """
    n, sizes = len(free), len(lengths)
    most = 0
    # No sample has more paths than this: room for all recurrences of a span.
    for i in range(n):
        most = max(most, row_ptr[i + 1] - row_ptr[i])
    spans, gains = np.empty((most, 4), np.int64), np.empty(most)
    totals = np.zeros((n, sizes))
    versions = np.zeros((n, sizes), np.int64)  # the number of sets when a total was computed
    best = np.zeros(n)
    found = [(0, 0, 0.0, 0)]
    rank = 0
    # Total gains of all spans that are free, the best for each start, and the best of each block.
    for start in range(n):
        for k in range(sizes):
            stop = start + lengths[k]
            # Spans with taken samples keep a gain of 0.
            if stop <= n and count_set_flags(free, start, stop) == lengths[k]:
                totals[start, k] = count_recurrences(
                    start, stop, starts, ptr, partners, sums, row_ptr, row_paths, free, cover,
                    spans, gains,
                )[0]  # fmt: skip
        best[start] = totals[start, find_largest(totals[start], sizes)]
    tops = np.empty((n + BLOCK - 1) // BLOCK)
    update_block_maxima(tops, best, 0, n)
    # The best span: taken if its total is up to date, else computed anew.
    while n > 0:
        block = find_largest(tops, len(tops)) * BLOCK
        start = block + find_largest(best[block:], min(BLOCK, n - block))
        if best[start] <= 0:
            break
        k = find_largest(totals[start], sizes)
        stop = start + lengths[k]
        total, count = count_recurrences(
            start, stop, starts, ptr, partners, sums, row_ptr, row_paths, free, cover, spans, gains
        )
        if versions[start, k] == rank and count > 0:
            covered, stop = stop, start  # of the span, the part that any partner matches
            for other in range(count):
                covered, stop = min(covered, spans[other, 2]), max(stop, spans[other, 3])
            # The span itself gets the gain of its best recurrence.
            found.append((covered, stop, gains[find_largest(gains, count)], rank))
            for other in range(count):
                found.append((spans[other, 0], spans[other, 1], gains[other], rank))  # noqa: PERF401
            # The span and its recurrences, which were appended last.
            for covered, stop, _, _ in found[-1 - count :]:
                free[covered:stop] = False
                # Spans that begin up to the longest length before it can reach into it.
                for begin in range(max(covered - lengths[sizes - 1] + 1, 0), stop):
                    for k in range(sizes):  # spans that reach into it gain nothing
                        totals[begin, k] *= begin + lengths[k] <= covered
                    best[begin] = totals[begin, find_largest(totals[begin], sizes)]
                update_block_maxima(tops, best, max(covered - lengths[sizes - 1] + 1, 0), stop)
            rank += 1
        else:
            totals[start, k], versions[start, k] = total, rank
            best[start] = totals[start, find_largest(totals[start], sizes)]
            update_block_maxima(tops, best, start, start + 1)
    # The list as arrays, without the entry that gave it its type.
    places = np.empty((len(found) - 1, 2), np.int64)
    scores, ranks = np.empty(len(places)), np.empty(len(places), np.int64)
    for k in range(len(places)):
        places[k, 0], places[k, 1], scores[k], ranks[k] = found[k + 1]
    return places, scores, ranks
