"""Where tasks are worked on: in this process, in several, or on a cluster.

An executor takes a function and what it is to be called with, and gives back what came of each, as
they come. `here.Here` is this process, `processes.Processes` are several of this machine,
`cluster.Cluster` the workers of a `dask.distributed` scheduler; another kind is one file more.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Protocol, TypeVar, runtime_checkable

Task = TypeVar("Task")
Outcome = TypeVar("Outcome")


@runtime_checkable
class Executor(Protocol):
    """Where tasks are worked on."""

    def completed(
        self,
        work: Callable[[Task], Outcome],
        tasks: Sequence[Task],
        *,
        workers: int | None = None,
    ) -> Iterator[tuple[Task, Outcome | None]]:
        """Each task and what came of it, as they come.

        Parameters
        ----------
        work : callable
            A function of a module. What it raises ends all.
        tasks : sequence
            Each is pickled where it goes to another process.
        workers : int, optional
            How many processes are worth to be started for these tasks, any by default; 0: none,
            but those that are there already may work on them.

        Yields
        ------
        task
            One of the given.
        outcome
            None where whatever process worked on it died. Others than this task lose nothing by
            it. Who stops asking ends the work on what is left.
        """
        ...
