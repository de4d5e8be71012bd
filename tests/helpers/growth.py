"""Measure how processor time grows with the size of the input, and the memory of work."""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable
from time import process_time
from timeit import repeat

PARTS = 8
LINEAR = 3.0 * PARTS
"""Limit of `times_longer` for linear work; quadratic work has 64."""
LEAST = 0.02
"""Minimum seconds of the smaller run, to reduce noise."""


def times_longer(work: Callable[[int], object], n: int) -> float:
    """Return the processor time for n divided by that for an eighth of it."""

    def spent(n: int) -> float:  # `repeat` disables the garbage collector
        return min(repeat(lambda: work(n), timer=process_time, repeat=2, number=1))

    return spent(n) / max(spent(n // PARTS), LEAST)


def measure_peak(work: Callable[[], object]) -> int:
    """Return the largest number of bytes that Python held during the work."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
