"""write_segments() and read_segments(): any format, picked by suffix."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from os import PathLike
from pathlib import Path
from typing import cast

from kineme.errors import FileError, ParameterError, ReadError, WriteError
from kineme.segmentation.result import Segmentation

MODULES = {".csv": "csv_table", ".json": "json_table", ".parquet": "parquet_table"}


def write_segments(segmentation: Segmentation, path: str | PathLike[str]) -> None:
    """Write a segmentation as CSV, JSON or Parquet; all of it, or nothing.

    Raises
    ------
    WriteError : unknown suffix, or the file cannot be written
    MissingDependencyError : Parquet without pyarrow
    """
    module = import_module(f"kineme.export.{_module_of(path, WriteError)}")
    cast(Callable[[Segmentation, Path], None], module.write)(segmentation, Path(path))


def read_segments(path: str | PathLike[str]) -> Segmentation:
    """The segmentation that :func:`write_segments` wrote.

    Raises
    ------
    ReadError : missing, damaged, not a segment table, or of a newer version
    MissingDependencyError : Parquet without pyarrow
    """
    module = import_module(f"kineme.export.{_module_of(path, ReadError)}")
    read = cast(Callable[[Path], Segmentation], module.read)
    try:
        return read(Path(path))
    except OSError as error:
        raise ReadError(path, f"cannot be read: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        raise ReadError(path, f"is not UTF-8 text (byte {error.start})") from error
    except ParameterError as error:
        raise ReadError(path, str(error)) from error


def _module_of(path: str | PathLike[str], error: type[FileError]) -> str:
    suffix = Path(path).suffix.lower()
    if suffix not in MODULES:
        raise error(path, f"segments are stored as {', '.join(MODULES)}, not {suffix or 'that'!r}")
    return MODULES[suffix]
