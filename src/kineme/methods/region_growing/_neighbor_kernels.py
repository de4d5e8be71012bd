"""Compiled search for neighbours: small loops on plain arrays.

Kernels trust their input; the public functions beside them validate it. Each
has a slow, literal twin in ``tests/helpers/naive.py``. Signatures are explicit, so one
compilation serves every call, and compiled code is kept on disk.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS

# Columns are screened in runs of this many, so that the far ones, which are
# most, cost one vectorised comparison each.
RUN = 32


@njit("float32(float32[::1], int64, int64)", **OPTIONS)
def select_smallest(values, count, rank):
    """Return the value of this rank, from 0, among the first ``count``, which are reordered.

    Hoare's quickselect: numpy's partition would take seconds to compile.
    """
    low, high = 0, count - 1
    while low < high:
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
    """``columns[i, :counts[i]]``: those in ``[starts[i], stops[i])`` that may be near row i.

    A column j passes if ``column_norms[j] - 2 product[i, j] <= row_limits[i]``,
    in float32.
    """
    # Single precision throughout: a literal 2 would make the expression double.
    two = np.float32(2)
    for i in range(product.shape[0]):
        limit = row_limits[i]
        count = 0
        # Most runs hold no near column: they are left after one vectorised count.
        for first in range(starts[i], stops[i], RUN):
            last = min(first + RUN, stops[i])
            hits = 0
            # The sides are |y|² - 2 x·y, and r² - |x|² with its margin.
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
    """Screened columns truly within the radius, row after row, and their distances.

    Distances are taken in float64. ``counts`` is updated to what was kept.
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
                # Columns of the block become columns of the graph.
                indices[kept] = first_column + j
                distances[kept] = distance
                kept += 1
        counts[i] = kept - before
    return indices[:kept], distances[:kept]


@njit("boolean[::1](int64[::1], float32[::1], int64)", **OPTIONS)
def mark_nearest(indptr, distances, k):
    """Which entries are among the k nearest of their row, ties to the earlier entry.

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
        # How many entries at exactly that distance are still to be kept.
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
    """Copy the entries within the radius and at least min_lag off the diagonal."""
    kept = 0
    for i in range(indptr.shape[0] - 1):
        for e in range(indptr[i], indptr[i + 1]):
            # Every entry is written, and the place only moves on if it is kept: no branch.
            out_indices[kept] = indices[e]
            out_distances[kept] = distances[e]
            kept += distances[e] <= radius and abs(indices[e] - i) >= min_lag
        out_indptr[i + 1] = kept
    return kept
