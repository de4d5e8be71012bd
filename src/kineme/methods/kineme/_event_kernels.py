"""Compiled loops over pairs of samples: find warping paths, and sets of spans that recur.

A pair of samples scores ``1 - distance² / scale²`` less the mean cost of both. The score of a path
is the sum over its pairs; after a step that skips a sample, a pair counts 1.5 times. Samples are
columns. Naive versions of the kernels are in ``tests/helpers/naive``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS

SUMS = {**OPTIONS, "fastmath": {"reassoc", "contract"}}
BLOCK = 512
"""Number of span starts per block in the table of largest gains."""


@njit("void(float64[:, ::1], float64[::1], int64, int64, float64, float64[::1])", **SUMS)
def score_pairs(samples, costs, i, start, scale, scores):
    """Write the scores of sample i with the samples from ``start`` on to ``scores``.

    A score is 1 for equal samples without costs.
    """
    # Squared distances, accumulated by dimension, as samples are columns.
    scores[:] = 0
    for d in range(len(samples)):
        value, others = samples[d, i], samples[d, start : start + len(scores)]
        for j in range(len(scores)):
            difference = value - others[j]
            scores[j] += difference * difference
    cost, others = costs[i], costs[start : start + len(scores)]
    for j in range(len(scores)):
        scores[j] = 1 - scores[j] / (scale * scale) - (cost + others[j]) / 2


@njit(
    "Tuple((int64[:, ::1], float64[::1], int64[:, ::1]))(float64[:, ::1], float64[::1],"
    " boolean[::1], int64, int64, int64, float64, float64)",
    **OPTIONS,
)
def find_local_paths(samples, costs, begins, gap, width, leg, scale, least):
    """Find local warping paths: return their ends (i, j, i, j, waypoint), scores, and waypoints.

    The two samples of a pair are ``gap`` to ``width`` apart. A path steps by one sample on both
    sides, or by two on one of them, never into a sample that ``begins`` a span. It continues while
    its score is above 0. Paths with a score of at least ``least`` are kept: one for each branch of
    each first pair, up to its best pair. Every ``leg`` samples a path stores a waypoint: (i, j,
    index of the waypoint before, or -1). ``waypoint`` is the index of its last one.
    """
    # Rolling buffers of three rows, as a step goes back by two at most. For the best path to each
    # pair: its score, first pair (i * n + j), index in `found`, and last waypoint.
    n = len(costs)
    row_scores = np.empty(n)
    scores = np.zeros((3, n))
    firsts = np.zeros((3, n), np.int64)
    records = np.full((3, n), -1, np.int64)
    waypoints = np.full((3, n), -1, np.int64)
    leg_starts = np.zeros((3, n), np.int64)  # first sample of the current leg
    # Numba infers the types of lists from these dummy entries.
    found = [(0, 0, 0, 0, np.int64(-1), 0.0)]
    stored_waypoints = [(0, 0, np.int64(-1))]
    for i in range(n):
        row, previous, second_previous = i % 3, (i - 1) % 3, (i - 2) % 3
        # Entries nearer than the gap still hold scores of an earlier row: clear them.
        for j in range(max(i + gap - 3, 0), min(i + gap, n)):
            scores[row, j] = 0
        # Neither the next sample nor a skipped one may begin a span.
        may_step, may_skip = i > 0 and not begins[i], i > 1 and not (begins[i] or begins[i - 1])
        near, far = min(i + gap, n), min(i + width + 1, n)
        score_pairs(samples, costs, i, near, scale, row_scores[near:far])
        for j in range(near, far):
            # Best path to this pair: a new path, or a continuation by one of three steps.
            score = row_scores[j]
            best, source, column = score, -1, -1
            if may_step and not begins[j]:
                before = scores[previous, j - 1]
                if before > 0 and before + score > best:
                    best, source, column = before + score, previous, j - 1
                before = scores[previous, j - 2]
                if not begins[j - 1] and before > 0 and before + 1.5 * score > best:
                    # A step that skips a sample counts its pair 1.5 times.
                    best, source, column = before + 1.5 * score, previous, j - 2
                before = scores[second_previous, j - 1]
                if may_skip and before > 0 and before + 1.5 * score > best:
                    best, source, column = before + 1.5 * score, second_previous, j - 1
            scores[row, j] = max(best, 0)
            if best <= 0:
                continue
            # Inherit first pair, record and waypoint from the path that is continued.
            first, record, waypoint, leg_start = i * n + j, np.int64(-1), np.int64(-1), i
            if source >= 0:
                first, record = firsts[source, column], records[source, column]
                waypoint, leg_start = waypoints[source, column], leg_starts[source, column]
            firsts[row, j], records[row, j] = first, record
            # Each branch has one record: its best pair so far.
            if best >= least:
                if record < 0:
                    records[row, j] = len(found)
                    found.append((first // n, first % n, i, j, waypoint, best))
                elif best > found[record][5]:
                    found[record] = (first // n, first % n, i, j, waypoint, best)
            # Store a waypoint after each leg, measured in samples of the first side.
            if i - leg_start >= leg:
                stored_waypoints.append((i, j, waypoint))
                waypoint, leg_start = np.int64(len(stored_waypoints) - 2), i
            waypoints[row, j], leg_starts[row, j] = waypoint, leg_start
    # Convert the lists to arrays, without the dummy entries.
    ends = np.empty((len(found) - 1, 5), np.int64)
    totals = np.empty(len(found) - 1)
    for k in range(len(totals)):
        ends[k, 0], ends[k, 1], ends[k, 2], ends[k, 3], ends[k, 4], totals[k] = found[k + 1]
    pairs = np.empty((len(stored_waypoints) - 1, 3), np.int64)
    for k in range(len(pairs)):
        pairs[k, 0], pairs[k, 1], pairs[k, 2] = stored_waypoints[k + 1]
    return ends, totals, pairs


@njit(
    "Tuple((float64[::1], float64[::1], float64[::1], float64[::1]))(float64[:, ::1],"
    " float64[::1], int64[::1], float64)",
    **OPTIONS,
)
def trace_path(samples, costs, ends, scale):
    """Trace the best path between two pairs; return partners and scores so far of its samples.

    They are returned for the samples of the first side, then for those of the second.
    """
    i0, j0 = ends[0], ends[1]
    rows, columns = ends[2] - i0 + 1, ends[3] - j0 + 1
    # Best score up to each pair, and the last step: 1 diagonal, 2 skips a column, 3 skips a row.
    scores = np.full((rows, columns), -np.inf)
    steps = np.zeros((rows, columns), np.int8)
    row_scores = np.empty(columns)
    score_pairs(samples, costs, i0, j0, scale, row_scores[:1])
    scores[0, 0] = row_scores[0]
    for i in range(1, rows):
        # Slopes are between 1/2 and 2, so only these columns connect both ends.
        ahead = rows - 1 - i
        first = max(1, (i + 1) // 2, columns - 1 - 2 * ahead)
        last = min(columns, 2 * i + 1, columns - (ahead + 1) // 2)
        score_pairs(samples, costs, i0 + i, j0 + first, scale, row_scores[first:last])
        for j in range(first, last):
            score = row_scores[j]
            scores[i, j], steps[i, j] = scores[i - 1, j - 1] + score, 1
            if j > 1 and scores[i - 1, j - 2] + 1.5 * score > scores[i, j]:
                scores[i, j], steps[i, j] = scores[i - 1, j - 2] + 1.5 * score, 2
            if i > 1 and scores[i - 2, j - 1] + 1.5 * score > scores[i, j]:
                scores[i, j], steps[i, j] = scores[i - 2, j - 1] + 1.5 * score, 3
    # Backtrack. A skipped sample gets the mean of the pairs before and after it.
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
            # Half a sample between the partners of both pairs.
            other_partners[j - 1] = i0 + i - 0.5
            other_sums[j - 1] = (scores[i, j] + scores[i - 1, j - 2]) / 2
            i, j = i - 1, j - 2
        else:
            partners[i - 1] = j0 + j - 0.5
            sums[i - 1] = (scores[i, j] + scores[i - 2, j - 1]) / 2
            i, j = i - 2, j - 1


@njit("int64(boolean[::1], int64, int64)", **OPTIONS)
def count_set_flags(flags, start, stop):
    """Count the flags of ``[start, stop)`` that are set."""
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
    """Find the recurrences of ``[start, stop)``; return their total gain and number.

    A recurrence is the partner of a part of the span, by a path that covers at least the share
    ``cover`` of the span. They are written to ``gains`` and ``spans`` (start and stop of the
    partner and of the part), in descending order of gain. Recurrences do not overlap each other or
    the span, and at least 4/5 of their samples are free.
    """
    length = stop - start
    middle = (start + stop) // 2
    n = 0
    # Collect the recurrences of all paths through the middle, sorted by gain.
    for path in row_paths[row_ptr[middle] : row_ptr[middle + 1]]:
        path_start = starts[path]
        # `sums[base + sample]` is the score of the path up to a sample.
        base = ptr[path] - path_start
        # Part of the span that the path covers.
        low, high = max(start, path_start), min(stop, path_start + ptr[path + 1] - ptr[path])
        if high - low < cover * length:
            continue
        # Trim samples at both ends that gain nothing.
        while low < high and low > path_start and sums[base + low] <= sums[base + low - 1]:
            low += 1
        while high - 1 > low and sums[base + high - 1] <= sums[base + high - 2]:
            high -= 1
        if high - low < cover * length:
            continue
        # Cumulative scores: their difference is the gain of the part.
        score = sums[base + high - 1] - (sums[base + low - 1] if low > path_start else 0.0)
        begin, end = round(partners[base + low]), round(partners[base + high - 1]) + 1
        # The partner must lie outside the span and have at least half of its length.
        if score > 0 and (end <= start or begin >= stop) and 2 * (end - begin) >= length:
            position = n  # insertion sort by descending gain
            while position > 0 and gains[position - 1] < score:
                for column in range(4):
                    spans[position, column] = spans[position - 1, column]
                gains[position] = gains[position - 1]
                position -= 1
            spans[position, 0], spans[position, 1], gains[position] = begin, end, score
            spans[position, 2], spans[position, 3] = low, high
            n += 1
    # Keep the recurrences with the largest gains that do not overlap and are free.
    total, count = 0.0, 0
    for k in range(n):
        begin, end = spans[k, 0], spans[k, 1]
        clear = True
        for other in range(count):
            clear = clear and (end <= spans[other, 0] or begin >= spans[other, 1])
        # In integers: at least 4/5 of the samples are free.
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
    """Return the index of the largest of the first ``count`` values; at a tie the first."""
    best = 0
    for i in range(1, count):
        if values[i] > values[best]:
            best = i
    return best


@njit("void(float64[::1], float64[::1], int64, int64)", **OPTIONS)
def update_block_maxima(maxima, values, start, stop):
    """Update the maximum of each block that overlaps ``[start, stop)``."""
    # The last block may be incomplete.
    for block in range(start // BLOCK, (stop + BLOCK - 1) // BLOCK):
        start_of_block = block * BLOCK
        size = min(BLOCK, len(values) - start_of_block)
        maxima[block] = values[start_of_block + find_largest(values[start_of_block:], size)]


@njit(
    "Tuple((int64[:, ::1], float64[::1], int64[::1]))(int64[::1], int64[::1], int64[::1],"
    " float64[::1], float64[::1], int64[::1], int64[::1], boolean[::1], float64)",
    **OPTIONS,
)
def choose_sets(lengths, starts, ptr, partners, sums, row_ptr, row_paths, free, cover):
    """Choose sets of occurrences greedily by total gain; return spans, gains and set of each.

    Total gains almost never rise when samples are taken. So only the gain of the best span is
    updated in each step (lazy greedy algorithm, after Minoux 1978). Changes ``free``.

    ``lengths`` are the span lengths to try. The other arrays are those of
    `events.find_matching_paths`, and ``cover`` is that of `count_recurrences`.
    """
    n, sizes = len(free), len(lengths)
    most = 0
    # Largest number of paths of a sample, which bounds the recurrences of a span.
    for i in range(n):
        most = max(most, row_ptr[i + 1] - row_ptr[i])
    spans, gains = np.empty((most, 4), np.int64), np.empty(most)
    totals = np.zeros((n, sizes))
    versions = np.zeros((n, sizes), np.int64)  # number of sets when a total was computed
    best = np.zeros(n)
    found = [(0, 0, 0.0, 0)]
    rank = 0
    # Total gains of all free spans, the best for each start, and the best for each block.
    for start in range(n):
        for k in range(sizes):
            stop = start + lengths[k]
            # Spans with samples that are not free keep a gain of 0.
            if stop <= n and count_set_flags(free, start, stop) == lengths[k]:
                totals[start, k] = count_recurrences(
                    start, stop, starts, ptr, partners, sums, row_ptr, row_paths, free, cover,
                    spans, gains,
                )[0]  # fmt: skip
        best[start] = totals[start, find_largest(totals[start], sizes)]
    maxima = np.empty((n + BLOCK - 1) // BLOCK)
    update_block_maxima(maxima, best, 0, n)
    # Take the best span if its total is up to date; otherwise recompute it.
    while n > 0:
        block = find_largest(maxima, len(maxima)) * BLOCK
        start = block + find_largest(best[block:], min(BLOCK, n - block))
        if best[start] <= 0:
            break
        k = find_largest(totals[start], sizes)
        stop = start + lengths[k]
        total, count = count_recurrences(
            start, stop, starts, ptr, partners, sums, row_ptr, row_paths, free, cover, spans, gains
        )
        if versions[start, k] == rank and count > 0:
            covered, stop = stop, start  # becomes the part of the span that any partner matches
            for other in range(count):
                covered, stop = min(covered, spans[other, 2]), max(stop, spans[other, 3])
            # The span itself gets the gain of its best recurrence.
            found.append((covered, stop, gains[find_largest(gains, count)], rank))
            for other in range(count):
                found.append((spans[other, 0], spans[other, 1], gains[other], rank))  # noqa: PERF401
            # Mark the span and its recurrences, appended last, as taken.
            for covered, stop, _, _ in found[-1 - count :]:
                free[covered:stop] = False
                # Spans that overlap it get a total of 0; they begin less than the longest length
                # before it.
                for begin in range(max(covered - lengths[sizes - 1] + 1, 0), stop):
                    for k in range(sizes):
                        totals[begin, k] *= begin + lengths[k] <= covered
                    best[begin] = totals[begin, find_largest(totals[begin], sizes)]
                update_block_maxima(maxima, best, max(covered - lengths[sizes - 1] + 1, 0), stop)
            rank += 1
        else:
            totals[start, k], versions[start, k] = total, rank
            best[start] = totals[start, find_largest(totals[start], sizes)]
            update_block_maxima(maxima, best, start, start + 1)
    # Convert the list to arrays, without the dummy entry.
    places = np.empty((len(found) - 1, 2), np.int64)
    scores, ranks = np.empty(len(places)), np.empty(len(places), np.int64)
    for k in range(len(places)):
        places[k, 0], places[k, 1], scores[k], ranks[k] = found[k + 1]
    return places, scores, ranks
