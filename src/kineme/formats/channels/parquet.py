"""Parquet tables: opened without reading them, and their columns as channels."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme.errors import MissingDependencyError, ReadError
from kineme.formats.channels.table import ChannelTable, channel_table, named, wanted_columns
from kineme.formats.columns import is_timing
from kineme.formats.files import MOST_EXPANSION, FileContent


def parquet_file(content: FileContent) -> Any:
    """A Parquet file, opened but not read.

    Parameters
    ----------
    content : FileContent

    Returns
    -------
    pyarrow.parquet.ParquetFile

    Raises
    ------
    ReadError
        It is none, damaged, or claims to hold much more than it can.
    MissingDependencyError
        pyarrow is not installed.
    """
    try:
        import pyarrow as pa
        from pyarrow import parquet
    except ImportError as error:
        raise MissingDependencyError("pyarrow", "tables") from error
    try:
        file = parquet.ParquetFile(pa.BufferReader(content.data))
    except (pa.ArrowException, OSError) as error:
        raise ReadError(content.path, "is not a Parquet file, or is damaged") from error
    rows, width = file.metadata.num_rows, file.metadata.num_columns
    if 8 * rows * width > MOST_EXPANSION * len(content.data):
        raise content.error(f"claims {rows} rows of {width} columns: it is damaged")
    return file


def parquet_channels(
    content: FileContent, file: Any, columns: Sequence[str] | None
) -> ChannelTable:
    """The channels of a Parquet file: those wanted, or all that hold numbers.

    Parameters
    ----------
    content : FileContent
    file : pyarrow.parquet.ParquetFile
        In it.
    columns : sequence of str or None
        By name and in this order.

    Returns
    -------
    ChannelTable

    Raises
    ------
    ReadError
        There is no such column, or one holds no numbers, or nothing is a channel.
    """
    import pyarrow as pa

    names = named(file.schema_arrow.names)
    types = dict(zip(names, file.schema_arrow.types, strict=True))
    kinds = (pa.types.is_integer, pa.types.is_floating, pa.types.is_boolean)
    numeric = [
        name
        for name in names
        if any(kind(types[name]) for kind in kinds)
        or (is_timing(name) and _tells_dates(types[name]))
    ]
    wanted = wanted_columns(content, names, columns, numeric)
    try:
        table = file.read(columns=[file.schema_arrow.names[names.index(name)] for name in wanted])
        values = {
            name: column.to_numpy() if is_timing(name) else _plain(column)
            for name, column in zip(wanted, table.columns, strict=True)
        }
    except (pa.ArrowException, OSError, ValueError, TypeError) as error:
        reason = " ".join(str(error).split())
        raise content.error(f"its columns cannot be read as numbers: {reason}") from error
    return channel_table(content, names, values, columns)


def _tells_dates(kind: Any) -> bool:
    import pyarrow as pa

    return bool(pa.types.is_timestamp(kind) or pa.types.is_string(kind))


def _plain(column: Any) -> NDArray[np.float64]:
    return np.asarray(column.to_numpy(), np.float64)
