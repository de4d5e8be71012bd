"""What code and commands take; medians of runs in turn, so that other work falls on all alike."""

from __future__ import annotations

import os
import subprocess
import sys
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


def kineme(*arguments: object) -> tuple[float, float, float]:
    """Seconds that a command takes, of clock and processors; gigabytes of its largest process."""
    start = perf_counter()
    process = subprocess.Popen(
        [sys.executable, "-m", "kineme", *map(str, arguments)], stdout=subprocess.DEVNULL
    )
    _, status, usage = os.wait4(process.pid, 0)
    if status:
        raise SystemExit(f"{arguments} ended with {status}")
    used = usage.ru_utime + usage.ru_stime
    return perf_counter() - start, used, usage.ru_maxrss / 1e6
