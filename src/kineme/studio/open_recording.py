"""An open recording, with its table, what was done to it, and where it is saved.

A table has a revision, which grows with every change and outlives the server.
An edit names the revision it was made on; on any other it is refused, so that
two pages cannot overwrite each other unseen. An edit has a name of its own:
one that is sent again, for want of an answer, is made once. It counts once its
result and the history are on the disk: one that was acknowledged outlives the
server, one that was not has changed nothing.

The segments of a recording that has no table yet are found while it is shown.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future, wait
from pathlib import Path

from msgspec import UNSET, structs

from kineme._util.json import options_to_json
from kineme.errors import KinemeError, ParameterError
from kineme.methods.presets import DEFAULT
from kineme.segments import editing
from kineme.segments.editing.carrying import count_names
from kineme.segments.hierarchy import DEFAULT_DETAIL
from kineme.segments.segmentation import Segmentation
from kineme.studio.edits import Surroundings, apply_edit
from kineme.studio.loading import LoadedRecording, get_digest
from kineme.studio.reading import RecordingCache
from kineme.studio.running import Run
from kineme.studio.storage.journal import Change, Journal
from kineme.studio.storage.listed import ListedRecording, make_file_id
from kineme.studio.storage.sidecars import (
    list_sidecar_problems,
    make_video_message,
    read_saved_options,
)
from kineme.studio.storage.tables import ChangedOnDiskError, TableFile, find_saved_table
from kineme.web.messages import Comparison, Edited, Preview, Recording, Version
from kineme.web.requests import Edit, PreviewRequest, Redo, Undo

Found = tuple[Segmentation, list[str]]
SOON = 3.0
"""Seconds that a page waits for segments; the first ones of all take longer, to compile."""
STILL_FINDING = "the segments are still being found: try again once they are"
CHANGED = "the table was changed elsewhere meanwhile: look at it as it is now, and edit it again"


class ConflictError(Exception):
    """Raised where an edit was made on another table than the present one."""


class OpenRecording:
    """A recording with its table, which edits change; ReadError where it cannot be read.

    ``others`` are files that hold the tables of other recordings; ``revision`` is that of the table
    to begin with. ``initial`` is the table where none is saved, if somebody has found one.
    """

    def __init__(
        self,
        listed: ListedRecording,
        cache: RecordingCache,
        others: set[Path],
        revision: int,
        initial: Segmentation | None = None,
    ):
        self.listed, self.id, self.path = listed, listed.id, listed.path
        self.loaded = LoadedRecording(listed, cache)
        self._others = others
        self._lock = threading.RLock()
        self._file, table, self._notes = self._saved_table()
        self._first: FirstSegments | None = None  # while they are being found
        self._previewed = Run(DEFAULT)  # the last of those that were asked for
        if table is None and initial is not None and self.loaded.fits(initial):
            table = initial
        if table is None:
            first = FirstSegments(self.loaded.first_table)
            if self.loaded.is_long or not first.are_soon():
                self._first, table = first, self.loaded.not_segmented()
            else:
                table, notes = first.result()
                self._notes = [*self._notes, *notes]
        elif get_digest(table) not in ("", self.loaded.provenance.sha256):
            self._notes = [*self._notes, f"{self.path.name} has changed since its table was made"]
        self._table, self._journal = table, Journal(self._file.path, table)
        self.revision = max(revision, self._journal.revision) - self.finding  # one more once found

    @property
    def finding(self) -> bool:
        """Whether its segments are still to be found; until then there is nothing to edit."""
        return self._first is not None

    def find(self) -> None:
        """Wait for the segments of a recording that is shown and played meanwhile."""
        if (first := self._first) is None:
            return
        try:
            table, notes = first.result()
        except KinemeError as error:
            table, notes = self._table, [f"not segmented: {error}"]
        with self._lock:
            if self._first is None:  # another thread has already taken the result
                return
            self._first = None
            self._notes = [*self._notes, *notes]
            self.revision += 1
            if not self._file.changed():  # otherwise keep the table that another program wrote
                self._table, self._journal = table, Journal(self._file.path, table)

    @property
    def table_path(self) -> Path:
        """Return the file of its table."""
        return self._file.path

    @property
    def table(self) -> Segmentation:
        """Return the table as it is, once its segments are found."""
        self.find()
        with self._lock:
            return self._table

    def message(self) -> tuple[Recording, bool]:
        """All that a page shows, and whether another program has changed the table meanwhile."""
        from kineme.web.page_data import make_recording_message

        with self._lock:
            anew = self._file.changed() and self._read_anew()
            shown = make_recording_message(
                self.loaded.page_data(), self._table, name=self.listed.name
            )
            read = self.loaded.provenance
            people = [*read.people] if len(read.people) > 1 else []
            message = structs.replace(
                shown,
                id=self.id,
                revision=self.revision,
                can_undo=self._journal.can_undo,
                can_redo=self._journal.can_redo,
                saved=self._saved,
                video=make_video_message(self.path, self.loaded.picture()),
                read_options=options_to_json(read_saved_options(self.path)),
                take=read.take,
                takes=[*read.takes],
                file=make_file_id(self.path),
                person=read.person if people else None,
                people=people,
                finding=self.finding,
                warnings=[
                    *shown.warnings,
                    *self._notes,
                    *self._journal.notes,
                    *list_sidecar_problems(self.path),
                ],
            )
            return message, anew

    def edit(self, revision: int, edit: Edit, files: Surroundings, *, name: str = "") -> Edited:
        """Return what an edit made of the table of that revision; it is on the disk.

        An edit whose name has been made is not made again. ConflictError where the table is of
        another revision, or the file not the one last read or written here; KinemeError where the
        edit cannot be made or saved.
        """
        if self.finding and revision == self.revision:
            raise ParameterError(STILL_FINDING)
        self.find()  # what a page could not send to the server before this one waits for its table
        with self._lock:
            if self._journal.knows(name):
                return self._edited([])
            if revision != self.revision:
                raise ConflictError(CHANGED)
            change, notes = self._after(edit, files)
            if self._file.changed():
                raise self._changed_elsewhere()
            before = self._table
            self._write(change, name)
            return self._edited(notes, before)

    def renew(self, initial: Segmentation) -> bool:
        """Show another table where nobody has saved one; whether it is another."""
        with self._lock:
            same = self._table == initial or not self.loaded.fits(initial)
            if same or self.finding or self._file.exists or self._file.changed():
                return False
            self._table, self._journal = initial, Journal(self._file.path, initial)
            self.revision += 1
            return True

    def take(self, make: Callable[[Segmentation], Segmentation]) -> bool:
        """Save what becomes of the table, the one before kept; whether it is another.

        As for an edit: it is on the disk then, and undo takes it back. ConflictError where another
        program has changed the file, KinemeError where it cannot be made or saved.
        """
        self.find()
        with self._lock:
            table = make(self._table)
            if table == self._table:
                return False
            if self._file.changed():
                raise self._changed_elsewhere()
            self._write(self._journal.changed(table, None, replaced=True))
            return True

    def preview(self, request: PreviewRequest) -> Preview:
        """Return what segmenting again would make of the table, which stays as it is.

        CancelledError where it is not wanted any more, or another one is.
        """
        from kineme.web.tables import make_segments_message

        detail = DEFAULT_DETAIL if request.detail is UNSET else request.detail
        former, self._previewed = self._previewed, Run(request.preset)
        former.cancel()
        found = self.loaded.segment(request.preset, request.parameters, detail, self._previewed)
        result = editing.carry_corrections(self.table, found)
        lost = [f"{result.corrections} corrections and {result.names} names"]
        return Preview(
            segmentation=make_segments_message(result.segmentation if request.keep else found),
            corrections=result.corrections,
            names=result.names,
            lost=result.lost if request.keep else lost,
            details=list(found.hierarchy.details) if found.hierarchy else [DEFAULT_DETAIL],
            detail=found.hierarchy.detail if found.hierarchy else DEFAULT_DETAIL,
        )

    def versions(self) -> list[Version]:
        """Return the tables that were replaced, the latest first."""
        with self._lock:
            steps = self._journal.versions()
            tables = {number: self._journal.table(number) for number in steps}
        return [
            Version(
                number=number,
                at=step.at,
                edit=step.edit,
                segments=len(tables[number]),
                corrections=tables[number].annotation.corrections,
                names=count_names(tables[number]),
            )
            for number, step in steps.items()
        ]

    def version(self, number: int) -> Comparison:
        """Return a table that was replaced, to lay beside the present one."""
        from kineme.web.tables import make_segments_message

        with self._lock:
            table = self._version(number)
            at = self._journal.versions()[number].at
        return Comparison(name=at, segmentation=make_segments_message(table), scores={})

    def _after(self, edit: Edit, files: Surroundings) -> tuple[Change, list[str]]:
        if isinstance(edit, Undo | Redo):
            undo = isinstance(edit, Undo)
            return self._journal.undone() if undo else self._journal.redone(), []
        outcome = apply_edit(self._table, edit, self.loaded, files, self._version)
        change = self._journal.changed(outcome.table, edit, replaced=outcome.replaced)
        return change, outcome.notes

    def _write(self, change: Change, name: str = "") -> None:
        """Have a change on the disk, and go on with its table."""
        try:
            self._journal.write(change, self._file.write, revision=self.revision + 1, name=name)
        except ChangedOnDiskError:
            raise self._changed_elsewhere() from None
        self._table, self.revision = change.table, self.revision + 1

    def _changed_elsewhere(self) -> ConflictError:
        return ConflictError(f"another program changed {self._file.path.name}: open it again")

    def _version(self, number: int) -> Segmentation:
        if number not in self._journal.versions():
            raise ParameterError(f"there is no version {number} of this table")
        return self._journal.table(number)

    def _read_anew(self) -> bool:
        """Return the table that another program left; undo brings back the one from before."""
        self._file, table, self._notes = self._saved_table()
        self._table = self._table if table is None else table
        self._journal = Journal(self._file.path, self._table)
        self.revision += 1
        return True

    def _saved_table(self) -> tuple[TableFile, Segmentation | None, list[str]]:
        """Return what is on the disk."""
        loaded = self.loaded
        return find_saved_table(
            self.listed, loaded.fits, self._others, of_another=loaded.is_of_another
        )

    def _edited(self, notes: list[str], before: Segmentation | None = None) -> Edited:
        """Return the present table, or how it differs from the one ``before``, a revision ago."""
        from kineme.web.tables import make_segments_message, make_table_change

        of = self.revision - 1
        change = None if before is None else make_table_change(before, self._table, revision=of)
        return Edited(
            revision=self.revision,
            change=change,
            segmentation=None if change else make_segments_message(self._table),
            can_undo=self._journal.can_undo,
            can_redo=self._journal.can_redo,
            saved=self._saved,
            notes=notes,
        )

    @property
    def _saved(self) -> str:
        """Return the name of the table's file, empty as long as there is none."""
        return self._file.path.name if self._file.exists else ""


class FirstSegments:
    """Segments, and notes for people, that a thread is finding."""

    def __init__(self, find: Callable[[], Found]):
        self._found: Future[Found] = Future()
        # Not one of a pool: those are waited for when the server ends.
        threading.Thread(target=self._run, args=[find], name="segments", daemon=True).start()

    def _run(self, find: Callable[[], Found]) -> None:
        try:
            self._found.set_result(find())
        except Exception as error:  # noqa: BLE001 (raised where it is asked for)
            self._found.set_exception(error)

    def are_soon(self) -> bool:
        """Return whether they are there within the time that people wait for."""
        return bool(wait([self._found], SOON).done)

    def result(self) -> Found:
        """Table and notes, as soon as they are there; whatever finding them raised."""
        return self._found.result()
