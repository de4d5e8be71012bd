"""Announce and time the stages of an analysis."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager

Progress = Callable[[str], None]


def time_stages(
    timings: dict[str, float], progress: Progress | None
) -> Callable[[str], AbstractContextManager[None]]:
    """Return a context manager ``stage(name)`` that calls ``progress`` and records seconds."""

    @contextmanager
    def stage(name: str) -> Iterator[None]:
        if progress is not None:
            progress(name)
        start = time.perf_counter()
        yield
        timings[name] = time.perf_counter() - start

    return stage
