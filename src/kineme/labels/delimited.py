"""Tables of text with one header line: rows by column name, numbers with their line."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from pathlib import Path
from typing import TextIO

from kineme.errors import ReadError
from kineme.formats.delimited import as_text, from_text


def read_rows(
    file: TextIO, path: Path, header: Iterable[Sequence[str]], *, delimiter: str = ","
) -> Iterator[tuple[int, dict[str, str]]]:
    """Line and cells by column name of each row below the header.

    The header is the first row that holds every name of one of the sets in
    ``header``; what stands above it is skipped. Cells a row lacks are empty.
    """
    rows = csv.reader(file, delimiter=delimiter, strict=True)
    names: list[str] = []
    try:
        for cells in rows:
            if names and any(cells):
                texts = dict(zip(names, map(from_text, cells), strict=False))
                yield rows.line_num, dict.fromkeys(names, "") | texts
            elif not names and any(set(needed) <= set(cells) for needed in header):
                names = cells
    except csv.Error as error:
        raise ReadError(path, f"is not a valid table: {error}", line=rows.line_num) from error
    if not names:
        needed = " or ".join(", ".join(map(repr, names)) for names in header)
        raise ReadError(path, f"has no header line with the columns {needed}")


def write_rows(
    file: TextIO, header: Sequence[str], rows: Iterable[Sequence[object]], *, delimiter: str = ","
) -> None:
    """A header line and one line per row; cells in quotes only where they must be.

    No spreadsheet runs a text in it, see `as_text`; `read_rows` gives the text back.
    """
    writer = csv.writer(file, delimiter=delimiter, lineterminator="\n")
    for cells in chain([header], rows):
        writer.writerow([as_text(cell) if isinstance(cell, str) else cell for cell in cells])


def number(text: str, name: str, path: Path, line: int) -> float:
    """``text`` as a finite number."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ReadError(path, f"{name} must be a number, not {text!r:.60}", line=line)
    return value


def integer(text: str, name: str, path: Path, line: int) -> int:
    """``text`` as a whole number."""
    value = number(text, name, path, line)
    if value != int(value):
        raise ReadError(path, f"{name} must be a whole number, not {text!r:.60}", line=line)
    return int(value)
