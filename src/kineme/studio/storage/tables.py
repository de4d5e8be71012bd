"""File in which a recording's table is saved; detects changes by other programs.

``walk.bvh`` has ``walk.segments.json`` beside it. If that file belongs to another recording
(``walk.c3d``), to an older recording of that name, or is not a table, it is left alone, and
``walk.bvh.segments.json`` or a numbered name is used. With several people, the name includes the
person: ``walk_anna.segments.json``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from hashlib import sha256
from itertools import count
from pathlib import Path

from kineme._util.files import CORRECTED, atomic_write, refuse_pipe
from kineme.errors import KinemeError, ReadError, WriteError
from kineme.labels import json_table, read_segments
from kineme.segments.segmentation import Segmentation
from kineme.studio.storage.listed_recording import ListedRecording


class ChangedOnDiskError(Exception):
    """Raised if the file has changed since it was last read or written here."""


class TableFile:
    """File of a table, which may not exist yet; remembers its last known content."""

    def __init__(self, path: Path):
        self.path = path
        self._stamp = _read_stamp(path)
        self._digest = _compute_digest(path)

    @property
    def exists(self) -> bool:
        """Whether the table has been saved."""
        return self._digest is not None

    def has_changed(self) -> bool:
        """Return whether another program has changed the file."""
        if _read_stamp(self.path) == self._stamp:
            return False
        return _compute_digest(self.path) != self._digest

    def read(self) -> Segmentation:
        """Return the table in the file and remember its content."""
        self._stamp, self._digest = _read_stamp(self.path), _compute_digest(self.path)
        return read_segments(self.path, format="json")

    def write(self, content: bytes) -> None:
        """Save a table that `encode_table` encoded, completely or not at all.

        ChangedOnDiskError if another program has changed the file, which is kept; WriteError if it
        cannot be written, or is a link to elsewhere.
        """
        with atomic_write(self.path) as draft:
            with draft.open("wb") as file:
                file.write(content)
            if self.has_changed():
                raise ChangedOnDiskError
            stamp = _read_stamp(draft)  # unchanged by the rename; later another program may write
        self._stamp, self._digest = stamp, sha256(content).digest()


def encode_table(table: Segmentation) -> bytes:
    """Return the file content of a table."""
    return json_table.dumps(table).encode()


def find_saved_table(
    listed: ListedRecording,
    fits: Callable[[Segmentation], bool],
    others: set[Path],
    *,
    of_another: Callable[[Segmentation], bool] = lambda _: False,
) -> tuple[TableFile, Segmentation | None, list[str]]:
    """Return the table file of a recording, its table if it is saved, and notes on skipped files.

    ``fits`` tells whether a table is of this recording. ``of_another`` tells whether it is of
    another take or person of its file, which is skipped silently. ``others`` are the table files of
    other recordings. WriteError if no name is left.
    """
    notes: list[str] = []
    for path in _list_candidate_paths(listed):
        file = TableFile(path)
        if path in others or path.is_symlink():
            continue
        if not file.exists:
            return file, None, notes
        try:
            table = file.read()
        except KinemeError as error:
            reason = error.reason if isinstance(error, ReadError) else str(error)
            notes.append(f"{path.name} was not used: it {reason}")
            continue
        if fits(table):
            return file, table, notes
        if not of_another(table):
            notes.append(f"{path.name} was not used: it belongs to another recording")
    raise WriteError(listed.path, "cannot store its table: all its file names are in use")


def list_default_table_paths(listed: ListedRecording) -> list[Path]:
    """Return the two names that nearly every table has."""
    base = listed.table_base
    return [base.with_name(name + CORRECTED) for name in (base.stem, base.name)]


def find_table_path(listed: ListedRecording) -> Path | None:
    """Return the first of these that exists."""
    return next((path for path in list_default_table_paths(listed) if path.is_file()), None)


def _list_candidate_paths(listed: ListedRecording) -> Iterator[Path]:
    yield from list_default_table_paths(listed)
    base = listed.table_base
    for number in count(2):
        yield base.with_name(f"{base.name}.{number}{CORRECTED}")


def _read_stamp(path: Path) -> tuple[int, int, int] | None:
    """Return values that change when a file is written; None if it is missing."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_ino, status.st_mtime_ns, status.st_size


def _compute_digest(path: Path) -> bytes | None:
    try:
        refuse_pipe(path)
        return sha256(path.read_bytes()).digest()
    except (OSError, ReadError):
        return None
