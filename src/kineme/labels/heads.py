"""The first and last bytes of files, by which formats that share a suffix are told apart."""

from __future__ import annotations

import csv
from pathlib import Path

LENGTH = 4096


def head(path: Path) -> bytes:
    """The first bytes of a file; none if it cannot be read."""
    try:
        with path.open("rb") as file:
            return file.read(LENGTH).removeprefix(b"\xef\xbb\xbf")
    except OSError:
        return b""


def tail(path: Path) -> bytes:
    """The last bytes of a file, where Parquet keeps what it knows of itself."""
    try:
        with path.open("rb") as file:
            file.seek(max(0, path.stat().st_size - 16 * LENGTH))
            return file.read()
    except OSError:
        return b""


def columns(path: Path) -> set[str]:
    """The cells of a file's first line, commas or tabs between them."""
    first = head(path).decode(errors="replace").partition("\n")[0].strip("\r")
    try:
        cells = next(csv.reader([first], delimiter=separator(first)), [])
    except csv.Error:
        return set()
    return {cell.strip() for cell in cells}


def separator(first_line: str) -> str:
    """What stands between the cells of a table: tabs if there are any, else commas."""
    return "\t" if "\t" in first_line else ","
