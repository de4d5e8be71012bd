"""An open recording with its table, edit history and saved file.

A table has a revision, which grows with every change and survives restarts of the server. An edit
names the revision that it was made on and is refused on any other, so that two pages cannot
overwrite each other unnoticed. An edit also has a name: if a page sends it again because it got no
answer, it is not applied twice. An edit is acknowledged only when its result and the history are on
the disk.

The segments of a recording without a table are found in a thread while it is shown.
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
from kineme.studio.edits import FileLookup, apply_edit
from kineme.studio.jobs import Run
from kineme.studio.loading import LoadedRecording, RecordingCache, get_digest
from kineme.studio.storage.sidecars import (
    ListedRecording,
    list_sidecar_problems,
    make_file_id,
    make_video_message,
    read_saved_options,
)
from kineme.studio.storage.tables import (
    Change,
    ChangedOnDiskError,
    Journal,
    TableFile,
    find_saved_table,
)
from kineme.web.messages import Comparison, Edited, Preview, Recording, Version
from kineme.web.page_data import make_recording_message
from kineme.web.requests import Edit, PreviewRequest, Redo, Undo
from kineme.web.tables import make_segments_message, make_table_change

Found = tuple[Segmentation, list[str]]
"""A table, and notes for the user."""
FIRST_WAIT_S = 3.0
"""Time that a page waits for segments; the first segmentation also compiles code."""
STILL_FINDING = "the recording is still being segmented: try again later"
CHANGED = "the table was changed elsewhere: check it, then edit again"


class ConflictError(Exception):
    """Raised if an edit was made on another table than the present one."""


class OpenRecording:
    """A recording with an editable table; ReadError if it cannot be read.

    ``others`` are the table files of other recordings. ``revision`` is the first revision of the
    table. ``initial`` is the table if none is saved; without it, the recording is segmented.
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
        self._file, table, self._notes = self._find_saved_table()
        self._first: Future[Found] | None = None  # set while the recording is segmented
        self._preview_run = Run(DEFAULT)  # the latest preview
        if table is None and initial is not None and self.loaded.fits(initial):
            table = initial
        if table is None:
            first = _start_thread(self.loaded.first_table)
            if self.loaded.is_long or not wait([first], FIRST_WAIT_S).done:
                self._first, table = first, self.loaded.make_single_segment("transition")
            else:
                table, notes = first.result()
                self._notes = [*self._notes, *notes]
        elif get_digest(table) not in ("", self.loaded.provenance.sha256):
            self._notes = [*self._notes, f"{self.path.name} has changed since its table was made"]
        self._table, self._journal = table, Journal(self._file.path, table)
        # Finding the segments will raise the revision by one.
        self.revision = max(revision, self._journal.revision) - self.finding

    @property
    def finding(self) -> bool:
        """Whether the recording is still being segmented; it cannot be edited before."""
        return self._first is not None

    def find(self) -> None:
        """Wait for the segments of a recording that is already shown."""
        if (first := self._first) is None:
            return
        try:
            table, notes = first.result()
        except KinemeError as error:
            table, notes = self._table, [f"not segmented: {error}"]
        with self._lock:
            if self._first is None:  # another thread was faster
                return
            self._first = None
            self._notes = [*self._notes, *notes]
            self.revision += 1
            if not self._file.has_changed():  # else keep the table that another program wrote
                self._table, self._journal = table, Journal(self._file.path, table)

    @property
    def table_path(self) -> Path:
        """File of the table."""
        return self._file.path

    @property
    def table(self) -> Segmentation:
        """Return the current table; wait until the recording is segmented."""
        self.find()
        with self._lock:
            return self._table

    def message(self) -> tuple[Recording, bool]:
        """Return everything that a page shows, and whether another program changed the table."""
        with self._lock:
            is_reloaded = self._file.has_changed() and self._reload()
            base = make_recording_message(
                self.loaded.page_data(), self._table, name=self.listed.name
            )
            source = self.loaded.provenance
            people = [*source.people] if len(source.people) > 1 else []
            message = structs.replace(
                base,
                id=self.id,
                revision=self.revision,
                can_undo=self._journal.can_undo,
                can_redo=self._journal.can_redo,
                saved=self._saved,
                video=make_video_message(self.path, self.loaded.picture()),
                read_options=options_to_json(read_saved_options(self.path)),
                take=source.take,
                takes=[*source.takes],
                file=make_file_id(self.path),
                person=source.person if people else None,
                people=people,
                finding=self.finding,
                warnings=[
                    *base.warnings,
                    *self._notes,
                    *self._journal.notes,
                    *list_sidecar_problems(self.path),
                ],
            )
            return message, is_reloaded

    def edit(self, revision: int, edit: Edit, files: FileLookup, *, name: str = "") -> Edited:
        """Apply an edit to the table of this revision, save it, and return the result.

        An edit with a known name is not applied again. ConflictError if the table has another
        revision or another program changed the file; KinemeError if the edit cannot be applied or
        saved.
        """
        # `find` raises the revision after it clears `finding`, so compare the revision first.
        if revision == self.revision and self.finding:
            raise ParameterError(STILL_FINDING)
        self.find()  # an edit resent after a restart waits for the table
        with self._lock:
            if self._journal.knows(name):
                return self._make_edited([])
            if revision != self.revision:
                raise ConflictError(CHANGED)
            change, notes = self._apply(edit, files)
            if self._file.has_changed():
                raise self._changed_elsewhere()
            before = self._table
            self._write(change, name)
            return self._make_edited(notes, before)

    def refresh_table(self, initial: Segmentation) -> bool:
        """Show another initial table if none is saved; return whether it is different."""
        with self._lock:
            is_unchanged = self._table == initial or not self.loaded.fits(initial)
            if is_unchanged or self.finding or self._file.exists or self._file.has_changed():
                return False
            self._table, self._journal = initial, Journal(self._file.path, initial)
            self.revision += 1
            return True

    def replace_table(self, make: Callable[[Segmentation], Segmentation]) -> bool:
        """Replace the table by ``make(table)``, saved as one undo step; return whether it changed.

        ConflictError if another program changed the file, KinemeError if it cannot be made or
        saved.
        """
        self.find()
        with self._lock:
            table = make(self._table)
            if table == self._table:
                return False
            if self._file.has_changed():
                raise self._changed_elsewhere()
            self._write(self._journal.make_change(table, None, replaced=True))
            return True

    def preview(self, request: PreviewRequest) -> Preview:
        """Return the table that segmenting again would give; the present one is kept.

        CancelledError if it is cancelled or a newer preview is requested.
        """
        detail = DEFAULT_DETAIL if request.detail is UNSET else request.detail
        previous, self._preview_run = self._preview_run, Run(request.preset)
        previous.cancel()
        segments = self.loaded.segment(
            request.preset, request.parameters, detail, self._preview_run
        )
        carried = editing.carry_corrections(self.table, segments)
        lost = [f"{carried.corrections} corrections and {carried.names} names"]
        return Preview(
            segmentation=make_segments_message(carried.segmentation if request.keep else segments),
            corrections=carried.corrections,
            names=carried.names,
            lost=carried.lost if request.keep else lost,
            details=list(segments.hierarchy.details) if segments.hierarchy else [DEFAULT_DETAIL],
            detail=segments.hierarchy.detail if segments.hierarchy else DEFAULT_DETAIL,
        )

    def versions(self) -> list[Version]:
        """Return the replaced tables, the latest first."""
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
        """Return a replaced table to compare with the present one."""
        with self._lock:
            table = self._version(number)
            at = self._journal.versions()[number].at
        return Comparison(name=at, segmentation=make_segments_message(table), scores={})

    def _apply(self, edit: Edit, files: FileLookup) -> tuple[Change, list[str]]:
        """Return the change that an edit makes, and notes for the user."""
        if isinstance(edit, Undo | Redo):
            return self._journal.undo_or_redo(undo=isinstance(edit, Undo)), []
        outcome = apply_edit(self._table, edit, self.loaded, files, self._version)
        change = self._journal.make_change(outcome.table, edit, replaced=outcome.replaced)
        return change, outcome.notes

    def _write(self, change: Change, name: str = "") -> None:
        """Save a change, then make its table the present one."""
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

    def _reload(self) -> bool:
        """Load the table that another program wrote; undo restores the previous one."""
        self._file, table, self._notes = self._find_saved_table()
        self._table = table or self._table
        self._journal = Journal(self._file.path, self._table)
        self.revision += 1
        return True

    def _find_saved_table(self) -> tuple[TableFile, Segmentation | None, list[str]]:
        """Return the table file, the saved table if there is one, and notes."""
        fits, belongs_to_other = self.loaded.fits, self.loaded.belongs_to_other
        return find_saved_table(self.listed, fits, self._others, belongs_to_other)

    def _make_edited(self, notes: list[str], before: Segmentation | None = None) -> Edited:
        """Return the message after an edit: the new table, or how it differs from ``before``."""
        change = None
        if before is not None:
            change = make_table_change(before, self._table, revision=self.revision - 1)
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
        """Name of the table file; empty until it exists."""
        return self._file.path.name if self._file.exists else ""


def _start_thread(find: Callable[[], Found]) -> Future[Found]:
    """Find segments in a thread; not in a pool, whose threads would delay the end of the server."""
    found: Future[Found] = Future()

    def run() -> None:
        try:
            found.set_result(find())
        except Exception as error:  # noqa: BLE001 (raised by `found.result`)
            found.set_exception(error)

    threading.Thread(target=run, name="segments", daemon=True).start()
    return found
