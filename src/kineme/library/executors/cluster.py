"""The workers of a cluster, by `dask.distributed`."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from itertools import islice
from typing import Any

from kineme._version import __version__
from kineme.errors import KinemeError, MissingDependencyError, ParameterError
from kineme.library.executors import Executor, Outcome, Task

EXTRA = "cluster"
"""The extra that installs what clusters need."""
AHEAD = 1000
"""Tasks that the scheduler knows at a time."""
_ONE = threading.Lock()


class Cluster:
    """The workers of a `dask.distributed.Client`.

    They see the recordings and the library at the same places as the client does. A worker has one
    task at a time, and as many threads for it as dask gave it. Dask tries a task anew whose worker
    died, three times by default (``distributed.scheduler.allowed-failures``).

    Parameters
    ----------
    client : distributed.Client

    Raises
    ------
    ParameterError
        It is none, or workers have another version of kineme, or none.
    MissingDependencyError
        dask is not installed.
    """

    def __init__(self, client: Any):
        if not isinstance(client, _distributed().Client):
            raise ParameterError(
                f"client takes a dask.distributed.Client or the address of a scheduler, not "
                f"{client!r:.60}"
            )
        self._client = client
        for address, version in client.run(_version, on_error="return").items():
            if version != __version__:
                told = "no kineme" if isinstance(version, Exception) else f"kineme {version}"
                raise ParameterError(
                    f"worker {address} has {told}, this is {__version__}: install the same there"
                )

    def completed(
        self,
        work: Callable[[Task], Outcome],
        tasks: Sequence[Task],
        *,
        workers: int | None = None,  # noqa: ARG002 (they are there already)
    ) -> Iterator[tuple[Task, Outcome | None]]:
        """Each task and what came of it, as they come; see `Executor`."""
        distributed = _distributed()
        waiting, running = iter(tasks), {}
        done = distributed.as_completed(loop=self._client.loop, raise_errors=False)

        def submit(n: int) -> None:
            for task in islice(waiting, n):
                future = self._client.submit(_alone, work, task, pure=False)
                running[future] = task
                done.add(future)

        try:
            submit(AHEAD)
            for future in done:
                yield running.pop(future), _outcome(future)
                submit(1)
        finally:
            self._client.cancel(list(running))


@contextmanager
def connected(client: Any) -> Iterator[Executor]:
    """The cluster of a client, or of the scheduler at an address such as ``tcp://10.0.0.1:8786``.

    An executor is taken as it is.

    Raises
    ------
    ParameterError
        No scheduler answers there; or as `Cluster`.
    MissingDependencyError
        dask is not installed.
    """
    if isinstance(client, Executor):
        yield client
        return
    if not isinstance(client, str):
        yield Cluster(client)
        return
    try:
        own = _distributed().Client(client, set_as_default=False)
    except (OSError, ValueError) as error:
        raise ParameterError(f"no scheduler answers at {client:.60}: {error!s:.100}") from error
    with own:
        yield Cluster(own)


def _distributed() -> Any:
    try:
        import distributed
    except ImportError as error:
        raise MissingDependencyError("dask.distributed", EXTRA) from error
    return distributed


def _outcome(future: Any) -> Any:
    """What came of a task; None where its workers died."""
    if future.status == "finished":
        return future.result()
    error = future.exception() if future.status == "error" else None
    if isinstance(error, _distributed().KilledWorker):
        return None
    if isinstance(error, KinemeError):
        raise error
    reason = "the scheduler is gone" if error is None else f"{error}"
    raise KinemeError(
        f"the cluster gave up: {' '.join(reason.split())[:200]}; what is done is kept, try again"
    )


def _version() -> str:
    """The version of kineme on a worker."""
    return __version__


def _alone(work: Callable[[Task], Outcome], task: Task) -> Outcome:
    """Work on a task, the only one in its process: settings of BLAS hold for a whole process."""
    from distributed import get_worker

    worker = get_worker()
    if worker.nanny is not None:  # a process of its own
        os.environ.setdefault("KINEME_THREADS", str(worker.state.nthreads))
    with _ONE:
        return work(task)
