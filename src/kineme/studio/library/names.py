"""Names of single hits: a hit is called as the segment is that it shows.

A segment and its name are in the table beside the recording, as everything is that the studio
corrects; nothing changes in the library.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path

from kineme.errors import KinemeError
from kineme.labels import read_segments
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment
from kineme.studio.folder import file_id
from kineme.studio.open_recordings import OpenRecordings, UnknownError
from kineme.studio.reading import stamp_of
from kineme.studio.storage.tables import usual_table
from kineme.web.edits import NameSegment
from kineme.web.library_messages import NamedHits, Span
from kineme.web.requests import EditRequest

SAME = 1 / 3
"""Seconds in common over those in either from which a hit shows a segment: half of each, where
both are as long. Hits begin anywhere in a cycle, so that more would leave half of them out."""
MOST_TABLES = 100
"""In memory."""


def segment_of(table: Segmentation, start_s: float, stop_s: float) -> Segment | None:
    """The segment that a span shows, of the level that fits it best; None where none does.

    Parameters
    ----------
    table : Segmentation
    start_s, stop_s : float

    Returns
    -------
    Segment or None
    """

    def share(row: Segment) -> float:
        common = min(row.stop_s, stop_s) - max(row.start_s, start_s)
        return common / (max(row.stop_s, stop_s) - min(row.start_s, start_s))

    best = max(table, key=share, default=None)
    return best if best is not None and share(best) >= SAME else None


def name_of(recording: Path, start_s: float, stop_s: float) -> str:
    """What the segment that a span shows is called in the table beside its recording, if at all."""
    path = usual_table(recording)
    table = _table(path, *stamp_of(path)) if path else None
    row = segment_of(table, start_s, stop_s) if table is not None else None
    return row.label if row is not None else ""


def call(
    recordings: OpenRecordings, hits: Iterable[tuple[Span, Path | None]], name: str
) -> NamedHits:
    """Give the segments that hits show a name; what cannot be named costs itself.

    Parameters
    ----------
    recordings : OpenRecordings
    hits : iterable of (Span, Path or None)
        Each with the file of its recording, if that is there.
    name : str
        Empty takes it away.

    Returns
    -------
    NamedHits
    """
    named, left = 0, []
    for span, path in hits:
        where = f"{span.recording}, {span.start_s:.2f} to {span.stop_s:.2f} s"
        if path is None:
            left.append(f"{where}: its file is not there")
            continue
        try:
            opened = recordings.get(file_id(path))
            row = segment_of(opened.table, span.start_s, span.stop_s)
            if row is None:
                left.append(f"{where}: no segment lies there")
                continue
            if row.label != name:
                edit = NameSegment(level=row.level, frame=row.start_frame, label=name)
                recordings.edit(opened.id, EditRequest(revision=opened.revision, edit=edit))
            named += 1
        except (KinemeError, UnknownError) as error:
            left.append(f"{where}: {error}")
    return NamedHits(named=named, left=left)


@lru_cache(MOST_TABLES)
def _table(path: Path, *_: int) -> Segmentation | None:
    """Of the file as it was at that time; None where it is no table."""
    try:
        return read_segments(path, format="json")
    except KinemeError:
        return None
