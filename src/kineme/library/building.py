"""Build a library: analyse new recordings, reuse existing analyses, and write the tables."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from kineme._util.checks import check_type, is_whole_number
from kineme._util.files import AnyPath, OwnedFolder, is_draft, make_absolute
from kineme._util.json import options_to_json
from kineme._version import __version__
from kineme.errors import ParameterError, ReadError
from kineme.formats import ReadOptions
from kineme.library.edits import read_edits
from kineme.library.executors import Executor, Progress, connect, start_processes
from kineme.library.gathering import compile_tables, gather, list_activities
from kineme.library.planning import (
    Entry,
    Plan,
    as_paths,
    list_recordings,
    make_plan,
    name_recordings,
    open_folder,
)
from kineme.library.storage.layout import (
    ANALYSES,
    HEAD,
    KEY_LENGTH,
    LOCK_EDITS,
    MOST_CLUSTERS,
    SCHEMA,
    TABLES,
    import_arrow,
    is_inside,
    lock_for_writing,
    make_path,
    read_json,
    translate_remote_errors,
    write_json,
)
from kineme.library.storage.tables import (
    has_analysis,
    is_analysis,
    is_table_file,
    is_tables_folder,
    read_table,
    write_index,
    write_tables,
)
from kineme.methods.segmenter import SegmentOptions
from kineme.transfer.clusters import CONSTANTS, Spans

Head = Mapping[str, Any]
"""Content of ``library.json``; empty if there is none yet."""
FormerRecordings = Mapping[Path, tuple[str, str]]
"""Name and analysis key of the recordings in the library, by path."""
REMOVED = "left.json"
"""File of the clusters of removed recordings by analysis key, in case they are added again."""
DAMAGED = "is damaged: remove it. Clusters of recordings that are added again then get new numbers"
NEVER_FOUND = "there is no such file or folder"
NOT_FOUND = "is missing, so its recordings are kept: --remove removes them"


class RemovedRecording(NamedTuple):
    """Activities of a removed recording: starts, stops (seconds) and clusters; and its name."""

    starts: list[float]
    stops: list[float]
    clusters: list[int]
    recording: str = ""


@dataclass(frozen=True)
class Built:
    """Result of a build.

    Attributes
    ----------
    folder : Path
        Folder of the library.
    paths : tuple of Path
        Recordings in the library.
    new : int
        Number of recordings that were read and segmented.
    removed : int
        Number of recordings that were removed.
    recursive : bool
        Whether subfolders were searched.
    failed : Mapping of Path to str
        Recordings that could not be read or segmented, and why.
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
    """Create or update a library of recordings.

    Sources are added to those of the library. New or changed recordings are read and segmented;
    recordings that disappeared from a source are removed. An interrupted build continues, and
    failed recordings are tried again.

    Parameters
    ----------
    sources : path-like, or iterable of path-like
        Recordings and folders of recordings; empty to update the known sources.
    into : path-like
        Folder of the library; created if missing.
    remove : iterable of path-like
        Sources to remove, with their recordings.
    recursive : bool, optional
        Search subfolders, too; as in the last build by default.
    read_options : ReadOptions, optional
        Options for reading; as in the last build by default.
    segment_options : SegmentOptions, optional
        Options for segmenting; as in the last build by default. If either differs from the
        last build, all recordings are analysed again.
    jobs : int
        Number of processes. With more than 1, a script must guard its code with
        ``if __name__ == "__main__"``, as always with multiprocessing.
    client : dask.distributed.Client or str, optional
        Use this cluster instead, or that of the scheduler at an address. Its workers need
        recordings and library under the same paths.
    progress : callable, optional
        Called with a description of the progress.

    Raises
    ------
    ParameterError
        No source, or invalid options.
    ReadError
        The folder is not a library of this version, or no source of a new library exists.
    WriteError
        The folder cannot be written, or another build is running on it.
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
    if not is_whole_number(jobs, 1):
        raise ParameterError(f"jobs must be a whole number from 1, not {jobs!r:.60}")
    check_type(recursive, (bool, type(None)), "build", "recursive is True or False")
    checked = ((read_options, ReadOptions), (segment_options, SegmentOptions))
    for options, kind in checked:
        check_type(options, (kind, type(None)), "build", f"{kind.__name__}() makes one")
    with start_processes(int(jobs)) if client is None else connect(client) as executor:
        added, removed = as_paths(sources), as_paths(remove)
        is_new = not make_path(into).exists()
        if is_new and added and not any(make_absolute(source).exists() for source in added):
            raise ReadError(added[0], NEVER_FOUND)  # before the folder is created
        folder = open_folder(into, added)
        with lock_for_writing(folder, "build"), translate_remote_errors(folder):
            head = read_json(folder / HEAD)
            plan = make_plan(folder, head, added, removed, recursive, read_options, segment_options)
            return _update_library(plan, head, executor, progress or (lambda _: None))


def _update_library(plan: Plan, head: Head, executor: Executor, progress: Progress) -> Built:
    """Update the library, which the caller has locked."""
    progress("looking for recordings")
    before = _read_former_recordings(plan.folder, head)
    recordings = list_recordings(
        plan.sources, recursive=plan.recursive, without=make_absolute(plan.folder)
    )
    missing_sources = [source for source in plan.sources if not source.exists()]
    # Recordings of a missing source, such as a removed disk, and that source.
    absent = {
        path: source
        for path, (_, key) in before.items()
        for source in missing_sources
        if path not in recordings and is_inside(path, source) and has_analysis(plan.analyses, key)
    }
    gathered = gather(plan, list(recordings), executor, progress)
    failed = dict.fromkeys(missing_sources, NOT_FOUND) | gathered.failed
    keys = {path: plan.key(digest) for path, digest in gathered.digests.items()}
    keys |= {path: before[path][1] for path in absent}
    names = name_recordings(
        {path: source for path, source in {**recordings, **absent}.items() if path in keys},
        {path: name for path, (name, _) in before.items()},
    )
    entries = sorted((name, path, keys[path]) for path, name in names.items())
    with lock_for_writing(plan.folder, "build", LOCK_EDITS):
        tables = _update_tables(plan, head, before, entries, failed, progress)
    _delete_unused_files(plan.folder, {key for _, _, key in entries}, tables)
    return Built(
        plan.folder,
        tuple(path for _, path, _ in entries),
        new=gathered.new,
        removed=len(before.keys() - keys.keys()),
        recursive=plan.recursive,
        failed=failed | dict.fromkeys(plan.missing, NEVER_FOUND),
    )


def _read_former_recordings(folder: Path, head: Head) -> FormerRecordings:
    """Return the recordings in the library, by path."""
    if not head:
        return {}
    table = read_table(folder, head["tables"], "recordings")
    columns = (table.column(name).to_pylist() for name in ("path", "recording", "piece"))
    return {make_path(path): (name, key) for path, name, key in zip(*columns, strict=True)}


def _update_tables(
    plan: Plan,
    head: Head,
    before: FormerRecordings,
    entries: Sequence[Entry],
    failed: Mapping[Path, str],
    progress: Progress,
) -> str:
    """Write the tables of these recordings and the head that names them; return their name."""
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
    former = list_activities(plan.folder, head.get("tables"))
    is_unchanged = {path: (name, key) for name, path, key in entries} == before
    # Damaged tables may lack the segments of a recording.
    is_unchanged &= former.keys() == {name for name, _, _ in entries}
    if is_unchanged and all(head.get(name) == content[name] for name in ("kineme", "clustering")):
        next_cluster, tables = head["following"], head["tables"]
    else:
        progress("clusters in common")
        edits, (removed, gone) = read_edits(plan.folder), _read_removed(plan.folder)
        next_cluster = max(head.get("following", 0), edits.next_cluster)
        pairs, present = {*before.values()}, {(name, key) for name, _, key in entries}
        by_key = {key: former[name] for name, key in sorted(pairs) if name in former}
        # Renamed and restored files are recognised by their content, changed ones by their name.
        known = {**removed, **by_key}
        moved = {name: key for name, key in sorted(present - pairs) if key in known}
        spans = {**former, **{name: known[key] for name, key in moved.items()}}
        new_tables, next_cluster = compile_tables(
            plan.folder, entries, spans, next_cluster, progress
        )
        gone |= {key: name for name, key in sorted(pairs - present)}
        _write_removed(plan.folder, {**removed, **by_key}, gone, {key for _, key in present})
        same = {name: name for name, _ in pairs & present}
        renamed = {name: gone[key] for name, key in moved.items() if key in gone}
        if (updated := edits.with_renamed(same | renamed)) != edits:
            updated.write(plan.folder)
        tables = write_tables(plan.folder, new_tables)
        write_index(plan.folder, tables, new_tables["recordings"].to_pydict())
    head_now = {**content, "following": next_cluster, "tables": tables}
    if head_now != head:
        write_json(plan.folder / HEAD, head_now)
    return str(tables)


def _read_removed(folder: Path) -> tuple[dict[str, Spans], dict[str, str]]:
    """Return the activities and names of removed recordings, by analysis key."""
    try:
        content = read_json(folder / REMOVED, RemovedRecording)
    except ReadError as error:
        raise ReadError(folder / REMOVED, DAMAGED) from error
    for starts, stops, clusters, _ in content.values():
        is_same_length = len(starts) == len(stops) == len(clusters)
        if not (is_same_length and all(-1 <= cluster < MOST_CLUSTERS for cluster in clusters)):
            raise ReadError(folder / REMOVED, DAMAGED)
    spans = {
        key: (np.array(starts, float), np.array(stops, float), np.array(clusters, np.int64))
        for key, (starts, stops, clusters, _) in content.items()
    }
    return spans, {key: each.recording for key, each in content.items()}


def _write_removed(
    folder: Path, spans: Mapping[str, Spans], names: Mapping[str, str], present: set[str]
) -> None:
    """Store the activities and names of recordings that are not in the library any more."""
    content = {
        key: [*(column.tolist() for column in columns), names.get(key, "")]
        for key, columns in spans.items()
        if key not in present
    }
    if content or (folder / REMOVED).exists():
        write_json(folder / REMOVED, content)


def _delete_unused_files(folder: Path, keys: set[str], tables: str) -> None:
    """Delete files of earlier builds that are not used any more, and drafts of killed builds."""
    owned = OwnedFolder(folder)
    for home in ((), (ANALYSES,), (TABLES, tables)):
        owned.delete(*home, is_ours=is_draft)
    owned.delete(ANALYSES, is_ours=lambda name: is_analysis(name) and name[:KEY_LENGTH] not in keys)
    with suppress(OSError):
        for path in [*(folder / TABLES).iterdir()]:
            if path.name != tables and is_tables_folder(path.name):
                owned.delete(TABLES, path.name, is_ours=is_table_file)
                with suppress(OSError):  # not empty: it holds other files
                    path.rmdir()
