"""Writing files so that a reader finds the old one or the new one, never half of one."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from kineme.errors import WriteError


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
