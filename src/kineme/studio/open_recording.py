"""An open recording, with its table, what was done to it, and where it is saved.

A table has a revision, which grows with every change. An edit names the
revision it was made on; on any other it is refused, so that two pages cannot
overwrite each other unseen. An edit counts once its result is on the disk: one
that was acknowledged outlives the server, one that was not has changed nothing.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from msgspec import structs

from kineme.segments.history import History
from kineme.segments.segmentation import Segmentation
from kineme.studio.edits import edited
from kineme.studio.loading import LoadedRecording
from kineme.studio.reading import RecordingCache
from kineme.studio.storage import ChangedOnDiskError, saved_table
from kineme.web.messages import Edited, Recording
from kineme.web.requests import Edit, Redo, Undo


class ConflictError(Exception):
    """The edit was made on another table than the present one, which comes along."""

    def __init__(self, reason: str, present: Edited):
        self.present = present
        super().__init__(reason)


class OpenRecording:
    """A recording with its table, which edits change.

    Parameters
    ----------
    name : str
        The id of the recording.
    path : Path
        Its file.
    cache : RecordingCache
        Where it is read from.
    others : set of Path
        Files that hold the tables of other recordings.
    revision : int
        Of the table, to begin with.

    Raises
    ------
    ReadError
        The recording cannot be read.
    """

    def __init__(
        self, name: str, path: Path, cache: RecordingCache, others: set[Path], revision: int
    ):
        self.id, self.path, self.revision = name, path, revision
        self.loaded = LoadedRecording(path, cache)
        self._others = others
        self._lock = threading.RLock()
        self._file, table, self._notes = saved_table(path, self.loaded.fits, others)
        if table is None:
            table, notes = self.loaded.first_table()
            self._notes = [*self._notes, *notes]
        elif _digest(table) not in ("", self.loaded.provenance.sha256):
            self._notes = [*self._notes, f"{path.name} has changed since its table was made"]
        self._history = History(table)

    @property
    def table_path(self) -> Path:
        """The file of its table."""
        return self._file.path

    @property
    def table(self) -> Segmentation:
        """The table as it is."""
        with self._lock:
            return self._history.present

    def message(self) -> tuple[Recording, bool]:
        """All that a page shows.

        Returns
        -------
        message : Recording
        anew : bool
            Whether the table was read again for it, because another program had changed the file.
        """
        from kineme.web.page_data import recording_message

        with self._lock:
            anew = self._file.changed() and self._read_anew()
            table = self._history.present
            shown = recording_message(self.loaded.page_data(), table, name=self.path.name)
            message = structs.replace(
                shown,
                id=self.id,
                revision=self.revision,
                can_undo=bool(self._history.past),
                can_redo=bool(self._history.future),
                saved=self._saved,
                warnings=[*self.loaded.warnings, *self._notes, *shown.warnings],
            )
            return message, anew

    def edit(self, revision: int, edit: Edit, knowledge_base: Callable[[str], Path]) -> Edited:
        """The table after an edit, which is on the disk.

        Parameters
        ----------
        revision : int
            Of the table that the edit was made on.
        edit : Edit
        knowledge_base : callable
            The file of a knowledge base by its id.

        Returns
        -------
        Edited

        Raises
        ------
        ConflictError
            The revision is not the present one, or the file is not the one that was last read or
            written here.
        KinemeError
            The edit cannot be made, or its result cannot be saved.
        """
        with self._lock:
            if revision != self.revision:
                reason = f"the table has changed: this edit is of revision {revision}"
                raise ConflictError(f"{reason}, now it is {self.revision}", self._edited([]))
            history, notes = self._after(edit, knowledge_base)
            try:
                self._file.write(history.present)
            except ChangedOnDiskError:
                reason = f"another program changed {self._file.path.name}: open it again"
                raise ConflictError(reason, self._edited([])) from None
            self._history, self.revision = history, self.revision + 1
            return self._edited(notes)

    def _after(
        self, edit: Edit, knowledge_base: Callable[[str], Path]
    ) -> tuple[History[Segmentation], list[str]]:
        if isinstance(edit, Undo):
            return self._history.undone(), []
        if isinstance(edit, Redo):
            return self._history.redone(), []
        table, notes = edited(self._history.present, edit, self.loaded, knowledge_base)
        return self._history.then(table), notes

    def _read_anew(self) -> bool:
        """The table that another program left; undo brings back the one from before."""
        self._file, table, self._notes = saved_table(self.path, self.loaded.fits, self._others)
        if table is not None:
            self._history = self._history.then(table)
        self.revision += 1
        return True

    def _edited(self, notes: list[str]) -> Edited:
        from kineme.web.page_data import segments_message

        return Edited(
            revision=self.revision,
            segmentation=segments_message(self._history.present),
            can_undo=bool(self._history.past),
            can_redo=bool(self._history.future),
            saved=self._saved,
            notes=notes,
        )

    @property
    def _saved(self) -> str:
        """The name of the table's file, empty as long as there is none."""
        return self._file.path.name if self._file.exists else ""


def _digest(table: Segmentation) -> str:
    """The digest of the recording that a table was made from, empty if it does not say."""
    read: Any = table.provenance.get("input")
    return str(read.get("sha256") or "") if isinstance(read, dict) else ""
