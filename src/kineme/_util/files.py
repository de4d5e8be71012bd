"""Write files and folders atomically, convert read errors, and derive file names."""

from __future__ import annotations

import errno
import os
import re
import secrets
import shutil
import stat
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from kineme.errors import FileError, KinemeError, LinkError, ReadError, WriteError

AnyPath = str | os.PathLike[str]
HEAD = 4096
"""Bytes at the start of a file that identify its format."""
TAIL = 1 << 16
"""Bytes at the end of a Parquet file that hold its column names."""
CORRECTED = ".segments.json"
"""End of the name of a table that was corrected in the studio."""
LONGEST_PERSON = 60
"""Longest person's name in a file name, in bytes; file names are limited to 255."""
VIDEOS = (
    ".mp4", ".webm", ".m4v", ".mov", ".ogv", ".mkv", ".avi", ".3gp", ".mts", ".mpg", ".wmv",
)  # fmt: skip
"""Suffixes of videos; those that browsers can play come first."""
PICTURES = (".png", ".pdf", ".svg")
"""Suffixes of pictures that are written."""
PAGES = (".html", ".htm")
"""Suffixes of pages that are written."""
POSES = ".poses.parquet"
"""Suffix of the table of poses, appended to the name of the video."""
if sys.platform != "win32":  # Windows does not delete open files anyway
    import fcntl

PIPE = "is a pipe or a device: save its output to a file first"
ABANDONED_S = 3600.0
"""Age in seconds after which an unlocked draft counts as left by a killed process."""

_DRAFT = re.compile(r"\.kineme-[0-9a-f]{12}(\.\w+)?")
_cleaned: set[Path] = set()  # folders whose abandoned drafts this process has removed


def is_remote(path: AnyPath) -> bool:
    """Return whether a path is a URL of universal_pathlib."""
    return hasattr(path, "protocol")


def make_absolute(path: Path) -> Path:
    """Return the absolute path without resolving links, so that given names are kept."""
    return path if is_remote(path) else Path(os.path.abspath(path))  # noqa: PTH100


@contextmanager
def atomic_write(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Provide a draft to write to, which replaces ``path`` when the block ends.

    The draft is in the same folder and has the same suffix. A link at ``path`` is rejected, since
    it would redirect the write. If the block raises, the draft is removed and ``path`` stays
    unchanged. After the block the file is flushed to disk. Drafts of killed processes are removed
    after an hour. Raise WriteError if the folder is missing, or the file cannot be written.
    """
    final, draft = _find_paths(path)
    with _write_draft(draft, final, path):
        yield draft
        # Flush before renaming: a crash leaves either the old file or the new one.
        _flush_to_disk(draft)
        draft.replace(final)


@contextmanager
def atomic_folder(target: Path) -> Iterator[Path]:
    """Provide a draft folder to fill, which replaces ``target`` when the block ends.

    The draft is beside ``target``, which must be new or empty. If the block raises, the draft is
    removed. Drafts of killed processes are removed after an hour. Raise WriteError if ``target``
    exists and is not empty, or if it cannot be created or written.
    """
    if target.exists() and not (target.is_dir() and not any(target.iterdir())):
        raise WriteError(target, "exists already: name a new folder or empty this one")
    remove_abandoned_drafts(target.parent)
    draft = target.with_name(make_draft_name())
    try:
        draft.mkdir()
    except OSError as error:
        reason = f"cannot be created: {target.parent}: {error.strerror or error}"
        raise WriteError(target, reason) from error
    with _write_draft(draft, target, target):
        yield draft
        # A rename onto an existing folder fails on some systems.
        if target.is_dir():
            target.rmdir()
        draft.rename(target)


@contextmanager
def _write_draft(draft: Path, final: Path, path: AnyPath) -> Iterator[None]:
    """Lock a draft until the block has renamed it; remove it if that fails.

    Errors name the requested ``path``.
    """
    descriptor = None
    try:
        descriptor = _open_locked(draft)
        yield
        # Flush the folder too: it stores the new name.
        _flush_to_disk(final.parent)
    except FileError as error:
        raise _rename_error(error, draft, final) from error
    except OSError as error:
        raise WriteError(path, f"cannot be written: {error.strerror or error}") from error
    finally:
        if descriptor is not None:
            os.close(descriptor)
        with suppress(OSError):  # the folder may have become read-only
            draft.unlink(missing_ok=True)
        shutil.rmtree(draft, ignore_errors=True)


def _rename_error(error: FileError, draft: Path, final: Path) -> FileError:
    """Return the error with the final path instead of that of the draft."""
    path = Path(error.path)
    if not path.is_relative_to(draft):
        return error
    return WriteError(final / path.relative_to(draft), error.reason)


@contextmanager
def translate_read_errors(path: str | os.PathLike[str]) -> Iterator[None]:
    """Convert any exception in a block that reads a file to a ReadError, with it as the cause.

    Readers raise specific errors themselves; this handles the rest. Warnings of numpy about too
    large numbers are suppressed, since such numbers are rejected later.
    """
    import numpy as np

    try:
        refuse_pipe(path)
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)
            yield
    except KinemeError as error:
        # A ValueError of kineme describes an error in the content of the file.
        if isinstance(error, FileError | ImportError) or not isinstance(error, ValueError):
            raise
        raise ReadError(path, str(error)) from error
    except OSError as error:
        raise ReadError(
            path, f"cannot be read: {error.strerror or shorten_error(error)}"
        ) from error
    except UnicodeDecodeError as error:
        reason = f"is not {error.encoding.upper()} text (byte {error.start}): save it as UTF-8"
        raise ReadError(path, reason) from error
    except MemoryError as error:
        raise ReadError(
            path,
            "needs more memory than is available: it may be damaged; if not, cut it into "
            "shorter files",
        ) from error
    except RecursionError as error:
        raise ReadError(path, "is nested too deeply: it is damaged") from error
    except Exception as error:
        message = shorten_error(error)
        reason = f"{type(error).__name__}: {message}" if message else type(error).__name__
        raise ReadError(path, f"cannot be read, it may be damaged ({reason})") from error


@dataclass(frozen=True)
class OwnedFolder:
    """A folder in which kineme writes and deletes files.

    Nothing below `root` is written or deleted through a link, and only files with kineme's names
    are deleted. The root itself may be a link, since the user chose it.
    """

    root: Path

    def path(self, *names: str) -> Path:
        """Return a path below the folder; raise WriteError if any part of it is a link."""
        path = self.root
        for name in names:
            path = path / name
            refuse_link(path)
        return path

    def make(self, *names: str) -> Path:
        """Create a folder below this one, with missing parents, and return its path."""
        path = self.path(*names)
        try:
            path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise WriteError(path, f"cannot be created: {error.strerror or error}") from error
        return path

    def delete(self, *names: str, is_ours: Callable[[str], object]) -> None:
        """Delete the files in a folder below this one for whose names ``is_ours`` is true.

        Links, folders and other files stay. Nothing is deleted through a link.
        """
        with suppress(OSError, WriteError):
            for path in [*self.path(*names).iterdir()]:
                if is_ours(path.name) and path.is_file() and not path.is_symlink():
                    with suppress(OSError):
                        path.unlink(missing_ok=True)


def make_draft_name(suffix: str = "") -> str:
    """Return a new name for a file that is removed if this process is killed while writing it."""
    return f".kineme-{secrets.token_hex(6)}{suffix}"


def is_draft(name: str) -> bool:
    """Return whether a file name was made by `make_draft_name`."""
    return _DRAFT.fullmatch(name) is not None


def refuse_link(path: Path) -> None:
    """Raise LinkError if a file or folder is a link, which could redirect a write."""
    if hasattr(path, "protocol"):  # universal_pathlib has no links
        return
    try:
        status = path.lstat()
    except (FileNotFoundError, NotADirectoryError):
        return
    except (OSError, ValueError) as error:  # no permission; a null byte in the name
        reason = getattr(error, "strerror", None) or error
        raise WriteError(path, f"cannot be written: {reason}") from error
    if stat.S_ISLNK(status.st_mode):
        raise LinkError(path, "is a link, which could lead out of the folder: remove it")


def read_file_stamp(path: Path) -> tuple[int, int, int] | None:
    """Return values that change when a file is written; None if it is missing."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_ino, status.st_mtime_ns, status.st_size


def refuse_pipe(path: str | os.PathLike[str]) -> None:
    """Raise ReadError if a local path is a pipe or device, since reading could block."""
    if _is_pipe(path):
        raise ReadError(path, PIPE)


def _is_pipe(path: str | os.PathLike[str]) -> bool:
    if hasattr(path, "protocol"):  # a path of universal_pathlib
        return False
    try:
        mode = os.stat(path).st_mode  # noqa: PTH116 (path may be a str)
    except (OSError, ValueError):  # reading will report the error
        return False
    return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))


def find_video(recording: Path) -> Path | None:
    """Return the video of a recording: itself or a file with its name beside it, or None.

    For ``squats.mp4.poses.parquet`` it is ``squats.mp4``.
    """
    if not recording.name:
        return None
    video = recording.with_name(recording.name.removesuffix(POSES) or recording.name)
    beside = [video.with_suffix(end) for suffix in VIDEOS for end in (suffix, suffix.upper())]
    for path in [video, *beside] if video.suffix.lower() in VIDEOS else beside:
        if path.is_file() and not path.is_symlink():
            return path
    return None


def add_person(path: Path, person: str) -> Path:
    """Return a path with a person's name added: ``walk_anna.csv`` for ``walk.csv``.

    Return the same path if ``person`` is empty.
    """
    if not person:
        return path
    suffix = CORRECTED if path.name.endswith(CORRECTED) else path.suffix
    return path.with_name(f"{path.name.removesuffix(suffix)}{make_person_suffix(person)}{suffix}")


def as_display_name(name: str | os.PathLike[str]) -> str:
    r"""Return a file name as valid Unicode text.

    Bytes that are not UTF-8 become the replacement character.

    Examples
    --------
    >>> as_display_name("take\udcff") == "take\ufffd"
    True
    """
    return os.fspath(name).encode("utf-8", "surrogateescape").decode("utf-8", "replace")


def make_person_suffix(person: str) -> str:
    """Return the suffix of file names of one person, such as ``_anna``; empty for no person."""
    name = re.sub(r"[^\w.-]+", "_", person).encode(errors="ignore")[:LONGEST_PERSON]
    return f"_{name.decode(errors='ignore').strip('._') or 'person'}" if person else ""


def read_head(path: Path) -> bytes:
    """Return the first bytes of a file; raise OSError if it cannot be opened."""
    if _is_pipe(path):
        raise OSError(errno.EINVAL, PIPE)
    with path.open("rb") as file:
        return file.read(HEAD)


def read_tail(path: Path) -> bytes:
    """Return the last bytes of a file; raise OSError if it cannot be opened."""
    if _is_pipe(path):
        raise OSError(errno.EINVAL, PIPE)
    with path.open("rb") as file:
        file.seek(max(0, path.stat().st_size - TAIL))
        return file.read()


def shorten_error(error: Exception) -> str:
    """Return the message of an exception on one line, shortened."""
    return " ".join(str(error).split())[:120]


def _find_paths(path: str | os.PathLike[str]) -> tuple[Path, Path]:
    """Return the final path of a file and the path of its draft."""
    target = Path(path)
    refuse_link(target)
    try:
        if target.is_dir():
            raise WriteError(path, "cannot be written: it is a folder; name a file in it")
        if not target.parent.is_dir():
            raise WriteError(path, f"cannot be written: the folder {target.parent} does not exist")
        # Resolve links now, in case they change during the write.
        final = Path(os.path.realpath(target.parent)) / target.name
    except OSError as error:  # no permission
        raise WriteError(path, f"cannot be written: {error.strerror or error}") from error
    remove_abandoned_drafts(final.parent)
    return final, final.with_name(make_draft_name(final.suffix))


def _open_locked(draft: Path) -> int | None:
    """Create the draft, unless it is a folder, and lock it; return its descriptor."""
    if sys.platform == "win32":
        return None
    descriptor = _open_draft(draft)
    lock_shared(descriptor)
    return descriptor


def lock_shared(file: int) -> None:
    """Mark an open file as being written, by a shared lock until it is closed."""
    if sys.platform != "win32":
        with suppress(OSError):  # file systems without locks
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)


def _open_draft(draft: Path, *, create: bool = True) -> int:
    how = os.O_RDONLY if draft.is_dir() else os.O_RDWR | (os.O_CREAT if create else 0)
    return os.open(draft, how, 0o666)


def is_locked(draft: Path, *, if_unknown: bool = True) -> bool:
    """Return whether a file or folder is still being written, see `lock_shared`.

    ``if_unknown`` is the answer where files cannot be locked: drafts are never removed there.
    """
    if sys.platform == "win32":
        return False
    try:
        file = _open_draft(draft, create=False)
    except FileNotFoundError:
        return False
    try:
        # A writer holds a shared lock, so an exclusive one fails.
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        return if_unknown
    finally:
        os.close(file)
    return False


def remove_abandoned_drafts(folder: Path) -> None:
    """Remove drafts of killed writers, once per folder and process.

    Drafts that another process still writes are kept.
    """
    if folder in _cleaned:
        return
    _cleaned.add(folder)
    with suppress(OSError), os.scandir(folder) as entries:
        drafts = [Path(entry) for entry in entries if is_draft(entry.name)]
        for draft in drafts:
            with suppress(OSError):
                old = time.time() - draft.stat().st_mtime > ABANDONED_S
                if not old or is_locked(draft):
                    continue
                if draft.is_dir():
                    shutil.rmtree(draft)
                else:
                    draft.unlink()


def _flush_to_disk(place: Path) -> None:
    """Flush a file, or the entries of a folder, to disk."""
    if sys.platform == "win32" and place.is_dir():  # folders cannot be opened
        return
    file = os.open(place, os.O_RDONLY)
    try:
        os.fsync(file)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.ENOTSUP):  # not supported by the file system
            raise
    finally:
        os.close(file)


class NoEntities:
    """Target of `xml.etree.ElementTree.XMLParser` that rejects entities."""

    def doctype(self, *_: Any) -> None:
        """Reject document types, which could define entities that expand without bounds."""
        from xml.etree.ElementTree import ParseError

        raise ParseError("it has a document type declaration, which is not allowed")
