"""Rows of numbers between tabs, commas or semicolons; an empty cell is not a number."""

from __future__ import annotations

import csv
import re
from array import array
from collections.abc import Sequence
from math import nan

import numpy as np
from numpy.typing import NDArray

from kineme.formats.files import FileContent, numbers
from kineme.formats.timing import date_seconds

EMPTY = frozenset(
    {"", "nan", "na", "n/a", "null", "none", "-"} | {"#n/a", "#nv", "#div/0!", "#num!", "#value!"}
)
"""What stands in a cell without a number, in lower case; the last are those of spreadsheets."""

_RUNS = re.compile(r"'*[=+\-@]")
"""A text that spreadsheets would run as a formula, or one that was kept from it."""

_COMMA = re.compile(r"\s*[+-]?\d*,\d+(?:[eE][+-]?\d+)?\s*")


def rows_of(
    content: FileContent,
    lines: Sequence[str],
    first: int,
    separator: str,
    width: int,
    columns: Sequence[int] | None = None,
    *,
    dates: Sequence[int] = (),
    comma: bool = False,
) -> NDArray[np.float64]:
    """(rows, columns): the lines' cells as numbers, NaN where empty.

    A last line that breaks off is left out with a warning.

    Parameters
    ----------
    first : int
        The number of the first line in the file.
    separator : str
        Between cells.
    width : int
        Cells in a line; empty ones may follow.
    columns : sequence of int, optional
        Those wanted, all by default; the others may hold anything.
    dates : sequence of int, optional
        Columns that hold dates, given as seconds since 1970.
    comma : bool
        Whether numbers have a decimal comma.

    Raises
    ------
    ReadError
        A cell is not a number, or a line is too short or too long.
    """
    wanted = range(width) if columns is None else columns
    dated = [i for i in dates if i in wanted]
    values = array("d")
    reader = csv.reader(lines, delimiter=separator)
    try:
        for cells in reader:
            if not any(map(str.strip, cells)):
                continue
            line = first + reader.line_num - 1
            if len(cells) < width or any(map(str.strip, cells[width:])):
                reason = f"{len(cells)} cells, but {width} columns"
                if reader.line_num < len(lines) or len(cells) > width:
                    raise content.error(reason, line)
                content.warn(f"{reason}: the last row breaks off, left out", line)
                break
            for i in dated:
                cells[i] = _seconds(content, cells[i].strip(), line)
            row = [cells[i] for i in wanted]
            values.extend(_numbers(content, [*map(dotted, row)] if comma else row, line))
    except csv.Error as error:
        raise content.error(str(error), first + reader.line_num - 1) from None
    if not values:
        raise content.error("no row of numbers found")
    return np.array(values).reshape(-1, len(wanted))


def texts_of(lines: Sequence[str], separator: str, column: int) -> list[str]:
    """The cells of one column as text, for the rows that `rows_of` gives and perhaps one more."""
    rows = (row for row in csv.reader(lines, delimiter=separator) if any(map(str.strip, row)))
    return [row[column].strip() if column < len(row) else "" for row in rows]


def separator_of(line: str) -> str:
    """Tab, semicolon or comma, whichever cuts the line into most cells."""
    return max("\t;,", key=line.count)


def has_comma(cell: str) -> bool:
    """Whether a cell is a number with a decimal comma."""
    return _COMMA.fullmatch(cell) is not None


def dotted(cell: str) -> str:
    """A cell with a decimal point in place of a decimal comma; other text as it is."""
    return cell.replace(",", ".") if has_comma(cell) else cell


def _seconds(content: FileContent, cell: str, line: int) -> str:
    """A date as a number in text; what is empty stays so."""
    try:
        return cell if cell.lower() in EMPTY else repr(date_seconds(cell))
    except ValueError as error:
        raise content.error(str(error), line) from None


def _numbers(content: FileContent, cells: list[str], line: int) -> list[float]:
    try:
        return numbers(cells)
    except ValueError:
        empty = [cell.strip().lower() in EMPTY for cell in cells]
    try:
        found = iter(numbers([cell for cell, hole in zip(cells, empty, strict=True) if not hole]))
    except ValueError as error:
        raise content.error(str(error), line) from None
    return [nan if hole else next(found) for hole in empty]


def as_text(text: str) -> str:
    """A cell that no spreadsheet runs: one that begins like a formula gets a ``'`` before it.

    Examples
    --------
    >>> as_text("=HYPERLINK(1)"), as_text("walk")
    ("'=HYPERLINK(1)", 'walk')
    """
    return f"'{text}" if _RUNS.match(text) else text


def from_text(cell: str) -> str:
    """The text that `as_text` made a cell of.

    Examples
    --------
    >>> from_text("'=HYPERLINK(1)"), from_text("'til")
    ('=HYPERLINK(1)', "'til")
    """
    return cell[1:] if cell.startswith("'") and _RUNS.match(cell) else cell
