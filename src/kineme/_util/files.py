"""Files and folders: made whole or not at all, known by their ends, read to one kind of error."""

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
"""Bytes by which a file is known without reading it whole."""
TAIL = 1 << 16
"""Bytes at the end of a Parquet file, where it names its columns."""
CORRECTED = ".segments.json"
"""How the name of a table ends that somebody corrected in the studio."""
LONGEST_PERSON = 60
"""Bytes of a person's name in that of a file, which may have 255 in all."""
VIDEOS = (
    ".mp4", ".webm", ".m4v", ".mov", ".ogv", ".mkv", ".avi", ".3gp", ".mts", ".mpg", ".wmv",
)  # fmt: skip
"""Suffixes of videos; those that browsers play come first."""
POSES = ".poses.parquet"
"""Behind the name of a video in that of the table of its poses."""
if sys.platform != "win32":  # where an open file cannot be removed anyway
    import fcntl

PIPE = "is a pipe or a device: save what comes from it in a file"
ABANDONED_S = 3600.0
"""Age from which a draft that no writer holds is that of one that was killed."""

_DRAFT = re.compile(r"\.kineme-[0-9a-f]{12}(\.\w+)?")
_swept: set[Path] = set()  # folders whose drafts this process has looked at


@contextmanager
def atomic_write(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A path to write to; what is there when the block ends becomes ``path``.

    It lies in the same folder and keeps the suffix. A link at ``path`` is refused: whoever
    made it would say which file is overwritten. If the block raises, the draft
    is removed and what was at ``path`` before stays as it was. Once the block has
    ended the file is on the disk under its name, should the machine go down.
    Drafts of killed writers are removed when they are an hour old.

    Raises
    ------
    WriteError
        The folder is missing, the file cannot be written, or is a link to elsewhere.
    """
    final, draft = _find_paths(path)
    with _write_draft(draft, final, path):
        yield draft
        # On the disk before it takes the name: a crash leaves the old file or the new one.
        _flush_to_disk(draft)
        draft.replace(final)


@contextmanager
def atomic_folder(target: Path) -> Iterator[Path]:
    """A folder to fill; what is in it when the block ends is in ``target``.

    It lies beside ``target``, which is new or empty, and takes its place. If the block
    raises, it is removed. Drafts of killed writers are removed when they are an hour old.

    Raises
    ------
    WriteError
        Something is there already, or the folder cannot be made or written.
    """
    if target.exists() and not (target.is_dir() and not any(target.iterdir())):
        raise WriteError(target, "is there already: name a new folder, or empty this one")
    _remove_abandoned_drafts(target.parent)
    draft = target.with_name(f".kineme-{secrets.token_hex(6)}")
    try:
        draft.mkdir()
    except OSError as error:
        reason = f"cannot be made: {target.parent}: {error.strerror or error}"
        raise WriteError(target, reason) from error
    with _write_draft(draft, target, target):
        yield draft
        # A folder can only replace an empty one that is gone.
        if target.is_dir():
            target.rmdir()
        draft.rename(target)


@contextmanager
def _write_draft(draft: Path, final: Path, path: AnyPath) -> Iterator[None]:
    """Hold a draft until the block has given it its final name; remove it if that fails.

    Errors name the ``path`` that was asked for.
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
        with suppress(OSError):  # a place that may not be written any more
            draft.unlink(missing_ok=True)
        shutil.rmtree(draft, ignore_errors=True)


def _rename_error(error: FileError, draft: Path, final: Path) -> FileError:
    """Return the error of a draft, or of a file in one, by the name that people know."""
    path = Path(error.path)
    if not path.is_relative_to(draft):
        return error
    return WriteError(final / path.relative_to(draft), error.reason)


@contextmanager
def translate_read_errors(path: str | os.PathLike[str]) -> Iterator[None]:
    """A block that reads a file: it ends well, or in an error of the package.

    Readers check what they can say something useful about; this is for the rest.
    Numbers too large to compute with are refused by what is made of them, so numpy
    need not warn of them.

    Raises
    ------
    ReadError
        In place of any exception but the package's own; the cause is kept.
    """
    import numpy as np

    try:
        refuse_pipe(path)
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)
            yield
    except KinemeError as error:
        # A ValueError of the package says what is wrong with the content of the file.
        if isinstance(error, FileError | ImportError) or not isinstance(error, ValueError):
            raise
        raise ReadError(path, str(error)) from error
    except OSError as error:
        raise ReadError(
            path, f"cannot be read: {error.strerror or shorten_error(error)}"
        ) from error
    except UnicodeDecodeError as error:
        encoding = error.encoding.upper()
        raise ReadError(path, f"is not {encoding} text (byte {error.start})") from error
    except MemoryError as error:
        raise ReadError(
            path, "needs more memory than there is: it is damaged, or cut it"
        ) from error
    except RecursionError as error:
        raise ReadError(path, "holds too much inside one another: it is damaged") from error
    except Exception as error:
        message = shorten_error(error)
        reason = f"{type(error).__name__}: {message}" if message else type(error).__name__
        raise ReadError(path, f"cannot be understood, it is damaged ({reason})") from error


@dataclass(frozen=True)
class OwnedFolder:
    """A folder in which kineme writes and deletes files.

    Nothing below `root` is written or deleted through a link, and only files with names that
    kineme gives are deleted. The root itself may be a link: a person named it.
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
        """Make a folder below this one, with the folders around it, and return its path."""
        path = self.path(*names)
        try:
            path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise WriteError(path, f"cannot be made: {error.strerror or error}") from error
        return path

    def delete(self, *names: str, is_ours: Callable[[str], object]) -> None:
        """Delete the files in a folder below this one whose names are kineme's.

        Links, folders and other people's files stay. Nothing is deleted through a link.
        """
        with suppress(OSError, WriteError):
            for path in [*self.path(*names).iterdir()]:
                if is_ours(path.name) and path.is_file() and not path.is_symlink():
                    with suppress(OSError):
                        path.unlink(missing_ok=True)


def is_draft(name: str) -> bool:
    """Return whether `atomic_write` gives such names to what is not written to its end yet."""
    return _DRAFT.fullmatch(name) is not None


def refuse_link(path: Path) -> None:
    """Raise LinkError if a file or folder is a link: others would choose where it leads."""
    if hasattr(path, "protocol"):  # of universal_pathlib: there are no links
        return
    try:
        found = path.lstat()
    except (FileNotFoundError, NotADirectoryError):
        return
    except (OSError, ValueError) as error:  # a folder closed to us; a null byte in the name
        reason = getattr(error, "strerror", None) or error
        raise WriteError(path, f"cannot be written: {reason}") from error
    if stat.S_ISLNK(found.st_mode):
        raise LinkError(path, "is a link, which could lead out of the folder: remove it")


def refuse_pipe(path: str | os.PathLike[str]) -> None:
    """ReadError where a path of this machine is a pipe or a device, which might be waited for."""
    if _is_pipe(path):
        raise ReadError(path, PIPE)


def _is_pipe(path: str | os.PathLike[str]) -> bool:
    if hasattr(path, "protocol"):  # of universal_pathlib
        return False
    try:
        mode = os.stat(path).st_mode  # noqa: PTH116 (a text serves as well)
    except (OSError, ValueError):  # reading will say what is wrong
        return False
    return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))


def find_video(recording: Path) -> Path | None:
    """Return the video of a recording: itself, or a file of its name beside it; None without one.

    The table ``squats.mp4.poses.parquet`` has ``squats.mp4``.
    """
    if not recording.name:
        return None
    own = recording.with_name(recording.name.removesuffix(POSES) or recording.name)
    beside = [own.with_suffix(end) for suffix in VIDEOS for end in (suffix, suffix.upper())]
    for path in [own, *beside] if own.suffix.lower() in VIDEOS else beside:
        if path.is_file() and not path.is_symlink():
            return path
    return None


def add_person(path: Path, person: str) -> Path:
    """What is called after one of the people in a recording: ``walk_anna.csv`` for ``walk.csv``.

    The same path where nobody is named.
    """
    if not person:
        return path
    suffix = CORRECTED if path.name.endswith(CORRECTED) else path.suffix
    return path.with_name(f"{path.name.removesuffix(suffix)}{make_person_suffix(person)}{suffix}")


def as_display_name(name: str | os.PathLike[str]) -> str:
    r"""Return the name of a file as text that every output can hold.

    Bytes that are not UTF-8 become the replacement character.

    Examples
    --------
    >>> as_display_name("take\udcff") == "take\ufffd"
    True
    """
    return os.fspath(name).encode("utf-8", "surrogateescape").decode("utf-8", "replace")


def make_person_suffix(person: str) -> str:
    """What the names of files end in that are of one person: ``_anna``; nothing for nobody."""
    name = re.sub(r"[^\w.-]+", "_", person).encode(errors="ignore")[:LONGEST_PERSON]
    return f"_{name.decode(errors='ignore').strip('._') or 'person'}" if person else ""


def read_head(path: Path) -> bytes:
    """Return the first bytes of a file; OSError if it cannot be opened."""
    if _is_pipe(path):
        raise OSError(errno.EINVAL, PIPE)
    with path.open("rb") as file:
        return file.read(HEAD)


def read_tail(path: Path) -> bytes:
    """Return the last bytes of a file; OSError if it cannot be opened."""
    if _is_pipe(path):
        raise OSError(errno.EINVAL, PIPE)
    with path.open("rb") as file:
        file.seek(max(0, path.stat().st_size - TAIL))
        return file.read()


def shorten_error(error: Exception) -> str:
    """Return what an exception of another package says, on one line."""
    return " ".join(str(error).split())[:120]


def _find_paths(path: str | os.PathLike[str]) -> tuple[Path, Path]:
    """Where the file goes in the end, and where it is written."""
    target = Path(path)
    refuse_link(target)
    try:
        if target.is_dir():
            raise WriteError(path, "cannot be written: it is a folder; name a file in it")
        if not target.parent.is_dir():
            raise WriteError(path, f"cannot be written: the folder {target.parent} does not exist")
        # The folder's own name outlives links on the way to it that are changed meanwhile.
        final = Path(os.path.realpath(target.parent)) / target.name
    except OSError as error:  # a folder closed to us
        raise WriteError(path, f"cannot be written: {error.strerror or error}") from error
    _remove_abandoned_drafts(final.parent)
    return final, final.with_name(f".kineme-{secrets.token_hex(6)}{final.suffix}")


def _open_locked(draft: Path) -> int | None:
    """Make the draft, unless it is a folder, and lock it as long as it is written."""
    if sys.platform == "win32":
        return None
    descriptor = _open_draft(draft)
    lock_shared(descriptor)
    return descriptor


def lock_shared(file: int) -> None:
    """Lock an open file as one that is being written, until it is closed; see `is_locked`."""
    if sys.platform != "win32":
        with suppress(OSError):  # file systems without locks
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)


def _open_draft(draft: Path) -> int:
    how = os.O_RDONLY if draft.is_dir() else os.O_CREAT | os.O_RDWR
    return os.open(draft, how | getattr(os, "O_CLOEXEC", 0), 0o666)


def is_locked(draft: Path) -> bool:
    """Return whether a writer still has a draft open."""
    if sys.platform == "win32":
        return False
    file = _open_draft(draft)
    try:
        # A writer holds a shared lock, so an exclusive one fails.
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return True
    finally:
        os.close(file)
    return False


def _remove_abandoned_drafts(folder: Path) -> None:
    """Remove drafts of killed writers, once per folder and process."""
    if folder in _swept:
        return
    _swept.add(folder)
    with suppress(OSError), os.scandir(folder) as entries:
        drafts = [Path(entry) for entry in entries if _DRAFT.fullmatch(entry.name)]
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
    """Have a file, or the names in a folder, on the disk."""
    if sys.platform == "win32" and place.is_dir():  # where folders cannot be opened
        return
    file = os.open(place, os.O_RDONLY | getattr(os, "O_CLOEXEC", 0))
    try:
        os.fsync(file)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.ENOTSUP):  # file systems that cannot
            raise
    finally:
        os.close(file)


class NoEntities:
    """A target of `xml.etree.ElementTree.XMLParser` whose documents define no entities."""

    def doctype(self, *_: Any) -> None:
        """Refuse: entities are defined here, and could grow a small file without bounds."""
        from xml.etree.ElementTree import ParseError

        raise ParseError("it has a document type")
