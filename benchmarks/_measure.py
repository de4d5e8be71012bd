"""Measure time and memory of code and commands, and match times of events."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from ctypes import CDLL
from resource import struct_rusage
from statistics import median
from time import perf_counter, process_time
from typing import NamedTuple

PR_SET_CHILD_SUBREAPER = 36
"""Number of this option of Linux's prctl."""


class Duration(NamedTuple):
    """Seconds by the clock, and of processor time, which excludes other work on the machine."""

    clock: float
    processor: float

    def __str__(self) -> str:
        return f"{self.clock:.3f} s ({self.processor:.3f} s of processor time)"


def take_medians(rows: Iterable[Duration]) -> Duration:
    """Return the medians."""
    return Duration(*map(median, zip(*rows, strict=True)))


def time_call(work: Callable[[], object]) -> Duration:
    """Call a function and return its duration."""
    clock, processor = perf_counter(), process_time()
    work()
    return Duration(perf_counter() - clock, process_time() - processor)


def time_in_turn(works: Mapping[str, Callable[[], object]], *, runs: int) -> dict[str, float]:
    """Return the median seconds of each function; run them in turn, so that other load is shared.

    One more round runs first and is not counted.
    """
    seconds: dict[str, list[float]] = {name: [] for name in works}
    for work in works.values():
        work()
    for _ in range(runs):
        for name, work in works.items():
            start = perf_counter()
            work()
            seconds[name].append(perf_counter() - start)
    return {name: median(times) for name, times in seconds.items()}


def judge(value: float, most: float) -> str:
    """Return whether a value is within its promised limit."""
    return f"at most {most:g} promised: {'kept' if value <= most else 'NOT KEPT'}"


def match_times(true: Iterable[float], found: Iterable[float], near_s: float) -> list[float]:
    """Match true times with found ones in turn, each used once; return the delays."""
    free, delays = list(found), []
    for at in true:
        nearest = min(free, key=lambda other: abs(other - at), default=None)
        if nearest is not None and abs(nearest - at) <= near_s:
            free.remove(nearest)
            delays.append(nearest - at)
    return delays


def run_kineme(*arguments: object) -> tuple[float, float, float]:
    """Return wall seconds and processor seconds of a command, and GB of its largest process."""
    _adopt_children()
    start = perf_counter()
    process = subprocess.Popen(
        [sys.executable, "-m", "kineme", *map(str, arguments)], stdout=subprocess.DEVNULL
    )
    _, status, usage = os.wait4(process.pid, 0)
    clock = perf_counter() - start
    if status:
        raise SystemExit(f"{arguments} ended with {status}")
    usages = [usage, *_wait_for_children()]
    used = sum(each.ru_utime + each.ru_stime for each in usages)
    return clock, used, max(each.ru_maxrss for each in usages) / 1e6


def _adopt_children() -> None:
    """Become the parent of orphaned child processes, to measure them (Linux only)."""
    if sys.platform == "linux":
        CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


def _wait_for_children() -> Iterator[struct_rusage]:
    """Yield the usage of remaining child processes, such as a fork server."""
    with suppress(ChildProcessError):
        while True:
            yield os.wait4(-1, 0)[2]
