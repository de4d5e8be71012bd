"""Tables of joint positions: CSV, TSV and Parquet, and CSV out.

What the columns may be called: `kineme.formats.columns`. Lines before the names
that begin with ``#`` are passed over. Written are ``time`` in seconds and
``JOINT_x JOINT_y JOINT_z`` in metres, y up, empty in gaps; the skeleton is not.
"""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np

from kineme.errors import MissingDependencyError, ReadError
from kineme.formats.columns import columns_to_motion, dated, is_used
from kineme.formats.delimited import rows_of, separator_of
from kineme.formats.files import MOST_EXPANSION, Source, save, unique
from kineme.formats.gaps import unseen
from kineme.formats.keypoints.deeplabcut import is_deeplabcut, read_deeplabcut
from kineme.formats.registry import Format, ReadOptions
from kineme.formats.tables.pose_tables import POSE_TABLES, PoseTable
from kineme.recordings.motion import Motion


def read_table(source: Source, options: ReadOptions) -> Motion:
    """The motion in a CSV or TSV of joint positions or keypoints."""
    lines = source.text.splitlines()
    first = next((i for i, line in enumerate(lines) if line.strip() and line[0] != "#"), 0)
    if is_deeplabcut(lines[first]):
        return read_deeplabcut(source, lines[first:], first + 1, options)
    separator = separator_of(lines[first])
    names = unique(_cells(lines[first], separator, source))
    table = PoseTable(source, names, lines[first + 1 :], first + 2, separator)
    for recognises, reader in POSE_TABLES:
        if recognises(names):
            return reader(table, options)
    used = [i for i, name in enumerate(names) if is_used(name)]
    below = lines[first + 1 :]
    dates = dated(names, _cells(below[0], separator, source) if below else [])
    values = rows_of(source, below, first + 2, separator, len(names), used, dates=dates)
    columns = {names[i]: column for i, column in zip(used, values.T, strict=True)}
    return columns_to_motion(source, "table", columns, options)


def read_parquet(source: Source, options: ReadOptions) -> Motion:
    """The motion in a Parquet table of joint positions."""
    try:
        import pyarrow as pa
        from pyarrow import parquet
    except ImportError as error:
        raise MissingDependencyError("pyarrow", "tables") from error
    try:
        file = parquet.ParquetFile(pa.BufferReader(source.data))
        rows, width = file.metadata.num_rows, file.metadata.num_columns
        if 8 * rows * width > MOST_EXPANSION * len(source.data):
            raise source.error(f"claims {rows} rows of {width} columns: it is damaged")
        table = file.read()
        columns = {name: _plain(table.column(name)) for name in unique(table.column_names)}
    except (pa.ArrowException, OSError, KeyError) as error:
        raise ReadError(source.path, "is not a Parquet file, or is damaged") from error
    return columns_to_motion(source, "Parquet table", columns, options)


def write_csv(motion: Motion, path: Path) -> None:
    """Leave the joints' positions in a CSV file, in metres with y up."""
    joints = unique(" ".join(name.replace('"', "'").split()) for name in motion.skeleton.names)
    names = ["time", *(f"{joint}_{axis}" for joint in joints for axis in "xyz")]
    head = ",".join(f'"{name}"' if "," in name else name for name in names) + "\n"
    row = "%.9f" + ",%.9f" * (len(names) - 1) + "\n"
    empty = "%.9f" + "," * (len(names) - 1) + "\n"
    values = motion.positions.reshape(motion.n_frames, -1).tolist()
    rows = zip(motion.times.tolist(), values, unseen(motion), strict=True)
    save(path, [head, *(empty % t if gap else row % (t, *line) for t, line, gap in rows)])


def _cells(line: str, separator: str, source: Source) -> list[str]:
    try:
        return [cell.strip() for cell in next(csv.reader([line], delimiter=separator))]
    except (csv.Error, StopIteration) as error:
        raise source.error(f"the columns' names cannot be read: {error}") from None


def _plain(column: Any) -> np.ndarray[Any, Any]:
    return np.asarray(column.to_numpy())


FORMAT = Format("table", (".csv", ".tsv"), lambda _: False, read_table, write_csv)
PARQUET = Format(
    "Parquet table", (".parquet",), lambda head: head.startswith(b"PAR1"), read_parquet
)
