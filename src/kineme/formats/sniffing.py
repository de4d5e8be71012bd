"""Find the table in a text file of no known device, and the timing of any table.

`kineme.formats.devices` describes the tables of known devices. In others:

- Lines above the names may be blank, start with ``#``, be the ``sep=;`` of spreadsheets, a header
  that ends with ``endheader``, or describe the device. One of them may state the frame rate:
  ``Sample rate: 120.0Hz``, ``Frequency,50``.
- Tabs, semicolons or commas separate cells, else blanks.
- Up to two lines of words may follow the names: units, kinds of numbers, or second names if the
  first ones are shared by several columns.
- Names may be missing: the table then starts with a row of numbers.

`kineme.recordings.times` describes columns of times, `kineme.recordings.regular` how rows become
frames.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import chain, dropwhile, islice, takewhile

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Floats
from kineme._util.checks import format_count, join_names
from kineme.errors import ParameterError
from kineme.formats.delimited import (
    DelimitedText,
    find_separator,
    from_text,
    is_finite,
    make_unique_names,
    split_cells,
)
from kineme.formats.files import FileContent
from kineme.recordings import Note
from kineme.recordings.arrays import list_spans, mark_spans
from kineme.recordings.cells import is_number
from kineme.recordings.column_names import EMPTY
from kineme.recordings.regular import Timing, place_rows
from kineme.recordings.times import (
    UNITS_NAMED,
    as_seconds,
    find_time_unit,
    is_date,
    is_rate,
    is_time,
    is_timing,
)

MAX_HEADER_LINES = 200
"""Maximum number of lines above the names."""

MAX_WORD_LINES = 2
"""Maximum number of lines of words between names and numbers."""

SEPARATOR = re.compile(r"\s*\"?sep=(.)\"?\s*", re.IGNORECASE)
"""Line in which spreadsheets declare the separator."""

_MIN_RATE = 1.0  # frames per second; times without a unit that give less are not seconds
_RATE = re.compile(
    r"\b(?:(?:sampl\w+|frame|update|output|measurement|capture|data)[\s_]*)?"
    r"(?:rate|frequency|freq|fps)\b\s*(?:[(\[]hz[)\]])?[^\w]*(\d+(?:[.,]\d+)?)",
    re.IGNORECASE,
)
_NO_FRAME_RATE = re.compile(r"cut|pass|notch|bandwidth|analog|range", re.IGNORECASE)
"""Words of lines whose frequency is that of a filter or of analog channels."""


def sniff(content: FileContent) -> DelimitedText:
    r"""Return the table in a text file.

    The names are in the first line, unless a later line has more cells than all lines above it and
    looks like names above rows of numbers. Raise ReadError if the file is empty or the names cannot
    be read.

    Examples
    --------
    >>> from pathlib import Path
    >>> text = b"Logger 3\ntime;hip x;hip y\ns;mm;mm\n0,00;1,5;2\n0,01;1,6;2\n"
    >>> table = sniff(FileContent(Path("take.csv"), text))
    >>> table.names, table.separator, table.has_decimal_comma, table.numbers().tolist()
    (['time', 'hip x', 'hip y'], ';', True, [[0.0, 1.5, 2.0], [0.01, 1.6, 2.0]])
    """
    lines = content.text.splitlines()
    header_end = next(
        (i for i, line in enumerate(lines) if line.strip().lower() == "endheader"), None
    )
    start = 0 if header_end is None else header_end + 1
    text_indices = (i for i in range(start, len(lines)) if is_text_line(lines[i]))
    # Enough lines for the header, words and three rows.
    indices = [*islice(text_indices, MAX_HEADER_LINES + MAX_WORD_LINES + 3)]
    if not indices:
        raise content.error("has no lines of numbers")
    # A declaration such as ``sep=;`` overrides the most frequent separator.
    declared = next(filter(None, map(SEPARATOR.fullmatch, lines[: indices[0]])), None)
    separator = declared[1] if declared else None
    candidates = range(min(MAX_HEADER_LINES, len(indices)))
    first = next((k for k in candidates if _is_head(lines, indices, k, separator)), 0)
    head = indices[first]
    separator = separator or find_separator(lines[head])
    n_words = _count_word_lines(lines, indices[first:], separator)
    first_row = indices[first + n_words] + 1
    is_blank_separated = header_end is not None or separator not in lines[head]
    if is_blank_separated:
        separator = "\t"
        cells = [cell.strip('"').strip() for cell in lines[head].split()]
    else:
        row = next(filter(str.strip, islice(lines, first_row, None)), "")
        cells = split_head(content, lines[head], row, separator)
    skipped = indices[first + 1 : first + 1 + n_words]
    joined = _join_names(cells, split_cells(lines[skipped[0]], separator)) if skipped else cells
    if joined != cells:
        cells, skipped = joined, skipped[1:]
    is_headless = not any(map(is_timing, cells)) and any(is_finite(c) or is_date(c) for c in cells)
    remark = "has no numbers and was skipped"
    notes = [f"line {i + 1} {remark}: {lines[i]:.60}" for i in skipped]
    return DelimitedText(
        content,
        lines,
        names=make_unique_names(map(from_text, cells)),
        head=head,
        first_row=first_row,
        separator=separator,
        is_headless=is_headless,
        is_blank_separated=is_blank_separated,
        units=split_cells(lines[first_row - 1], separator) if n_words else (),
        rate=_find_rate(lines[:head]),
        notes=(*note_skipped_lines(first, "rows" if is_headless else "names"), *notes),
    )


def is_text_line(line: str) -> bool:
    """Return whether a line is not blank, not a comment, and not the ``sep=;`` of spreadsheets."""
    return bool(line.strip()) and line[0] != "#" and not SEPARATOR.fullmatch(line)


def note_skipped_lines(count: int, name: str) -> tuple[str, ...]:
    """Return a note on the number of lines above the table, if there are any."""
    return (f"{format_count(count, 'line')} above the {name} skipped",) if count else ()


def split_head(content: FileContent, line: str, row: str, separator: str) -> list[str]:
    """Return the cells of the line of names above a row.

    A separator inside quotes is part of a name, unless the row has as many cells as the line has
    without regard to quotes.
    """
    plain = split_cells(line, separator)
    if '"' not in line or len(split_cells(row, separator)) == len(plain):
        return plain
    try:
        cells = next(csv.reader([line], delimiter=separator))
    except csv.Error as error:
        raise content.error(f"the columns' names cannot be read: {error}") from None
    return [cell.strip().strip('"').strip() for cell in cells]


def _is_head(
    lines: Sequence[str], indices: Sequence[int], index: int, separator: str | None
) -> bool:
    """Return whether a line holds names: rows below have as many cells, lines above fewer."""
    separator = separator or find_separator(lines[indices[index]])
    names, *below = (
        split_cells(lines[i], separator) for i in indices[index : index + MAX_WORD_LINES + 3]
    )
    rows = [*dropwhile(lambda cells: not any(map(is_number, cells)), below)][:2]
    # Spreadsheets pad lines with separators.
    cells_above = (
        split_cells(lines[i].strip().rstrip(separator), separator) for i in indices[:index]
    )
    return (
        len(names) > 1
        and not any(map(is_number, names))
        and _is_full(names)
        and bool(rows)
        and all(_fits(row, len(names)) and any(map(is_number, row)) for row in rows)
        and all(len(cells) < len(names) or not _is_full(cells) for cells in cells_above)
    )


def _join_names(names: list[str], words: Sequence[str]) -> list[str]:
    """Return the names joined with the words below, if only both together are unique.

    Examples
    --------
    >>> _join_names(["time", "L_TOE", "L_TOE"], ["", "x", "y"])
    ['time', 'L_TOE_x', 'L_TOE_y']
    >>> _join_names(["time", "acc", "acc"], ["s", "g", "g"])
    ['time', 'acc', 'acc']
    """
    joined = ["_".join(filter(None, pair)) for pair in zip(names, words, strict=False)]
    needed = len(set(names)) < len(names) == len(joined) == len(set(joined))
    return joined if needed else names


def _count_word_lines(lines: Sequence[str], indices: Sequence[int], separator: str) -> int:
    """Return the number of lines of words between the names in the first line and the numbers."""
    names, *below = (split_cells(lines[i], separator) for i in indices[: MAX_WORD_LINES + 2])
    words = [*takewhile(lambda cells: not any(map(_has_value, cells)), below[:MAX_WORD_LINES])]
    row = below[len(words)] if len(words) < len(below) else []
    if len(names) == 1 or any(map(is_number, names)) or not _fits(row, len(names)):
        return 0
    positions = [[i for i, cell in enumerate(line) if cell.lower() not in EMPTY] for line in words]
    # Words count only if rows below have a value in each of their columns.
    fits = all(_fits(line, len(names)) for line in words)
    has_values_below = all(positions) and all(
        i < len(names) and _has_value(row[i]) for i in chain(*positions)
    )
    return len(words) if fits and has_values_below else 0


def _fits(cells: Sequence[str], width: int) -> bool:
    """Return whether a line has this many cells; rows may end with an additional separator."""
    return len(cells) == width or (len(cells) == width + 1 and not cells[-1])


def is_row(cells: Sequence[str]) -> bool:
    """Return whether cells hold numbers, dates or nothing, and at least one number."""
    has_number = any(map(is_number, cells))
    return has_number and all(_has_value(cell) or cell.lower() in EMPTY for cell in cells)


def _has_value(cell: str) -> bool:
    return is_number(cell) or is_date(cell)


def _is_full(cells: Sequence[str]) -> bool:
    """Return whether most cells of a line are not empty."""
    return 2 * sum(map(bool, cells)) > len(cells)


def _find_rate(lines: Sequence[str]) -> float | None:
    """Return the frame rate stated in the lines above a table, if there is exactly one."""
    values = {
        float(match[1].replace(",", "."))
        for line in lines
        if not _NO_FRAME_RATE.search(line)
        for match in _RATE.finditer(line)
    }
    # Several different rates are ambiguous.
    rates = values - {0.0}
    return rates.pop() if len(rates) == 1 else None


def find_table_timing(
    content: FileContent,
    columns: Mapping[str, ArrayLike],
    fps: float | None = None,
    values: Floats | None = None,
) -> Timing:
    """Return the rate of a table and the frame of each row; ``fps`` overrides its times.

    ``values`` (rows, channels) help to separate sensors of different rates. Raise ReadError if no
    column defines the rate, or if one is inconsistent.
    """
    if fps:
        return Timing(fps)
    for column in columns:
        if is_rate(column):
            return Timing(_check_rate(content, read_column(content, columns, column)))
    clocks = [column for column in columns if is_time(column)]
    stopped = [column for column in clocks if len(clocks) > 1 and _is_stopped(columns[column])]
    # Use the first clock that runs; a single stopped one is refused with the reason.
    for column in [name for name in clocks if name not in stopped] or clocks:
        unit = find_time_unit(column)
        try:
            times, guessed_unit = as_seconds(columns[column], unit)
        except (ValueError, TypeError) as error:
            raise content.error(f"column {column!r} cannot be read as times: {error}") from None
        times = read_column(content, {column: times}, column)
        timing = find_timing(content, times, values)
        notes = list(timing.notes)
        if guessed_unit:
            remark = f"{column} is read in {UNITS_NAMED[guessed_unit]}, inferred from its steps"
            notes.insert(0, Note(remark, "warning"))
        elif timing.fps <= _MIN_RATE and not unit:
            raise content.error(
                f"its times are {1 / timing.fps:g} apart; if these are not seconds, give fps "
                f"(--fps; {1e3 * timing.fps:g} for milliseconds)"
            )
        if stopped:
            remark = f"{join_names(stopped)} does not advance: {column} used for times"
            notes.insert(0, Note(remark, "warning"))
        return replace(timing, notes=tuple(notes))
    raise content.error("no column 'time' or 'fps' found: give fps= (--fps)")


def find_timing(content: FileContent, times: Floats, values: Floats | None = None) -> Timing:
    """Return the result of `place_rows`; raise ReadError if the times define no rate."""
    try:
        return place_rows(times, values)
    except ParameterError as error:
        raise content.error(str(error)) from None


def place_points(timing: Timing, points: Floats) -> tuple[Floats, tuple[tuple[int, int], ...]]:
    """Return points (rows, points, axes) as frames, and the gaps without rows.

    Points that are missing for long become NaN. If rows are frames already, they stay unchanged.
    """
    if timing.order is None:
        return points, timing.gaps
    resampled = timing.resample(points.reshape(len(points), -1))
    gaps = timing.gaps
    if resampled.missing is not None:
        is_empty = np.asarray(resampled.missing.all(axis=1))
        resampled.values[resampled.missing & ~is_empty[:, None]] = np.nan
        gaps = list_spans(is_empty | mark_spans(gaps, len(is_empty)))
    return resampled.values.reshape(-1, *points.shape[1:]), gaps


def read_column(
    content: FileContent, columns: Mapping[str, ArrayLike], name: str, rows: int | None = None
) -> Floats:
    """Return a column as numbers (rows,); raise ReadError if it has other values or length."""
    try:
        values = np.asarray(columns[name], np.float64)
    except (ValueError, TypeError):
        raise content.error(f"column {name!r} does not hold numbers") from None
    if values.ndim != 1 or len(values) == 0 or len(values) != (rows or len(values)):
        raise content.error(f"column {name!r} has shape {values.shape}, not one value per row")
    return values


def _is_stopped(cells: ArrayLike) -> bool:
    """Return whether a column of times is empty, or constant over several rows."""
    texts = {str(cell).strip() for cell in np.asarray(cells).ravel()}
    return texts <= {"", "nan", "None"} or (len(texts) == 1 and np.size(cells) > 1)


def _check_rate(content: FileContent, rates: Floats) -> float:
    rate = float(rates[0])
    if not (np.isfinite(rate) and rate > 0) or np.ptp(rates) > 0:
        raise content.error(
            f"the frame rate is not one positive number ({rate:g} first): give fps= (--fps)"
        )
    return rate
