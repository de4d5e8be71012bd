"""Compiled search for neighbours: small loops on plain arrays.

Kernels trust their input; the public functions beside them validate it. Each
has a slow, literal twin in ``tests/naive.py``. Signatures are explicit, so one
compilation serves every call, and compiled code is kept on disk.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._compiled import OPTIONS

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
                indices[kept] = first_column + j
                distances[kept] = distance
                kept += 1
        counts[i] = kept - before
    return indices[:kept], distances[:kept]


@njit("boolean[::1](int64[::1], float32[::1], int64)", **OPTIONS)
def nearest_mask(indptr, distances, k):
    """Which entries are among the k nearest of their row, ties to the earlier entry.

    Row i is ``distances[indptr[i] - indptr[0]:indptr[i + 1] - indptr[0]]``.
    Entries are counted into bins of distance; only the bin in which the k-th
    falls is sorted.
    """
    n_bins = 64
    mask = np.empty(distances.shape[0], np.bool_)
    bins = np.empty(n_bins + 1, np.int64)
    for i in range(indptr.shape[0] - 1):
        first, last = indptr[i] - indptr[0], indptr[i + 1] - indptr[0]
        if last - first <= k:
            mask[first:last] = True
            continue
        row = distances[first:last]
        low = row.min()
        span = row.max() - low
        scale = n_bins / span if span > 0 else 0.0
        bins[:] = 0
        for distance in row:
            bins[int((distance - low) * scale)] += 1
        nearer = 0
        edge = 0
        while nearer + bins[edge] <= k:
            nearer += bins[edge]
            edge += 1
        ties = np.empty(bins[edge], np.float32)
        count = 0
        for distance in row:
            if int((distance - low) * scale) == edge:
                ties[count] = distance
                count += 1
        rest = k - nearer
        limit = np.sort(ties)[rest - 1] if rest > 0 else np.float32(-1)
        rest -= (ties < limit).sum()
        for e in range(first, last):
            place = int((distances[e] - low) * scale)
            mask[e] = place < edge or (place == edge and distances[e] < limit)
            if place == edge and distances[e] == limit and rest > 0:
                mask[e] = True
                rest -= 1
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
            out_indices[kept] = indices[e]
            out_distances[kept] = distances[e]
            kept += distances[e] <= radius and abs(indices[e] - i) >= min_lag
        out_indptr[i + 1] = kept
    return kept
