"""Where tasks are worked on: in this process, in several, or on a cluster; and how far they are.

An executor takes a function and what it is to be called with, and gives back what came of each, as
they come. `InProcess` is this process, `Processes` are several of this machine, `Cluster` the
workers of a `dask.distributed` scheduler; another kind is one class more.
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
    "kineme.transfer.channel_samples",
    "kineme.formats.skeletons._amc_kernels",
    "kineme.methods.kineme.pipeline",
    "kineme.methods.kineme.found",
    "pyarrow.parquet",
)
"""What takes long to import."""
_SOON = threading.Event()
"""Set once processes are being started, before the tasks are known."""
EXTRA = "cluster"
"""The extra that installs what clusters need."""
AHEAD = 1000
"""Tasks that the scheduler has at a time."""
_ONE = threading.Lock()
Progress = Callable[[str], None]


@runtime_checkable
class Executor(Protocol):
    """Where tasks are worked on."""

    def completed(
        self, work: Callable[[Task], Outcome], tasks: Sequence[Task], *, workers: int | None = None
    ) -> Iterator[tuple[Task, Outcome | None]]:
        """Yield each task and what came of it, as they come.

        None comes of a task whose process died; other tasks are not affected. What ``work``, a
        function of a module, raises ends all; to close the iterator ends the work on what is left.
        ``workers`` is how many processes are worth to be started for these tasks, any by default;
        0: none, but those that are there already may work on them.
        """
        ...


class InProcess:
    """The process that asks, one task after the other; a task that ends it ends all."""

    def completed(
        self, work: Callable[[Task], Outcome], tasks: Sequence[Task], *, workers: int | None = None
    ) -> Iterator[tuple[Task, Outcome | None]]:
        """Yield each task and what came of it, as they come; see `Executor`."""
        del workers  # there is one
        for task in tasks:
            yield task, work(task)


class Processes:
    """So many processes of this machine at most, kept from one call to the next."""

    def __init__(self, jobs: int):
        self._jobs = jobs
        self._pool: ProcessPoolExecutor | None = None

    def completed(
        self, work: Callable[[Task], Outcome], tasks: Sequence[Task], *, workers: int | None = None
    ) -> Iterator[tuple[Task, Outcome | None]]:
        """Yield each task and what came of it, as they come; see `Executor`.

        For one task alone no process is started either, unless that is begun already.
        """
        if not (self._pool or _SOON.is_set()) and (workers == 0 or len(tasks) == 1):
            yield from InProcess().completed(work, tasks)
            return
        waiting = list(reversed(tasks))
        while waiting:
            suspects = yield from self._run(work, waiting, min(self._jobs, workers or self._jobs))
            for task in suspects:  # alone, so that it is known who ends its process
                dying = yield from self._run(work, [task], 1)
                if dying:
                    yield task, None

    def close(self, *, wait: bool = False) -> None:
        """End the processes once their present tasks are done, and wait for that.

        Python that ends at the same time as they do may complain of it.
        """
        if self._pool is not None:
            self._pool.shutdown(wait=wait, cancel_futures=True)
        self._pool = None

    def _run(
        self, work: Callable[[Task], Outcome], waiting: list[Task], most: int
    ) -> Generator[tuple[Task, Outcome], None, list[Task]]:
        """Work on tasks from the end of the list; those in work when one died are returned."""
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
            if running:  # nobody asks any more
                self.close()
        return []


@contextmanager
def start_processes(jobs: int) -> Iterator[Executor]:
    """So many processes of this machine at most; 1 is this one."""
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
    """Start the server that processes are forked from: that takes a second beside this one."""
    if sys.platform == "linux":
        make_process_context(PRELOADED)
        _SOON.set()


class Cluster:
    """The workers of a `dask.distributed.Client`.

    They see the recordings and the library at the same places as the client does. A worker has one
    task at a time, and as many threads for it as dask gave it. Dask tries a task anew whose worker
    died, three times by default (``distributed.scheduler.allowed-failures``).
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
                    f"worker {address} has {other}, this is {__version__}: install the same there"
                )

    def completed(
        self, work: Callable[[Task], Outcome], tasks: Sequence[Task], *, workers: int | None = None
    ) -> Iterator[tuple[Task, Outcome | None]]:
        """Yield each task and what came of it, as they come; see `Executor`."""
        del workers  # they are there already
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
    """The cluster of a client, or of the scheduler at an address such as ``tcp://10.0.0.1:8786``.

    An executor is taken as it is.
    """
    if not isinstance(client, str):
        yield client if isinstance(client, Executor) else Cluster(client)
        return
    try:
        connection = _import_distributed().Client(client, set_as_default=False)
    except (OSError, ValueError) as error:
        raise ParameterError(f"no scheduler answers at {client:.60}: {error!s:.100}") from error
    with connection:
        yield Cluster(connection)


def _import_distributed() -> Any:
    with require_extra("dask.distributed", EXTRA):
        import distributed
    return distributed


def _get_outcome(future: Any) -> Any:
    """Return what came of a task; None where its workers died."""
    if future.status == "finished":
        return future.result()
    error = future.exception() if future.status == "error" else None
    if isinstance(error, _import_distributed().KilledWorker):
        return None
    if isinstance(error, KinemeError):
        raise error
    reason = "the scheduler is gone" if error is None else f"{error}"
    raise KinemeError(
        f"the cluster gave up: {' '.join(reason.split())[:200]}; what is done is kept, try again"
    )


def _get_version() -> str:
    """Return the version of kineme on a worker."""
    return __version__


def _run_exclusively(work: Callable[[Task], Outcome], task: Task) -> Outcome:
    """Work on a task, the only one in its process: settings of BLAS hold for a whole process."""
    from distributed import get_worker

    worker = get_worker()
    if worker.nanny is not None:  # a process of its own
        os.environ.setdefault("KINEME_THREADS", str(worker.state.nthreads))
    with _ONE:
        return work(task)


def track_progress(progress: Progress, things: int, work: float) -> Callable[[int, float], None]:
    """Return what tells how many things are done, and how long the work on the others will take.

    So many things make so much work, in any unit. It is called with what was done since.
    """
    started = time.monotonic()
    things_done, work_done = 0, 0.0

    def done(more_things: int, more_work: float) -> None:
        nonlocal things_done, work_done
        things_done, work_done = things_done + more_things, work_done + more_work
        left_s = (time.monotonic() - started) * (work - work_done) / max(work_done, 1)
        shown = f"{left_s:.0f} s" if left_s < 90 else f"{left_s / 60:.0f} min"
        more = f", {shown} left" if things_done < things else ""
        progress(f"{things_done} of {things}{more}")

    return done
