"""The processes of this machine."""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from multiprocessing import get_context, parent_process
from multiprocessing.connection import wait as wait_for
from multiprocessing.context import BaseContext

from kineme._threads import n_threads
from kineme.library.executors import Outcome, Task

SHARED = ("kineme.library.making", "kineme.methods.recurrence.analysis", "pyarrow.parquet")
"""What takes long to import."""


@dataclass(frozen=True)
class Processes:
    """So many processes of this machine at most."""

    jobs: int

    def completed(
        self, work: Callable[[Task], Outcome], tasks: Sequence[Task]
    ) -> Iterator[tuple[Task, Outcome | None]]:
        """Each task and what came of it, as they come; see `Executor`."""
        waiting = list(reversed(tasks))
        while waiting:
            suspects = yield from _in_a_pool(work, waiting, self.jobs)
            for task in suspects:  # alone, so that it is known who ends its process
                dying = yield from _in_a_pool(work, [task], 1)
                if dying:
                    yield task, None


def _in_a_pool(
    work: Callable[[Task], Outcome], waiting: list[Task], jobs: int
) -> Generator[tuple[Task, Outcome], None, list[Task]]:
    """Work on tasks from the end of the list; those in work when a process died are returned."""
    share = max(1, n_threads() // jobs)
    pool = ProcessPoolExecutor(
        min(jobs, len(waiting)),
        mp_context=_context(),
        initializer=_prepare,
        initargs=(share,),
    )
    running: dict[Future[Outcome], Task] = {}
    try:
        while waiting or running:
            while waiting and len(running) < jobs:
                task = waiting.pop()
                running[pool.submit(work, task)] = task
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                outcome = future.result()
                yield running.pop(future), outcome
    except BrokenProcessPool:
        return list(running.values())
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
    return []


def _context() -> BaseContext:
    """How processes are started.

    A copy of this one could wait forever for threads that it lacks. Where that can be, they are
    copies of one that has none, and has imported what all need.
    """
    if sys.platform != "linux":
        return get_context("spawn")
    context = get_context("forkserver")
    context.set_forkserver_preload([*SHARED])
    return context


def _prepare(threads: int) -> None:
    """Make a worker one of several, which ends when the process that started it is gone."""
    os.environ["KINEME_THREADS"] = str(threads)
    parent = parent_process()
    if parent is not None:
        sentinel = parent.sentinel

        def watch() -> None:
            wait_for([sentinel])
            os._exit(1)

        threading.Thread(target=watch, daemon=True).start()
