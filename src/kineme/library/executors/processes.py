"""The processes of this machine."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager

from kineme._processes import context, interrupted_later, pool_of
from kineme.library.executors import Executor, Outcome, Task
from kineme.library.executors.here import Here

SHARED = (
    "kineme.library.work",
    "kineme.library.making",
    "kineme.library.vocabulary.joining",
    "kineme.formats.skeletons._amc_kernels",
    "kineme.methods.kineme.pipeline",
    "kineme.methods.kineme.found",
    "pyarrow.parquet",
)
"""What takes long to import."""
_SOON = threading.Event()
"""Set where this was begun before it was known what there is to do."""


class Processes:
    """So many processes of this machine at most, which go on from one work to the next.

    Parameters
    ----------
    jobs : int
    """

    def __init__(self, jobs: int):
        self._jobs = jobs
        self._pool: ProcessPoolExecutor | None = None

    def completed(
        self,
        work: Callable[[Task], Outcome],
        tasks: Sequence[Task],
        *,
        workers: int | None = None,
    ) -> Iterator[tuple[Task, Outcome | None]]:
        """Each task and what came of it, as they come; see `Executor`.

        For one task alone no process is started either, unless that is begun already.
        """
        if not (self._pool or _SOON.is_set()) and (workers == 0 or len(tasks) == 1):
            yield from Here().completed(work, tasks)
            return
        waiting = list(reversed(tasks))
        while waiting:
            suspects = yield from self._done(work, waiting, min(self._jobs, workers or self._jobs))
            for task in suspects:  # alone, so that it is known who ends its process
                dying = yield from self._done(work, [task], 1)
                if dying:
                    yield task, None

    def close(self, *, wait: bool = False) -> None:
        """End the processes once they are done with what they are at, and wait for that.

        Python that ends at the same time as they do may complain of it.
        """
        if self._pool is not None:
            self._pool.shutdown(wait=wait, cancel_futures=True)
        self._pool = None

    def _done(
        self, work: Callable[[Task], Outcome], waiting: list[Task], most: int
    ) -> Generator[tuple[Task, Outcome], None, list[Task]]:
        """Work on tasks from the end of the list; those in work when one died are returned."""
        if self._pool is None:
            self._pool = pool_of(self._jobs, SHARED)
        running: dict[Future[Outcome], Task] = {}
        try:
            while waiting or running:
                while waiting and len(running) < most:
                    with interrupted_later():
                        running[self._pool.submit(work, waiting[-1])] = waiting[-1]
                    waiting.pop()
                for future in wait(running, return_when=FIRST_COMPLETED).done:
                    outcome = future.result()
                    yield running.pop(future), outcome
        except BrokenProcessPool:
            self.close()
            return list(running.values())
        finally:
            if running:  # nobody asks any more
                self.close()
        return []


@contextmanager
def processes(jobs: int) -> Iterator[Executor]:
    """So many processes of this machine at most; 1 is this one."""
    if jobs == 1:
        yield Here()
        return
    several = Processes(jobs)
    try:
        yield several
    except BaseException:
        several.close()
        raise
    several.close(wait=True)


def start_soon() -> None:
    """Start what processes are copies of: that takes a second, in which this one can go on."""
    if sys.platform == "linux":
        context(SHARED)
        _SOON.set()
