"""Read and write text tables with one header line, and help to recognise formats.

A table and its side file are renamed one after the other. A writer killed between the two leaves
files that do not match. Therefore the side file holds the SHA-256 of its table's cuts
(`digest_cuts`), and reading compares the two (`find_differences`).
"""

from __future__ import annotations

import csv
import math
from codecs import BOM_UTF8
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from hashlib import sha256
from itertools import chain
from math import isclose
from pathlib import Path
from typing import Any, TextIO

from kineme._util.files import atomic_write, read_head, read_tail
from kineme.errors import ReadError
from kineme.formats.delimited import as_text, find_separator, from_text
from kineme.recordings.cells import replace_decimal_comma
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level

CUTS_KEY = "cuts_sha256"
"""Key of the digest of a table's cuts in its side file."""
SAME_RATE = 5e-4
"""Relative difference of frame rates that count as equal; spreadsheets round seconds."""


def read_rows(
    file: TextIO,
    path: Path,
    header: Sequence[Sequence[str]],
    rename: Callable[[Sequence[str]], list[str]] = list,
    *,
    numbers: Collection[str] = (),
) -> Iterator[tuple[int, dict[str, str]]]:
    """Yield line number and cells by column name of each row below the header.

    The header is the first row that contains all names of one of the sets in ``header``; lines
    above it are skipped. Names are compared after ``rename``. Missing cells are empty. ``numbers``
    are columns that may have decimal commas, unless commas separate the cells.
    """
    above = 0
    try:
        for line in file:
            # Lines above the header may have other separators.
            separator = find_separator(line)
            rows = csv.reader(chain([line], file), delimiter=separator, strict=True)
            names = rename(next(rows))
            if any(set(needed) <= set(names) for needed in header):
                break
            above += rows.line_num
        else:
            needed = " or ".join(", ".join(map(repr, names)) for names in header[:2])
            raise ReadError(path, f"has no header line with the columns {needed}")
        with_comma = set() if separator == "," else {*numbers}
        for cells in filter(any, rows):
            # Rows may be shorter or longer than the header.
            row = dict.fromkeys(names, "") | dict(zip(names, map(from_text, cells), strict=False))
            row |= {name: replace_decimal_comma(row[name]) for name in with_comma & row.keys()}
            yield above + rows.line_num, row
    except csv.Error as error:
        line_number = above + rows.line_num
        raise ReadError(path, f"is not a valid table: {error}", line=line_number) from error


def write_rows(
    file: TextIO, header: Sequence[str], rows: Iterable[Sequence[object]], *, delimiter: str = ","
) -> None:
    """Write a header line and one line per row, quoting cells only if needed.

    Texts are escaped so that spreadsheets do not run them as formulas, see `as_text`;
    `read_rows` reverses this.
    """
    writer = csv.writer(file, delimiter=delimiter, lineterminator="\n")
    for cells in chain([header], rows):
        writer.writerow([as_text(cell) if isinstance(cell, str) else cell for cell in cells])


@contextmanager
def open_new_text(path: Path, *, newline: str = "") -> Iterator[TextIO]:
    """Open a text file that replaces ``path`` atomically when it is closed."""
    with atomic_write(path) as draft, draft.open("w", encoding="utf-8", newline=newline) as file:
        yield file


def format_source(segmentation: Segmentation) -> str:
    """Return the path of the segmented file as valid UTF-8 text."""
    path = (segmentation.provenance.get("input") or {}).get("path") or ""
    return str(path).encode(errors="backslashreplace").decode()


def parse_level(text: str | None) -> Level:
    """Return the level in a cell, "activity" by default."""
    return "primitive" if text == "primitive" else "activity"


def parse_number(text: str, name: str, path: Path, line: int) -> float:
    """Return ``text`` as a finite number; raise ReadError otherwise."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ReadError(path, f"{name} must be a number, not {text!r:.60}", line=line)
    return value


def parse_integer(text: str, name: str, path: Path, line: int) -> int:
    """Return ``text`` as an integer; raise ReadError otherwise."""
    value = parse_number(text, name, path, line)
    if value != int(value):
        raise ReadError(path, f"{name} must be a whole number, not {text!r:.60}", line=line)
    return int(value)


def read_first_bytes(path: Path) -> bytes:
    """Return the first bytes of a file without byte order mark; empty if it cannot be read."""
    try:
        return read_head(path).removeprefix(BOM_UTF8)
    except OSError:
        return b""


def read_last_bytes(path: Path) -> bytes:
    """Return the last bytes of a file, where Parquet stores metadata; empty if unreadable."""
    try:
        return read_tail(path)
    except OSError:
        return b""


def read_columns(path: Path) -> set[str]:
    """Return the cells of a file's first line."""
    first = read_first_bytes(path).decode(errors="replace").partition("\n")[0].strip("\r")
    try:
        cells = next(csv.reader([first], delimiter=find_separator(first)), [])
    except csv.Error:
        return set()
    return {cell.strip() for cell in cells}


def digest_cuts(cuts: Iterable[tuple[object, object, object]]) -> str:
    """Return a digest of the level, first frame and end of every row, in any order.

    Labels are not included, so that people may edit them.
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
    """Return notes on a table and side file that were not written together.

    ``found`` is the digest of the table's cuts; side files without a digest are trusted.
    ``head_rate`` is from the side file, ``row_rate`` computed from frames and seconds of the table.
    """
    if CUTS_KEY not in side:
        return ()
    rates = [rate for rate in (head_rate, row_rate) if rate is not None]
    if len(rates) == 2 and not isclose(*rates, rel_tol=SAME_RATE):
        raise ReadError(
            path,
            f"is of {row_rate:g} frames per second, but {beside.name} states {head_rate:g}, "
            "so it belongs to another table: remove that file or write both again",
        )
    note = (
        f"{path.name} does not match {beside.name}: the table was edited since, or writing "
        "was interrupted"
    )
    return () if side[CUTS_KEY] == found else (note,)
