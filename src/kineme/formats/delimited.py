"""Delimited text: a table in a file, its columns, and how numbers and times are written in it.

Every reader of CSV, TSV, MOT, STO, TRC and of the tables of capture programs looks at a file
through a `DelimitedText`, which `kineme.formats.sniffing` finds. Between semicolons or tabs numbers
may have a decimal comma; an empty cell is not a number; columns of times may hold dates, see
`kineme.formats.timing`.
"""

from __future__ import annotations

import csv
import re
from array import array
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from functools import cached_property
from itertools import islice, pairwise
from math import nan

import numpy as np
from numpy.typing import NDArray

from kineme._util.checks import make_unique
from kineme.formats.files import FileContent, parse_numbers
from kineme.recordings.times import (
    append_unit,
    find_date_columns,
    is_ambiguous,
    is_date,
    is_day_first,
    is_timing,
    parse_date,
)

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

COMMAS = "numbers have a decimal comma"
"""Note on it."""

_ROWS_SNIFFED = 50  # in which a decimal comma and rows of several people are looked for
_FRAME = frozenset({"frame", "frame_id", "frame_idx"})
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
    units : sequence of str
        Of the columns, where a line below their names tells them.
    rate : float, optional
        Frames per second, where a line above the names tells it.
    notes : tuple of str
        On lines that were passed over.
    hidden : frozenset of str
        Columns that are channels only where they are asked for, as a device's counters are.
    clocks : mapping of str to str, optional
        The columns of times and their units, "" for dates, where a device tells them.
    day_before_month : bool, optional
        How a header says that dates are written.
    """

    content: FileContent
    lines: Sequence[str]
    names: Sequence[str]
    head: int
    below: int
    separator: str
    headless: bool = False
    blanks: bool = False
    units: Sequence[str] = ()
    rate: float | None = None
    notes: tuple[str, ...] = ()
    hidden: frozenset[str] = frozenset()
    clocks: Mapping[str, str] | None = None
    day_before_month: bool | None = None

    @cached_property
    def rows(self) -> Sequence[str]:
        """Return the lines of the table below its names."""
        rows = self.lines[self.below :]
        return ["\t".join(row.split()) for row in rows] if self.blanks else rows

    @cached_property
    def first_cells(self) -> list[str]:
        """Return the cells of the first row that is not blank."""
        row = next(filter(str.strip, self.rows), "")
        return split_cells(row, self.separator) if row else []

    @cached_property
    def comma(self) -> bool:
        """Return whether its numbers have a decimal comma."""
        if self.separator == ",":
            return False
        rows = islice(filter(str.strip, self.rows), _ROWS_SNIFFED)
        cells = [cell for row in rows for cell in split_cells(row, self.separator)]
        return any(map(has_comma, cells)) and not any("." in c for c in cells if is_number(c))

    @cached_property
    def dates(self) -> list[int]:
        """Return the columns that tell the time by dates."""
        if self.clocks is None:
            return find_date_columns(self.names, self.first_cells)
        cells = zip(self.names, self.first_cells, strict=False)
        return [i for i, (name, cell) in enumerate(cells) if name in self.clocks and is_date(cell)]

    @cached_property
    def times(self) -> dict[str, str]:
        """Columns that tell times or a rate, and their names as `find_table_timing` knows them."""
        if self.clocks is not None:
            told = {
                name: f"time ({unit})" if unit else "time" for name, unit in self.clocks.items()
            }
        else:
            units = dict(zip(self.names, self.units, strict=False))
            told = {
                name: append_unit(name, units.get(name, ""))
                for name in self.names
                if is_timing(name)
            }
        return told | {self.names[i]: "time (s)" for i in self.dates}

    @cached_property
    def day_first(self) -> bool | None:
        """Return whether its dates name the day before the month; None where they do not tell."""
        if self.day_before_month is not None:
            return self.day_before_month
        first = (self.first_cells[i] for i in self.dates)
        if not any(map(is_ambiguous, first)):
            return None
        return is_day_first(self.texts(self.dates[0]))

    @property
    def remarks(self) -> tuple[str, ...]:
        """Return the notes, and how numbers and dates are written."""
        notes = (*self.notes, COMMAS) if self.comma else self.notes
        doubtful = next(filter(is_ambiguous, (self.first_cells[i] for i in self.dates)), None)
        if doubtful is None or self.day_first is not None:
            return notes
        day = datetime.fromtimestamp(parse_date(doubtful), UTC)
        return (*notes, f"{doubtful!r} is taken for {day:%-d %B %Y}")

    def numbered(self) -> DelimitedText:
        """Return the same table, its columns called by their numbers where it is headless."""
        if not self.headless:
            return self
        names = [str(i) for i in range(1, len(self.names) + 1)]
        return replace(self, names=names, below=self.head, headless=False)

    def numeric(self) -> list[str]:
        """Return names of columns whose first cell is a number or empty, and of those of dates."""
        first = map(replace_decimal_comma, self.first_cells) if self.comma else self.first_cells
        dates = {self.names[i] for i in self.dates}
        return [
            name
            for name, cell in zip(self.names, first, strict=False)
            if name not in self.hidden
            and (cell.lower() in EMPTY or name in dates or is_finite(cell))
        ]

    def texts(self, column: int) -> list[str]:
        """Return the cells of one column; a truncated last row is included."""
        rows = csv.reader(self.rows, delimiter=self.separator)
        full = (row for row in rows if any(map(str.strip, row)))
        return [row[column].strip() if column < len(row) else "" for row in full]

    def numbers(self, columns: Sequence[int] | None = None) -> NDArray[np.float64]:
        """(rows, columns): cells as numbers, NaN where empty, and dates as seconds since 1970.

        Of columns that are given these alone; the others may hold anything. A last line that breaks
        off is left out with a warning.
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
                    cells[i] = _convert_date(content, cells[i].strip(), line, self.day_first)
                row = [cells[i] for i in chosen]
                values.extend(
                    _parse_cells(
                        content, [*map(replace_decimal_comma, row)] if self.comma else row, line
                    )
                )
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
        cells = [split_cells(row, self.separator) for row in rows]
        for one, other in pairwise(row for row in cells if len(row) == len(names)):
            differing = [i for i in owners if one[i] != other[i]]
            if differing and all(one[i] == other[i] for i in times):
                k = differing[0]
                raise self.content.error(
                    f"rows of one time are told apart by column {names[k]!r} "
                    f"({one[k]:.20}, {other[k]:.20}): give each a file or columns of its own"
                )


def make_unique_names(names: Iterable[str]) -> list[str]:
    """Return the names of columns, each of them once, and none of them empty."""
    return make_unique(name.strip() or NAMELESS for name in names)


def find_separator(line: str) -> str:
    """Tab, semicolon or comma, whichever cuts the line into most cells."""
    return max("\t;,", key=line.count)


def split_cells(line: str, separator: str) -> list[str]:
    """Return the cells of a line, without blanks and quotes around them."""
    return [cell.strip().strip('"').strip() for cell in line.split(separator)]


def is_number(cell: str) -> bool:
    """Return whether a cell is a number, with a decimal point or comma."""
    return bool(_NUMBER.fullmatch(cell))


def has_comma(cell: str) -> bool:
    """Return whether a cell is a number with a decimal comma."""
    return _COMMA.fullmatch(cell) is not None


def replace_decimal_comma(cell: str) -> str:
    """Return a cell with a decimal point in place of a decimal comma; other text as it is."""
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
    """Return the text that `as_text` made a cell of.

    Examples
    --------
    >>> from_text("'=HYPERLINK(1)"), from_text("'til")
    ('=HYPERLINK(1)', "'til")
    """
    return cell[1:] if cell.startswith("'") and _FORMULA.match(cell) else cell


def is_finite(cell: str) -> bool:
    """Return whether a cell is a finite number."""
    try:
        parse_numbers([cell])
    except ValueError:
        return False
    return True


def _convert_date(content: FileContent, cell: str, line: int, day_first: bool | None) -> str:
    """Return a date as a number in text; what is empty stays so."""
    try:
        return cell if cell.lower() in EMPTY else repr(parse_date(cell, day_first=day_first))
    except ValueError as error:
        raise content.error(str(error), line) from None


def _parse_cells(content: FileContent, cells: list[str], line: int) -> list[float]:
    try:
        return parse_numbers(cells)
    except ValueError:
        empty = [cell.strip().lower() in EMPTY for cell in cells]
    try:
        rest = iter(
            parse_numbers([cell for cell, hole in zip(cells, empty, strict=True) if not hole])
        )
    except ValueError as error:
        raise content.error(str(error), line) from None
    return [nan if hole else next(rest) for hole in empty]
