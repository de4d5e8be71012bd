"""What files of signals hold: the names of their columns, and the columns wanted.

Each kind of file is a pair of functions: its column names without reading the
rest, and its columns as a `Table`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme.errors import MissingDependencyError, ReadError
from kineme.formats.arrays.mat import mat_channels
from kineme.formats.channels.muscles import muscles_of
from kineme.formats.channels.text_table import NAMELESS, TextTable, named
from kineme.formats.columns import dated, is_timing, timed
from kineme.formats.delimited import rows_of
from kineme.formats.files import MOST_EXPANSION, Source, unique
from kineme.formats.markers.c3d_file import parse_c3d
from kineme.formats.timing import Timing

Floats = NDArray[np.float64]

COUNTERS = frozenset(
    {"frame", "frames", "frame#", "index", "idx", "sample", "row", "id", "unnamed: 0"}
    | {"__index_level_0__"}
)
"""Names of columns that count rows."""


@dataclass(frozen=True)
class Table:
    """Columns of numbers.

    Parameters
    ----------
    names : of the channels
    values : (rows, channels)
    timing : columns that tell times or a rate, by name
    rate : the file's own, None if it has none
    notes : sentences on what was left out
    """

    names: list[str]
    values: Floats
    timing: Mapping[str, ArrayLike]
    rate: float | None = None
    notes: tuple[str, ...] = ()

    def timed(self, source: Source, fps: float | None) -> Timing:
        """Frames per second, pauses, and what was seen of the times."""
        if fps or self.rate:
            return Timing(fps or self.rate or 0.0)
        if not self.timing:
            raise source.error("nothing in it tells the frame rate: give fps (--fps)")
        return timed(source, self.timing, None)


class Kind(NamedTuple):
    """How to read a kind of file."""

    names: Callable[[Source], list[str]]
    read: Callable[[Source, Sequence[str] | None], Table]


def kind_of(source: Source) -> str:
    """The name of a file's kind, by its first bytes and its suffix."""
    head, suffix = source.data[:4096], source.path.suffix.lower()
    if suffix in (".npz", ".npy"):
        raise source.error("holds arrays: load them with numpy and give these to kineme.Signals")
    if suffix in (".c3d", ".mat"):
        return suffix[1:].upper()
    if head.startswith(b"PAR1"):
        return "Parquet table"
    return "MOT/STO" if b"\nendheader" in head.lower() else "table"


def _text_names(source: Source) -> list[str]:
    return TextTable.of(source).names


def _read_text(source: Source, columns: Sequence[str] | None) -> Table:
    text = TextTable.of(source)
    wanted = _wanted(source, text.names, columns, text.numeric())
    at = [text.names.index(name) for name in wanted]
    values = rows_of(
        source,
        text.rows,
        text.first_row,
        text.separator,
        len(text.names),
        at,
        dates=dated(text.names, text.first_cells()),
    )
    return _table(source, text.names, dict(zip(wanted, values.T, strict=True)), columns)


def _parquet_names(source: Source) -> list[str]:
    return named(parquet_file(source).schema_arrow.names)


def _read_parquet(source: Source, columns: Sequence[str] | None) -> Table:
    import pyarrow as pa

    file = parquet_file(source)
    names = named(file.schema_arrow.names)
    types = dict(zip(names, file.schema_arrow.types, strict=True))
    kinds = (pa.types.is_integer, pa.types.is_floating, pa.types.is_boolean)
    numeric = [
        name
        for name in names
        if any(kind(types[name]) for kind in kinds)
        or (is_timing(name) and _tells_dates(types[name]))
    ]
    wanted = _wanted(source, names, columns, numeric)
    try:
        table = file.read(columns=[file.schema_arrow.names[names.index(name)] for name in wanted])
        values = {
            name: column.to_numpy() if is_timing(name) else _plain(column)
            for name, column in zip(wanted, table.columns, strict=True)
        }
    except (pa.ArrowException, OSError, ValueError, TypeError) as error:
        raise ReadError(source.path, f"its columns cannot be read as numbers: {error}") from error
    return _table(source, names, values, columns)


def _tells_dates(kind: Any) -> bool:
    import pyarrow as pa

    return bool(pa.types.is_timestamp(kind) or pa.types.is_string(kind))


def _plain(column: Any) -> Floats:
    return np.asarray(column.to_numpy(), np.float64)


def _c3d_names(source: Source) -> list[str]:
    return unique(parse_c3d(source).analog_labels)


def _read_c3d(source: Source, columns: Sequence[str] | None) -> Table:
    file = parse_c3d(source)
    if not file.analog.size:
        raise source.error("holds no analog channels")
    names = unique(file.analog_labels)
    wanted = _wanted(source, names, columns, names)
    at = [names.index(name) for name in wanted]
    return Table(wanted, file.analog[:, at], {}, file.analog_rate or None)


def read_muscles(source: Source) -> Table:
    """The analog channels of a C3D that are muscles', with a note of what was taken."""
    names, note = muscles_of(source, parse_c3d(source))
    return replace(_read_c3d(source, names), notes=(note,))


def _mat_names(source: Source) -> list[str]:
    return list(mat_channels(source)[0])


def _read_mat(source: Source, columns: Sequence[str] | None) -> Table:
    channels, rate = mat_channels(source)
    lengths = Counter(map(len, channels.values()))
    length = max(lengths, key=lambda n: (lengths[n], n), default=0)
    if columns and columns[0] in channels:
        length = len(channels[columns[0]])
    alike = [name for name, channel in channels.items() if len(channel) == length]
    wanted = _wanted(source, list(channels), columns, alike)
    for name in wanted:
        if name not in alike:
            raise source.error(f"column {name!r} is not as long as {wanted[0]!r}: choose one rate")
    values = {name: np.asarray(channels[name], np.float64) for name in wanted}
    table = _table(source, alike, values, columns)
    others = [name for name in channels if name not in alike]
    if columns is None and others:
        note = f"of another length, left out: {', '.join(others)}"
        table = replace(table, notes=(*table.notes, note))
    known = rate is not None and np.isfinite(rate) and rate > 0
    return replace(table, rate=rate) if known else table


def parquet_file(source: Source) -> Any:
    """A Parquet file, opened but not read; ReadError where it is none or damaged."""
    try:
        import pyarrow as pa
        from pyarrow import parquet
    except ImportError as error:
        raise MissingDependencyError("pyarrow", "tables") from error
    try:
        file = parquet.ParquetFile(pa.BufferReader(source.data))
    except (pa.ArrowException, OSError) as error:
        raise ReadError(source.path, "is not a Parquet file, or is damaged") from error
    rows, width = file.metadata.num_rows, file.metadata.num_columns
    if 8 * rows * width > MOST_EXPANSION * len(source.data):
        raise source.error(f"claims {rows} rows of {width} columns: it is damaged")
    return file


def _wanted(
    source: Source, names: list[str], columns: Sequence[str] | None, numeric: Iterable[str]
) -> list[str]:
    """The columns to read: those asked for, or all that hold numbers, and those of times."""
    for name in columns or ():
        if name not in names:
            raise source.error(f"no column {name!r}; there are {', '.join(names)}")
    if columns is not None and len(set(columns)) < len(columns):
        raise source.error("a column is asked for twice")
    timing = [name for name in numeric if is_timing(name)]
    chosen = list(numeric) if columns is None else list(columns)
    return [*chosen, *(name for name in timing if name not in chosen)]


def _table(
    source: Source,
    names: list[str],
    values: Mapping[str, Floats],
    columns: Sequence[str] | None,
) -> Table:
    """The columns read, taken apart: channels, times, and a note of what is neither."""
    timing = {name: column for name, column in values.items() if is_timing(name)}
    if columns is not None:
        chosen, notes = list(columns), []
    else:
        chosen = [name for name in values if name not in timing and not _counts(name)]
        left = [name for name in names if name not in chosen and name not in timing]
        notes = [f"columns that are no channels: {', '.join(left)}"] if left else []
    if not chosen:
        raise source.error(f"none of its columns is a channel ({', '.join(names)})")
    return Table(
        chosen, np.column_stack([values[name] for name in chosen]), timing, None, tuple(notes)
    )


def _counts(name: str) -> bool:
    """Whether a column of this name counts rows, as the one that pandas leaves nameless."""
    return name.strip().lower() in COUNTERS or name.startswith(NAMELESS)


KINDS = {
    "table": Kind(_text_names, _read_text),
    "MOT/STO": Kind(_text_names, _read_text),
    "Parquet table": Kind(_parquet_names, _read_parquet),
    "C3D": Kind(_c3d_names, _read_c3d),
    "MAT": Kind(_mat_names, _read_mat),
}
