"""Compiled loops of the search. Naive versions are in ``tests/helpers/naive``."""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS

HALF, ZERO = np.float32(0.5), np.float32(0)


@njit(
    "void(float32[:, ::1], float32[::1], float32[::1], int64, float32[:, ::1], int32[:, ::1], "
    "float32[:, ::1], float32[::1], int32[::1])",
    **OPTIONS,
)
def warp_columns(products, squares, example_squares, first, sums, begins, rows, costs, starts):
    """Compute the cost and start of the cheapest warping of an example that ends at each sample.

    The squared distance of sample first + j of a recording and sample i of an example of length m
    is ``products[j, i] + squares[j] + example_squares[i]``, where ``products`` are -2 x·y and the
    others |x|² and |y|².

    ``sums``, ``begins`` (3, m + 1) and ``rows`` (2, m) are rolling buffers that are kept from one
    call to the next. For the last three samples of the recording, they hold the sums of distances
    up to each sample of the example, and the starts of these warpings; for the last two samples,
    the distances. Before the first call all of ``sums`` is infinite; its first column stays so.
    """
    n, m = products.shape
    for j in range(n):
        now, one, two = (first + j) % 3, (first + j - 1) % 3, (first + j - 2) % 3
        here, before = rows[(first + j) % 2], rows[(first + j - 1) % 2, 1:]
        for i in range(m):
            here[i] = np.sqrt(max(products[j, i] + squares[j] + example_squares[i], ZERO))
        next_one = here[1:]
        quick_sums, quick_begins = sums[one], begins[one]
        even_sums, even_begins = sums[one, 1:], begins[one, 1:]
        slow_sums, slow_begins = sums[two, 1:], begins[two, 1:]
        new_sums, new_begins = sums[now, 2:], begins[now, 2:]
        for i in range(m - 1):
            # Without branches, so that the compiler can vectorise the loop.
            even = even_sums[i] + next_one[i]
            slow = slow_sums[i] + HALF * (before[i] + next_one[i])
            quick = quick_sums[i] + (here[i] + next_one[i])
            begin_slow, begin_even, begin_quick = slow_begins[i], even_begins[i], quick_begins[i]
            begin = begin_slow if slow < even else begin_even
            best = min(even, slow)
            new_begins[i] = begin_quick if quick < best else begin
            new_sums[i] = min(best, quick)
        sums[now, 1] = here[0]
        begins[now, 1] = first + j
        costs[j] = sums[now, m] / np.float32(m)
        starts[j] = begins[now, m]


@njit("int64(int64[::1], int64[::1], int64, boolean[::1], int64[::1])", **OPTIONS)
def choose_apart(starts, stops, most, occupied, chosen):
    """Choose at most ``most`` spans that do not overlap, in order; return their number.

    The indices of the chosen ones are written to ``chosen``. ``occupied`` marks their samples.
    """
    n = 0
    for i in range(len(starts)):
        if n == most:
            break
        free = True
        for j in range(starts[i], stops[i]):
            if occupied[j]:
                free = False
                break
        if free:
            occupied[starts[i] : stops[i]] = True
            chosen[n] = i
            n += 1
    return n
