"""Run tasks in this process, in several processes or on a cluster, and report progress.

An executor calls a function with each task and yields results as they complete. `InProcess` uses
this process, `Processes` several on this machine, `DaskCluster` the workers of a `dask.distributed`
scheduler. Other executors implement `Executor`.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from itertools import islice
from typing import Any, Protocol, TypeVar, runtime_checkable

from kineme._util.checks import require_extra
from kineme._util.parallel import defer_interrupt, make_process_context, make_process_pool
from kineme._version import __version__
from kineme.errors import KinemeError, ParameterError

Task = TypeVar("Task")
Outcome = TypeVar("Outcome")
PRELOADED = (
    "kineme.library.gathering",
    "kineme.library.descriptions",
    "kineme.methods.segmenter",
    "kineme.transfer.embeddings",
    "kineme.formats.skeletons._amc_kernels",
    "kineme.methods.kineme.pipeline",
    "pyarrow.parquet",
)
"""Modules that take long to import."""
_STARTED = threading.Event()
"""Set once the fork server is being started."""
EXTRA = "cluster"
"""Extra that installs the dependencies of clusters."""
AHEAD = 1000
"""Tasks submitted to the scheduler at a time."""
_ONE_TASK = threading.Lock()
Progress = Callable[[str], None]


@runtime_checkable
class Executor(Protocol):
    """Runs tasks."""

    def completed(
        self, work: Callable[[Task], Outcome], tasks: Sequence[Task], *, workers: int | None = None
    ) -> Iterator[tuple[Task, Outcome | None]]:
        """Yield each task with its result as they complete.

        The result is None for a task whose process died; other tasks are not affected. An exception
        in ``work``, a module-level function, ends all; closing the iterator cancels the rest.
        ``workers`` limits the processes to start for these tasks, unlimited by default.
        """
        ...


class InProcess:
    """Run tasks one by one in the calling process."""

    def completed(
        self, work: Callable[[Task], Outcome], tasks: Sequence[Task], *, workers: int | None = None
    ) -> Iterator[tuple[Task, Outcome | None]]:
        """Yield each task with its result; see `Executor`."""
        del workers  # always one
        for task in tasks:
            yield task, work(task)


class Processes:
    """Run tasks in up to ``jobs`` processes of this machine, which are kept between calls."""

    def __init__(self, jobs: int):
        self._jobs = jobs
        self._pool: ProcessPoolExecutor | None = None

    def completed(
        self, work: Callable[[Task], Outcome], tasks: Sequence[Task], *, workers: int | None = None
    ) -> Iterator[tuple[Task, Outcome | None]]:
        """Yield each task with its result as they complete; see `Executor`.

        A single task runs in this process unless other processes exist already.
        """
        if len(tasks) == 1 and not (self._pool or _STARTED.is_set()):
            yield from InProcess().completed(work, tasks)
            return
        waiting = list(reversed(tasks))
        while waiting:
            suspects = yield from self._run(work, waiting, min(self._jobs, workers or self._jobs))
            for task in suspects:  # run each alone to find the one that kills its process
                dying = yield from self._run(work, [task], 1)
                if dying:
                    yield task, None

    def close(self, *, wait: bool = False) -> None:
        """End the processes once their current tasks are done.

        Without ``wait``, Python may print errors if it exits at the same time.
        """
        if self._pool is not None:
            self._pool.shutdown(wait=wait, cancel_futures=True)
        self._pool = None

    def _run(
        self, work: Callable[[Task], Outcome], waiting: list[Task], most: int
    ) -> Generator[tuple[Task, Outcome], None, list[Task]]:
        """Run tasks from the end of the list; return those running when a process died."""
        if self._pool is None:
            self._pool = make_process_pool(self._jobs, PRELOADED)
        running: dict[Future[Outcome], Task] = {}
        try:
            while waiting or running:
                while waiting and len(running) < most:
                    with defer_interrupt():
                        running[self._pool.submit(work, waiting[-1])] = waiting[-1]
                    waiting.pop()
                for future in wait(running, return_when=FIRST_COMPLETED).done:
                    outcome = future.result()
                    yield running.pop(future), outcome
        except BrokenProcessPool:
            self.close()
            return list(running.values())
        finally:
            if running:  # the caller stopped iterating
                self.close()
        return []


@contextmanager
def start_processes(jobs: int) -> Iterator[Executor]:
    """Provide an executor with so many processes; 1 uses this process."""
    if jobs == 1:
        yield InProcess()
        return
    several = Processes(jobs)
    try:
        yield several
    except BaseException:
        several.close()
        raise
    several.close(wait=True)


def start_fork_server() -> None:
    """Start the fork server in advance; it takes a second, in parallel with this process."""
    if sys.platform == "linux":
        make_process_context(PRELOADED)
        _STARTED.set()


class DaskCluster:
    """Run tasks on the workers of a `dask.distributed.Client`.

    Workers need the recordings and the library under the same paths as the client. A worker runs
    one task at a time with all its threads. Dask repeats a task whose worker died, three times by
    default (``distributed.scheduler.allowed-failures``).
    """

    def __init__(self, client: Any):
        if not isinstance(client, _import_distributed().Client):
            taken = "a dask.distributed.Client or the address of a scheduler"
            raise ParameterError(f"client takes {taken}, not {client!r:.60}")
        self._client = client
        for address, version in client.run(_get_version, on_error="return").items():
            if version != __version__:
                other = "no kineme" if isinstance(version, Exception) else f"kineme {version}"
                raise ParameterError(
                    f"worker {address} has {other}, but this is {__version__}: install the "
                    "same version there"
                )

    def completed(
        self, work: Callable[[Task], Outcome], tasks: Sequence[Task], *, workers: int | None = None
    ) -> Iterator[tuple[Task, Outcome | None]]:
        """Yield each task with its result as they complete; see `Executor`."""
        del workers  # dask has started them
        done = _import_distributed().as_completed(loop=self._client.loop, raise_errors=False)
        waiting, running = iter(tasks), {}

        def submit(n: int) -> None:
            for task in islice(waiting, n):
                future = self._client.submit(_run_exclusively, work, task, pure=False)
                running[future] = task
                done.add(future)

        try:
            submit(AHEAD)
            for future in done:
                yield running.pop(future), _get_outcome(future)
                submit(1)
        finally:
            self._client.cancel(list(running))


@contextmanager
def connect(client: Any) -> Iterator[Executor]:
    """Provide the executor of a client or a scheduler address such as ``tcp://10.0.0.1:8786``.

    An executor is passed through.
    """
    if not isinstance(client, str):
        yield client if isinstance(client, Executor) else DaskCluster(client)
        return
    try:
        connection = _import_distributed().Client(client, set_as_default=False)
    except (OSError, ValueError) as error:
        raise ParameterError(f"no scheduler responds at {client:.60}: {error!s:.100}") from error
    with connection:
        yield DaskCluster(connection)


def _import_distributed() -> Any:
    with require_extra("dask.distributed", EXTRA):
        import distributed
    return distributed


def _get_outcome(future: Any) -> Any:
    """Return the result of a task; None if its workers died."""
    if future.status == "finished":
        return future.result()
    error = future.exception() if future.status == "error" else None
    if isinstance(error, _import_distributed().KilledWorker):
        return None
    if isinstance(error, KinemeError):
        raise error
    reason = "the connection to the scheduler was lost" if error is None else f"{error}"
    raise KinemeError(
        f"the cluster gave up: {' '.join(reason.split())[:200]}. Finished work is kept: try again"
    )


def _get_version() -> str:
    """Return the version of kineme on a worker."""
    return __version__


def _run_exclusively(work: Callable[[Task], Outcome], task: Task) -> Outcome:
    """Run a task alone in its process, since BLAS settings are global to a process."""
    from distributed import get_worker

    worker = get_worker()
    if worker.nanny is not None:  # a process of its own
        os.environ.setdefault("KINEME_THREADS", str(worker.state.nthreads))
    with _ONE_TASK:
        return work(task)


def track_progress(progress: Progress, items: int, work: float) -> Callable[[int, float], None]:
    """Return a function that reports the number of finished items and the remaining time.

    ``work`` is the total amount of work in any unit. Call the function with the number of newly
    finished items and their work.
    """
    started = time.monotonic()
    items_done, work_done = 0, 0.0

    def done(more_items: int, more_work: float) -> None:
        nonlocal items_done, work_done
        items_done, work_done = items_done + more_items, work_done + more_work
        left_s = (time.monotonic() - started) * (work - work_done) / max(work_done, 1)
        shown = f"{left_s:.0f} s" if left_s < 90 else f"{left_s / 60:.0f} min"
        more = f", {shown} left" if items_done < items else ""
        progress(f"{items_done} of {items}{more}")

    return done
