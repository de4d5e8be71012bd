"""BORIS events as CSV: a START and a STOP row per segment, both levels.

Written as BORIS's "tabular events": ``Time`` in seconds beside ``Image index``
(the first frame of a START, one past the last of a STOP, counted from 0),
frame rate and length of the recording on every row, the level as
``Behavioral category``. Scores are not kept.

Read are the tabular events of old and new versions (header line below a
preamble or on top; START and STOP under ``Behavior type`` or ``Status``) and
the aggregated ones (``Start (s)``, ``Stop (s)``). POINT events last no
time and are left out with a warning. Rows of several subjects or observations must not overlap.

Source: BORIS user guide, "Export events".
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

from kineme.errors import ReadError
from kineme.formats.label_tables import is_boris_table
from kineme.labels.delimited import (
    head,
    level_of,
    new_text,
    number,
    read_rows,
    source_path,
    write_rows,
)
from kineme.labels.registry import LabelFormat
from kineme.labels.spans import Labels, Span, text_of
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment

COLUMNS = (
    "Observation id",
    "Observation date",
    "Description",
    "Observation type",
    "Source",
    "Time offset (s)",
    "Media duration (s)",
    "FPS (frame/s)",
    "Subject",
    "Behavior",
    "Behavioral category",
    "Behavior type",
    "Time",
    "Media file name",
    "Image index",
    "Image file path",
    "Comment",
)
RATES = ("FPS (frame/s)", "FPS")
LENGTHS = ("Media duration (s)", "Observation duration", "Total length")
Cells = dict[str, str]


def write(rows: Sequence[Segment], segmentation: Segmentation, path: Path) -> None:
    """Leave two rows per segment at ``path``, in time order."""
    media = source_path(segmentation)
    facts = {
        "Observation id": Path(media).stem,
        "Observation type": "Media file(s)",
        "Source": media,
        "Time offset (s)": 0.0,
        "Media duration (s)": segmentation.n_frames / segmentation.fps,
        "FPS (frame/s)": segmentation.fps,
        "Subject": "No focal subject",
        "Media file name": media,
    }
    events = [
        {
            "Behavior": text_of(row),
            "Behavioral category": row.level,
            "Behavior type": kind,
            "Time": time,
            "Image index": frame,
        }
        for row in rows
        for kind, time, frame in (
            ("START", row.start_s, row.start_frame),
            ("STOP", row.stop_s, row.stop_frame),
        )
    ]
    # What stops at a frame comes before what starts there.
    events.sort(key=lambda event: (event["Image index"], event["Behavior type"] == "START"))
    with new_text(path) as file:
        lines = ({**facts, **event} for event in events)
        write_rows(file, COLUMNS, ([line.get(name, "") for name in COLUMNS] for line in lines))


def read(path: Path) -> Labels:
    """Return the state events at ``path``."""
    headers = [("Time", "Behavior"), ("Start (s)", "Stop (s)", "Behavior")]
    with path.open(encoding="utf-8-sig", newline="") as file:
        rows = list(read_rows(file, path, headers))
    spans = list(
        _pair_states(rows, path) if rows and "Time" in rows[0][1] else _read_aggregated(rows, path)
    )
    points = Counter(cells["Behavior"] for _, cells in rows if _kind(cells) == "POINT")
    listed = ", ".join(f"{name} ({count})" for name, count in points.items())
    notes = (f"point events last no time and are left out: {listed:.200}",) if points else ()
    return Labels(spans, "seconds", _fact(rows, RATES), _fact(rows, LENGTHS), notes)


def _pair_states(rows: list[tuple[int, Cells]], path: Path) -> Iterator[Span]:
    """Yield each STOP with the START of the same behavior before it."""
    starts: dict[tuple[str, ...], float] = {}
    for line, cells in rows:
        kind = _kind(cells)
        if kind == "POINT":
            continue
        same = ("Observation id", "Subject", "Behavior", "Behavioral category")
        # States of several subjects and observations may be open at once.
        key = tuple(cells.get(name, "") for name in same)
        time = number(cells["Time"], "Time", path, line)
        if kind == "START" and key not in starts:
            starts[key] = time
        elif kind == "STOP" and key in starts:
            yield Span(
                starts.pop(key), time, cells["Behavior"], level_of(cells.get("Behavioral category"))
            )
        else:
            reason = f"{cells['Behavior']!r:.60} has a {kind!r:.20} where START and STOP alternate"
            raise ReadError(path, reason, line=line)
    if starts:
        raise ReadError(path, f"{next(iter(starts))[2]!r:.60} has a START without a STOP")


def _read_aggregated(rows: list[tuple[int, Cells]], path: Path) -> Iterator[Span]:
    for line, cells in rows:
        if _kind(cells) == "POINT":
            continue
        start = number(cells["Start (s)"], "Start (s)", path, line)
        stop = number(cells["Stop (s)"], "Stop (s)", path, line)
        level = level_of(cells.get("Behavioral category"))
        yield Span(start, stop, cells["Behavior"], level)


def _kind(cells: Cells) -> str:
    return (cells.get("Behavior type") or cells.get("Status") or "").strip().upper()


def _fact(rows: list[tuple[int, Cells]], names: Sequence[str]) -> float | None:
    """Return what the first row says about the recording, if that is a positive number."""
    for name in names:
        try:
            value = float(rows[0][1][name]) if rows else 0.0
        except (KeyError, ValueError):
            continue
        if 0 < value < 1e15:
            return value
    return None


FORMAT = LabelFormat(
    name="boris",
    help="BORIS events",
    suffixes=(".csv",),
    holds="levels",
    read=read,
    write=write,
    recognises=lambda path: is_boris_table(head(path).decode(errors="replace")),
)
