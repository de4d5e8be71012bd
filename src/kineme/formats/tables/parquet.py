"""Parquet tables of joint positions or of channels."""

from __future__ import annotations

import numpy as np

from kineme.formats.channels.parquet import parquet_channels, parquet_columns, parquet_file
from kineme.formats.channels.reading import to_signals
from kineme.formats.channels.sensors import hold_channels
from kineme.formats.channels.table import named
from kineme.formats.channels.writing import write_signals
from kineme.formats.columns import columns_to_motion, is_used
from kineme.formats.files import FileContent, unique
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format
from kineme.recordings import Motion, Signals

NAME = "Parquet table"


def read_parquet(content: FileContent, options: ReadOptions) -> Motion | Signals:
    """The joint positions in a Parquet table, or its channels where there are none."""
    file = parquet_file(content)
    if options.channels or hold_channels(named(file.schema_arrow.names)):
        table = parquet_channels(content, file, options.columns or None)
        return to_signals(content, NAME, table, options.fps)
    stored = file.schema_arrow.names
    read = parquet_columns(content, file, [name for name in stored if is_used(name)])
    names = unique(read.column_names)
    columns = dict.fromkeys(unique(stored), np.empty(0)) | {
        name: np.asarray(column.to_numpy())
        for name, column in zip(names, read.columns, strict=True)
    }
    return columns_to_motion(content, NAME, columns, options)


FORMAT = Format(
    NAME,
    (".parquet",),
    lambda head: head.startswith(b"PAR1"),
    read_parquet,
    write_signals=write_signals,
    channels=True,
)
