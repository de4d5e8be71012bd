"""What code and commands take; medians of runs in turn, so that other work falls on all alike."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from ctypes import CDLL
from resource import struct_rusage
from statistics import median
from time import perf_counter

PR_SET_CHILD_SUBREAPER = 36
"""Of Linux's prctl."""


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
    _adopt()
    start = perf_counter()
    process = subprocess.Popen(
        [sys.executable, "-m", "kineme", *map(str, arguments)], stdout=subprocess.DEVNULL
    )
    _, status, usage = os.wait4(process.pid, 0)
    clock = perf_counter() - start
    if status:
        raise SystemExit(f"{arguments} ended with {status}")
    usages = [usage, *_left_behind()]
    used = sum(each.ru_utime + each.ru_stime for each in usages)
    return clock, used, max(each.ru_maxrss for each in usages) / 1e6


def _adopt() -> None:
    """Become the parent of what the processes of a command leave behind (Linux only)."""
    if sys.platform == "linux":
        CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


def _left_behind() -> Iterator[struct_rusage]:
    """What they used, such as the process that the others are copies of."""
    with suppress(ChildProcessError):
        while True:
            yield os.wait4(-1, 0)[2]
