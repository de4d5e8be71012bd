"""Parquet tables of joint positions or of channels."""

from __future__ import annotations

import numpy as np

from kineme.errors import ReadError
from kineme.formats.channels.parquet import parquet_channels, parquet_file
from kineme.formats.channels.reading import to_signals
from kineme.formats.channels.sensors import hold_channels
from kineme.formats.channels.table import named
from kineme.formats.channels.writing import write_signals
from kineme.formats.columns import columns_to_motion
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
    import pyarrow as pa

    try:
        read = file.read()
        columns = {
            name: np.asarray(read.column(name).to_numpy()) for name in unique(read.column_names)
        }
    except (pa.ArrowException, OSError, KeyError) as error:
        raise ReadError(content.path, "is not a Parquet file, or is damaged") from error
    return columns_to_motion(content, NAME, columns, options)


FORMAT = Format(
    NAME,
    (".parquet",),
    lambda head: head.startswith(b"PAR1"),
    read_parquet,
    write_signals=write_signals,
    channels=True,
)
