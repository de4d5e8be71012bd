"""Read and write tables of text with one header line, and tell formats apart by their first bytes.

A table and its side file are renamed one after the other. A writer that is killed between
the two leaves files of different recordings beside each other. So the side file names the
SHA-256 of its table's cuts (`digest_cuts`), and reading compares the two (`find_differences`).
"""

from __future__ import annotations

import csv
import math
from codecs import BOM_UTF8
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from hashlib import sha256
from itertools import chain
from math import isclose
from pathlib import Path
from typing import Any, TextIO

from kineme._util.files import atomic_write, read_head, read_tail
from kineme.errors import ReadError
from kineme.formats.delimited import as_text, from_text
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level


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


@contextmanager
def open_new_text(path: Path, *, newline: str = "") -> Iterator[TextIO]:
    """Open a text file that takes the place of ``path`` once all is written."""
    with atomic_write(path) as draft, draft.open("w", encoding="utf-8", newline=newline) as file:
        yield file


def format_source(segmentation: Segmentation) -> str:
    """Return the file that was segmented, in characters that UTF-8 can hold."""
    path = (segmentation.provenance.get("input") or {}).get("path") or ""
    return str(path).encode(errors="backslashreplace").decode()


def parse_level(text: str | None) -> Level:
    """Return the level that a cell names; activity where it names none."""
    return "primitive" if text == "primitive" else "activity"


def parse_number(text: str, name: str, path: Path, line: int) -> float:
    """``text`` as a finite number."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ReadError(path, f"{name} must be a number, not {text!r:.60}", line=line)
    return value


def parse_integer(text: str, name: str, path: Path, line: int) -> int:
    """``text`` as a whole number."""
    value = parse_number(text, name, path, line)
    if value != int(value):
        raise ReadError(path, f"{name} must be a whole number, not {text!r:.60}", line=line)
    return int(value)


def read_first_bytes(path: Path) -> bytes:
    """Return the first bytes of a file; none if it cannot be read."""
    try:
        return read_head(path).removeprefix(BOM_UTF8)
    except OSError:
        return b""


def read_last_bytes(path: Path) -> bytes:
    """Return the last bytes of a file, where Parquet keeps what it knows of itself."""
    try:
        return read_tail(path)
    except OSError:
        return b""


def read_columns(path: Path) -> set[str]:
    """Return the cells of a file's first line, commas or tabs between them."""
    first = read_first_bytes(path).decode(errors="replace").partition("\n")[0].strip("\r")
    try:
        cells = next(csv.reader([first], delimiter=find_separator(first)), [])
    except csv.Error:
        return set()
    return {cell.strip() for cell in cells}


def find_separator(first_line: str) -> str:
    """What stands between the cells: tabs if there are any, semicolons if there are no commas."""
    if "\t" in first_line:
        return "\t"
    return ";" if ";" in first_line and "," not in first_line else ","


CUTS_KEY = "cuts_sha256"
"""Where a side file has the digest of its table's cuts."""

SAME_RATE = 5e-4
"""Share by which two frame rates differ that are one, once spreadsheets rounded the seconds."""


def digest_cuts(cuts: Iterable[tuple[object, object, object]]) -> str:
    """What a side file says of its table: level, first frame and end of every row, in any order.

    Labels are not in it, so that people may edit them.
    """
    lines = sorted(",".join(map(str, cut)) for cut in cuts)
    return sha256("\n".join(lines).encode()).hexdigest()


def find_differences(
    path: Path,
    beside: Path,
    side: Mapping[str, Any],
    found: str,
    *,
    head_rate: float | None,
    row_rate: float | None,
) -> tuple[str, ...]:
    """Return what to say of a table and its side file that were not written together.

    ``found`` is the `digest` of the table; side files that are older than it have none, and are
    believed. The rates are those in the side file and of frames and seconds in the table.
    """
    if CUTS_KEY not in side:
        return ()
    rates = [rate for rate in (head_rate, row_rate) if rate is not None]
    if len(rates) == 2 and not isclose(*rates, rel_tol=SAME_RATE):
        raise ReadError(
            path,
            f"is of {row_rate:g} frames per second, but {beside.name} speaks of {head_rate:g}, "
            "and was written with another table: remove that file, or write both again",
        )
    note = (
        f"{path.name} is not the table that {beside.name} was written with: its cuts were moved "
        "since, or writing broke off between the two"
    )
    return () if side[CUTS_KEY] == found else (note,)
