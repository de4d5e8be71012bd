"""Handle paths and URLs alike: convert, write atomically, and cache."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from hashlib import sha256
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, cast
from urllib.parse import urlparse
from urllib.request import url2pathname

from kineme._util.checks import check_path, require_extra
from kineme._util.files import atomic_write, refuse_pipe
from kineme.errors import (
    KinemeError,
    ParameterError,
    ReadError,
    WriteError,
)

REMOTE_EXTRA = "remote"
"""Extra that installs the dependencies of URLs."""
_URL = re.compile(r"[a-z][a-z0-9+.-]+://", re.IGNORECASE)


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


def is_remote(path: str | PathLike[str]) -> bool:
    """Return whether a path is a URL of universal_pathlib."""
    return hasattr(path, "protocol")


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
