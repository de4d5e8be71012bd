"""Summaries of the saved tables of a folder, without reading the recordings.

Tables in the current format are decoded directly into the few columns needed, which takes a tenth
of the time. Others are read normally. Summaries are cached until the file changes.
"""

from __future__ import annotations

from collections.abc import Container, Sequence
from functools import lru_cache
from itertools import groupby, pairwise
from pathlib import Path

import msgspec

from kineme._util.files import refuse_pipe
from kineme.errors import KinemeError, ReadError
from kineme.labels import json_table, read_segments
from kineme.segments.annotation import NO_ANNOTATION, Annotation, Span
from kineme.segments.editing import comments
from kineme.segments.editing.annotating import find_marked
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Kind, Level, Segment
from kineme.studio.recording_cache import read_stamp
from kineme.web.messages import BriefTable

MAX_TABLES = 10_000
"""Summaries cached in memory, about 10 kB each."""


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
