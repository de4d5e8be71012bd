"""Compiled loops of the segmentation: growing regions, coherent paths, links.

Frames count from 0. Naive versions of the kernels are in ``tests/helpers/naive``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS


@njit("Tuple((int64[::1], int32[::1]))(int64[::1], int32[::1], boolean)", **OPTIONS)
def group_pairs(indptr, indices, by_later):
    """Group the stored pairs by their later or earlier frame; return pointers and other frames."""
    n = len(indptr) - 1
    # Counting sort: count the pairs of each frame, then compute where they begin.
    grouped = np.zeros(n + 1, np.int64)
    for i in range(n):
        for e in range(indptr[i], indptr[i + 1]):
            key = max(i, indices[e]) if by_later else min(i, indices[e])
            grouped[key + 1] += 1
    # Next free position among the pairs of each frame.
    position = np.empty(n, np.int64)
    for i in range(n):
        position[i] = grouped[i]
        grouped[i + 1] += grouped[i]
    others = np.empty(len(indices), np.int32)
    for i in range(n):
        for e in range(indptr[i], indptr[i + 1]):
            j = indices[e]
            key, other = (max(i, j), min(i, j)) if by_later else (min(i, j), max(i, j))
            others[position[key]] = other
            position[key] += 1
    return grouped, others


@njit("int64(int64[::1], int64, int64)", **OPTIONS)
def find_most(counts, first, last):
    """Return the largest of the counts from first to last, both inclusive."""
    largest = counts[first]
    for i in range(first + 1, last + 1):
        largest = max(largest, counts[i])
    return largest


@njit("int64[::1](int64[::1], int32[::1], int64, int64)", **OPTIONS)
def grow_squares_forward(indptr, earlier, min_gap, min_count):
    """Count the neighbour pairs inside the growing square at each frame; -1 if undefined.

    ``earlier[indptr[i]:indptr[i + 1]]`` holds the earlier frame of every
    stored pair whose later frame is i.
    """
    n = len(indptr) - 1
    counts = np.full(n, -1, np.int64)
    start = last = still = count = 0
    for i in range(1, n):
        for e in range(indptr[i], indptr[i + 1]):
            # Count pairs with both frames in the square from `start` to i.
            count += earlier[e] >= start
        counts[i] = count
        if counts[i] != counts[i - 1]:
            still = 0
            continue
        still += 1
        if still == min_gap:
            # A region with too few neighbours is continued instead of cut.
            if find_most(counts, last, i) > min_count:
                last = i - still
                start = i
                # The new square begins with the pairs of frame i alone.
                count = 0
                for e in range(indptr[i], indptr[i + 1]):
                    count += earlier[e] >= start
            still = 0
    return counts


@njit("int64[::1](int64[::1], int32[::1], boolean[::1], int64, int64)", **OPTIONS)
def grow_squares_backward(indptr, later, forward_cuts, min_gap, min_count):
    """Count the pairs as `grow_squares_forward`, from the end; regions also end at forward cuts.

    ``later[indptr[i]:indptr[i + 1]]`` holds the later frame of every stored
    pair whose earlier frame is i.
    """
    n = len(indptr) - 1
    counts = np.full(n, -1, np.int64)
    end = last = n - 1
    still = count = 0
    # Start at the last frame but one: the last frame has no later frame.
    for i in range(n - 2, -1, -1):
        for e in range(indptr[i], indptr[i + 1]):
            count += later[e] <= end
        counts[i] = count
        # At a forward cut another activity ends: start a new region.
        restart = forward_cuts[i]
        if not restart:
            if counts[i] != counts[i + 1]:
                still = 0
                continue
            still += 1
            if still == min_gap:
                still = 0
                restart = find_most(counts, i, last) > min_count
        if restart:
            last = end = i
            count = 0
            for e in range(indptr[i], indptr[i + 1]):
                count += later[e] <= end
    return counts


@njit("int64[::1](int64[::1], int32[::1], int64, int64)", **OPTIONS)
def scan_lines_forward(indptr, indices, min_gap, min_count):
    """Return the frames at which a region, scanned line by line, stops finding neighbours."""
    cuts = []
    start = region = still = 0
    for i in range(len(indptr) - 1):
        count = 0
        for e in range(indptr[i], indptr[i + 1]):
            count += start <= indices[e] <= i
        region += count
        still = 0 if count else still + 1
        if still >= min_gap and region > min_count:
            start = i - still
            cuts.append(start)
            region = still = 0
    return np.array(cuts, dtype=np.int64)


@njit("int64[::1](int64[::1], int32[::1], boolean[::1], int64, int64)", **OPTIONS)
def scan_lines_backward(indptr, indices, forward_cuts, min_gap, min_count):
    """Scan as `scan_lines_forward`, from the end; regions also end at forward cuts."""
    cuts = []
    end = len(indptr) - 2
    region = still = 0
    for i in range(len(indptr) - 2, -1, -1):
        count = 0
        for e in range(indptr[i], indptr[i + 1]):
            count += i <= indices[e] <= end
        region += count
        still = 0 if count else still + 1
        if forward_cuts[i]:
            end = i
            region = still = 0
        elif still >= min_gap and region > min_count:
            # The last frame, in this direction, that had a neighbour.
            end = i + still
            cuts.append(end)
            region = still = 0
    # Reverse to order of time.
    return np.array(cuts[::-1], dtype=np.int64)


@njit("int64(int32[::1], int32[::1])", **OPTIONS)
def count_members(values, others):
    """Count the values of an ascending array that occur in another ascending array."""
    count = k = 0
    for value in values:
        while k < len(others) and others[k] < value:
            k += 1
        count += k < len(others) and others[k] == value
    return count


@njit("boolean[::1](int64[::1], int32[::1], int32[::1], float64)", **OPTIONS)
def mark_coherent_paths(ptr, rows, columns, share):
    """Mark the paths with a mirror image: a path with rows and columns exchanged."""
    n = len(ptr) - 1
    coherent = np.zeros(n, np.bool_)
    for p in range(n):
        # A path may be its own mirror image, so q runs over all paths.
        p_rows, p_columns = rows[ptr[p] : ptr[p + 1]], columns[ptr[p] : ptr[p + 1]]
        needed = share * len(p_rows)
        for q in range(n):
            q_rows, q_columns = rows[ptr[q] : ptr[q + 1]], columns[ptr[q] : ptr[q + 1]]
            if (
                count_members(p_rows, q_columns) >= needed
                and count_members(p_columns, q_rows) >= needed
            ):
                coherent[p] = True
                break
    return coherent


@njit("int64(int32[::1], int32[::1], int64)", **OPTIONS)
def find_row_at_column(rows, columns, column):
    """Return the row at which a path passes a column; between two nodes, their rounded mean."""
    node = max(np.searchsorted(columns, column, side="right") - 1, 0)
    if columns[node] < column and node + 1 < len(rows):
        return (rows[node] + rows[node + 1] + 1) // 2
    return rows[node]


@njit(
    "Tuple((int64[::1], float64[::1]))(int64[::1], int32[::1], int32[::1], int64[::1], int64,"
    " float64, boolean)",
    **OPTIONS,
)
def find_linked_segments(ptr, rows, columns, borders, g, coverage, interpolate):
    """Return the segments h that paths link to segment g, and the smaller covered share of both.

    Segments are the frames ``borders[h]..borders[h + 1]``, both inclusive. A
    segment may be linked by several paths.
    """
    linked, shares = [], []
    g_first, g_last = borders[g], borders[g + 1]
    for p in range(len(ptr) - 1):
        path_rows, path_columns = rows[ptr[p] : ptr[p + 1]], columns[ptr[p] : ptr[p + 1]]
        low, high = path_columns[0], path_columns[-1]
        # Segments share their border frame, so the one that ends at `low` counts as well.
        h = max(np.searchsorted(borders, low, side="right") - 2, 0)
        while h < len(borders) - 1 and borders[h] <= high:
            first, last = borders[h], borders[h + 1]
            # 2014: all rows of the path. 2017: only the rows between the borders of h.
            row_low, row_high = path_rows[0], path_rows[-1]
            if interpolate:
                row_low = find_row_at_column(path_rows, path_columns, first)
                row_high = find_row_at_column(path_rows, path_columns, last)
            # Covered share of the frames of h, and of g; ends are inclusive.
            of_h = (min(last, high) - max(first, low) + 1) / (last - first + 1)
            of_g = (min(g_last, row_high) - max(g_first, row_low) + 1) / (g_last - g_first + 1)
            if min(of_h, of_g) >= coverage:
                linked.append(h)
                shares.append(min(of_h, of_g))
            h += 1
    return np.array(linked, dtype=np.int64), np.array(shares, dtype=np.float64)


@njit("int64[::1](int64[::1], int32[::1], int64[::1])", **OPTIONS)
def count_inner_neighbors(indptr, indices, borders):
    """Count the neighbours of each frame inside its own block ``[borders[b], borders[b + 1])``."""
    counts = np.zeros(len(indptr) - 1, np.int64)
    for b in range(len(borders) - 1):
        for i in range(borders[b], borders[b + 1]):
            for e in range(indptr[i], indptr[i + 1]):
                counts[i] += borders[b] <= indices[e] < borders[b + 1]
    return counts
