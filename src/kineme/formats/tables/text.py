"""Text tables of joint positions or of channels: CSV, TSV; and CSV out.

What the columns may be called: `kineme.formats.columns`. Lines before the names
that begin with ``#`` are passed over. Written are ``time`` in seconds and
``JOINT_x JOINT_y JOINT_z`` in metres, y up, empty in gaps; the skeleton is not.
"""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

from kineme.errors import ReadError
from kineme.formats.channels.reading import to_signals
from kineme.formats.channels.sensors import hold_channels
from kineme.formats.channels.text import TextTable, text_channels
from kineme.formats.channels.writing import write_signals
from kineme.formats.columns import RATE, columns_to_motion, dated, is_timing, is_used
from kineme.formats.delimited import EMPTY, as_text, from_text, rows_of
from kineme.formats.files import FileContent, in_a_cell, save, spelled, unique
from kineme.formats.gaps import unseen
from kineme.formats.interleaved import refuse_interleaved
from kineme.formats.keypoints.deeplabcut import is_deeplabcut, read_deeplabcut
from kineme.formats.layout import COMMAS, first_full, has_commas, is_number, layout_of
from kineme.formats.markers.capture_tables import is_capture_table, read_capture_table
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format
from kineme.formats.tables.pose_tables import POSE_TABLES, PoseTable
from kineme.formats.timing import NO_TIMES, is_date
from kineme.recordings import Motion, Signals

NAME = "table"


def read_table(content: FileContent, options: ReadOptions) -> Motion | Signals:
    """The joints or keypoints in a text table, or its channels where there are none."""
    if not options.channels and is_capture_table(content.data):
        return read_capture_table(content, options)
    channels = _channels(content, asked=options.channels)
    if channels is not None:
        table = text_channels(content, channels, options.columns or None)
        return to_signals(content, NAME, table, options.fps)
    return _read_motion(content, options)


def write_csv(motion: Motion, path: Path) -> None:
    """Leave the joints' positions in a CSV file, in metres with y up."""
    joints = spelled(path, motion.skeleton.names, lambda n: in_a_cell(n.replace('"', "'")))
    rate = [RATE] if motion.n_frames < 2 else []  # which the time of one row does not tell
    names = [*rate, "time", *(f"{joint}_{axis}" for joint in joints for axis in "xyz")]
    head = ",".join(f'"{name}"' if "," in name else name for name in map(as_text, names)) + "\n"
    told = "".join(f"{motion.fps!r}," for _ in rate)
    cells = 3 * len(joints)
    row = f"{told}%.9f{',%.9f' * cells}\n"
    empty = f"{told}%.9f{',' * cells}\n"
    values = motion.positions.reshape(motion.n_frames, -1).tolist()
    rows = zip(motion.times.tolist(), values, unseen(motion), strict=True)
    save(path, [head, *(empty % t if gap else row % (t, *line) for t, line, gap in rows)])


def _channels(content: FileContent, *, asked: bool) -> TextTable | None:
    """The table, where it is one of channels or is asked for as such."""
    try:
        table = TextTable.of(content)
    except ReadError:
        if asked:
            raise
        return None
    return table if asked or hold_channels(table.head) else None


def _read_motion(content: FileContent, options: ReadOptions) -> Motion:
    lines = content.text.splitlines()
    layout = layout_of(lines)
    if layout is None:
        raise content.error("has no lines of numbers")
    first, separator = layout.names, layout.separator
    if is_deeplabcut(lines[first]):
        return read_deeplabcut(content, lines[first:], first + 1, options)
    names = unique(map(from_text, _cells(lines[first], separator, content)))
    table = PoseTable(content, names, lines[first + 1 :], first + 2, separator)
    for recognises, reader in POSE_TABLES:
        if recognises(names):
            return reader(table, options)
    refuse_interleaved(content, names, lines[layout.below :], separator)
    timeless = options.fps is not None
    used = [i for i, n in enumerate(names) if is_used(n) and not (timeless and is_timing(n))]
    below, line = lines[layout.below :], layout.below + 1
    cells = _cells(first_full(below), separator, content)
    dates = dated(names, cells)
    if wrong := [names[i] for i in used if i < len(cells) and _tells_nothing(names[i], cells[i])]:
        raise content.error(f"column {wrong[0]!r} {NO_TIMES}: give fps= (--fps)", line)
    comma = has_commas(below, separator)
    values = rows_of(content, below, line, separator, len(names), used, dates=dates, comma=comma)
    columns = {names[i]: column for i, column in zip(used, values.T, strict=True)}
    motion = columns_to_motion(content, NAME, columns, options)
    return motion.noted(*layout.notes, *((COMMAS,) if comma else ()))


def _tells_nothing(name: str, cell: str) -> bool:
    """Whether a column is called as times are, and its first cell is none."""
    known = is_number(cell) or is_date(cell) or cell.lower() in EMPTY
    return is_timing(name) and not known


def _cells(line: str, separator: str, content: FileContent) -> list[str]:
    try:
        return [cell.strip() for cell in next(csv.reader([line], delimiter=separator))]
    except (csv.Error, StopIteration) as error:
        raise content.error(f"the columns' names cannot be read: {error}") from None


FORMAT = Format(
    NAME,
    (".csv", ".tsv"),
    lambda _: False,
    read_table,
    write_csv,
    write_signals,
    channels=True,
)
TEXT = replace(FORMAT, name="text table", suffixes=(".txt", ".dat"), write=None)
