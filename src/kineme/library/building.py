"""Building a library: what is new is read, segmented and described; what is there is kept."""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any

from kineme._checks import check_path, is_number
from kineme._version import __version__
from kineme.errors import ParameterError, WriteError
from kineme.library.compiling import compiled
from kineme.library.constants import VOCABULARY
from kineme.library.edits import read_edits
from kineme.library.layout import (
    HEAD,
    LOCK_EDITS,
    PIECES,
    SCHEMA,
    SEEN,
    TABLES,
    arrow,
    held,
    read_head,
    read_json,
    write_json,
)
from kineme.library.pieces import has_piece
from kineme.library.settings import Settings
from kineme.library.sources import Glances, listed, names_of
from kineme.library.tables import read_table, write_tables
from kineme.library.work import Task, outcomes_of

AnyPath = str | PathLike[str]
Progress = Callable[[str], None]

NOT_THERE = "there is no such file or folder"
GONE = "is not there: its recordings are kept; --remove takes them out"


@dataclass(frozen=True)
class Built:
    """What a build did.

    Attributes
    ----------
    folder : Path
        Of the library.
    paths : tuple of Path
        The recordings in it.
    new : int
        How many of them were read and segmented.
    removed : int
        How many are not in it any more.
    recursive : bool
        Whether folders in folders were looked into.
    failed : Mapping of Path to str
        What could not be read or segmented, and why.
    """

    folder: Path
    paths: tuple[Path, ...]
    new: int
    removed: int
    recursive: bool
    failed: Mapping[Path, str] = field(default_factory=dict)


def build(
    sources: AnyPath | Iterable[AnyPath],
    into: AnyPath,
    *,
    remove: Iterable[AnyPath] = (),
    recursive: bool | None = None,
    settings: Settings | None = None,
    jobs: int = 1,
    progress: Progress | None = None,
) -> Built:
    """Make a library of recordings, or bring one up to date.

    Sources add to those that the library knows. Recordings that are new or changed are read and
    segmented, those that are gone from a source are taken out. A build that was ended before goes
    on; one that failed for some recordings tries these again.

    Parameters
    ----------
    sources : path-like, or iterable of path-like
        Recordings and folders of them; none for those that the library knows.
    into : path-like
        Folder of the library; made where there is none.
    remove : iterable of path-like
        Sources to take out, with their recordings.
    recursive : bool, optional
        Look into the folders of a folder, too; as the last time by default.
    settings : Settings, optional
        How recordings are read and segmented; as the last time by default. Others than those mean
        that everything is done anew.
    jobs : int
        Processes at once. With more than 1, a script must guard what it runs with
        ``if __name__ == "__main__"``, as always with processes.
    progress : callable, optional
        Called with a sentence on how far it is.

    Returns
    -------
    Built

    Raises
    ------
    ParameterError
        No source, or options that make no sense.
    ReadError
        The folder is of another kind or version.
    WriteError
        The folder cannot be written, or another build is at work on it.
    MissingDependencyError
        pyarrow is not installed.

    Examples
    --------
    >>> import kineme
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as home:
    ...     built = kineme.library.build(kineme.bundled_recording(), f"{home}/library")
    ...     len(built.paths), built.new
    (1, 1)
    """
    arrow()
    if not (is_number(jobs) and jobs == int(jobs) and jobs >= 1):
        raise ParameterError(f"jobs must be a whole number from 1, not {jobs!r:.60}")
    folder = opened(into)
    with held(folder, "build"):
        head = read_json(folder / HEAD)
        known = known_sources(into, _paths(sources), _paths(remove))
        missing = [each for each in known if not each.exists() and not _is_known(head, each)]
        plan = _Plan(
            folder,
            tuple(each for each in known if each not in missing),
            tuple(missing),
            bool(head.get("recursive")) if recursive is None else recursive,
            settings or (Settings.from_json(head["settings"]) if head else Settings()),
        )
        if not known and not head:
            raise ParameterError(f"{into}: nothing to build from: name recordings or folders")
        return _built(plan, head, int(jobs), progress or _silent)


def known_sources(
    into: AnyPath, sources: Iterable[Path] = (), remove: Iterable[Path] = ()
) -> list[Path]:
    """The sources of a library after these were added and removed, as absolute paths."""
    head = read_json(Path(into) / HEAD)
    sources = [Path(each) for each in head.get("sources", ())] + [*map(_absolute, sources)]
    removed = {*map(_absolute, remove)}
    unknown = removed - set(sources)
    if unknown:
        raise ParameterError(
            f"{min(unknown)} is no source of the library; there are "
            f"{', '.join(map(str, sources)) or 'none'}"
        )
    return [path for path in dict.fromkeys(sources) if path not in removed]


def opened(into: AnyPath) -> Path:
    """The folder of a library, made where there is none."""
    check_path(into, "build")
    folder = Path(into)
    if (folder / HEAD).is_file():
        read_head(folder)
        return folder
    begun = (folder / PIECES).is_dir()  # by a build that was ended before its first head
    try:
        if folder.exists() and not begun and (not folder.is_dir() or any(folder.iterdir())):
            raise WriteError(into, "is there already and is no library: name a new folder")
        (folder / PIECES).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise WriteError(into, f"cannot be made: {error.strerror or error}") from error
    return folder


@dataclass(frozen=True)
class _Plan:
    """What a build is asked for."""

    folder: Path
    sources: tuple[Path, ...]
    missing: tuple[Path, ...]
    recursive: bool
    settings: Settings

    @property
    def pieces(self) -> Path:
        return self.folder / PIECES


def _built(plan: _Plan, head: dict[str, Any], jobs: int, progress: Progress) -> Built:
    progress("looking for recordings")
    before = _before(plan.folder, head)
    found = listed(plan.sources, recursive=plan.recursive, without=_absolute(plan.folder))
    gone = [source for source in plan.sources if not source.exists()]
    kept = {
        path: source
        for path in before
        for source in gone
        if path not in found and path.is_relative_to(source)
    }
    failed = dict.fromkeys(gone, GONE)
    keys, new = _keys(plan, found, jobs, progress, failed)
    keys |= {path: before[path][1] for path in kept if has_piece(plan.pieces, before[path][1])}
    names = names_of(
        {path: source for path, source in {**found, **kept}.items() if path in keys},
        {path: name for path, (name, _) in before.items()},
    )
    wanted = {
        "schema": SCHEMA,
        "kineme": __version__,
        "settings": plan.settings.to_json(),
        "sources": [str(source) for source in plan.sources],
        "recursive": plan.recursive,
        "vocabulary": dict(VOCABULARY.parameters()),
        "failed": {str(path): reason for path, reason in sorted(failed.items())},
    }
    entries = sorted((name, path, keys[path]) for path, name in names.items())
    same = {path: (name, key) for name, path, key in entries} == before
    with held(plan.folder, "build", LOCK_EDITS):
        if same and all(head.get(name) == wanted[name] for name in ("kineme", "vocabulary")):
            following, tables = head["following"], head["tables"]
        else:
            progress("clusters in common")
            following = max(head.get("following", 0), read_edits(plan.folder).following)
            made, following = compiled(plan.folder, entries, head.get("tables"), following)
            tables = write_tables(plan.folder, made)
        now = {**wanted, "following": following, "tables": tables}
        if now != head:
            write_json(plan.folder / HEAD, now)
    _clean(plan.folder, {key for _, _, key in entries}, tables)
    removed = len(before.keys() - keys.keys())
    paths = tuple(path for _, path, _ in entries)
    failed |= dict.fromkeys(plan.missing, NOT_THERE)
    return Built(plan.folder, paths, new, removed, plan.recursive, failed)


def _before(folder: Path, head: Mapping[str, Any]) -> dict[Path, tuple[str, str]]:
    """Name and piece of each recording that the library has."""
    if not head:
        return {}
    table = read_table(folder, head["tables"], "recordings")
    columns = (table.column(name).to_pylist() for name in ("path", "recording", "piece"))
    return {Path(path): (name, key) for path, name, key in zip(*columns, strict=True)}


def _keys(
    plan: _Plan,
    found: Mapping[Path, Path],
    jobs: int,
    progress: Progress,
    failed: dict[Path, str],
) -> tuple[dict[Path, str], int]:
    """The piece of each recording, made where there is none; and how many were made."""
    seen = read_json(plan.folder / SEEN)
    glances = Glances(plan.settings.options().skeleton)
    looks = {path: glances.at(path) for path in found}
    keys: dict[Path, str] = {}
    tasks = []
    for path in found:
        glance, key = seen.get(str(path), ("", ""))
        key = plan.settings.key(key)
        if glance and glance == looks[path] and has_piece(plan.pieces, key):
            keys[path] = key
        else:
            tasks.append(Task(path, plan.pieces, plan.settings))
    new = 0
    digests = {str(path): seen[str(path)][1] for path in keys}
    started = time.monotonic()
    for done, (task, outcome) in enumerate(outcomes_of(tasks, jobs), 1):
        if outcome.fatal:
            raise WriteError(plan.folder, outcome.error)
        if outcome.error:
            failed[task.path] = outcome.error
        else:
            keys[task.path] = plan.settings.key(outcome.digest)
            digests[str(task.path)] = outcome.digest
        new += outcome.new
        progress(_told(done, len(tasks), time.monotonic() - started))
    told = {path: [looks[Path(path)], digest] for path, digest in digests.items()}
    if told != {path: list(one) for path, one in seen.items()}:
        write_json(plan.folder / SEEN, told)
    return keys, new


def _told(done: int, of: int, seconds: float) -> str:
    left = seconds / done * (of - done)
    shown = f"{left:.0f} s" if left < 90 else f"{left / 60:.0f} min"
    return f"{done} of {of}" + (f", {shown} left" if done < of else "")


def _clean(folder: Path, keys: set[str], tables: str) -> None:
    """Remove what nothing names any more, and drafts of builds that were ended."""
    for path in (folder / PIECES).iterdir():
        if path.suffix not in (".npy", ".parquet") or path.stem not in keys:
            path.unlink(missing_ok=True)
    for path in (folder / TABLES).iterdir():
        if path.name != tables:
            shutil.rmtree(path, ignore_errors=True)
    for path in folder.glob(".kineme-*"):
        path.unlink(missing_ok=True)


def _is_known(head: Mapping[str, Any], source: Path) -> bool:
    return str(source) in head.get("sources", ())


def _paths(given: AnyPath | Iterable[AnyPath]) -> list[Path]:
    if isinstance(given, str | PathLike):
        return [Path(given)]
    paths = list(given)
    for path in paths:
        check_path(path, "build")
    return [Path(path) for path in paths]


def _absolute(path: Path) -> Path:
    return Path(os.path.abspath(path))  # noqa: PTH100 (links are not followed)


def _silent(_: str) -> None:
    """Says nothing."""
