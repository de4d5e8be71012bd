"""How far each recording of a folder is: what its table holds, without opening the recording."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from kineme.errors import KinemeError
from kineme.labels import read_segments
from kineme.segments.editing.marks import marked
from kineme.studio.reading import stamp_of
from kineme.studio.storage.tables import usual_table

MOST_KNOWN = 10_000
"""Tables whose counts stay in memory."""


@dataclass(frozen=True)
class Progress:
    """How many segments a table has, are checked, have a name, and are no transitions."""

    segments: int
    checked: int
    named: int
    to_name: int


def progress(recording: Path) -> Progress | None:
    """How far a recording is, as its table says.

    Parameters
    ----------
    recording : Path

    Returns
    -------
    Progress or None
        None where it has no table, or one that cannot be read.
    """
    path = usual_table(recording)
    try:
        return _counts(path, *stamp_of(path)) if path else None
    except Exception:  # noqa: BLE001 (a table that is damaged in any way costs itself only)
        return None


@lru_cache(MOST_KNOWN)
def _counts(path: Path, *_: int) -> Progress | None:
    """Of the file as it was at that time; a file that is no table counts for none."""
    try:
        table = read_segments(path, format="json")
    except KinemeError:
        return None
    named = int((table.table.label != "").sum())
    to_name = int((table.table.kind != "transition").sum())
    return Progress(len(table), len(marked(table, "checked")), named, to_name)
