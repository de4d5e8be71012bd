"""What there is to open: the files of a folder, each known to the page by an id.

An id says nothing and is good for nothing but to find one of the files that
are listed then, so that no request can name any other. How far each
recording is, its table tells; the recording is not opened for it.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from hashlib import blake2b
from pathlib import Path

from kineme.errors import KinemeError
from kineme.formats.listing import files_in, holds_recording
from kineme.labels import holds_labels, read_segments
from kineme.segments.editing.annotating import marked
from kineme.studio.reading import stamp_of
from kineme.studio.storage.tables import usual_table, usual_tables

MOST_COUNTS = 10_000
"""Tables whose counts stay in memory."""


def file_id(path: Path) -> str:
    """The id of a file: the same for as long as it lies there."""
    return blake2b(str(path.absolute()).encode(errors="surrogateescape"), digest_size=9).hexdigest()


class Folder:
    """A folder, to which uploads go; or some files of it, which alone are listed then."""

    of_library = False

    def __init__(self, root: Path, files: Iterable[Path] | None = None):
        self.root = root
        self._files = None if files is None else list(files)

    def add(self, path: Path) -> None:
        """List a file that came later."""
        if self._files is not None and path not in self._files:
            self._files.append(path)

    def recordings(self) -> dict[str, Path]:
        """The recordings by id, in the order of their names, or as given."""
        if self._files is not None:
            return {file_id(path): path for path in self._files if path.is_file()}
        return {file_id(path): path for path in self._listed() if holds_recording(path)}

    def knowledge_bases(self) -> dict[str, Path]:
        """The knowledge bases by id."""
        archives = [path for path in self._listed() if path.suffix.lower() == ".npz"]
        if not archives:
            return {}
        from kineme.transfer.knowledge_file import holds_knowledge  # half a second of imports

        return {file_id(path): path for path in archives if holds_knowledge(path)}

    def annotations(self) -> dict[str, Path]:
        """The label files by id, without the tables that the studio itself saves."""
        tables = {table for path in self.recordings().values() for table in usual_tables(path)}
        found = [path for path in self._listed() if path not in tables and holds_labels(path)]
        return {file_id(path): path for path in found}

    def _listed(self) -> list[Path]:
        try:
            return files_in(self.root)
        except OSError:
            return []


@dataclass(frozen=True)
class Progress:
    """How many segments a table has, are checked, have a name, and are no transitions."""

    segments: int
    checked: int
    named: int
    to_name: int


def progress(recording: Path) -> Progress | None:
    """How far a recording is; None where it has no table, or one that cannot be read."""
    path = usual_table(recording)
    try:
        return _counts(path, *stamp_of(path)) if path else None
    except Exception:  # noqa: BLE001 (a table that is damaged in any way costs itself only)
        return None


@lru_cache(MOST_COUNTS)
def _counts(path: Path, *_: int) -> Progress | None:
    """Of the file as it was at that time; a file that is no table counts for none."""
    try:
        table = read_segments(path, format="json")
    except KinemeError:
        return None
    named = int((table.table.label != "").sum())
    to_name = int((table.table.kind != "transition").sum())
    return Progress(len(table), len(marked(table, "checked")), named, to_name)
