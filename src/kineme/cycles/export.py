"""Write cycles to CSV, Parquet, Excel, MATLAB and netCDF files.

=========== ==================================================================================
``.csv``    the cycles; the summary and the mean curves beside it, as ``NAME.summary.csv`` and
            ``NAME.curves.csv``
``.parquet`` the same three as Parquet
``.xlsx``   sheets ``cycles``, ``summary``, ``curves`` and ``provenance``
``.mat``    structs ``cycles``, ``summary``, ``mean_curves``; ``curves`` (cycles x channels x
            points), ``channels``, ``units``; characters that MATLAB rejects become ``_`` in names
``.nc``     all curves with the columns of their cycles, readable by xarray
=========== ==================================================================================
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from math import isnan
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from kineme._util.checks import check_path, check_type, require_extra
from kineme._util.files import atomic_write
from kineme.cycles.table import Columns, Cycles
from kineme.errors import WriteError
from kineme.labels.delimited import open_new_text, write_rows

NAME_OF_MATLAB = 63
"""Longest name in MATLAB, in characters."""
DIGITS = 15
"""Significant digits in CSV and Excel."""
TABLE_SUFFIXES = (".csv", ".parquet")
"""Suffixes of tables such as those of events and summaries."""
SHEET_ROWS = 1_048_575
"""Largest number of rows in an Excel sheet below the header."""


def write_cycles(cycles: Cycles, path: str | PathLike[str], *, ends: bool = False) -> None:
    """Write cycles, their summary and their curves; the suffix selects the format.

    Parameters
    ----------
    cycles : Cycles
    path : path-like
        ``.csv``, ``.parquet``, ``.xlsx``, ``.mat`` or ``.nc``.
    ends : bool
        Whether means include the first and last cycle of an activity.

    Raises
    ------
    WriteError
        Unknown suffix, or the file cannot be written.
    MissingDependencyError
        The package for this format is not installed.

    Examples
    --------
    >>> import kineme
    >>> from kineme.cycles import write_cycles
    >>> from kineme.datasets import bundled_truth
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> cycles = kineme.cycles(motion, kineme.read_segments(bundled_truth()))
    >>> write_cycles(cycles, "squats.csv")
    """
    check_type(cycles, Cycles, "write_cycles", "kineme.cycles(recording, segments) gives them")
    check_path(path, "write_cycles")
    target = Path(path)
    writer = _WRITERS.get(target.suffix.lower())
    if writer is None:
        raise WriteError(target, f"must end in {', '.join(_WRITERS)}")
    writer(cycles, target, ends)


def write_table(columns: Columns, path: str | PathLike[str]) -> None:
    """Write a table such as the result of `Cycles.summary` as CSV or Parquet.

    Parameters
    ----------
    columns : dict of str to array
    path : path-like
        ``.csv`` or ``.parquet``.

    Raises
    ------
    WriteError
        Unknown suffix, or the file cannot be written.
    MissingDependencyError
        Parquet without pyarrow.

    Examples
    --------
    >>> import numpy as np
    >>> from kineme.cycles import write_table
    >>> write_table({"group": np.array(["squat"]), "n": np.array([3])}, "counts.csv")
    """
    check_path(path, "write_table")
    target = Path(path)
    if target.suffix.lower() == ".parquet":
        with require_extra("pyarrow", "tables"):
            from pyarrow import parquet, table
        with atomic_write(target) as draft:
            parquet.write_table(table(columns), draft)
    elif target.suffix.lower() == ".csv":
        with open_new_text(target) as file:
            write_rows(file, [*columns], zip(*map(_format_cells, columns.values()), strict=True))
    else:
        raise WriteError(target, f"must end in {' or '.join(TABLE_SUFFIXES)}")


def _format_cells(column: np.ndarray[Any, Any]) -> list[Any]:
    """Return the cells of a column, "" for nan; rounding errors such as 1.1400000000000001 go."""
    if column.dtype.kind != "f":
        return list(column.tolist())
    return ["" if isnan(cell) else float(f"{cell:.{DIGITS}g}") for cell in column.tolist()]


def _make_tables(cycles: Cycles, ends: bool) -> dict[str, Columns]:
    return {
        "cycles": cycles.columns,
        "summary": cycles.summary(ends=ends),
        "curves": cycles.mean_curves(ends=ends),
    }


def _write_tables(cycles: Cycles, path: Path, ends: bool) -> None:
    for name, columns in _make_tables(cycles, ends).items():
        place = path if name == "cycles" else path.with_suffix(f".{name}{path.suffix}")
        write_table(columns, place)


def _write_excel(cycles: Cycles, path: Path, ends: bool) -> None:
    """Write a sheet per table, and one of the provenance."""
    with require_extra("openpyxl", "excel"):
        from openpyxl import Workbook
    book = Workbook(write_only=True)
    for name, columns in _make_tables(cycles, ends).items():
        n = len(next(iter(columns.values()))) if columns else 0
        if n > SHEET_ROWS:
            raise WriteError(path, f"a spreadsheet cannot hold {n} rows of {name}: write .parquet")
        sheet = book.create_sheet(name)
        sheet.append([*columns])
        # Excel stores None as an empty cell, and "" as a text.
        for row in zip(*map(_format_cells, columns.values()), strict=True):
            sheet.append([None if cell == "" else cell for cell in row])
    sheet = book.create_sheet("provenance")
    for key, value in cycles.provenance.items():
        # A cell holds one value: structures become JSON.
        sheet.append([key, value if isinstance(value, str) else json.dumps(value)])
    with atomic_write(path) as draft:
        book.save(draft)


def _write_matlab(cycles: Cycles, path: Path, ends: bool) -> None:
    from scipy.io import savemat

    tables = _make_tables(cycles, ends)
    content = {
        "cycles": _make_struct(tables["cycles"]),
        "summary": _make_struct(tables["summary"]),
        "mean_curves": _make_struct(tables["curves"]),
        "curves": cycles.curves,
        "channels": np.array(cycles.channels, object),
        "units": np.array(cycles.units, object),
        "provenance": json.dumps(dict(cycles.provenance)),
    }
    with atomic_write(path) as draft, draft.open("wb") as file:
        savemat(file, content, long_field_names=True, oned_as="column")


def _make_struct(columns: Columns) -> dict[str, Any]:
    """Return columns with valid MATLAB names; texts become cells."""
    struct: dict[str, Any] = {}
    for name, column in columns.items():
        # MATLAB's names hold letters, digits and _ only, and begin with a letter.
        plain = re.sub(r"\W", "_", name, flags=re.ASCII)
        plain = (plain if plain[:1].isalpha() else f"x{plain}")[:NAME_OF_MATLAB]
        if plain in struct:
            # Names that became equal get a number, within the length that MATLAB allows.
            number = f"_{len(struct)}"
            plain = plain[: NAME_OF_MATLAB - len(number)] + number
        # Arrays of objects become cells; fixed-width texts would become padded matrices.
        struct[plain] = column.astype(object) if column.dtype.kind == "U" else column
    return struct


def _write_netcdf(cycles: Cycles, path: Path, ends: bool) -> None:  # noqa: ARG001 (curves only)
    dataset = cycles.to_xarray()
    dataset.attrs["provenance"] = json.dumps(dict(cycles.provenance))
    with atomic_write(path) as draft:
        dataset.to_netcdf(draft, engine="scipy")


_WRITERS: dict[str, Callable[[Cycles, Path, bool], None]] = {
    ".csv": _write_tables,
    ".parquet": _write_tables,
    ".xlsx": _write_excel,
    ".mat": _write_matlab,
    ".nc": _write_netcdf,
}
SUFFIXES = tuple(_WRITERS)
