"""Compiled search for neighbours: small loops on plain arrays.

Kernels trust their input; the public functions beside them validate it. Each
has a slow, literal twin in ``tests/naive.py``. Signatures are explicit, so one
compilation serves every call, and compiled code is kept on disk.
"""

from __future__ import annotations

import numpy as np
from numba import njit

OPTIONS = {"cache": True, "nogil": True, "error_model": "numpy"}

# Columns are screened in runs of this many, so that the far ones, which are
# most, cost one vectorised comparison each.
RUN = 32


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
    two = np.float32(2)
    for i in range(product.shape[0]):
        limit = row_limits[i]
        count = 0
        for first in range(starts[i], stops[i], RUN):
            last = min(first + RUN, stops[i])
            hits = 0
            for j in range(first, last):
                hits += column_norms[j] - two * product[i, j] <= limit
            if hits:
                for j in range(first, last):
                    if column_norms[j] - two * product[i, j] <= limit:
                        columns[i, count] = j
                        count += 1
        counts[i] = count


@njit(
    "int64(float64[:, ::1], float64[:, ::1], float64, int32[:, ::1], int64[::1], int32[::1],"
    " float32[::1])",
    fastmath={"reassoc", "contract"},
    **OPTIONS,
)
def measure_columns(rows, others, radius, columns, counts, indices, distances):
    """Screened columns truly within the radius, packed row after row; returns how many.

    Distances are taken in float64. ``counts`` is updated to what was kept.
    """
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
                indices[kept] = j
                distances[kept] = distance
                kept += 1
        counts[i] = kept - before
    return kept


@njit("boolean[::1](int64[::1], int32[::1], float32[::1], int64)", **OPTIONS)
def nearest_mask(indptr, indices, distances, k):
    """Which stored entries are among the k nearest of their row, ties to the lower index."""
    mask = np.ones(indices.shape[0], np.bool_)
    bits = distances.view(np.int32)
    for i in range(indptr.shape[0] - 1):
        first, last = indptr[i], indptr[i + 1]
        if last - first > k:
            # Distances are not negative, so their bits sort as they do.
            keys = np.empty(last - first, np.int64)
            for e in range(first, last):
                keys[e - first] = (np.int64(bits[e]) << 32) | np.int64(indices[e])
            limit = np.partition(keys, k - 1)[k - 1]
            for e in range(first, last):
                mask[e] = keys[e - first] <= limit
    return mask


@njit("int64(int64[::1], int32[::1], float32[::1], float32, int64, int64[::1], int32[::1],"
      " float32[::1])", **OPTIONS)
def copy_restricted(indptr, indices, distances, radius, min_lag, out_indptr, out_indices,
                    out_distances):
    """Copy the entries within the radius and at least min_lag off the diagonal."""
    kept = 0
    for i in range(indptr.shape[0] - 1):
        for e in range(indptr[i], indptr[i + 1]):
            out_indices[kept] = indices[e]
            out_distances[kept] = distances[e]
            kept += distances[e] <= radius and abs(indices[e] - i) >= min_lag
        out_indptr[i + 1] = kept
    return kept
