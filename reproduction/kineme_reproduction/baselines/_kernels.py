"""Compiled parts of ACA and HACA: small loops on plain arrays.

Kernels trust their input; each has a slow, literal twin in ``tests/helpers/naive``.
Signatures are explicit, so one compilation serves every call, and compiled
code is kept on disk.
"""

from __future__ import annotations

import numpy as np
from numba import njit


@njit("float64[:, ::1](float64[:, ::1], int64)", cache=True, nogil=True)
def propagate(kernel, longest):
    """``out[a, b]`` is the best min(K[i, j], K[i + w, j + w]) with (a, b) a corner of that square.

    w runs from 1 to ``longest``, i < j; the diagonal is 1.
    """
    n = kernel.shape[0]
    out = np.zeros((n, n))
    shared = np.empty(n)
    for i in range(n - 1):
        for w in range(1, min(longest, n - 1 - i) + 1):
            for j in range(i + 1, n - w):
                shared[j] = min(kernel[i, j], kernel[i + w, j + w])
            for j in range(i + 1, n - w):
                out[i, j] = max(out[i, j], shared[j])
            for j in range(i + 1, n - w):
                out[i, j + w] = max(out[i, j + w], shared[j])
            for j in range(i + 1, n - w):
                out[i + w, j + w] = max(out[i + w, j + w], shared[j])
            for j in range(i + w + 1, n - w):
                out[i + w, j] = max(out[i + w, j], shared[j])
    for a in range(n):
        out[a, a] = 1.0
        for b in range(a):
            out[a, b] = out[b, a]
    return out


@njit("float64[:, ::1](float64[:, ::1], float64[::1], int64, int64, int64)", cache=True, nogil=True)
def window_alignments(kernel, weights, start, stop, longest):
    """``out[v, l - 1]``: DTAK of the window of l frames ending at v with the segment [start, stop).

    All windows grow at once: column i % longest of ``table`` belongs to the
    window that starts at frame i, row s to the segment's frame start + s.
    """
    n, rows = kernel.shape[0], stop - start
    out = np.zeros((n, longest))
    table = np.full((rows, longest), -np.inf)
    diagonal = np.empty(longest)
    segment_weight = weights[start:stop].sum()
    for v in range(n):
        newest = v % longest
        for s in range(rows):
            table[s, newest] = -np.inf
        step = weights[v] * kernel[v, start]
        for i in range(longest):
            diagonal[i] = table[0, i]
            table[0, i] += step
        table[0, newest] = step + weights[start] * kernel[v, start]
        for s in range(1, rows):
            step = weights[v] * kernel[v, start + s]
            side = weights[start + s] * kernel[v, start + s]
            both = step + side
            for i in range(longest):
                old = table[s, i]
                best = max(old + step, table[s - 1, i] + side)
                table[s, i] = max(best, diagonal[i] + both)
                diagonal[i] = old
        weight = segment_weight
        for length in range(1, min(longest, v + 1) + 1):
            first = v - length + 1
            weight += weights[first]
            out[v, length - 1] = table[rows - 1, first % longest] / weight
    return out


@njit("int64[::1](float64[:, ::1], int64, boolean)", cache=True, nogil=True)
def cheapest_lengths(costs, shortest, as_coded):
    """Return the lengths of consecutive windows that cover all frames at the least total cost.

    ``costs[v, l - 1]`` is the cost of the window of l frames ending at v; no
    window is below ``shortest`` frames. Of equal totals the shortest last
    window wins. ``as_coded`` repeats a slip of the authors' first
    segmentation: a longer last window replaces the one found so far whenever
    that one's total exceeds ``shortest``, be the longer one's below it or not.
    Empty if no cover exists.
    """
    n, longest = costs.shape
    total = np.full(n + 1, np.inf)
    total[0] = 0.0
    last = np.zeros(n + 1, np.int64)
    for v in range(n):
        for length in range(shortest, min(longest, v + 1) + 1):
            cost = total[v + 1 - length] + costs[v, length - 1]
            bound = np.float64(shortest) if as_coded and last[v + 1] > 0 else cost
            if cost < np.inf and bound < total[v + 1]:
                total[v + 1] = cost
                last[v + 1] = length
    lengths = np.empty(n, np.int64)
    count, v = 0, n
    while v > 0 and last[v] > 0:
        lengths[count] = last[v]
        count += 1
        v -= last[v]
    if v > 0:
        count = 0
    return lengths[:count][::-1].copy()
