"""The pieces of the recordings of a build: those that are there, and those to be made."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from kineme.errors import WriteError
from kineme.library.executors import Executor
from kineme.library.layout import SEEN, read_json, write_json
from kineme.library.pieces import has_piece
from kineme.library.planning import Plan
from kineme.library.sources import Glances

Progress = Callable[[str], None]


@dataclass
class Gathered:
    """What there is of the recordings of a build.

    Attributes
    ----------
    digests : dict of Path to str
        Of the files of each recording that has a piece.
    failed : dict of Path to str
        Why the others have none.
    new : int
        How many pieces were made.
    """

    digests: dict[Path, str] = field(default_factory=dict)
    failed: dict[Path, str] = field(default_factory=dict)
    new: int = 0


def gather(
    plan: Plan, found: Sequence[Path], executor: Executor | int, progress: Progress
) -> Gathered:
    """The pieces of recordings, made where there is none.

    Files that look as they did when they were last read are not read again.

    Parameters
    ----------
    plan : Plan
    found : sequence of Path
        The recordings.
    executor : Executor or int
        Where they are made; a number is that of processes of this machine at most.
    progress : callable
        Called with a sentence on how far it is.

    Raises
    ------
    WriteError
        The folder cannot be written.
    """
    seen = read_json(plan.folder / SEEN)
    glances = Glances(plan.settings.options().skeleton)
    looks = {path: glances.at(path) for path in found}
    there = Gathered(_unchanged(plan, looks, seen))
    waiting = [path for path in found if path not in there.digests]
    if waiting:
        _make(plan, waiting, executor, progress, there)
    told = {str(path): [looks[path], digest] for path, digest in there.digests.items()}
    if told != seen:
        write_json(plan.folder / SEEN, told)
    return there


def _unchanged(
    plan: Plan, looks: Mapping[Path, str], seen: Mapping[str, tuple[str, str]]
) -> dict[Path, str]:
    """Digests of recordings that look as they did, and have a piece."""
    digests = {}
    for path, look in looks.items():
        glance, digest = seen.get(str(path), ("", ""))
        if glance and glance == look and has_piece(plan.pieces, plan.settings.key(digest)):
            digests[path] = digest
    return digests


def _make(
    plan: Plan,
    waiting: Sequence[Path],
    executor: Executor | int,
    progress: Progress,
    into: Gathered,
) -> None:
    """Make the pieces of recordings; what came of each is noted."""
    from kineme.library.work import Task, executor_for, outcomes_of

    tasks = [Task(path, plan.pieces, plan.settings) for path in waiting]
    if isinstance(executor, int):
        executor = executor_for(tasks, executor)
    started = time.monotonic()
    for done, (task, outcome) in enumerate(outcomes_of(tasks, executor), 1):
        if outcome.fatal:
            raise WriteError(plan.folder, outcome.error)
        if outcome.error:
            into.failed[task.path] = outcome.error
        else:
            into.digests[task.path] = outcome.digest
        into.new += outcome.new
        progress(_told(done, len(tasks), time.monotonic() - started))


def _told(done: int, of: int, seconds: float) -> str:
    """How far it is, and for how long it goes on."""
    left = seconds / done * (of - done)
    shown = f"{left:.0f} s" if left < 90 else f"{left / 60:.0f} min"
    return f"{done} of {of}" + (f", {shown} left" if done < of else "")
