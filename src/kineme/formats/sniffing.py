"""Find where a table begins in a file of text that no device claims, see `kineme.formats.devices`.

- Above the names there may be blank lines, lines that begin with ``#``, the ``sep=;`` of
  spreadsheets, a header that ends in ``endheader``, and lines on the device and the recording. One
  of these may tell the frame rate: ``Sample rate: 120.0Hz``, ``Frequency,50``.
- Cells are parted by tabs, semicolons or commas, else by blanks.
- Below the names there may be two lines of words: units, what kind of numbers these are, or second
  names, where the first ones are those of several columns.
- Names may be missing: rows of numbers then stand at the top.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from itertools import chain, dropwhile, islice, takewhile

from kineme._util.checks import format_count
from kineme.formats.delimited import (
    EMPTY,
    DelimitedText,
    find_separator,
    from_text,
    is_finite,
    is_number,
    make_unique_names,
    split_cells,
)
from kineme.formats.files import FileContent
from kineme.recordings.times import is_date, is_timing

HIGHEST = 200
"""Lines above the names at most."""

WORDS = 2
"""Lines of words between names and numbers at most."""

SEPARATOR = re.compile(r"\s*\"?sep=(.)\"?\s*", re.IGNORECASE)
"""Line in which spreadsheets say what parts their cells."""

_RATE = re.compile(
    r"\b(?:(?:sampl\w+|frame|update|output|measurement|capture|data)[\s_]*)?"
    r"(?:rate|frequency|freq|fps)\b\s*(?:[(\[]hz[)\]])?[^\w]*(\d+(?:[.,]\d+)?)",
    re.IGNORECASE,
)
_OF_A_FILTER = re.compile(r"cut|pass|notch|bandwidth|analog|range", re.IGNORECASE)


def sniff(content: FileContent) -> DelimitedText:
    r"""Return the table in a file of text.

    The names are in the first line, unless a line below it, of more cells than all above, looks
    like names over rows of numbers.

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
    text = (i for i in range(start, len(lines)) if is_text_line(lines[i]))
    full = [*islice(text, HIGHEST + WORDS + 3)]  # the highest head, words and rows below it
    if not full:
        raise content.error("has no lines of numbers")
    declared = next(filter(None, map(SEPARATOR.fullmatch, lines[: full[0]])), None)
    separator = declared[1] if declared else None
    places = range(min(HIGHEST, len(full)))
    first = next((k for k in places if _is_head(lines, full, k, separator)), 0)
    head = full[first]
    separator = separator or find_separator(lines[head])
    words = _count_word_lines(lines, full[first:], separator)
    below = full[first + words] + 1
    blanks = ended is not None or separator not in lines[head]
    if blanks:
        separator, cells = "\t", lines[head].split()
        cells = [cell.strip('"').strip() for cell in cells]
    else:
        row = next(filter(str.strip, islice(lines, below, None)), "")
        cells = split_head(content, lines[head], row, separator)
    passed = full[first + 1 : first + 1 + words]
    if words and (both := _join_names(cells, split_cells(lines[passed[0]], separator))) != cells:
        cells, passed = both, passed[1:]
    headless = not any(map(is_timing, cells)) and any(is_finite(c) or is_date(c) for c in cells)
    remark = "holds no numbers and is passed over"
    notes = [f"line {i + 1} {remark}: {lines[i]:.60}" for i in passed]
    return DelimitedText(
        content,
        lines,
        make_unique_names(map(from_text, cells)),
        head,
        below,
        separator,
        headless,
        blanks,
        split_cells(lines[below - 1], separator) if words else (),
        _find_rate(lines[:head]),
        (*note_skipped_lines(first, "rows" if headless else "names"), *notes),
    )


def is_text_line(line: str) -> bool:
    """Return whether a line is neither blank, a comment, nor the ``sep=;`` of spreadsheets."""
    return bool(line.strip()) and line[0] != "#" and not SEPARATOR.fullmatch(line)


def note_skipped_lines(count: int, what: str) -> tuple[str, ...]:
    """Return the note on lines above the names or rows of a table, if there are any."""
    return (f"{format_count(count, 'line')} above the {what} passed over",) if count else ()


def split_head(content: FileContent, line: str, row: str, separator: str) -> list[str]:
    """Return the cells of the line of names above a row.

    A separator between quotes is part of a name, but where the row has as many cells as there
    are without quotes.
    """
    plain = split_cells(line, separator)
    if '"' not in line or len(split_cells(row, separator)) == len(plain):
        return plain
    try:
        cells = next(csv.reader([line], delimiter=separator))
    except csv.Error as error:
        raise content.error(f"the columns' names cannot be read: {error}") from None
    return [cell.strip().strip('"').strip() for cell in cells]


def _is_head(lines: Sequence[str], full: Sequence[int], at: int, separator: str | None) -> bool:
    """Return whether a line has names: rows of as many cells below it, fewer cells above it."""
    separator = separator or find_separator(lines[full[at]])
    names, *below = (split_cells(lines[i], separator) for i in full[at : at + WORDS + 3])
    rows = [*dropwhile(lambda cells: not any(map(is_number, cells)), below)][:2]
    # spreadsheets fill lines up with separators
    above = (split_cells(lines[i].strip().rstrip(separator), separator) for i in full[:at])
    return (
        len(names) > 1
        and not any(map(is_number, names))
        and _is_full(names)
        and bool(rows)
        and all(_fits(row, len(names)) and any(map(is_number, row)) for row in rows)
        and all(len(cells) < len(names) or not _is_full(cells) for cells in above)
    )


def _join_names(names: list[str], words: Sequence[str]) -> list[str]:
    """Names with the words below them, where only both tell the columns apart.

    Examples
    --------
    >>> _join_names(["time", "L_TOE", "L_TOE"], ["", "x", "y"])
    ['time', 'L_TOE_x', 'L_TOE_y']
    >>> _join_names(["time", "acc", "acc"], ["s", "g", "g"])
    ['time', 'acc', 'acc']
    """
    both = ["_".join(filter(None, pair)) for pair in zip(names, words, strict=False)]
    needed = len(set(names)) < len(names) == len(both) == len(set(both))
    return both if needed else names


def _count_word_lines(lines: Sequence[str], full: Sequence[int], separator: str) -> int:
    """Return how many lines hold words below the names, in the first line, and above numbers."""
    names, *below = (split_cells(lines[i], separator) for i in full[: WORDS + 2])
    words = [*takewhile(lambda cells: not any(map(_has_value, cells)), below[:WORDS])]
    row = below[len(words)] if len(words) < len(below) else []
    if len(names) == 1 or any(map(is_number, names)) or not _fits(row, len(names)):
        return 0
    places = [[i for i, cell in enumerate(each) if cell.lower() not in EMPTY] for each in words]
    fits = all(_fits(each, len(names)) for each in words)
    over = all(places) and all(i < len(names) and _has_value(row[i]) for i in chain(*places))
    return len(words) if fits and over else 0


def _fits(cells: Sequence[str], width: int) -> bool:
    """Whether a line has so many cells; rows may end in one more separator than their names."""
    return len(cells) == width or (len(cells) == width + 1 and not cells[-1])


def is_row(cells: Sequence[str]) -> bool:
    """Return whether cells hold numbers, dates or nothing, and a number at least."""
    has_number = any(map(is_number, cells))
    return has_number and all(_has_value(cell) or cell.lower() in EMPTY for cell in cells)


def _has_value(cell: str) -> bool:
    return is_number(cell) or is_date(cell)


def _is_full(cells: Sequence[str]) -> bool:
    """Return whether most cells of a line hold something."""
    return 2 * sum(map(bool, cells)) > len(cells)


def _find_rate(lines: Sequence[str]) -> float | None:
    """Return the frame rate that the lines above a table tell, if they tell one."""
    found = {
        float(match[1].replace(",", "."))
        for line in lines
        if not _OF_A_FILTER.search(line)
        for match in _RATE.finditer(line)
    }
    rates = found - {0.0}
    return rates.pop() if len(rates) == 1 else None
