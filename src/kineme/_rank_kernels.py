"""Compiled choice of the value of a rank, for the kernels that need one."""

from __future__ import annotations

from numba import njit

from kineme._compiled import OPTIONS


@njit("float32(float32[::1], int64, int64)", **OPTIONS)
def smallest(values, count, rank):
    """The value of this rank, from 0, among the first ``count``, which are reordered.

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
