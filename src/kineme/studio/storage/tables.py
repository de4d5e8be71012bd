"""Where a recording's table is saved, and whether somebody else has changed it there.

It is ``walk.segments.json`` beside ``walk.bvh``. Where that file is the table of
another recording (``walk.c3d``), of an earlier one of that name, or no table at
all, it is left alone, and ``walk.bvh.segments.json`` or a numbered name serves. That of one of
several people is called after them, too: ``walk_anna.segments.json``.
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
from kineme.studio.storage.listed import ListedRecording


class ChangedOnDiskError(Exception):
    """Raised where the file is not the one that was last read or written here."""


class TableFile:
    """File that a table is saved in, as it was last read or written here; or will be."""

    def __init__(self, path: Path):
        self.path = path
        self._stamp = _read_stamp(path)
        self._digest = _compute_digest(path)

    @property
    def exists(self) -> bool:
        """Return whether the table has been saved."""
        return self._digest is not None

    def changed(self) -> bool:
        """Return whether the file is another than the one last read or written here."""
        if _read_stamp(self.path) == self._stamp:
            return False
        return _compute_digest(self.path) != self._digest

    def read(self) -> Segmentation:
        """Return the table in the file, which counts as seen from now on."""
        self._stamp, self._digest = _read_stamp(self.path), _compute_digest(self.path)
        return read_segments(self.path, format="json")

    def write(self, content: bytes) -> None:
        """Save a table, as `encode_table` has it, on the disk; all of it, or nothing.

        ChangedOnDiskError where somebody else has changed the file, which stays as it is;
        WriteError where it cannot be written, or is a link to elsewhere.
        """
        with atomic_write(self.path) as draft:
            with draft.open("wb") as file:
                file.write(content)
            if self.changed():
                raise ChangedOnDiskError
            stamp = _read_stamp(
                draft
            )  # which stays with it under its name; later it may be another's
        self._stamp, self._digest = stamp, sha256(content).digest()


def encode_table(table: Segmentation) -> bytes:
    """Return what a file holds of a table."""
    return json_table.dumps(table).encode()


def find_saved_table(
    listed: ListedRecording,
    fits: Callable[[Segmentation], bool],
    others: set[Path],
    *,
    of_another: Callable[[Segmentation], bool] = lambda _: False,
) -> tuple[TableFile, Segmentation | None, list[str]]:
    """Where the recording's table is saved, the table if it has been, and files left alone.

    ``fits`` says whether a table is of this recording, ``of_another`` whether it is of another
    take or person of its file, which is no news; ``others`` hold the tables of other recordings.
    WriteError where no name is left.
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
            notes.append(f"{path.name} was left alone: it {reason}")
            continue
        if fits(table):
            return file, table, notes
        if not of_another(table):
            notes.append(f"{path.name} was left alone: it is the table of another recording")
    raise WriteError(listed.path, "has no name left for its table")


def list_default_table_paths(listed: ListedRecording) -> list[Path]:
    """Return the two names that nearly every recording's table has."""
    after = listed.with_table
    return [after.with_name(name + CORRECTED) for name in (after.stem, after.name)]


def find_table_path(listed: ListedRecording) -> Path | None:
    """That of them which is there, if one is."""
    return next((path for path in list_default_table_paths(listed) if path.is_file()), None)


def _list_candidate_paths(listed: ListedRecording) -> Iterator[Path]:
    yield from list_default_table_paths(listed)
    after = listed.with_table
    for number in count(2):
        yield after.with_name(f"{after.name}.{number}{CORRECTED}")


def _read_stamp(path: Path) -> tuple[int, int, int] | None:
    """Return what changes when a file is written; None where there is none."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_ino, found.st_mtime_ns, found.st_size


def _compute_digest(path: Path) -> bytes | None:
    try:
        refuse_pipe(path)
        return sha256(path.read_bytes()).digest()
    except (OSError, ReadError):
        return None
