"""The tables of a library: what was computed over all recordings, as Parquet.

``DESCRIBED`` tells every column. Tables of one build lie in one folder, which is called by a digest
of what it holds; the head of the library names the valid one.
"""

from __future__ import annotations

import secrets
import shutil
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from kineme._doors import reading
from kineme._files import atomic_write
from kineme.errors import ReadError, WriteError
from kineme.library.storage.layout import EMBEDDED, TABLES, arrow, as_array, as_column
from kineme.library.storage.places import is_remote, written
from kineme.segments.table import DESCRIBED as SEGMENTS
from kineme.segments.table import Column

DESCRIBED: Mapping[str, Mapping[str, Column]] = {
    "recordings": {
        "recording": Column(str, "its name in the library: the path in the folder that was given"),
        "path": Column(str, "where it was read from"),
        "vocabulary": Column(str, "`bodies`, or which channels; empty where it is not searched"),
        "format": Column(str, "of its file"),
        "n_frames": Column(int, "frames of its file"),
        "fps": Column(float, "frames per second"),
        "duration_s": Column(float, "seconds"),
        "piece": Column(str, "name of the files in `pieces/` that hold what is kept of it"),
        "features_fps": Column(float, "samples of its features per second"),
        "samples": Column(int, "of its features; 0 where it is not searched"),
        "notes": Column(str, "what had to be inferred and what is unsure, one a line"),
    },
    "segments": {
        "recording": Column(str, "the recording it is of"),
        "segment": Column(int, "its row among those of the recording, from 0"),
        **SEGMENTS,
        "own_cluster": Column(int, "its cluster in the recording alone"),
        "action_label": Column(str, "the name of `action`"),
    },
    "words": {
        "recording": Column(str, "the recording it is of"),
        "own_cluster": Column(int, "the cluster in that recording"),
        "cluster": Column(int, "the cluster of the library"),
        "label": Column(str, "the name of that, or empty"),
        "following": Column(int, "the cluster it is next to but for its own; -1: none"),
        "confidence": Column(float, "how much nearer it is to its own cluster, 0 to 1"),
        "spread": Column(float, "mean distance to the other words of its cluster"),
        "start_s": Column(float, "where its typical segment starts"),
        "stop_s": Column(float, "where that stops"),
        "seconds": Column(float, "of all its segments"),
    },
    "embeddings": {
        "recording": Column(str, "the recording it is of"),
        "segment": Column(int, "its row among those of the recording, from 0"),
        "embedding": Column(float, f"{EMBEDDED} numbers: what is near is alike"),
    },
}
"""The columns of each table, edits applied, and what is in them."""

LARGEST = 1e30
"""Of any number in a table."""

ADDED = ("label", "action_label")
"""Columns that come with the edits, where a table has none."""


def table_of(name: str, columns: Mapping[str, Any]) -> Any:
    """A table of computed columns, a pyarrow.Table; of any number of rows, with none, too.

    Embeddings are a pyarrow.Array already.
    """
    pa, _ = arrow()
    return pa.table(
        {
            column: columns[column]
            if column == "embedding"
            else as_column(columns[column], known.type)
            for column, known in DESCRIBED[name].items()
            if column in columns
        }
    )


def write_tables(folder: Path, tables: Mapping[str, Any]) -> str:
    """Leave tables in the folder of a library; the name under which they lie there.

    Parameters
    ----------
    folder : Path
    tables : mapping of str to pyarrow.Table

    Returns
    -------
    str
    """
    _, parquet = arrow()
    home = folder / TABLES
    if is_remote(home):
        return _put(home, tables)
    draft = home / f".{secrets.token_hex(6)}"
    try:
        draft.mkdir(parents=True)
        digest = sha256()
        for name, table in tables.items():
            with atomic_write(draft / f"{name}.parquet") as file:
                parquet.write_table(table, file, compression="zstd")
            digest.update((draft / f"{name}.parquet").read_bytes())
        named = digest.hexdigest()[:16]
        if not (home / named).is_dir():
            draft.rename(home / named)
    except OSError as error:
        raise WriteError(folder, f"cannot be written: {error.strerror or error}") from error
    finally:
        shutil.rmtree(draft, ignore_errors=True)
    return named


def _put(home: Path, tables: Mapping[str, Any]) -> str:
    """The same where folders cannot be moved: nothing names these tables before all are there."""
    with TemporaryDirectory(prefix="kineme-") as near:
        named = write_tables(Path(near), tables)
        for file in sorted((Path(near) / TABLES / named).iterdir()):
            with written(home / named / file.name) as draft:
                shutil.copy(file, draft)
    return named


def read_table(folder: Path, named: str, name: str) -> Any:
    """One of the tables, a pyarrow.Table.

    Parameters
    ----------
    folder : Path
    named : str
        The tables that the head of the library names.
    name : str
        Of the table.

    Raises
    ------
    ReadError
        It is gone or damaged.
    """
    pa, parquet = arrow()
    path = folder / TABLES / named / f"{name}.parquet"
    with reading(path):
        content = pa.BufferReader(path.read_bytes())
        table = parquet.ParquetFile(content).read(use_threads=False)  # see `arrow`
        table.validate(full=True)
    for column, known in DESCRIBED[name].items():
        times = table.column_names.count(column)
        if times > 1 or (times == 0 and column not in ADDED):
            said = "holds twice" if times else "lacks"
            raise ReadError(path, f"is damaged: it {said} {column!r}; build the library again")
        if times and not _is_sound(table.column(column), known.type):
            raise ReadError(path, f"is damaged in {column!r}; build the library again")
    return table


def _is_sound(column: Any, kind: type) -> bool:
    """Whether a column is of its type, and has a value in every row."""
    pa, _ = arrow()
    types = {str: pa.string(), int: pa.int64(), float: pa.float64()}
    if column.null_count:
        return False
    if pa.types.is_fixed_size_list(column.type):
        return bool(column.type.value_type == pa.float32() and column.type.list_size == EMBEDDED)
    if column.type != types[kind]:
        return False
    return kind is not float or not (np.abs(as_array(column)) > LARGEST).any()
