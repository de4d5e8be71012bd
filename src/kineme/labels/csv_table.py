"""Segments in CSV: a header line, one line per row, UTF-8, comma (or tab), decimal point.

There are no comment lines, so ``pandas.read_csv`` and spreadsheets read the file directly.
Frame rate, provenance and timings are in ``NAME.provenance.json`` beside ``NAME.csv``, with a
digest of the cuts: if cuts were edited since, a note reports it. Without that file the frame
rate is computed from the last row. Empty numbers are nan. Labels that spreadsheets would run as
formulas start with ``'``. Columns are found by name; unknown ones are ignored.

Handwritten tables of intervals are read as well: ``label`` with ``start_s`` and ``stop_s``
(seconds, or dates such as 2026-01-31T09:30:00.25), or with ``start_frame`` and ``stop_frame``,
in any order, and optionally ``level``, ``kind``, ``cluster`` and ``count`` (repetitions). Columns
may have other usual names (`kineme.formats.label_columns`), milliseconds, or durations. Uncovered
frames are transitions. A column ``recording`` must name only one recording; tables of several are
read by `kineme.labels.collections`.
"""

from __future__ import annotations

import csv
import json
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import astuple, replace
from itertools import chain
from pathlib import Path
from typing import Any, Literal

from kineme._util.files import atomic_write, translate_read_errors
from kineme.errors import ReadError
from kineme.formats.delimited import find_separator, from_text, split_cells
from kineme.formats.label_columns import FROM_TO, SPANS, holds_spans, rename_columns
from kineme.labels.delimited import (
    CUTS_KEY,
    digest_cuts,
    find_differences,
    open_new_text,
    parse_level,
    parse_number,
    read_columns,
    read_first_bytes,
    read_rows,
    write_rows,
)
from kineme.labels.json_table import SCHEMA, join_head, make_head, parse
from kineme.labels.registry import LabelFormat
from kineme.labels.spans import Labels, Span, require_one_recording
from kineme.recordings.cells import is_number, replace_decimal_comma
from kineme.recordings.times import HOURLESS, is_date, may_count_hours, parse_date
from kineme.segments.editing.annotating import assign_comments, set_comments_by_row
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import COLUMNS, COMMENT, Segment, find_lacking, sort_rows


def write(_: Sequence[Segment], segmentation: Segmentation, path: Path) -> None:
    """Write the table to ``path`` and the rest to the provenance file beside it."""
    provenance_path = name_provenance(path)
    head = make_head(segmentation) | {CUTS_KEY: _digest_columns(segmentation.table.columns())}
    more: dict[str, Sequence[Any]] = {**segmentation.more_columns()}
    if any(comments := assign_comments(segmentation)):
        more[COMMENT] = comments
    rows = zip(map(_format_cells, segmentation), *more.values(), strict=True)
    with atomic_write(provenance_path) as head_draft, open_new_text(path) as file:
        head_draft.write_text(json.dumps(head, indent=2) + "\n", encoding="utf-8")
        write_rows(file, [*COLUMNS, *more], ([*cells, *others] for cells, *others in rows))


def read(path: Path) -> Segmentation | Labels:
    """Read a segment table with its provenance file, or a table of intervals."""
    with path.open(encoding="utf-8-sig", newline="") as file:
        first = file.readline()
        comma = find_separator(first)
        names = set(next(csv.reader([first], delimiter=comma), []))
        if {"time_s", "event"} <= names and not holds_spans(names):
            raise ReadError(
                path,
                "is a table of events, which have no duration: kineme events --labels FILE writes "
                "the spans between them",
            )
        # Tables of intervals have no such pair of columns.
        if not {"level", "start_frame"} <= names:
            return require_one_recording(read_intervals(path), path)
        file.seek(0)
        rows = csv.DictReader(file, strict=True, delimiter=comma)
        columns = _list_columns(rows, path, commas=comma != ",")
    comments = columns.pop(COMMENT, None)
    segmentation = _attach_provenance(columns, path)
    if comments is None:
        return segmentation
    # The rows of the file may be in another order than those of the table.
    return set_comments_by_row(segmentation, [comments[row] for row in sort_rows(columns)])


def _attach_provenance(columns: dict[str, list[Any]], path: Path) -> Segmentation:
    """Return the table with the content of its provenance file, if there is one."""
    provenance_path = name_provenance(path)
    if not provenance_path.is_file():
        return join_head(columns, _guess_head(columns, path), path)
    # A shortened or extended table does not match its provenance file.
    head = parse(provenance_path.read_text(encoding="utf-8-sig"), provenance_path)
    if head.get("n_frames") != max(columns["stop_frame"]):
        raise ReadError(
            path,
            f"ends at frame {max(columns['stop_frame'])}, but {provenance_path.name} states "
            f"{head.get('n_frames')!r} frames: remove that file if it belongs to another table",
        )
    rest = {name: value for name, value in head.items() if name != "hierarchy"}
    table = join_head(columns, rest, path)
    rates = {"head_rate": table.fps, "row_rate": _read_rate(columns)}
    changes = find_differences(path, provenance_path, head, _digest_columns(columns), **rates)
    if not changes:
        return join_head(columns, head, path)
    notes = [*table.provenance.get("notes", ()), *changes]
    return replace(table, provenance={**table.provenance, "notes": notes})


def name_provenance(path: Path) -> Path:
    """Return the path of a table's provenance file: ``cuts.provenance.json`` for ``cuts.csv``."""
    return path.with_suffix(".provenance.json")


def choose_roundest_rate(n_frames: int, seconds: float) -> float:
    """Return the frame rate with the fewest digits that gives exactly this duration."""
    # Try 0 digits first; the first rate that reproduces the seconds wins.
    rounded = (round(n_frames / seconds, digits) for digits in range(16))
    return next((fps for fps in rounded if fps and n_frames / fps == seconds), n_frames / seconds)


def lists_recordings(path: Path) -> bool:
    """Return whether a table has a column ``recording``, or lists several in one named otherwise.

    A single name in a column such as ``file`` may be that of a video of the recording.
    """
    columns = read_columns(path)
    has_other_name = "recording" in rename_columns(columns) and "recording" not in columns
    if not (has_other_name and _recognises(path)):
        return "recording" in columns
    with translate_read_errors(path):
        return len(read_intervals(path)) > 1


def read_intervals(path: Path) -> dict[str, Labels]:
    """Read a table of intervals; return labels by recording, or by "" without that column."""
    first, second = SPANS[0]
    spans: dict[str, list[Span]] = {}
    times: list[str] = []
    with path.open(encoding="utf-8-sig", newline="") as file:
        headers = [(*names, "label") for names in SPANS]
        for line, row in read_rows(file, path, headers, rename_columns, numbers={*chain(*SPANS)}):
            first, second = next(names for names in SPANS if set(names) <= set(row))
            start, stop = (_parse_time(row[name], name, path, line) for name in (first, second))
            times += (row[first].strip(), row[second].strip())
            stop += start if second.startswith("duration") else 0.0
            count = _parse_count(row, path, line)
            text = "transition" if row.get("kind") == "transition" else row["label"]
            level = parse_level(row.get("level"))
            span = Span(start, stop, text, level, _parse_cluster(row), repetitions=count)
            spans.setdefault(row.get("recording", ""), []).append(span)
    unit: Literal["seconds", "frames"] = "frames" if first.endswith("frame") else "seconds"
    remarks = (HOURLESS,) if unit == "seconds" and may_count_hours(times) else ()
    return {recording: Labels(some, unit, remarks=remarks) for recording, some in spans.items()}


def _parse_time(cell: str, name: str, path: Path, line: int) -> float:
    """Return a time in frames or seconds.

    It may also be a date (seconds since 1970), a time of day (since midnight), or minutes and
    seconds, which `convert_clock_times` may take for hours and minutes.
    """
    if not name.endswith("frame") and is_date(cell.strip()):
        return parse_date(cell.strip())
    value = parse_number(cell, name, path, line)
    return value / 1000 if name.endswith("_ms") else value


def _parse_cluster(row: dict[str, str]) -> int:
    """Return the cluster number in a row; -1 for other texts."""
    text = row.get("cluster", "").strip()
    return int(text) if re.fullmatch("[0-9]{1,9}", text) else -1


def _parse_count(row: dict[str, str], path: Path, line: int) -> int | None:
    text = row.get("count", "").strip()
    if text and not text.isdecimal():
        raise ReadError(path, f"count must be a whole number, not {text!r:.60}", line=line)
    return int(text) if text else None


def _list_columns(rows: csv.DictReader[str], path: Path, *, commas: bool) -> dict[str, list[Any]]:
    """Return the known columns of a table as lists."""
    names = rows.fieldnames or ()
    columns: dict[str, list[Any]] = {name: [] for name in (*COLUMNS, COMMENT) if name in names}
    try:
        missing = find_lacking(columns)
        if missing:
            raise ReadError(path, f"is not a segment table: it has no column {missing[0]!r}")
        for row in rows:
            for name, column in columns.items():
                column.append(_read_cell(row[name], name, path, rows.line_num, commas=commas))
    except csv.Error as error:
        raise ReadError(path, f"is not valid CSV: {error}", line=rows.line_num) from error
    if not columns["level"]:
        raise ReadError(path, "has no segments")
    return columns


def _read_cell(text: str | None, name: str, path: Path, line: int, *, commas: bool) -> str | float:
    """Return a cell in the type of its column; an empty number is nan."""
    if text is None:
        raise ReadError(path, f"the line ends before column {name!r}", line=line)
    kind = COLUMNS[name].type if name in COLUMNS else str
    if kind is str:
        return from_text(text)
    if kind is float and not text.strip():
        return math.nan
    try:
        return kind(replace_decimal_comma(text) if commas else text)
    except ValueError as error:
        needed = "a whole number" if kind is int else "a number"
        raise ReadError(path, f"{name} must be {needed}, not {text!r}", line=line) from error


def _digest_columns(columns: Mapping[str, Any]) -> str:
    return digest_cuts(
        zip(columns["level"], columns["start_frame"], columns["stop_frame"], strict=True)
    )


def _read_rate(columns: dict[str, list[Any]]) -> float | None:
    """Return the frame rate computed from the last row; None if impossible."""
    # The last row has the longest time, hence the most exact ratio.
    n_frames, seconds = max(zip(columns["stop_frame"], columns["stop_s"], strict=True))
    valid = 0 < n_frames < 2**53 and 0 < seconds < math.inf
    return choose_roundest_rate(n_frames, seconds) if valid else None


def _guess_head(columns: dict[str, list[Any]], path: Path) -> dict[str, Any]:
    """Return a head for a table without provenance file, from its last row."""
    n_frames, fps = max(columns["stop_frame"]), _read_rate(columns)
    if fps is None:
        seconds = max(columns["stop_s"])
        raise ReadError(
            path, f"ends at frame {n_frames}, {seconds} s, so its frame rate cannot be computed"
        )
    note = (
        f"frame rate {fps:g} Hz computed from frames and seconds: no {name_provenance(path).name}"
    )
    return {"schema": SCHEMA, "n_frames": n_frames, "fps": fps, "provenance": {"notes": [note]}}


def _format_cells(row: Segment) -> list[Any]:
    return ["" if isinstance(cell, float) and math.isnan(cell) else cell for cell in astuple(row)]


def _recognises(path: Path) -> bool:
    """Return whether the first line has the columns of segments or intervals."""
    names = read_columns(path)
    if {name.lower() for name in names} >= FROM_TO:
        # The edges of a graph have columns of these names, too, but hold no number.
        row = "".join(read_first_bytes(path).decode(errors="replace").splitlines()[1:2])
        cells = split_cells(row, find_separator(row))
        if row and not any(is_number(cell) or is_date(cell) for cell in cells):
            return False
    return holds_spans(names)


FORMAT = LabelFormat(
    name="csv",
    help="The table, for spreadsheets",
    suffixes=(".csv", ".tsv"),
    holds="all",
    read=read,
    write=write,
    recognises=_recognises,
)
