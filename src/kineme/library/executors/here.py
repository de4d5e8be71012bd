"""One process: the one that asks."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from kineme.library.executors import Outcome, Task


class Here:
    """The process that asks, one task after the other; a task that ends it ends all."""

    def completed(
        self,
        work: Callable[[Task], Outcome],
        tasks: Sequence[Task],
        *,
        workers: int | None = None,  # noqa: ARG002 (there is one)
    ) -> Iterator[tuple[Task, Outcome | None]]:
        """Each task and what came of it, as they come; see `Executor`."""
        for task in tasks:
            yield task, work(task)
