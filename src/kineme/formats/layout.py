"""Where a text table begins, and how its numbers are written: as loggers and spreadsheets do it.

Above the names there may be blank lines, lines that begin with ``#``, the ``sep=;`` of
spreadsheets, and lines on the device and the recording. Below them there may be a line of
units. Between semicolons or tabs numbers may have a decimal comma.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import islice

from kineme._counts import counted
from kineme.formats.delimited import EMPTY, has_comma, separator_of
from kineme.formats.timing import is_date

HIGHEST = 200
"""Lines above the names at most."""

COMMAS = "numbers have a decimal comma"
"""The note on it."""

_LOOKED_AT = 50  # rows in which a decimal comma is looked for
_SEPARATOR = re.compile(r"\s*\"?sep=(.)\"?\s*", re.IGNORECASE)
_NUMBER = re.compile(r"\s*[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][+-]?\d+)?\s*")


@dataclass(frozen=True)
class Layout:
    """Where a table stands among the lines of a file.

    Parameters
    ----------
    names : int
        The line of names, or the first row where there are none, counted from 0.
    below : int
        The line after it that is the first row of the table.
    separator : str
        Between cells.
    notes : tuple of str
        On lines that were passed over.
    """

    names: int
    below: int
    separator: str
    notes: tuple[str, ...] = ()


def layout_of(lines: Sequence[str], start: int = 0) -> Layout | None:
    """Where the table begins; None where there are no lines.

    The names are in the first line, unless a line below it, of more cells than all above, looks
    like names over rows of numbers while the first does not.

    Parameters
    ----------
    lines : sequence of str
        Of a file.
    start : int
        The first line to look at.
    """
    full = [i for i in range(start, len(lines)) if lines[i].strip() and lines[i][0] != "#"]
    said = _SEPARATOR.fullmatch(lines[full[0]]) if full else None
    full = full[1:] if said else full
    if not full:
        return None
    separator = said[1] if said else None
    tried = range(min(HIGHEST, len(full)))
    first = next((k for k in tried if _heads(lines, full, k, separator)), 0)
    names = full[first]
    separator = separator or separator_of(lines[names])
    below = names + 1
    notes = [f"{counted(first, 'line')} above the names passed over"] if first else []
    if len(full) > first + 1 and _is_units(lines, full[first:], separator):
        below = full[first + 1] + 1
        notes.append(f"line {below} holds no numbers and is passed over: {lines[below - 1]:.60}")
    return Layout(names, below, separator, tuple(notes))


def has_commas(rows: Sequence[str], separator: str) -> bool:
    """Whether numbers in these rows have a decimal comma."""
    if separator == ",":
        return False
    cells = [cell for row in islice(_full(rows), _LOOKED_AT) for cell in cells_of(row, separator)]
    return any(map(has_comma, cells)) and not any("." in c for c in cells if is_number(c))


def first_full(rows: Sequence[str]) -> str:
    """The first row that is not blank, or an empty one."""
    return next(iter(_full(rows)), "")


def _full(rows: Sequence[str]) -> Sequence[str] | filter[str]:
    return filter(str.strip, rows)


def _heads(lines: Sequence[str], full: Sequence[int], at: int, separator: str | None) -> bool:
    """Whether names stand in a line, rows of as many cells below it, and fewer cells above it."""
    head = lines[full[at]]
    sep = separator or separator_of(head)
    if sep not in head or _has(cells_of(head, sep), is_number):
        return False
    width = head.count(sep) + 1
    above = (lines[i].strip().rstrip(sep) for i in full[:at])  # spreadsheets fill lines up
    rows = [cells_of(lines[i], sep) for i in full[at + 1 : at + 4]]
    rows = rows[1:] if rows and not _has(rows[0], is_number) else rows[:2]
    return (
        bool(rows)
        and all(len(row) == width and _has(row, is_number) for row in rows)
        and all(line.count(sep) + 1 < width for line in above)
    )


def _is_units(lines: Sequence[str], full: Sequence[int], separator: str) -> bool:
    """Whether words stand below the names, and numbers below these."""
    names, *rows = (cells_of(lines[i], separator) for i in full[:3])
    if len(rows) < 2 or separator not in lines[full[0]] or _has(names, is_number):
        return False
    words = [i for i, cell in enumerate(rows[0]) if cell.lower() not in EMPTY]
    return (
        bool(words)
        and len(rows[0]) == len(rows[1]) == len(names)
        and not any(is_number(rows[0][i]) or is_date(rows[0][i]) for i in words)
        and all(is_number(rows[1][i]) or is_date(rows[1][i]) for i in words)
    )


def cells_of(line: str, separator: str) -> list[str]:
    """The cells of a line, without blanks and quotes around them."""
    return [cell.strip().strip('"').strip() for cell in line.split(separator)]


def _has(cells: Sequence[str], what: Callable[[str], bool]) -> bool:
    return any(map(what, cells))


def is_number(cell: str) -> bool:
    """Whether a cell is a number, with a decimal point or comma."""
    return bool(_NUMBER.fullmatch(cell))
