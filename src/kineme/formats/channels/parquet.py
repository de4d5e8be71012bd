"""Open Parquet tables without reading them, and read their columns as channels."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any

import numpy as np

from kineme._util.checks import require_extra
from kineme._util.files import shorten_error
from kineme.errors import ReadError
from kineme.formats.channels.reading import (
    ChannelTable,
    list_needed_columns,
    make_channel_table,
    select_columns,
)
from kineme.formats.delimited import make_unique_names
from kineme.formats.files import FileContent
from kineme.recordings.column_names import describe_alternation, is_owner
from kineme.recordings.times import find_unnamed_clock, is_timing


def open_parquet(content: FileContent) -> Any:
    """Return a `pyarrow.parquet.ParquetFile`, not yet read; raise ReadError if it is damaged."""
    with require_extra("pyarrow", "tables"):
        import pyarrow as pa
        from pyarrow import parquet
    try:
        file = parquet.ParquetFile(pa.BufferReader(content.data))
    except (pa.ArrowException, OSError) as error:
        raise ReadError(content.path, "is not a Parquet file, or is damaged") from error
    rows, width = file.metadata.num_rows, file.metadata.num_columns
    content.require_memory(8 * rows * width, f"{rows} rows of {width} columns")
    return file


def read_parquet_columns(content: FileContent, file: Any, columns: Sequence[str]) -> Any:
    """Return columns of a Parquet file as a table, if the file can plausibly hold that much.

    Texts are first read as dictionaries of distinct values, and their expanded size is estimated:
    ten kilobytes can repeat a long text for gigabytes.
    """
    import pyarrow as pa
    from pyarrow import parquet

    texts = [field.name for field in file.schema_arrow if _is_text(field.type)]
    try:  # without the metadata of columns: if damaged, it ends the process
        if texts:
            file = parquet.ParquetFile(pa.BufferReader(content.data), read_dictionary=texts)
        # A thread that releases the bytes while Python exits would abort the process.
        table = file.read(columns=list(columns), use_threads=False)
        content.require_memory(
            sum(map(_estimate_expanded_size, table.columns)), "texts that repeat"
        )
        plain = [
            pa.field(field.name, field.type.value_type)
            if pa.types.is_dictionary(field.type)
            else field
            for field in table.schema
        ]
        return table.cast(pa.schema(plain, table.schema.metadata))
    except (pa.ArrowException, OSError, LookupError) as error:
        reason = f"is damaged, its columns cannot be read: {shorten_error(error)}"
        raise content.error(reason) from error


def read_parquet_channels(
    content: FileContent, file: Any, columns: Sequence[str] | None
) -> ChannelTable:
    """Return the named channels of a Parquet file in this order, or all columns of numbers."""
    import pyarrow as pa

    names = make_unique_names(file.schema_arrow.names)
    types = dict(zip(names, file.schema_arrow.types, strict=True))
    times = find_parquet_times(file)
    numbers = (pa.types.is_integer, pa.types.is_floating, pa.types.is_boolean)
    numeric = [
        name for name in names if name in times or any(is_kind(types[name]) for is_kind in numbers)
    ]
    columns = select_columns(content, names, columns, numeric, times)
    refuse_interleaved(content, file, columns or ())
    chosen = list_needed_columns(columns, numeric, times)
    try:
        stored = [file.schema_arrow.names[names.index(name)] for name in chosen]
        table = read_parquet_columns(content, file, stored)
        values = {
            name: np.asarray(column.to_numpy(), None if name in times else np.float64)
            for name, column in zip(chosen, table.columns, strict=True)
        }
    except (pa.ArrowException, OSError, ValueError, TypeError) as error:
        reason = f"its columns cannot be read as numbers: {shorten_error(error)}"
        raise content.error(reason) from error
    return make_channel_table(content, names, values, columns, times)


def find_parquet_times(file: Any) -> dict[str, str]:
    """Return columns of times or rates, and the names that `find_table_timing` knows."""
    from pyarrow import types

    dates = (types.is_timestamp, types.is_duration)
    named = (*dates, types.is_integer, types.is_floating, types.is_boolean, types.is_string)
    fields = list(zip(make_unique_names(file.schema_arrow.names), file.schema_arrow, strict=True))
    times = {
        name: name
        for name, field in fields
        if is_timing(name) and any(is_kind(field.type) for is_kind in named)
    }
    clocks = [name for name, field in fields if any(is_kind(field.type) for is_kind in dates)]
    # An index of pandas is a column of dates without such a name.
    return times | dict.fromkeys(find_unnamed_clock(times, clocks), "time")


def refuse_interleaved(content: FileContent, file: Any, requested: Collection[str] = ()) -> None:
    """Raise ReadError if rows of several points, people or devices alternate."""
    owners = [name for name in file.schema_arrow.names if is_owner(name)]
    table = read_parquet_columns(content, file, owners)
    cells = zip(owners, (column.to_pylist() for column in table.columns), strict=True)
    if error := describe_alternation(dict(cells), requested):
        raise content.error(error)


def _is_text(kind: Any) -> bool:
    from pyarrow import types

    kinds = (types.is_string, types.is_large_string, types.is_binary, types.is_large_binary)
    return any(is_text(kind) for is_text in (*kinds, types.is_dictionary))


def _estimate_expanded_size(column: Any) -> int:
    """Return the bytes of a column with the text of every row stored separately."""
    import pyarrow.compute as pc
    from pyarrow import types

    if not types.is_dictionary(column.type):
        return int(column.nbytes)

    if not _is_text(column.type.value_type):
        return 8 * len(column)
    longest = (pc.max(pc.binary_length(chunk.dictionary)).as_py() for chunk in column.chunks)
    return sum(
        len(chunk) * max(8, most or 0) for chunk, most in zip(column.chunks, longest, strict=True)
    )
