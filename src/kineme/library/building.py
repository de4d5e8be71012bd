"""Building a library: what is new is read, segmented and described; what is there is kept."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from kineme._util.checks import check_type, is_number
from kineme._util.files import AnyPath, OwnedFolder, is_draft
from kineme._util.json import options_to_json
from kineme._version import __version__
from kineme.errors import ParameterError, ReadError
from kineme.formats import ReadOptions
from kineme.library.edits import read_edits
from kineme.library.executors import Executor, Progress, connect, start_processes
from kineme.library.gathering import gather
from kineme.library.planning import (
    Entry,
    Plan,
    as_paths,
    list_recordings,
    make_absolute,
    make_plan,
    name_recordings,
    open_folder,
)
from kineme.library.storage.analyses import KEY_LENGTH, has_analysis, is_analysis
from kineme.library.storage.index import write_index
from kineme.library.storage.layout import (
    ANALYSES,
    HEAD,
    LOCK_EDITS,
    MOST_CLUSTERS,
    SCHEMA,
    TABLES,
    import_arrow,
    lock_for_writing,
    read_json,
    write_json,
)
from kineme.library.storage.places import is_inside, make_path, translate_remote_errors
from kineme.library.storage.tables import is_table_file, is_tables_folder, read_table, write_tables
from kineme.methods.segmenter import SegmentOptions
from kineme.transfer.clusters import CONSTANTS, Spans

Head = Mapping[str, Any]
"""What ``library.json`` says; nothing where there is none yet."""
Former = Mapping[Path, tuple[str, str]]
"""Name and analysis of recordings that the library has."""
REMOVED = "left.json"
"""Clusters of recordings that were taken out, by the key of the analysis, for when they return."""
Kept = tuple[list[float], list[float], list[int]]
"""Starts, stops and clusters of activities."""
DAMAGED = "is damaged: remove it; clusters of recordings that come back get new numbers then"

NEVER_FOUND = "there is no such file or folder"
NOT_FOUND = "is not there: its recordings are kept; --remove takes them out"


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
    read_options: ReadOptions | None = None,
    segment_options: SegmentOptions | None = None,
    jobs: int = 1,
    client: Any = None,
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
    read_options : ReadOptions, optional
        How recordings are read; as the last time by default.
    segment_options : SegmentOptions, optional
        How recordings are segmented; as the last time by default. Where either differs from
        the last time, everything is done anew.
    jobs : int
        Processes at most. With more than 1, a script must guard what it runs with
        ``if __name__ == "__main__"``, as always with processes.
    client : dask.distributed.Client or str, optional
        Work on this cluster instead, or on that of the scheduler at an address. Its workers see
        recordings and library at the same places.
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
    import_arrow()
    if not (is_number(jobs) and jobs == int(jobs) and jobs >= 1):
        raise ParameterError(f"jobs must be a whole number from 1, not {jobs!r:.60}")
    check_type(recursive, (bool, type(None)), "build", "recursive is True or False")
    made = ((read_options, ReadOptions), (segment_options, SegmentOptions))
    for options, kind in made:
        check_type(options, (kind, type(None)), "build", f"{kind.__name__}() makes one")
    with start_processes(int(jobs)) if client is None else connect(client) as executor:
        added, removed = as_paths(sources), as_paths(remove)
        folder = open_folder(into, [*added, *removed])
        with lock_for_writing(folder, "build"), translate_remote_errors(folder):
            head = read_json(folder / HEAD)
            plan = make_plan(folder, head, added, removed, recursive, read_options, segment_options)
            return _update_library(plan, head, executor, progress or (lambda _: None))


def _update_library(plan: Plan, head: Head, executor: Executor, progress: Progress) -> Built:
    """Return the library brought up to date, for one that holds it."""
    progress("looking for recordings")
    before = _read_former_recordings(plan.folder, head)
    found = list_recordings(
        plan.sources, recursive=plan.recursive, without=make_absolute(plan.folder)
    )
    missing_sources = [source for source in plan.sources if not source.exists()]
    not_found = {path: entry for path, entry in before.items() if path not in found}
    absent = _group_missing(plan, not_found, missing_sources)
    gathered = gather(plan, list(found), executor, progress)
    failed = dict.fromkeys(missing_sources, NOT_FOUND) | gathered.failed
    keys = {path: plan.key(digest) for path, digest in gathered.digests.items()}
    keys |= {path: before[path][1] for path in absent}
    names = name_recordings(
        {path: source for path, source in {**found, **absent}.items() if path in keys},
        {path: name for path, (name, _) in before.items()},
    )
    entries = sorted((name, path, keys[path]) for path, name in names.items())
    with lock_for_writing(plan.folder, "build", LOCK_EDITS):
        tables = _update_tables(plan, head, before, entries, failed, progress)
    _delete_unused_files(plan.folder, {key for _, _, key in entries}, tables)
    return Built(
        plan.folder,
        tuple(path for _, path, _ in entries),
        gathered.new,
        len(before.keys() - keys.keys()),
        plan.recursive,
        failed | dict.fromkeys(plan.missing, NEVER_FOUND),
    )


def _read_former_recordings(folder: Path, head: Head) -> Former:
    """Return the recordings that the library has."""
    if not head:
        return {}
    table = read_table(folder, head["tables"], "recordings")
    columns = (table.column(name).to_pylist() for name in ("path", "recording", "piece"))
    return {make_path(path): (name, key) for path, name, key in zip(*columns, strict=True)}


def _group_missing(
    plan: Plan, not_found: Former, missing_sources: Sequence[Path]
) -> dict[Path, Path]:
    """Recordings of sources that are not there, by source: as on a disk that was taken out."""
    return {
        path: source
        for path, (_, key) in not_found.items()
        for source in missing_sources
        if is_inside(path, source) and has_analysis(plan.analyses, key)
    }


def _update_tables(
    plan: Plan,
    head: Head,
    before: Former,
    entries: Sequence[Entry],
    failed: Mapping[Path, str],
    progress: Progress,
) -> str:
    """The name of the tables of these recordings, which the head of the library tells now."""
    content = {
        "schema": SCHEMA,
        "kineme": __version__,
        "read_options": options_to_json(plan.read_options),
        "segment_options": options_to_json(plan.segment_options),
        "sources": [str(source) for source in plan.sources],
        "recursive": plan.recursive,
        "clustering": asdict(CONSTANTS),
        "failed": {str(path): reason for path, reason in sorted(failed.items())},
    }
    same = {path: (name, key) for name, path, key in entries} == before
    if same and all(head.get(name) == content[name] for name in ("kineme", "clustering")):
        following, tables = head["following"], head["tables"]
    else:
        from kineme.library.compiling import compile_tables, list_activities

        progress("clusters in common")
        following = max(head.get("following", 0), read_edits(plan.folder).following)
        former = list_activities(plan.folder, head.get("tables"))
        removed = _read_removed(plan.folder)
        returned = {
            name: removed[key] for name, _, key in entries if key in removed and name not in former
        }
        made, following = compile_tables(
            plan.folder, entries, {**returned, **former}, following, progress
        )
        keys = dict(before.values())
        by_key = {keys[name]: spans for name, spans in former.items() if name in keys}
        _write_removed(plan.folder, removed, by_key, (key for _, _, key in entries))
        tables = write_tables(plan.folder, made)
        write_index(plan.folder, tables, made["recordings"].to_pydict())
    now = {**content, "following": following, "tables": tables}
    if now != head:
        write_json(plan.folder / HEAD, now)
    return str(tables)


def _read_removed(folder: Path) -> dict[str, Spans]:
    """Return the activities of recordings that were taken out, by key."""
    try:
        content = read_json(folder / REMOVED, Kept)
    except ReadError as error:
        raise ReadError(folder / REMOVED, DAMAGED) from error
    for starts, stops, clusters in content.values():
        is_even = len(starts) == len(stops) == len(clusters)
        if not (is_even and all(-1 <= cluster < MOST_CLUSTERS for cluster in clusters)):
            raise ReadError(folder / REMOVED, DAMAGED)
    return {
        key: (np.array(starts, float), np.array(stops, float), np.array(clusters, np.int64))
        for key, (starts, stops, clusters) in content.items()
    }


def _write_removed(
    folder: Path, removed: Mapping[str, Spans], before: Mapping[str, Spans], keys: Iterable[str]
) -> None:
    """Keep activities of recordings, removed earlier or there before, that have no key now."""
    present = set(keys)
    content = {
        key: [column.tolist() for column in spans]
        for key, spans in {**removed, **before}.items()
        if key not in present
    }
    if content or (folder / REMOVED).exists():
        write_json(folder / REMOVED, content)


def _delete_unused_files(folder: Path, keys: set[str], tables: str) -> None:
    """Delete files of earlier builds that nothing names, and drafts of builds that were ended."""
    owned = OwnedFolder(folder)
    for home in ((), (ANALYSES,), (TABLES, tables)):
        owned.delete(*home, is_ours=is_draft)
    owned.delete(ANALYSES, is_ours=lambda name: is_analysis(name) and name[:KEY_LENGTH] not in keys)
    with suppress(OSError):
        for path in [*(folder / TABLES).iterdir()]:
            if path.name != tables and is_tables_folder(path.name):
                owned.delete(TABLES, path.name, is_ours=is_table_file)
                with suppress(OSError):  # somebody keeps a file in it
                    path.rmdir()
