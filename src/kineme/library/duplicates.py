"""Recordings of the same content, of which one is worked on for all of them.

Whole files are read only where sizes and a sample are equal, so few are that are not equal.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from hashlib import sha256
from typing import NamedTuple

from kineme._threads import map_threads
from kineme.errors import ReadError
from kineme.formats.options import AnyPath
from kineme.library.sources import content_digest
from kineme.library.storage.places import is_remote
from kineme.library.work import Task

SAMPLE = 4096
"""Bytes from the middle of a file."""


class Group(NamedTuple):
    """Tasks of equal content, and its digest; empty where there is one only."""

    tasks: Sequence[Task]
    digest: str


def by_content(tasks: Iterable[Task], skeleton: AnyPath | None) -> list[Group]:
    """Groups of equal content, the largest first, as their tasks.

    Parameters
    ----------
    tasks : iterable of Task
    skeleton : path-like, optional
        That all of them are read with.

    Returns
    -------
    list of Group
        What is elsewhere, and what cannot be read, is alone.
    """
    told: tuple[Callable[[Task], str], ...] = (
        lambda task: "" if is_remote(task.path) else f"{task.size}",
        _sample,
        lambda task: _digest(task, skeleton),
    )
    groups = [Group(list(tasks), "")]
    for tell in told:
        groups = [part for group in groups for part in _parted(group, tell)]
    return sorted(groups, key=lambda group: (-group.tasks[0].size, group.tasks[0].path))


def _parted(group: Group, tell: Callable[[Task], str]) -> list[Group]:
    """The parts of a group that are told alike; what is told nothing of is alone."""
    if len(group.tasks) < 2:
        return [group]
    parts: defaultdict[str | Task, list[Task]] = defaultdict(list)
    for task, told in zip(group.tasks, map_threads(tell, group.tasks), strict=True):
        parts[told or task].append(task)
    return [Group(part, key if isinstance(key, str) else "") for key, part in parts.items()]


def _sample(task: Task) -> str:
    """What is in the middle of a file."""
    if task.path.is_dir():
        return "folder"
    try:
        with task.path.open("rb") as file:
            file.seek(max(task.size - SAMPLE, 0) // 2)
            return sha256(file.read(SAMPLE)).hexdigest()
    except OSError:
        return ""


def _digest(task: Task, skeleton: AnyPath | None) -> str:
    try:
        return content_digest(task.path, skeleton)
    except ReadError:  # whoever works on it will say so
        return ""
