"""Delimited text: where a table begins in a file, what parts its cells, how numbers are written.

Every reader of CSV, TSV, MOT, STO, TRC and of the tables of capture programs looks at a file
through a `DelimitedText`, which `sniff` finds as loggers and spreadsheets leave it:

- Above the names there may be blank lines, lines that begin with ``#``, the ``sep=;`` of
  spreadsheets, a header that ends in ``endheader``, and lines on the device and the recording.
- Cells are parted by tabs, semicolons or commas, else by blanks.
- Below the names there may be a line of units.
- Between semicolons or tabs numbers may have a decimal comma; an empty cell is not a number.
- Columns of times may hold dates, see `kineme.formats.timing`.
"""

from __future__ import annotations

import csv
import re
from array import array
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice, pairwise
from math import nan

import numpy as np
from numpy.typing import NDArray

from kineme._counts import counted
from kineme.formats.files import FileContent, numbers, unique
from kineme.formats.timing import date_columns, date_seconds, is_date, is_timing

EMPTY = frozenset(
    {"", "nan", "na", "n/a", "null", "none", "-"} | {"#n/a", "#nv", "#div/0!", "#num!", "#value!"}
)
"""What stands in a cell without a number, in lower case; the last are those of spreadsheets."""

OWNERS = frozenset(
    {"person", "person_id", "subject", "participant", "individual", "track", "track_id"}
    | {"device", "device_id", "sensor", "sensor_id", "joint", "bodypart"}
)
"""Names of columns that tell whose a row is, in lower case."""

NAMELESS = "(no name)"
"""What a column is called whose name is empty."""

HIGHEST = 200
"""Lines above the names at most."""

COMMAS = "numbers have a decimal comma"
"""The note on it."""

_ROWS_SNIFFED = 50  # in which a decimal comma and rows of several people are looked for
_FRAME = frozenset({"frame", "frame_id", "frame_idx"})
_SEPARATOR = re.compile(r"\s*\"?sep=(.)\"?\s*", re.IGNORECASE)
_NUMBER = re.compile(r"\s*[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][+-]?\d+)?\s*")
_COMMA = re.compile(r"\s*[+-]?\d*,\d+(?:[eE][+-]?\d+)?\s*")
_FORMULA = re.compile(r"'*[=+\-@]")
"""A text that spreadsheets would run as a formula, or one that was kept from it."""


@dataclass(frozen=True)
class DelimitedText:
    """A table in a file of text.

    Parameters
    ----------
    content : FileContent
    lines : sequence of str
        Of the file, up to the end of the table.
    names : sequence of str
        Of the columns, each once.
    head : int
        The line of the names, or the first row where there are none, counted from 0.
    below : int
        The line after it that is the first row of the table.
    separator : str
        Between cells.
    headless : bool
        Whether the line of names holds numbers and names no time, so that it is a row for
        those who need no names.
    blanks : bool
        Whether cells are parted by blanks; ``rows`` then have tabs in place of these.
    notes : tuple of str
        On lines that were passed over.
    """

    content: FileContent
    lines: Sequence[str]
    names: Sequence[str]
    head: int
    below: int
    separator: str
    headless: bool = False
    blanks: bool = False
    notes: tuple[str, ...] = ()

    @cached_property
    def rows(self) -> Sequence[str]:
        """The lines of the table below its names."""
        rows = self.lines[self.below :]
        return ["\t".join(row.split()) for row in rows] if self.blanks else rows

    @cached_property
    def first_cells(self) -> list[str]:
        """The cells of the first row that is not blank."""
        row = next(filter(str.strip, self.rows), "")
        return cells_of(row, self.separator) if row else []

    @cached_property
    def comma(self) -> bool:
        """Whether its numbers have a decimal comma."""
        if self.separator == ",":
            return False
        rows = islice(filter(str.strip, self.rows), _ROWS_SNIFFED)
        cells = [cell for row in rows for cell in cells_of(row, self.separator)]
        return any(map(has_comma, cells)) and not any("." in c for c in cells if is_number(c))

    @cached_property
    def dates(self) -> list[int]:
        """The columns that tell the time by dates."""
        return date_columns(self.names, self.first_cells)

    @property
    def remarks(self) -> tuple[str, ...]:
        """The notes, and how numbers are written."""
        return (*self.notes, COMMAS) if self.comma else self.notes

    def numbered(self) -> DelimitedText:
        """The same table, its columns called by their numbers where it is headless."""
        if not self.headless:
            return self
        names = [str(i) for i in range(1, len(self.names) + 1)]
        return replace(self, names=names, below=self.head, headless=False)

    def numeric(self) -> list[str]:
        """The names of columns whose first cell is a number or empty, and of those of dates."""
        first = map(dotted, self.first_cells) if self.comma else self.first_cells
        dates = {self.names[i] for i in self.dates}
        return [
            name
            for name, cell in zip(self.names, first, strict=False)
            if cell.lower() in EMPTY or name in dates or _is_finite(cell)
        ]

    def texts(self, column: int) -> list[str]:
        """The cells of one column, for the rows that `numbers` gives and perhaps one more."""
        rows = csv.reader(self.rows, delimiter=self.separator)
        full = (row for row in rows if any(map(str.strip, row)))
        return [row[column].strip() if column < len(row) else "" for row in full]

    def numbers(self, columns: Sequence[int] | None = None) -> NDArray[np.float64]:
        """(rows, columns): cells as numbers, NaN where empty, and dates as seconds since 1970.

        A last line that breaks off is left out with a warning.

        Parameters
        ----------
        columns : sequence of int, optional
            These alone, all by default; the others may hold anything.

        Raises
        ------
        ReadError
            A cell is not a number, or a line is too short or too long.
        """
        content, width, first = self.content, len(self.names), self.below + 1
        chosen = range(width) if columns is None else columns
        dates = [i for i in self.dates if i in chosen]
        values = array("d")
        reader = csv.reader(self.rows, delimiter=self.separator)
        try:
            for cells in reader:
                if not any(map(str.strip, cells)):
                    continue
                line = first + reader.line_num - 1
                if len(cells) < width or any(map(str.strip, cells[width:])):
                    reason = f"{len(cells)} cells, but {width} columns"
                    if reader.line_num < len(self.rows) or len(cells) > width:
                        raise content.error(reason, line)
                    content.warn(f"{reason}: the last row breaks off, left out", line)
                    break
                for i in dates:
                    cells[i] = _seconds(content, cells[i].strip(), line)
                row = [cells[i] for i in chosen]
                values.extend(_numbers(content, [*map(dotted, row)] if self.comma else row, line))
        except csv.Error as error:
            raise content.error(str(error), first + reader.line_num - 1) from None
        if not values:
            raise content.error("no row of numbers found")
        return np.array(values).reshape(-1, len(chosen))

    def refuse_interleaved(self) -> None:
        """ReadError where rows of one time or frame are of several people, devices or joints."""
        names = self.names
        times = [i for i, name in enumerate(names) if is_timing(name) or name.lower() in _FRAME]
        owners = [i for i, name in enumerate(names) if name.lower() in OWNERS]
        if not (times and owners):
            return
        rows = islice(filter(str.strip, self.rows), _ROWS_SNIFFED)
        cells = [cells_of(row, self.separator) for row in rows]
        for one, other in pairwise(row for row in cells if len(row) == len(names)):
            differing = [i for i in owners if one[i] != other[i]]
            if differing and all(one[i] == other[i] for i in times):
                k = differing[0]
                raise self.content.error(
                    f"rows of one time are told apart by column {names[k]!r} "
                    f"({one[k]:.20}, {other[k]:.20}): give each a file or columns of its own"
                )


def sniff(content: FileContent) -> DelimitedText:
    r"""The table in a file of text.

    The names are in the first line, unless a line below it, of more cells than all above, looks
    like names over rows of numbers while the first does not.

    Raises
    ------
    ReadError
        There are no lines, or the names cannot be read.

    Examples
    --------
    >>> from pathlib import Path
    >>> text = b"Logger 3\ntime;hip x;hip y\ns;mm;mm\n0,00;1,5;2\n0,01;1,6;2\n"
    >>> table = sniff(FileContent(Path("take.csv"), text))
    >>> table.names, table.separator, table.comma, table.numbers().tolist()
    (['time', 'hip x', 'hip y'], ';', True, [[0.0, 1.5, 2.0], [0.01, 1.6, 2.0]])
    """
    lines = content.text.splitlines()
    ended = next((i for i, line in enumerate(lines) if line.strip().lower() == "endheader"), None)
    start = 0 if ended is None else ended + 1
    full = [i for i in range(start, len(lines)) if lines[i].strip() and lines[i][0] != "#"]
    declared = _SEPARATOR.fullmatch(lines[full[0]]) if full else None
    full = full[1:] if declared else full
    if not full:
        raise content.error("has no lines of numbers")
    separator = declared[1] if declared else None
    candidates = range(min(HIGHEST, len(full)))
    first = next((k for k in candidates if _is_head(lines, full, k, separator)), 0)
    head = full[first]
    separator = separator or separator_of(lines[head])
    below = head + 1
    notes = [f"{counted(first, 'line')} above the names passed over"] if first else []
    if len(full) > first + 1 and _has_units(lines, full[first:], separator):
        below = full[first + 1] + 1
        notes.append(f"line {below} holds no numbers and is passed over: {lines[below - 1]:.60}")
    blanks = ended is not None or separator not in lines[head]
    if blanks:
        separator, cells = "\t", lines[head].split()
        cells = [cell.strip('"').strip() for cell in cells]
    else:
        row = next(filter(str.strip, islice(lines, below, None)), "")
        cells = _head_cells(content, lines[head], row, separator)
    headless = any(map(_is_finite, cells)) and not any(map(is_timing, cells))
    names = named(map(from_text, cells))
    return DelimitedText(
        content, lines, names, head, below, separator, headless, blanks, tuple(notes)
    )


def named(names: Iterable[str]) -> list[str]:
    """The names of columns, each of them once, and none of them empty."""
    return unique(name.strip() or NAMELESS for name in names)


def separator_of(line: str) -> str:
    """Tab, semicolon or comma, whichever cuts the line into most cells."""
    return max("\t;,", key=line.count)


def cells_of(line: str, separator: str) -> list[str]:
    """The cells of a line, without blanks and quotes around them."""
    return [cell.strip().strip('"').strip() for cell in line.split(separator)]


def is_number(cell: str) -> bool:
    """Whether a cell is a number, with a decimal point or comma."""
    return bool(_NUMBER.fullmatch(cell))


def has_comma(cell: str) -> bool:
    """Whether a cell is a number with a decimal comma."""
    return _COMMA.fullmatch(cell) is not None


def dotted(cell: str) -> str:
    """A cell with a decimal point in place of a decimal comma; other text as it is."""
    return cell.replace(",", ".") if has_comma(cell) else cell


def as_text(text: str) -> str:
    """A cell that no spreadsheet runs: one that begins like a formula gets a ``'`` before it.

    Examples
    --------
    >>> as_text("=HYPERLINK(1)"), as_text("walk")
    ("'=HYPERLINK(1)", 'walk')
    """
    return f"'{text}" if _FORMULA.match(text) else text


def from_text(cell: str) -> str:
    """The text that `as_text` made a cell of.

    Examples
    --------
    >>> from_text("'=HYPERLINK(1)"), from_text("'til")
    ('=HYPERLINK(1)', "'til")
    """
    return cell[1:] if cell.startswith("'") and _FORMULA.match(cell) else cell


def _head_cells(content: FileContent, line: str, row: str, separator: str) -> list[str]:
    """The cells of the line of names above a row.

    A separator between quotes is part of a name, but where the row has as many cells as there
    are without quotes.
    """
    plain = cells_of(line, separator)
    if '"' not in line or len(cells_of(row, separator)) == len(plain):
        return plain
    try:
        cells = next(csv.reader([line], delimiter=separator))
    except csv.Error as error:
        raise content.error(f"the columns' names cannot be read: {error}") from None
    return [cell.strip().strip('"').strip() for cell in cells]


def _is_head(lines: Sequence[str], full: Sequence[int], at: int, separator: str | None) -> bool:
    """Whether names stand in a line, rows of as many cells below it, and fewer cells above it."""
    head = lines[full[at]]
    sep = separator or separator_of(head)
    if sep not in head or any(map(is_number, cells_of(head, sep))):
        return False
    width = head.count(sep) + 1
    above = (lines[i].strip().rstrip(sep) for i in full[:at])  # spreadsheets fill lines up
    rows = [cells_of(lines[i], sep) for i in full[at + 1 : at + 4]]
    rows = rows[1:] if rows and not any(map(is_number, rows[0])) else rows[:2]
    return (
        bool(rows)
        and all(len(row) == width and any(map(is_number, row)) for row in rows)
        and all(line.count(sep) + 1 < width for line in above)
    )


def _has_units(lines: Sequence[str], full: Sequence[int], separator: str) -> bool:
    """Whether words stand below the names, and numbers below these."""
    names, *rows = (cells_of(lines[i], separator) for i in full[:3])
    if len(rows) < 2 or separator not in lines[full[0]] or any(map(is_number, names)):
        return False
    words = [i for i, cell in enumerate(rows[0]) if cell.lower() not in EMPTY]
    return (
        bool(words)
        and len(rows[0]) == len(rows[1]) == len(names)
        and not any(is_number(rows[0][i]) or is_date(rows[0][i]) for i in words)
        and all(is_number(rows[1][i]) or is_date(rows[1][i]) for i in words)
    )


def _is_finite(cell: str) -> bool:
    try:
        numbers([cell])
    except ValueError:
        return False
    return True


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
        rest = iter(numbers([cell for cell, hole in zip(cells, empty, strict=True) if not hole]))
    except ValueError as error:
        raise content.error(str(error), line) from None
    return [nan if hole else next(rest) for hole in empty]
