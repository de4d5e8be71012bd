"""Where a table begins in a file of text, as loggers, devices and spreadsheets leave it.

- Above the names there may be blank lines, lines that begin with ``#``, the ``sep=;`` of
  spreadsheets, a header that ends in ``endheader``, and lines on the device and the recording. One
  of these may tell the frame rate: ``Sample rate: 120.0Hz``, ``Frequency,50``.
- Cells are parted by tabs, semicolons or commas, else by blanks.
- Below the names there may be two lines of words: units, what kind of numbers these are, or second
  names, where the first ones are those of several columns.
- Names may be missing: rows of numbers then stand at the top, or below lines of fewer cells.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from itertools import islice

from kineme._util.checks import format_count
from kineme.formats.delimited import (
    EMPTY,
    DelimitedText,
    cells_of,
    from_text,
    is_finite,
    is_number,
    named,
    separator_of,
)
from kineme.formats.files import FileContent
from kineme.formats.timing import is_date, is_timing

HIGHEST = 200
"""Lines above the names at most."""

WORDS = 2
"""Lines of words between names and numbers at most."""

_SEPARATOR = re.compile(r"\s*\"?sep=(.)\"?\s*", re.IGNORECASE)
_HERTZ = re.compile(r"(\d+(?:[.,]\d+)?)\s*hz\b", re.IGNORECASE)
_RATE = re.compile(
    r"\b(?:(?:sampl\w+|frame|update|output|measurement|capture|data)[\s_]*)?"
    r"(?:rate|frequency|freq|fps)\b\s*(?:[(\[]hz[)\]])?[^\w]*(\d+(?:[.,]\d+)?)",
    re.IGNORECASE,
)
_OF_A_FILTER = re.compile(r"cut|pass|notch|bandwidth|analog|range", re.IGNORECASE)


def sniff(content: FileContent) -> DelimitedText:
    r"""Return the table in a file of text.

    The names are in the first line, unless a line below it, of more cells than all above, looks
    like names over rows of numbers, or is the first of rows of numbers without names.

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
    first = _first_line(lines, full, separator)
    head = full[first]
    separator = separator or separator_of(lines[head])
    words = _lines_of_words(lines, full[first:], separator)
    below = full[first + words] + 1
    blanks = ended is not None or separator not in lines[head]
    if blanks:
        separator, cells = "\t", lines[head].split()
        cells = [cell.strip('"').strip() for cell in cells]
    else:
        row = next(filter(str.strip, islice(lines, below, None)), "")
        cells = _head_cells(content, lines[head], row, separator)
    passed = full[first + 1 : first + 1 + words]
    if words and (both := _joined(cells, cells_of(lines[passed[0]], separator))) != cells:
        cells, passed = both, passed[1:]
    headless = not any(map(is_timing, cells)) and any(is_finite(c) or is_date(c) for c in cells)
    notes = []
    if first:
        what = "rows" if headless else "names"
        notes.append(f"{format_count(first, 'line')} above the {what} passed over")
    notes += [f"line {i + 1} holds no numbers and is passed over: {lines[i]:.60}" for i in passed]
    return DelimitedText(
        content,
        lines,
        named(map(from_text, cells)),
        head,
        below,
        separator,
        headless,
        blanks,
        cells_of(lines[below - 1], separator) if words else (),
        _rate_in(lines[:head]),
        tuple(notes),
    )


def _head_cells(content: FileContent, line: str, row: str, separator: str) -> list[str]:
    """Return the cells of the line of names above a row.

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


def _first_line(lines: Sequence[str], full: Sequence[int], separator: str | None) -> int:
    """Which of the full lines has the names, or is the first row of a table without names."""
    heads = (k for k in range(min(HIGHEST, len(full))) if _is_head(lines, full, k, separator))
    nameless = _first_of_nameless(lines, full, separator)
    if not nameless:
        return next(heads, 0)

    def width(place: int) -> int:
        line = lines[full[place]]
        return len(cells_of(line, separator or separator_of(line)))

    return max([*heads, nameless], key=width)


def _is_head(lines: Sequence[str], full: Sequence[int], at: int, separator: str | None) -> bool:
    """Whether names stand in a line, rows of as many cells below it, and fewer cells above it."""
    head = lines[full[at]]
    sep = separator or separator_of(head)
    cells = cells_of(head, sep)
    if len(cells) == 1 or any(map(is_number, cells)) or not _are_names(cells):
        return False
    words = _lines_of_words(lines, full[at:], sep)
    rows = [cells_of(lines[i], sep) for i in full[at + 1 + words : at + 4 + words]]
    rows = rows[1:] if rows and not any(map(is_number, rows[0])) else rows[:2]
    # spreadsheets fill lines up, and devices stand above each of their channels
    above = [cells_of(lines[i].strip().rstrip(sep), sep) for i in full[:at]]
    return (
        bool(rows)
        and all(_fits(row, len(cells)) and any(map(is_number, row)) for row in rows)
        and all(len(others) < len(cells) or not _are_names(others) for others in above)
    )


def _joined(names: list[str], words: Sequence[str]) -> list[str]:
    """Names with the words below them, where only both tell the columns apart.

    Examples
    --------
    >>> _joined(["time", "L_TOE", "L_TOE"], ["", "x", "y"])
    ['time', 'L_TOE_x', 'L_TOE_y']
    >>> _joined(["time", "acc", "acc"], ["s", "g", "g"])
    ['time', 'acc', 'acc']
    """
    both = ["_".join(filter(None, pair)) for pair in zip(names, words, strict=False)]
    needed = len(set(names)) < len(names) == len(both) == len(set(both))
    return both if needed else names


def _first_of_nameless(lines: Sequence[str], full: Sequence[int], separator: str | None) -> int:
    """Of rows of numbers below lines of fewer cells, the first; 0 where there are none."""
    for at in range(1, min(HIGHEST, len(full) - 1)):
        line = lines[full[at]]
        sep = separator or separator_of(line)
        rows = [cells_of(lines[i], sep) for i in full[at : at + 3]]
        width = len(rows[0])
        if width > 1 and all(_fits(row, width) and is_row(row) for row in rows):
            above = [len(cells_of(lines[i], sep)) for i in full[:at]]
            return at if max(above) < width and (at > 1 or above[0] == 1) else 0
    return 0


def _lines_of_words(lines: Sequence[str], full: Sequence[int], separator: str) -> int:
    """How many lines hold words below the names, in the first of the lines, and above numbers."""
    names = cells_of(lines[full[0]], separator)
    if len(names) == 1 or any(map(is_number, names)):
        return 0
    for n in range(WORDS, 0, -1):
        *words, row = (cells_of(lines[i], separator) for i in full[1 : n + 2] or full[:1])
        if len(words) == n and all(_are_words(each, row, len(names)) for each in words):
            return n
    return 0


def _are_words(cells: Sequence[str], row: Sequence[str], width: int) -> bool:
    """Return whether words stand over the numbers of a row."""
    words = [i for i, cell in enumerate(cells) if cell.lower() not in EMPTY]
    return (
        bool(words)
        and _fits(cells, width)
        and _fits(row, width)
        and max(words) < width
        and not any(is_number(cells[i]) or is_date(cells[i]) for i in words)
        and all(is_number(row[i]) or is_date(row[i]) for i in words)
    )


def _fits(cells: Sequence[str], width: int) -> bool:
    """Whether a line has so many cells; rows may end in one more separator than their names."""
    return len(cells) == width or (len(cells) == width + 1 and not cells[-1])


def is_row(cells: Sequence[str]) -> bool:
    """Return whether cells hold numbers, dates or nothing, and a number at least."""
    return any(map(is_number, cells)) and all(
        is_number(cell) or is_date(cell) or cell.lower() in EMPTY for cell in cells
    )


def _are_names(cells: Sequence[str]) -> bool:
    """Return whether most cells of a line hold something, and not all of them the same."""
    full = [cell for cell in cells if cell]
    return 2 * len(full) > len(cells) and (len(cells) == 1 or len(set(full)) > 1)


def _rate_in(lines: Sequence[str]) -> float | None:
    """Return the frame rate that the lines above a table tell, if they tell one."""
    found = {
        float(match[1].replace(",", "."))
        for line in lines
        if not _OF_A_FILTER.search(line)
        for match in (*_HERTZ.finditer(line), *_RATE.finditer(line))
    }
    rates = found - {0.0}
    return rates.pop() if len(rates) == 1 else None
