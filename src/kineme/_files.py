"""Files as such: written whole or not at all, and known by their first and last bytes."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from kineme.errors import WriteError

HEAD = 4096
"""Bytes by which a file is known without reading it whole."""
TAIL = 1 << 16
"""Bytes at the end of a Parquet file, where it names its columns."""


@contextmanager
def atomic_write(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A path to write to; what is there when the block ends becomes ``path``.

    It lies in the same folder and keeps the suffix. If the block raises, it
    is removed and what was at ``path`` before stays as it was.

    Raises
    ------
    WriteError
        The folder is missing or the file cannot be written.
    """
    target = Path(path)
    if target.is_dir():
        raise WriteError(path, "cannot be written: it is a folder; name a file in it")
    if not target.parent.is_dir():
        raise WriteError(path, f"cannot be written: the folder {target.parent} does not exist")
    final = Path(os.path.realpath(target))
    draft = final.with_name(f".{secrets.token_hex(6)}{final.suffix}")
    try:
        yield draft
        draft.replace(final)
    except OSError as error:
        raise WriteError(path, f"cannot be written: {error.strerror or error}") from error
    finally:
        draft.unlink(missing_ok=True)


def head_of(path: Path) -> bytes:
    """The first bytes of a file; OSError if it cannot be opened."""
    with path.open("rb") as file:
        return file.read(HEAD)


def tail_of(path: Path) -> bytes:
    """The last bytes of a file; OSError if it cannot be opened."""
    with path.open("rb") as file:
        file.seek(max(0, path.stat().st_size - TAIL))
        return file.read()
