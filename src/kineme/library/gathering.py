"""The pieces of the recordings of a build: those that are there, and those to be made."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from threading import Thread

from kineme._checks import is_text
from kineme.errors import ReadError, WriteError
from kineme.library.duplicates import by_content
from kineme.library.executors import Executor
from kineme.library.executors.here import Here
from kineme.library.planning import Plan
from kineme.library.progress import Progress, Watch
from kineme.library.sources import Glances
from kineme.library.storage.layout import SEEN, read_json, write_json
from kineme.library.work import Outcome, Task, outcomes_of, tasks_for

Seen = dict[str, tuple[str, str]]
UNNAMED = "its name is not UTF-8, so no table can hold it: rename it"
"""What is said of such a file."""


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


def gather(plan: Plan, found: Sequence[Path], executor: Executor, progress: Progress) -> Gathered:
    """The pieces of recordings, made where there is none.

    Files that look as they did when they were last read are not read again.

    Parameters
    ----------
    plan : Plan
    found : sequence of Path
        The recordings.
    executor : Executor
        Where they are made.
    progress : callable
        Called with a sentence on how far it is.

    Raises
    ------
    WriteError
        The folder cannot be written.
    """
    seen = _seen(plan.folder / SEEN, progress)
    glances = Glances(plan.settings.options().skeleton)
    named = [path for path in found if is_text(str(path))]
    looks = {path: glances.at(path) for path in named}
    unnamed = [path for path in found if path not in looks]
    there = Gathered(_unchanged(plan, looks, seen), failed=dict.fromkeys(unnamed, UNNAMED))
    waiting = [path for path in named if path not in there.digests]
    if waiting:
        _make(plan, waiting, executor, progress, there)
    told = {str(path): (looks[path], digest) for path, digest in there.digests.items()}
    if told != seen:
        write_json(plan.folder / SEEN, told)
    return there


def _seen(path: Path, progress: Progress) -> Seen:
    """Look and digest of each recording when it was last read; none where the file is damaged."""
    try:
        return read_json(path, tuple[str, str])
    except ReadError as error:
        progress(f"{path.name} is left alone, all recordings are looked at anew: it {error.reason}")
        return {}


def _unchanged(plan: Plan, looks: Mapping[Path, str], seen: Seen) -> dict[Path, str]:
    """Digests of recordings that look as they did, and have a piece."""
    digests = {}
    whole = {piece.stem for piece in plan.pieces.glob("*.parquet")}
    for path, look in looks.items():
        glance, digest = seen.get(str(path), ("", ""))
        if glance and glance == look and plan.settings.key(digest) in whole:
            digests[path] = digest
    return digests


def _make(
    plan: Plan,
    waiting: Sequence[Path],
    executor: Executor,
    progress: Progress,
    into: Gathered,
) -> None:
    """Make the pieces of recordings; what came of each is noted."""
    tasks = tasks_for(waiting, plan.pieces, plan.settings)
    groups = {
        group.tasks[0]: group for group in by_content(tasks, plan.settings.options().skeleton)
    }
    if not isinstance(executor, Here):  # what comes next is imported while others work
        Thread(target=import_module, args=("kineme.library.compiling",), daemon=True).start()
    watch = Watch(progress, len(tasks), sum(task.size for task in tasks))
    alone: list[Task] = []
    for task, outcome in outcomes_of(list(groups), executor):
        _note(plan, task, outcome, into)
        (_, *others), digest = groups[task]
        if outcome.digest == digest:
            into.digests.update((other.path, digest) for other in others)
        else:  # it failed, and says so of this one, or has changed since
            alone += others
            others = []
        watch.done(1 + len(others), task.size * (1 + len(others)))
    for task, outcome in outcomes_of(alone, executor):
        _note(plan, task, outcome, into)
        watch.done(1, task.size)


def _note(plan: Plan, task: Task, outcome: Outcome, into: Gathered) -> None:
    """What came of a task; WriteError where others will fail alike."""
    if outcome.fatal:
        raise WriteError(plan.folder, outcome.error)
    if outcome.error:
        into.failed[task.path] = outcome.error
    else:
        into.digests[task.path] = outcome.digest
    into.new += outcome.new
