"""First and last bytes of files, by which formats that share a suffix are told apart."""

from __future__ import annotations

import csv
from codecs import BOM_UTF8
from pathlib import Path

from kineme._util.files import read_head, read_tail


def head(path: Path) -> bytes:
    """Return the first bytes of a file; none if it cannot be read."""
    try:
        return read_head(path).removeprefix(BOM_UTF8)
    except OSError:
        return b""


def tail(path: Path) -> bytes:
    """Return the last bytes of a file, where Parquet keeps what it knows of itself."""
    try:
        return read_tail(path)
    except OSError:
        return b""


def columns(path: Path) -> set[str]:
    """Return the cells of a file's first line, commas or tabs between them."""
    first = head(path).decode(errors="replace").partition("\n")[0].strip("\r")
    try:
        cells = next(csv.reader([first], delimiter=separator(first)), [])
    except csv.Error:
        return set()
    return {cell.strip() for cell in cells}


def separator(first_line: str) -> str:
    """What stands between the cells: tabs if there are any, semicolons if there are no commas."""
    if "\t" in first_line:
        return "\t"
    return ";" if ";" in first_line and "," not in first_line else ","
