"""Medians of runs taken in turn, so that what else the machine does falls on all alike."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from statistics import median
from time import perf_counter


def interleaved(works: Mapping[str, Callable[[], object]], *, runs: int) -> dict[str, float]:
    """Median seconds of each work over so many rounds, after one that is not counted."""
    seconds: dict[str, list[float]] = {name: [] for name in works}
    for work in works.values():
        work()
    for _ in range(runs):
        for name, work in works.items():
            start = perf_counter()
            work()
            seconds[name].append(perf_counter() - start)
    return {name: median(times) for name, times in seconds.items()}


def verdict(value: float, most: float) -> str:
    """Whether what was promised is kept."""
    return f"at most {most:g} promised: {'kept' if value <= most else 'NOT KEPT'}"
