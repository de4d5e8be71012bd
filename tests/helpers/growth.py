"""Whether work grows with what there is to do, at whatever pace a machine goes."""

from __future__ import annotations

from collections.abc import Callable
from time import process_time
from timeit import repeat

PARTS = 8
LINEAR = 3.0 * PARTS
"""`times_longer` of work in proportion stays below this; that of a square is 64."""
LEAST = 0.02
"""Seconds: what takes less is taken for so much."""


def times_longer(work: Callable[[int], object], n: int) -> float:
    """How many times the processor time for n is that for an eighth of it."""

    def spent(n: int) -> float:  # `repeat` stops the garbage collector, which walks all that lives
        return min(repeat(lambda: work(n), timer=process_time, repeat=2, number=1))

    return spent(n) / max(spent(n // PARTS), LEAST)
