"""Represent tables in delimited text, and parse their numbers and dates.

Readers of CSV, TSV, MOT, STO, TRC and exports of capture programs use a `DelimitedText`, which
`kineme.formats.sniffing` creates. Tables separated by semicolons or tabs may have decimal commas.
Empty cells become NaN. Columns of times may hold dates, see `kineme.formats.sniffing`.
"""

from __future__ import annotations

import csv
import re
from array import array
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from functools import cached_property
from itertools import islice
from math import nan

import numpy as np
from numpy.typing import NDArray

from kineme._util.checks import make_unique
from kineme.formats.files import FileContent, parse_numbers
from kineme.recordings.cells import COMMAS, has_decimal_comma, replace_decimal_comma
from kineme.recordings.column_names import EMPTY, describe_alternation, is_owner
from kineme.recordings.times import (
    HOURLESS,
    HOURS,
    append_unit,
    counts_hours,
    find_date_columns,
    is_ambiguous,
    is_date,
    is_day_first,
    is_timing,
    may_count_hours,
    parse_date,
)

NAMELESS = "(no name)"
"""Name given to columns without one."""

_ROWS_SNIFFED = 50  # rows searched for decimal commas
_FORMULA = re.compile(r"'*[=+\-@]")
"""Start of a text that spreadsheets would run as a formula, or that is escaped with ``'``."""


@dataclass(frozen=True)
class DelimitedText:
    """A table in a text file."""

    content: FileContent
    lines: Sequence[str]  # of the file, up to the end of the table
    names: Sequence[str]  # of the columns, unique
    head: int  # index of the line of names, or of the first row if there are no names
    first_row: int  # index of the line of the first row
    separator: str  # of cells
    is_headless: bool = False  # the line at `head` is a row of numbers rather than names
    is_blank_separated: bool = False  # blanks separate cells; `rows` contain tabs instead
    units: Sequence[str] = ()  # of the columns, if a line below the names states them
    rate: float | None = None  # frames per second, if a line above the names states it
    notes: tuple[str, ...] = ()  # on skipped lines
    hidden: frozenset[str] = frozenset()  # channels only if requested, such as counters
    clocks: Mapping[str, str] | None = None  # columns of times and units ("" for dates), if known
    day_before_month: bool | None = None  # order in dates, if a header states it

    @cached_property
    def rows(self) -> Sequence[str]:
        """Lines of the table below its names."""
        rows = self.lines[self.first_row :]
        return ["\t".join(row.split()) for row in rows] if self.is_blank_separated else rows

    @cached_property
    def first_cells(self) -> list[str]:
        """Cells of the first row that is not blank."""
        row = next(filter(str.strip, self.rows), "")
        return split_cells(row, self.separator) if row else []

    @cached_property
    def has_decimal_comma(self) -> bool:
        """Whether numbers have a decimal comma."""
        if self.separator == ",":
            return False
        rows = islice(filter(str.strip, self.rows), _ROWS_SNIFFED)
        return has_decimal_comma(cell for row in rows for cell in split_cells(row, self.separator))

    @cached_property
    def dates(self) -> list[int]:
        """Indices of the columns that hold dates."""
        if self.clocks is None:
            return find_date_columns(self.names, self.first_cells)
        cells = zip(self.names, self.first_cells, strict=False)
        return [i for i, (name, cell) in enumerate(cells) if name in self.clocks and is_date(cell)]

    @cached_property
    def times(self) -> dict[str, str]:
        """Columns of times or rates, and the names under which `find_table_timing` knows them."""
        if self.clocks is not None:
            times = {name: append_unit("time", unit) for name, unit in self.clocks.items()}
        else:
            units = dict(zip(self.names, self.units, strict=False))
            timing = filter(is_timing, self.names)
            times = {name: append_unit(name, units.get(name, "")) for name in timing}
        return times | {self.names[i]: "time (s)" for i in self.dates}

    @cached_property
    def day_first(self) -> bool | None:
        """Whether dates have the day before the month; None if the dates do not show it."""
        if self.day_before_month is not None:
            return self.day_before_month
        first = (self.first_cells[i] for i in self.dates)
        if not any(map(is_ambiguous, first)):
            return None
        return is_day_first(self.texts(self.dates[0]))

    @cached_property
    def hourly(self) -> dict[int, bool]:
        """Columns of times such as 9:45, and whether these are hours and minutes."""
        units = dict(enumerate(self.units))
        columns = {i: self.texts(i) for i in self.dates if may_count_hours([self.first_cells[i]])}
        return {
            i: counts_hours(texts, f"{self.names[i]} {units.get(i, '')}")
            for i, texts in columns.items()
            if may_count_hours(texts)
        }

    @property
    def remarks(self) -> tuple[str, ...]:
        """Notes on skipped lines and on the form of numbers and dates."""
        notes = (*self.notes, COMMAS) if self.has_decimal_comma else self.notes
        notes += tuple(HOURS if is_hours else HOURLESS for is_hours in self.hourly.values())
        doubtful = next(filter(is_ambiguous, (self.first_cells[i] for i in self.dates)), None)
        if doubtful is None or self.day_first is not None:
            return notes
        day = datetime.fromtimestamp(parse_date(doubtful), UTC)
        return (*notes, f"{doubtful!r} is taken for {day:%-d %B %Y}")

    def number_columns(self) -> DelimitedText:
        """Return the same table, with columns numbered from 1 if it has no names."""
        if not self.is_headless:
            return self
        names = [str(i) for i in range(1, len(self.names) + 1)]
        return replace(self, names=names, first_row=self.head, is_headless=False)

    def find_numeric_columns(self) -> list[str]:
        """Return the names of columns that start with a number, an empty cell or a date."""
        first_cells = self.first_cells
        if self.has_decimal_comma:
            first_cells = [*map(replace_decimal_comma, first_cells)]
        dates = {self.names[i] for i in self.dates}
        return [
            name
            for name, cell in zip(self.names, first_cells, strict=False)
            if name not in self.hidden
            and (cell.lower() in EMPTY or name in dates or is_finite(cell))
        ]

    def texts(self, column: int) -> list[str]:
        """Return the cells of one column; a truncated last row is included."""
        return [row[column].strip() if column < len(row) else "" for _, row in self._split_rows()]

    def numbers(self, columns: Sequence[int] | None = None) -> NDArray[np.float64]:
        """Return cells as numbers (rows, columns), NaN if empty, dates as seconds since 1970.

        ``columns`` selects columns; the others may hold anything. A truncated last line is dropped
        with a warning.
        """
        content, width = self.content, len(self.names)
        chosen = range(width) if columns is None else columns
        dates = [i for i in self.dates if i in chosen]
        values = array("d")
        for line, cells in self._split_rows():
            if len(cells) < width or any(map(str.strip, cells[width:])):
                reason = f"{len(cells)} cells, but {width} columns"
                # Only a short last row is what a truncated file looks like.
                if line < self.first_row + len(self.rows) or len(cells) > width:
                    raise content.error(reason, line)
                content.warn(f"{reason}: the last row is truncated and left out", line)
                break
            for i in dates:
                cells[i] = _convert_date(content, cells[i].strip(), line, self.day_first)
            row = [cells[i] for i in chosen]
            if self.has_decimal_comma:
                row = [*map(replace_decimal_comma, row)]
            values.extend(_parse_cells(content, row, line))
        if not values:
            raise content.error("no row of numbers found")
        table = np.array(values).reshape(-1, len(chosen))
        for column, i in enumerate(chosen):
            if self.hourly.get(i):
                table[:, column] *= 60  # they were read as minutes and seconds
        return table

    def refuse_interleaved(self, requested: Collection[str] = ()) -> None:
        """Raise ReadError if rows of several points, people or devices alternate."""
        texts = {name: self.texts(i) for i, name in enumerate(self.names) if is_owner(name)}
        if error := describe_alternation(texts, requested):
            raise self.content.error(error)

    def _split_rows(self) -> Iterator[tuple[int, list[str]]]:
        """Yield the line number and the cells of each row that is not blank."""
        reader = csv.reader(self.rows, delimiter=self.separator)
        try:
            for cells in reader:
                if any(map(str.strip, cells)):
                    # Quoted cells may span lines, so the reader counts them.
                    yield self.first_row + reader.line_num, cells
        except csv.Error as error:
            raise self.content.error(str(error), self.first_row + reader.line_num) from None


def make_unique_names(names: Iterable[str]) -> list[str]:
    """Return the names of columns, made unique; empty ones are replaced."""
    return make_unique(name.strip() or NAMELESS for name in names)


def find_separator(line: str) -> str:
    """Return tab, semicolon or comma, whichever is most frequent in the line."""
    # `max` returns the first of equally frequent ones, so tabs take precedence.
    return max("\t;,", key=line.count)


def split_cells(line: str, separator: str) -> list[str]:
    """Return the cells of a line, without surrounding blanks and quotes."""
    return [cell.strip().strip('"').strip() for cell in line.split(separator)]


def as_text(text: str) -> str:
    """Return a cell that no spreadsheet runs: text that looks like a formula gets a leading ``'``.

    Examples
    --------
    >>> as_text("=HYPERLINK(1)"), as_text("walk")
    ("'=HYPERLINK(1)", 'walk')
    """
    return f"'{text}" if _FORMULA.match(text) else text


def from_text(cell: str) -> str:
    """Return the text of a cell made by `as_text`.

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
    """Return a date as the text of a number; an empty cell stays unchanged."""
    try:
        return cell if cell.lower() in EMPTY else repr(parse_date(cell, day_first=day_first))
    except ValueError as error:
        raise content.error(str(error), line) from None


def _parse_cells(content: FileContent, cells: list[str], line: int) -> list[float]:
    """Return the numbers in the cells of a row, nan for empty ones."""
    try:
        return parse_numbers(cells)
    except ValueError:
        # Only rows with empty cells or errors take this slower path.
        empty = [cell.strip().lower() in EMPTY for cell in cells]
    try:
        numbers = parse_numbers(
            ["0" if hole else cell for cell, hole in zip(cells, empty, strict=True)]
        )
    except ValueError as error:
        raise content.error(str(error), line) from None
    return [nan if hole else number for number, hole in zip(numbers, empty, strict=True)]
