"""Documents: one open recording each, with its table, what was done to it, and where it is kept.

A table has a revision, which grows with every change. An edit names the
revision it was made on; on any other it is refused, so that two pages cannot
overwrite each other unseen. An edit counts once its result is on the disk: one
that was acknowledged outlives the server, one that was not has changed nothing.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any, cast

from kineme.errors import KinemeError
from kineme.labels import json_table
from kineme.segments.history import History
from kineme.segments.segmentation import Segmentation
from kineme.studio.edits import edited
from kineme.studio.folder import Folder
from kineme.studio.storage import ChangedOnDiskError, saved_table
from kineme.studio.takes import Reading, Sources, Take
from kineme.web.messages import Edit, Edited, Recording, Segments

Listener = Callable[[str, int], None]
AS_IT_IS = Reading()


class UnknownError(Exception):
    """There is no such recording, file or tile."""


class ConflictError(Exception):
    """The edit was made on another table than the present one, which comes along."""

    def __init__(self, reason: str, present: Edited):
        self.present = present
        super().__init__(reason)


class Document:
    """An open recording.

    Parameters
    ----------
    name : the id of the recording
    taken : files that hold the tables of other recordings
    revision : to begin with

    Raises
    ------
    ReadError : the recording cannot be read
    """

    def __init__(self, name: str, path: Path, sources: Sources, taken: set[Path], revision: int):
        self.id, self.path, self.revision = name, path, revision
        self.take = Take(path, sources)
        self._taken = taken
        self._lock = threading.RLock()
        self._kept, table, self._notes = saved_table(path, self.take.fits, taken)
        if table is None:
            table, notes = self.take.first_table()
            self._notes = [*self._notes, *notes]
        elif _digest(table) not in ("", self.take.provenance.sha256):
            self._notes = [*self._notes, f"{path.name} has changed since its table was made"]
        self._history = History(table)

    @property
    def kept_at(self) -> Path:
        """The file of its table."""
        return self._kept.path

    @property
    def table(self) -> Segmentation:
        """The table as it is."""
        with self._lock:
            return self._history.present

    def recording(self) -> tuple[Recording, bool]:
        """All that a page shows, and whether the table was read anew from the disk for it."""
        from kineme.web.recording import recording

        with self._lock:
            anew = self._kept.changed() and self._read_anew()
            state = self._edited([])
            shown = recording(self.take.footage(), self._history.present, name=self.path.name)
            message: Recording = {
                **shown,
                "id": self.id,
                "revision": state["revision"],
                "can_undo": state["can_undo"],
                "can_redo": state["can_redo"],
                "saved": state["saved"],
                "warnings": [*self.take.warnings, *self._notes, *shown["warnings"]],
            }
            return message, anew

    def edit(self, revision: int, edit: Edit, knowledge_base: Callable[[str], Path]) -> Edited:
        """The table after an edit, which is on the disk.

        Raises
        ------
        ConflictError : the revision is not the present one, or the file is not the one that was
            last read or written here
        KinemeError : the edit cannot be made, or its result cannot be saved
        """
        with self._lock:
            if revision != self.revision:
                reason = f"the table has changed: this edit is of revision {revision}"
                raise ConflictError(f"{reason}, now it is {self.revision}", self._edited([]))
            history, notes = self._after(edit, knowledge_base)
            try:
                self._kept.write(history.present)
            except ChangedOnDiskError:
                reason = f"another program changed {self._kept.path.name}: open it again"
                raise ConflictError(reason, self._edited([])) from None
            self._history, self.revision = history, self.revision + 1
            return self._edited(notes)

    def _after(
        self, edit: Edit, knowledge_base: Callable[[str], Path]
    ) -> tuple[History[Segmentation], list[str]]:
        if edit["kind"] == "undo":
            return self._history.undone(), []
        if edit["kind"] == "redo":
            return self._history.redone(), []
        table, notes = edited(self._history.present, edit, self.take, knowledge_base)
        return self._history.then(table), notes

    def _read_anew(self) -> bool:
        """The table that another program left; undo brings back the one from before."""
        self._kept, table, self._notes = saved_table(self.path, self.take.fits, self._taken)
        if table is not None:
            self._history = self._history.then(table)
        self.revision += 1
        return True

    def _edited(self, notes: list[str]) -> Edited:
        return {
            "revision": self.revision,
            "segmentation": segments_message(self._history.present),
            "can_undo": bool(self._history.past),
            "can_redo": bool(self._history.future),
            "saved": self._kept.path.name if self._kept.exists else "",
            "notes": notes,
        }


class Documents:
    """The recordings of a folder, each opened once.

    Parameters
    ----------
    changed : called with id and revision when a table has changed
    reading : what the files do not say themselves
    """

    def __init__(self, folder: Folder, changed: Listener, reading: Reading = AS_IT_IS):
        self.folder = folder
        self._changed = changed
        self._sources = Sources(reading)
        self._open: dict[str, Document] = {}
        self._lock = threading.Lock()
        self._opening: dict[str, threading.Lock] = {}

    def get(self, name: str) -> Document:
        """The recording of that id, opened if it is not, and again if its file has changed.

        Raises
        ------
        UnknownError : no such recording is listed
        ReadError : it cannot be read
        """
        known = self._open.get(name)
        if known is not None and not known.take.changed():
            return known
        path = _found(self.folder.recordings(), name, "recording")
        with self._lock:
            opening = self._opening.setdefault(name, threading.Lock())
        with opening:
            known = self._open.get(name)
            if known is None or known.take.changed():
                others = [other for other in list(self._open.values()) if other.path != path]
                taken = {other.kept_at for other in others}
                revision = 1 if known is None else known.revision + 1
                self._open[name] = Document(name, path, self._sources, taken, revision)
            return self._open[name]

    def recording(self, name: str) -> Recording:
        """All that a page shows of the recording of that id."""
        document = self.get(name)
        message, anew = document.recording()
        if anew:
            self._changed(name, message["revision"])
        return message

    def prepare(self, names: Iterable[str]) -> None:
        """Open recordings before they are asked for; what is wrong with one is said then."""
        for name in names:
            with suppress(KinemeError, UnknownError):
                self.recording(name)

    def edit(self, name: str, revision: int, edit: Edit) -> Edited:
        """The recording's table after an edit; see :meth:`Document.edit`."""
        result = self.get(name).edit(revision, edit, self.knowledge_base)
        self._changed(name, result["revision"])
        return result

    def knowledge_base(self, name: str) -> Path:
        """The file of the knowledge base of that id."""
        return _found(self.folder.knowledge_bases(), name, "knowledge base")

    def annotation(self, name: str) -> Path:
        """The label file of that id."""
        return _found(self.folder.annotations(), name, "label file")


def segments_message(table: Segmentation) -> Segments:
    """A table as the pages have it."""
    return cast(Segments, json_table.as_object(table))


def _found(files: dict[str, Path], name: str, what: str) -> Path:
    if name not in files:
        raise UnknownError(f"there is no such {what}; it may have been taken away")
    return files[name]


def _digest(table: Segmentation) -> str:
    """The digest of the recording that a table was made from, empty if it does not say."""
    source: Any = table.provenance.get("input")
    return str(source.get("sha256") or "") if isinstance(source, dict) else ""
