"""Read and write the tables of a library, Parquet files with results over all recordings.

``DESCRIBED`` documents every column. The tables of a build lie in one folder, which is named by a
digest of its content; the head of the library names the current one.
"""

from __future__ import annotations

import re
import secrets
import shutil
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from kineme._util.files import OwnedFolder, atomic_write, is_draft, translate_read_errors
from kineme.errors import ReadError, WriteError
from kineme.library.storage.layout import EMBEDDED, TABLES, as_array, as_column, import_arrow
from kineme.library.storage.places import is_remote, write_locally
from kineme.segments.table import COLUMNS, Column

DESCRIBED: Mapping[str, Mapping[str, Column]] = {
    "recordings": {
        "recording": Column("its name in the library: its path in its source"),
        "path": Column("where it was read from"),
        "vocabulary": Column("`bodies`, or which channels; empty where it is not searched"),
        "format": Column("of its file"),
        "n_frames": Column("frames of its file", int),
        "fps": Column("frames per second", float),
        "duration_s": Column("seconds", float),
        "piece": Column("name of the files in `pieces/` that hold what is kept of it"),
        "features_fps": Column("samples of its features per second", float),
        "samples": Column("of its features; 0 where it is not searched", int),
        "notes": Column("what was inferred and what is uncertain, one a line"),
    },
    "segments": {
        "recording": Column("the recording it is of"),
        "segment": Column("its row in the table of the recording, from 0", int),
        **COLUMNS,
        "own_cluster": Column("its cluster in the recording alone", int),
        "action_label": Column("the name of `action`"),
    },
    "local_clusters": {
        "recording": Column("the recording it is of"),
        "own_cluster": Column("the cluster in that recording", int),
        "cluster": Column("the cluster of the library", int),
        "label": Column("the name of that, or empty"),
        "next_cluster": Column("the nearest other cluster; -1: there is no other", int),
        "confidence": Column("how much nearer its own cluster is than that one, 0 to 1", float),
        "spread": Column("mean distance from the other members of its cluster", float),
        "start_s": Column("where its typical segment starts", float),
        "stop_s": Column("where that stops", float),
        "seconds": Column("of all its segments", float),
    },
    "embeddings": {
        "recording": Column("the recording it is of"),
        "segment": Column("its row in the table of the recording, from 0", int),
        "embedding": Column(f"{EMBEDDED} numbers, near each other for similar segments", float),
    },
}
"""Columns of each table with edits applied, and their descriptions."""

_FOLDER = re.compile(r"[0-9a-f]{16}|\.[0-9a-f]{12}")
"""Matches folders of tables, and drafts of them."""
_WINDOWS = re.compile(r"windows\.\d+\.npy")

LARGEST = 1e30
"""Largest absolute value in a table."""

ADDED = ("label", "action_label")
"""Columns that `apply_edits` adds if a table lacks them."""


def is_tables_folder(name: str) -> bool:
    """Return whether a folder name is that of a build's tables."""
    return _FOLDER.fullmatch(name) is not None


def is_table_file(name: str) -> bool:
    """Return whether a file name in such a folder is that of a table, an index or a draft."""
    stem, _, suffix = name.partition(".")
    table = stem in DESCRIBED and suffix == "parquet"
    return table or is_draft(name) or _WINDOWS.fullmatch(name) is not None


def make_table(name: str, columns: Mapping[str, Any]) -> Any:
    """Return computed columns as a pyarrow.Table with the declared types, even without rows.

    Embeddings must be a pyarrow.Array.
    """
    pa, _ = import_arrow()
    return pa.table(
        {
            column: columns[column]
            if column == "embedding"
            else as_column(columns[column], declared.type)
            for column, declared in DESCRIBED[name].items()
            if column in columns
        }
    )


def write_tables(folder: Path, tables: Mapping[str, Any]) -> str:
    """Write tables to the folder of a library and return the name of their folder."""
    _, parquet = import_arrow()
    home = folder / TABLES
    if is_remote(home):
        return _upload_tables(home, tables)
    draft = home / f".{secrets.token_hex(6)}"
    try:
        draft.mkdir(parents=True)
        digest = sha256()
        for name, table in tables.items():
            with atomic_write(draft / f"{name}.parquet") as file:
                parquet.write_table(table, file, compression="zstd")
            digest.update((draft / f"{name}.parquet").read_bytes())
        folder_name = digest.hexdigest()[:16]
        if not OwnedFolder(folder).path(TABLES, folder_name).is_dir():
            draft.rename(home / folder_name)
    except OSError as error:
        raise WriteError(folder, f"cannot be written: {error.strerror or error}") from error
    finally:
        shutil.rmtree(draft, ignore_errors=True)
    return folder_name


def _upload_tables(home: Path, tables: Mapping[str, Any]) -> str:
    """Upload tables file by file, since remote folders cannot be renamed; return their name.

    This is safe because the head names the tables only after all files exist.
    """
    with TemporaryDirectory(prefix="kineme-") as local_folder:
        folder_name = write_tables(Path(local_folder), tables)
        for file in sorted((Path(local_folder) / TABLES / folder_name).iterdir()):
            with write_locally(home / folder_name / file.name) as draft:
                shutil.copy(file, draft)
    return folder_name


def read_table(folder: Path, folder_name: str, name: str) -> Any:
    """Read a table from the folder of tables ``named``, as a pyarrow.Table."""
    pa, parquet = import_arrow()
    path = folder / TABLES / folder_name / f"{name}.parquet"
    with translate_read_errors(path):
        content = pa.BufferReader(path.read_bytes())
        table = parquet.ParquetFile(content).read(use_threads=False)  # see `import_arrow`
        table.validate(full=True)
    for column, declared in DESCRIBED[name].items():
        times = table.column_names.count(column)
        if times > 1 or (times == 0 and column not in ADDED):
            fault = "holds twice" if times else "lacks"
            raise ReadError(path, f"is damaged: it {fault} {column!r}; build the library again")
        if times and not _is_valid(table.column(column), declared.type):
            raise ReadError(path, f"is damaged in {column!r}; build the library again")
    return table


def _is_valid(column: Any, kind: type) -> bool:
    """Return whether a column has its type, a value in every row, and no huge numbers."""
    pa, _ = import_arrow()
    types = {str: pa.string(), int: pa.int64(), float: pa.float64()}
    if column.null_count:
        return False
    if pa.types.is_fixed_size_list(column.type):
        return bool(column.type.value_type == pa.float32() and column.type.list_size == EMBEDDED)
    if column.type != types[kind]:
        return False
    return kind is not float or not (np.abs(as_array(column)) > LARGEST).any()
