"""File names in the folder of a library, and access to its JSON files and Arrow columns.

Paths and URLs are handled alike: converted, written atomically, and cached.
"""

from __future__ import annotations

import json
import os
import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from hashlib import sha256
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, cast
from urllib.parse import urlparse
from urllib.request import url2pathname

import numpy as np
from numpy.typing import NDArray

from kineme._util.checks import check_path, is_number, require_extra
from kineme._util.files import atomic_write, is_remote, refuse_link, refuse_pipe
from kineme._util.json import load_json
from kineme.errors import KinemeError, ParameterError, ReadError, WriteError

if sys.platform != "win32":
    import fcntl

REMOTE_EXTRA = "remote"
"""Extra that installs the dependencies of URLs."""
_URL = re.compile(r"[a-z][a-z0-9+.-]+://", re.IGNORECASE)
SCHEMA = "kineme.library/5"
"""Schema of the folder; increment the number for changes that old readers would misread."""
HEAD, EDITS, STATES = "library.json", "edits.json", "seen.json"
LOCK, LOCK_EDITS = ".lock", ".edits.lock"
TABLES, ANALYSES = "tables", "pieces"
KEY_LENGTH = 32
"""Length of the key of an analysis; see `kineme.library.planning.Plan.key`."""
EMBEDDED = 32
"""Length of an embedding."""
BODIES = "bodies"
"""Vocabulary of all recordings of bodies."""
MOST_CLUSTERS = 1 << 62
"""Upper limit of cluster numbers, which fits into int64 columns."""
_KINDS = {
    "clustering": dict,
    "failed": dict,
    "following": int,  # number of the next new cluster
    "read_options": dict,
    "segment_options": dict,
    "sources": list,
    "tables": str,
}
EXTRA = "library"
"""Extra that installs the dependencies of libraries."""


def make_path(path: str | PathLike[str], caller: str = "make_path") -> Path:
    """Return a path object for a path or URL.

    Examples
    --------
    >>> make_path("file:///tmp/takes").name
    'takes'
    """
    if is_remote(path):
        return cast("Path", path)
    check_path(path, caller)
    if not isinstance(path, str) or not _URL.match(path):
        return Path(path)
    if path.lower().startswith("file://"):
        return Path(url2pathname(urlparse(path).path))
    with require_extra("universal_pathlib", REMOTE_EXTRA):
        from upath import UPath
    try:
        remote = UPath(path)
        _ = remote.fs
    except (ImportError, ValueError) as error:  # e.g. "Install s3fs to access S3"
        raise ParameterError(f"{path:.200} cannot be reached: {error}") from error
    return cast("Path", remote)


def is_inside(path: Path, folder: Path) -> bool:
    """Return whether a path lies in a folder; a remote path is in no local folder."""
    return is_remote(path) == is_remote(folder) and path.is_relative_to(folder)


@contextmanager
def translate_remote_errors(path: Path) -> Iterator[None]:
    """Turn connection errors while using a remote path into ReadError."""
    try:
        yield
    except KinemeError:
        raise
    except Exception as error:
        if not is_remote(path):
            raise
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        raise ReadError(path, f"cannot be reached: {reason}") from error


@contextmanager
def write_locally(path: Path) -> Iterator[Path]:
    """Provide a local file to write, which replaces ``path`` when the block ends.

    Atomic: local files use `kineme._util.files.atomic_write`, remote ones are put as one object.
    """
    if not is_remote(path):
        with atomic_write(path) as draft:
            yield draft
        return
    with TemporaryDirectory(prefix="kineme-") as home:
        draft = Path(home) / path.name
        yield draft
        remote: Any = path
        try:
            remote.fs.put_file(str(draft), remote.path)
        except Exception as error:
            reason = " ".join(str(error).split())[:200] or type(error).__name__
            raise WriteError(path, f"cannot be written: {reason}") from error


def copy_nearby(path: Path) -> Path:
    """Return a local path for a file whose content never changes; remote files are cached.

    The cache is in ``KINEME_CACHE`` or ``~/.cache/kineme`` and may be deleted.
    """
    if not is_remote(path):
        refuse_pipe(path)
        return path
    home = Path(os.environ.get("KINEME_CACHE") or Path.home() / ".cache" / "kineme") / "library"
    copy = home / f"{sha256(str(path).encode()).hexdigest()[:32]}{path.suffix}"
    if not copy.is_file():
        content = path.read_bytes()
        copy.parent.mkdir(parents=True, exist_ok=True)
        with atomic_write(copy) as draft:
            draft.write_bytes(content)
    return copy


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
    if not _is_valid(head):
        raise ReadError(path, "is damaged: its content is not valid; build the library again")
    return head


def _is_valid(head: Mapping[str, Any]) -> bool:
    """Return whether a head has all entries of `_KINDS` with valid values."""
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
