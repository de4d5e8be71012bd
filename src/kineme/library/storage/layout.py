"""File names in the folder of a library, and access to its JSON files and Arrow columns."""

from __future__ import annotations

import json
import os
import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme._util.checks import is_number, require_extra
from kineme._util.files import refuse_link
from kineme._util.json import load_json
from kineme.errors import ReadError, WriteError
from kineme.library.storage.places import is_remote, make_path, write_locally

if sys.platform != "win32":
    import fcntl

SCHEMA = "kineme.library/5"
"""Schema of the folder; increment the number for changes that old readers would misread."""
HEAD, EDITS, STATES = "library.json", "edits.json", "seen.json"
LOCK, LOCK_EDITS = ".lock", ".edits.lock"
TABLES, ANALYSES = "tables", "pieces"
EMBEDDED = 32
"""Length of an embedding."""
BODIES = "bodies"
"""Vocabulary of all recordings of bodies."""
MOST_CLUSTERS = 1 << 62
"""Upper limit of cluster numbers, which fits into int64 columns."""
_KINDS = {
    "clustering": dict,
    "failed": dict,
    "following": int,
    "read_options": dict,
    "segment_options": dict,
    "sources": list,
    "tables": str,
}
EXTRA = "library"
"""Extra that installs the dependencies of libraries."""


def read_head(folder: str | PathLike[str]) -> dict[str, Any]:
    """Return the content of ``library.json``; raise ReadError if it is invalid."""
    path = make_path(folder) / HEAD
    if not path.is_file():
        raise ReadError(
            folder, "is not a library: make one with kineme library build FOLDER --into LIB"
        )
    head = read_json(path)
    if head.get("schema") != SCHEMA:
        raise ReadError(
            path,
            f"is of the schema {head.get('schema')!r:.40}, but this version of kineme reads "
            f"{SCHEMA}: build the library again in another folder",
        )
    if not _is_complete(head):
        raise ReadError(path, "is damaged: its content is not valid; build the library again")
    return head


def _is_complete(head: Mapping[str, Any]) -> bool:
    """Return whether all entries of a head are present and valid."""
    if not all(isinstance(head.get(name), kind) for name, kind in _KINDS.items()):
        return False
    constants = head["clustering"]
    return (
        re.fullmatch("[0-9a-f]{1,64}", head["tables"]) is not None
        and 0 <= head["following"] < MOST_CLUSTERS
        and all(isinstance(text, str) for text in (*head["sources"], *head["failed"].values()))
        and "unsure" in constants
        and all(is_number(value) for value in constants.values())
    )


def read_json(path: Path, values: Any = Any) -> dict[str, Any]:
    """Return the object in a JSON file with values of a type; empty if the file is missing."""
    try:
        return load_json(path, dict[str, values])
    except ReadError as error:
        if isinstance(error.__cause__, FileNotFoundError):
            return {}
        raise


def write_json(path: Path, content: dict[str, Any]) -> None:
    """Write an object to a JSON file atomically."""
    # ASCII only, since file names need not be UTF-8.
    text = json.dumps(content, indent=1, sort_keys=True)
    with write_locally(path) as draft:
        draft.write_text(text + "\n", encoding="utf-8")


@contextmanager
def lock_for_writing(folder: Path, what: str, name: str = LOCK) -> Iterator[None]:
    """Lock the library for writing; raise WriteError if another process holds the lock.

    ``what`` is the action that the error suggests to repeat, ``name`` the lock file.
    """
    if is_remote(folder):  # no locks there
        yield
        return
    try:
        refuse_link(folder / name)
        descriptor = os.open(
            folder / name, os.O_CREAT | os.O_RDWR | getattr(os, "O_CLOEXEC", 0), 0o666
        )
    except OSError as error:
        raise WriteError(folder, f"cannot be written: {error.strerror or error}") from error
    try:
        if sys.platform != "win32":
            try:
                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                raise WriteError(
                    folder, f"another process is changing this library: {what} when it has finished"
                ) from None
            except OSError:  # file systems without locks
                pass
        yield
    finally:
        os.close(descriptor)


def import_arrow() -> tuple[Any, Any]:
    """Return the modules pyarrow and pyarrow.parquet.

    Read with ``use_threads=False``: an Arrow thread that releases Python bytes while Python exits
    aborts the process (https://github.com/apache/arrow/issues/34314).
    """
    with require_extra("pyarrow", EXTRA):
        import pyarrow as pa
        from pyarrow import parquet
    return pa, parquet


def as_array(column: Any) -> NDArray[Any]:
    """Return a column of a pyarrow.Table as an array; texts become objects.

    Uses DLPack, since pyarrow's own conversion imports pandas.
    """
    pa, _ = import_arrow()
    values = column.combine_chunks()
    if not pa.types.is_string(values.type):
        return np.from_dlpack(values)
    coded = values.dictionary_encode()
    texts = np.array(coded.dictionary.to_pylist(), dtype=object)
    found: NDArray[Any] = texts[np.from_dlpack(coded.indices)]
    return found


def as_column(values: Iterable[Any], kind: type) -> Any:
    """Return texts, or numbers of a type, as a pyarrow.Array.

    Uses buffers, since pyarrow's own conversion imports pandas.
    """
    pa, _ = import_arrow()
    if kind is str:
        texts = [str(text).encode() for text in values]
        ends = np.cumsum([0, *map(len, texts)], dtype=np.int32)
        buffers = [None, pa.py_buffer(ends), pa.py_buffer(b"".join(texts))]
        return pa.Array.from_buffers(pa.string(), len(texts), buffers)
    numbers: NDArray[Any] = np.ascontiguousarray(values, kind)
    type_ = pa.from_numpy_dtype(numbers.dtype)
    return pa.Array.from_buffers(type_, len(numbers), [None, pa.py_buffer(numbers)])
