"""List what can be opened: the recordings of a folder, each with an id.

A page only knows ids. An id is valid only for a recording that is listed at that time, so a request
cannot name any other file. Progress is read from the table; the recording is not opened. The people
in a file are read from a small file beside it, once somebody selected one.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from kineme._util.files import CORRECTED
from kineme.formats.listing import drop_duplicates, holds_recording, list_files
from kineme.labels import holds_labels
from kineme.segments.segmentation import Segmentation
from kineme.studio.overview import read_brief
from kineme.studio.storage.sidecars import ListedRecording, list_recordings, make_file_id
from kineme.studio.storage.tables import find_table_path, list_default_table_paths


class Folder:
    """A folder, to which uploads go. With ``files``, only these are listed."""

    is_library = False

    def __init__(self, root: Path, files: Iterable[Path] | None = None):
        self.root = root
        self._files = None if files is None else list(files)

    def add(self, path: Path) -> None:
        """List a file that was added later."""
        if self._files is not None and path not in self._files:
            self._files.append(path)

    def recordings(self) -> dict[str, ListedRecording]:
        """Return the recordings by id, sorted by name or in the given order."""
        if self._files is not None:
            files = [path for path in self._files if path.is_file()]
        else:
            present = (path for path in self._listed() if not path.name.endswith(CORRECTED))
            files = drop_duplicates([path for path in present if holds_recording(path)])
        return {each.id: each for each in list_recordings(files)}

    def knowledge_bases(self) -> dict[str, Path]:
        """Return the knowledge bases by id."""
        archives = [path for path in self._listed() if path.suffix.lower() == ".npz"]
        if not archives:
            return {}
        from kineme.transfer.knowledge import holds_knowledge  # its imports take half a second

        return {make_file_id(path): path for path in archives if holds_knowledge(path)}

    def annotations(self, recordings: Iterable[ListedRecording] | None = None) -> dict[str, Path]:
        """Return the label files by id, without the tables that the studio saves.

        ``recordings`` are those of the folder, if they were listed already.
        """
        listed = self.recordings().values() if recordings is None else recordings
        tables = {table for each in listed for table in list_default_table_paths(each)}
        label_files = [path for path in self._listed() if path not in tables and holds_labels(path)]
        return {make_file_id(path): path for path in label_files}

    def folders(self) -> list[Path]:
        """Return the subfolders, where people may keep their labels."""
        try:
            inside = sorted(self.root.iterdir())
        except OSError:
            return []
        return [path for path in inside if path.is_dir() and not path.name.startswith(".")]

    def first_table(self, path: Path) -> Segmentation | None:  # noqa: ARG002 (of a library)
        """Return the initial table of a recording without a saved one, if it is known."""
        return None

    def _listed(self) -> list[Path]:
        try:
            return list_files(self.root)
        except OSError:
            return []


@dataclass(frozen=True)
class Progress:
    """Number of segments of a table: all, checked, named, and those to name (no transitions)."""

    segments: int
    checked: int
    named: int
    to_name: int


def count_progress(listed: ListedRecording) -> Progress | None:
    """Return the progress of a recording; None without a readable table."""
    path = find_table_path(listed)
    table = read_brief(path) if path else None
    if table is None:
        return None
    named = sum(label != "" for label in table.label)
    to_name = sum(kind != "transition" for kind in table.kind)
    return Progress(len(table.level), len(table.checked), named, to_name)
