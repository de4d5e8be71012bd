"""Making pieces, by any executor; whatever happens to one recording costs it only.

What makes them takes a second to import, so that is left to the processes that do it: the one that
waits for them has started them by then.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from threadpoolctl import threadpool_limits

from kineme.errors import KinemeError, KinemeWarning, MissingDependencyError, WriteError
from kineme.formats import read_quietly
from kineme.library.executors import Executor
from kineme.library.settings import Settings
from kineme.library.sources import content_digest, size_of
from kineme.library.storage.pieces import has_piece, write_piece
from kineme.library.storage.recordings import fetched

PER_WORKER = 1 << 20
"""Bytes of recordings for which one process more is started: a start costs seconds."""
DIED = "the process that worked on it died: it may need more memory than there is"


@dataclass(frozen=True)
class Task:
    """A recording to describe.

    Attributes
    ----------
    path : Path
    pieces : Path
        Where its piece goes.
    settings : Settings
    size : int
        Bytes of the recording.
    """

    path: Path
    pieces: Path
    settings: Settings
    size: int

    def __hash__(self) -> int:
        return hash(self.path)


@dataclass(frozen=True)
class Outcome:
    """What came of a task: the digest of its files, whose piece is there, or why it is not.

    Attributes
    ----------
    digest : str
    new : bool
        Whether it was not there before.
    error : str
    fatal : bool
        Whether others will fail alike, as on a full disk.
    """

    digest: str = ""
    new: bool = False
    error: str = ""
    fatal: bool = False


def tasks_for(paths: Iterable[Path], pieces: Path, settings: Settings) -> list[Task]:
    """The tasks of recordings, the largest first: the last ones to be done are short."""
    tasks = [Task(path, pieces, settings, size_of(path)) for path in paths]
    return sorted(tasks, key=lambda task: (-task.size, task.path))


def outcomes_of(tasks: Sequence[Task], executor: Executor) -> Iterator[tuple[Task, Outcome]]:
    """Each task and what came of it, as they come.

    Parameters
    ----------
    tasks : sequence of Task
    executor : Executor
        Where they are worked on.

    Yields
    ------
    task : Task
    outcome : Outcome
    """
    for task, outcome in executor.completed(work_on, tasks, workers=workers_for(tasks)):
        yield task, outcome or Outcome(error=DIED)


def workers_for(tasks: Iterable[Task]) -> int:
    """How many processes are worth to be started for so many and so large recordings."""
    return 1 + sum(task.size for task in tasks) // PER_WORKER


def work_on(task: Task) -> Outcome:
    """Read, segment and describe a recording, unless its piece is there."""
    try:
        from kineme.library.making import make_piece

        with warnings.catch_warnings(), threadpool_limits(1):  # sums do not depend on threads
            warnings.simplefilter("ignore", KinemeWarning)
            options = task.settings.options()
            with fetched(task.path, options.skeleton) as path:
                digest = content_digest(path, options.skeleton)
                key = task.settings.key(digest)
                if has_piece(task.pieces, key):
                    return Outcome(digest)
                recording = read_quietly(path, options)
            write_piece(task.pieces, key, *make_piece(recording, task.settings))
    except (WriteError, MissingDependencyError) as error:
        return Outcome(error=_said(error), fatal=isinstance(error, WriteError))
    except Exception as error:  # noqa: BLE001 (one recording never ends a build)
        return Outcome(error=_said(error))
    return Outcome(digest, new=True)


def _said(error: BaseException) -> str:
    text = " ".join(str(error).split())
    return text if isinstance(error, KinemeError) else f"{type(error).__name__}: {text}"
