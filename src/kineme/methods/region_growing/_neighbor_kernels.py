"""Compiled loops that search neighbours.

Kernels do not check their arguments; the functions that call them do. Naive versions
are in ``tests/helpers/naive``. Signatures are explicit, so that each kernel is
compiled once, and compiled code is cached on disk.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS

RUN = 32
"""Number of columns that are screened at a time, by one vectorised comparison."""


@njit("float32(float32[::1], int64, int64)", **OPTIONS)
def select_smallest(values, count, rank):
    """Return the value of rank ``rank``, from 0, among the first ``count``; reorder these.

    Hoare's quickselect, because numpy's partition takes seconds to compile.
    """
    low, high = 0, count - 1
    while low < high:
        # Partition: values up to the pivot to the left, values from the pivot on to the right.
        pivot = values[(low + high) // 2]
        left, right = low, high
        while left <= right:
            while values[left] < pivot:
                left += 1
            while values[right] > pivot:
                right -= 1
            if left <= right:
                values[left], values[right] = values[right], values[left]
                left += 1
                right -= 1
        # Continue in the part that contains the rank.
        if rank <= right:
            high = right
        elif rank >= left:
            low = left
        else:
            break
    return values[rank]


@njit(
    "void(float32[:, ::1], float32[::1], float32[::1], int64[::1], int64[::1], int32[:, ::1],"
    " int64[::1])",
    **OPTIONS,
)
def screen_columns(product, row_limits, column_norms, starts, stops, columns, counts):
    """Write the columns of ``[starts[i], stops[i])`` that may be near row i to ``columns[i]``.

    ``counts[i]`` is their number. A column j passes if
    ``column_norms[j] - 2 product[i, j] <= row_limits[i]``, in float32.
    """
    # A literal 2 would make the expression double precision.
    two = np.float32(2)
    for i in range(product.shape[0]):
        limit = row_limits[i]
        count = 0
        # Most runs have no near column and end after one vectorised count.
        for first in range(starts[i], stops[i], RUN):
            last = min(first + RUN, stops[i])
            hits = 0
            # |y|² - 2 x·y <= r² - |x|² + margin.
            for j in range(first, last):
                hits += column_norms[j] - two * product[i, j] <= limit
            if hits:
                for j in range(first, last):
                    if column_norms[j] - two * product[i, j] <= limit:
                        columns[i, count] = j
                        count += 1
        counts[i] = count


@njit(
    "Tuple((int32[::1], float32[::1]))"
    "(float64[:, ::1], float64[:, ::1], float64, int64, int32[:, ::1], int64[::1])",
    fastmath={"reassoc", "contract"},
    **OPTIONS,
)
def measure_columns(rows, others, radius, first_column, columns, counts):
    """Return the screened columns within the radius, row by row, and their distances.

    Distances are computed in float64. ``counts`` is updated.
    """
    indices = np.empty(counts.sum(), np.int32)
    distances = np.empty(len(indices), np.float32)
    kept = 0
    for i in range(rows.shape[0]):
        before = kept
        for c in range(counts[i]):
            j = columns[i, c]
            square = 0.0
            for d in range(rows.shape[1]):
                difference = rows[i, d] - others[j, d]
                square += difference * difference
            distance = np.sqrt(square)
            if distance <= radius:
                # Convert columns of the block to columns of the graph.
                indices[kept] = first_column + j
                distances[kept] = distance
                kept += 1
        counts[i] = kept - before
    return indices[:kept], distances[:kept]


@njit("boolean[::1](int64[::1], float32[::1], int64)", **OPTIONS)
def mark_nearest(indptr, distances, k):
    """Mark the k nearest entries of each row; at a tie the earlier entry.

    Row i is ``distances[indptr[i] - indptr[0]:indptr[i + 1] - indptr[0]]``.
    """
    mask = np.ones(len(distances), np.bool_)
    longest = 0
    for i in range(len(indptr) - 1):
        longest = max(longest, indptr[i + 1] - indptr[i])
    values = np.empty(longest, np.float32)
    for i in range(len(indptr) - 1):
        first = indptr[i] - indptr[0]
        count = indptr[i + 1] - indptr[i]
        if count <= k:
            continue
        for e in range(count):
            values[e] = distances[first + e]
        # The k-th smallest distance of the row.
        limit = select_smallest(values, count, k - 1) if k > 0 else np.float32(-1)
        # Number of entries with exactly this distance that are kept.
        ties = k
        for e in range(first, first + count):
            ties -= distances[e] < limit
        for e in range(first, first + count):
            tie = distances[e] == limit and ties > 0
            ties -= tie
            mask[e] = tie or distances[e] < limit
    return mask


@njit(
    "int64(int64[::1], int32[::1], float32[::1], float32, int64, int64[::1], int32[::1],"
    " float32[::1])",
    **OPTIONS,
)
def copy_restricted(
    indptr, indices, distances, radius, min_lag, out_indptr, out_indices, out_distances
):
    """Copy the entries within the radius and at least min_lag off the diagonal; count them."""
    kept = 0
    for i in range(indptr.shape[0] - 1):
        for e in range(indptr[i], indptr[i + 1]):
            # Without a branch: write every entry, and overwrite it if it is not kept.
            out_indices[kept] = indices[e]
            out_distances[kept] = distances[e]
            kept += distances[e] <= radius and abs(indices[e] - i) >= min_lag
        out_indptr[i + 1] = kept
    return kept
