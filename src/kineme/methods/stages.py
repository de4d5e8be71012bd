"""Stages of an analysis: announced as they begin, timed as they end."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager

Progress = Callable[[str], None]


def time_stages(
    timings: dict[str, float], progress: Progress | None
) -> Callable[[str], AbstractContextManager[None]]:
    """``with stage("name"):`` tells ``progress`` and adds the seconds to ``timings``."""

    @contextmanager
    def stage(name: str) -> Iterator[None]:
        if progress is not None:
            progress(name)
        start = time.perf_counter()
        yield
        timings[name] = time.perf_counter() - start

    return stage
