"""List what can be opened: the recordings of a folder, each with an id, and its saved tables.

A page only knows ids. An id is valid only for a recording that is listed at that time, so a request
cannot name any other file. The people in a file are read from a small file beside it, once somebody
selected one.

Saved tables are summarised without reading the recordings. Tables in the current format are decoded
directly into the few columns needed, which takes a tenth of the time. Others are read normally.
Summaries are cached until the file changes.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import groupby, pairwise
from pathlib import Path

import msgspec

from kineme._util.files import CORRECTED, refuse_pipe
from kineme.errors import KinemeError, ReadError
from kineme.formats.listing import drop_duplicates, holds_recording, list_files
from kineme.labels import holds_labels, json_table, read_segments
from kineme.segments.annotation import NO_ANNOTATION, Annotation, Span
from kineme.segments.editing import comments
from kineme.segments.editing.annotating import find_marked
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Kind, Level, Segment
from kineme.studio.loading import read_stamp
from kineme.studio.storage.sidecars import ListedRecording, list_recordings, make_file_id
from kineme.studio.storage.tables import find_table_path, list_default_table_paths
from kineme.web.messages import BriefTable

MAX_TABLES = 10_000
"""Summaries cached in memory, about 10 kB each."""


class Folder:
    """A folder, to which uploads go. With ``files``, only these are listed."""

    is_library = False

    def __init__(self, root: Path, files: Iterable[Path] | None = None):
        self.root = root
        self._files = None if files is None else list(files)

    def add(self, path: Path) -> None:
        """List a file that was added later."""
        if self._files is not None and path not in self._files:
            self._files.append(path)

    def recordings(self) -> dict[str, ListedRecording]:
        """Return the recordings by id, sorted by name or in the given order."""
        if self._files is not None:
            files = [path for path in self._files if path.is_file()]
        else:
            present = (path for path in self._listed() if not path.name.endswith(CORRECTED))
            files = drop_duplicates([path for path in present if holds_recording(path)])
        return {each.id: each for each in list_recordings(files)}

    def knowledge_bases(self) -> dict[str, Path]:
        """Return the knowledge bases by id."""
        archives = [path for path in self._listed() if path.suffix.lower() == ".npz"]
        if not archives:
            return {}
        from kineme.transfer.knowledge import holds_knowledge  # its imports take half a second

        return {make_file_id(path): path for path in archives if holds_knowledge(path)}

    def annotations(self, recordings: Iterable[ListedRecording] | None = None) -> dict[str, Path]:
        """Return the label files by id, without the tables that the studio saves.

        ``recordings`` are those of the folder, if they were listed already.
        """
        listed = self.recordings().values() if recordings is None else recordings
        tables = {table for each in listed for table in list_default_table_paths(each)}
        label_files = [path for path in self._listed() if path not in tables and holds_labels(path)]
        return {make_file_id(path): path for path in label_files}

    def folders(self) -> list[Path]:
        """Return the subfolders, where people may keep their labels."""
        try:
            inside = sorted(self.root.iterdir())
        except OSError:
            return []
        return [path for path in inside if path.is_dir() and not path.name.startswith(".")]

    def first_table(self, path: Path) -> Segmentation | None:  # noqa: ARG002 (of a library)
        """Return the initial table of a recording without a saved one, if it is known."""
        return None

    def _listed(self) -> list[Path]:
        try:
            return list_files(self.root)
        except OSError:
            return []


@dataclass(frozen=True)
class Progress:
    """Number of segments of a table: all, checked, named, and those to name (no transitions)."""

    segments: int
    checked: int
    named: int
    to_name: int


def count_progress(listed: ListedRecording) -> Progress | None:
    """Return the progress of a recording; None without a readable table."""
    path = find_table_path(listed)
    table = read_brief(path) if path else None
    if table is None:
        return None
    named = sum(label != "" for label in table.label)
    to_name = sum(kind != "transition" for kind in table.kind)
    return Progress(len(table.level), len(table.checked), named, to_name)


def read_brief(path: Path) -> BriefTable | None:
    """Return the summary of a table file; None if it is missing or cannot be read."""
    try:
        return _summarize_file(path, *read_stamp(path))
    except Exception:  # noqa: BLE001 (a damaged table must not hide the others)
        return None


def summarize_table(table: Segmentation) -> BriefTable:
    """Return the summary of a table."""
    return _make_brief(table, [*table], find_marked(table, "checked"), len(comments(table)))


class _Row(msgspec.Struct):
    level: Level
    kind: Kind
    start_frame: int
    stop_frame: int
    cluster: int
    activity: int
    label: str
    confidence: float | None
    border_confidence: float | None = None


class _Saved(msgspec.Struct):
    schema: str
    n_frames: int
    fps: float
    segments: list[_Row]
    annotation: Annotation = NO_ANNOTATION


@lru_cache(MAX_TABLES)
def _summarize_file(path: Path, *_: int) -> BriefTable | None:
    """Return the summary of a table file. The file stamp is only part of the cache key."""
    try:
        refuse_pipe(path)
        saved = msgspec.json.decode(path.read_bytes(), type=_Saved)
    except (ValueError, ReadError):
        saved = None
    if saved is not None and saved.schema == json_table.SCHEMA and _has_valid_rows(saved):
        annotation = saved.annotation
        return _make_brief(saved, saved.segments, {*annotation.checked}, len(annotation.comments))
    try:
        return summarize_table(read_segments(path, format="json"))
    except KinemeError:
        return None


def _has_valid_rows(saved: _Saved) -> bool:
    """Return whether the rows of each level cover all frames, without gaps or overlaps."""
    levels = [[*rows] for _, rows in groupby(saved.segments, lambda row: row.level)]
    return [rows[0].level for rows in levels] in (["activity"], ["activity", "primitive"]) and all(
        rows[0].start_frame == 0
        and rows[-1].stop_frame == saved.n_frames
        and all(a.start_frame < a.stop_frame for a in rows)
        and all(a.stop_frame == b.start_frame for a, b in pairwise(rows))
        for rows in levels
    )


def _make_brief(
    table: Segmentation | _Saved,
    rows: Sequence[Segment] | Sequence[_Row],
    checked: Container[Span],
    n_comments: int,
) -> BriefTable:
    """Return the message with the columns of a table that the list of recordings needs."""
    spans = [(row.level, row.start_frame, row.stop_frame) for row in rows]
    return BriefTable(
        n_frames=table.n_frames,
        fps=table.fps,
        level=[row.level for row in rows],
        kind=[row.kind for row in rows],
        start_frame=[row.start_frame for row in rows],
        stop_frame=[row.stop_frame for row in rows],
        cluster=[row.cluster for row in rows],
        activity=[row.activity for row in rows],
        label=[row.label for row in rows],
        confidence=[row.confidence for row in rows],  # nan becomes null in JSON
        border_confidence=[row.border_confidence for row in rows],
        checked=[number for number, span in enumerate(spans) if span in checked],
        comments=n_comments,
    )
