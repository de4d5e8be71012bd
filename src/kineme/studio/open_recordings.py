"""Open recordings of a folder, by id: their tables, reading options and common names.

Clusters of different recordings are only related by their names. Renaming a cluster everywhere
renames the clusters and segments elsewhere that have the old name. In a library clusters are
shared: see `kineme.studio.library`.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import fields, replace
from functools import partial
from pathlib import Path
from typing import TypeVar

from msgspec import UNSET

from kineme._util.checks import format_count
from kineme.errors import KinemeError, ParameterError, ReadError, SeveralPeopleError
from kineme.formats import ReadOptions
from kineme.labels.collections import Extent
from kineme.methods.segmenter import SegmentOptions
from kineme.segments.editing import cluster_names
from kineme.segments.segmentation import Segmentation
from kineme.studio.choices import make_repeat_request
from kineme.studio.folder import Folder, read_brief, summarize_table
from kineme.studio.jobs import IDLE, READING
from kineme.studio.loading import SKETCH_REVISION, RecordingCache, Sketch, Sketcher
from kineme.studio.open_recording import STILL_FINDING, ConflictError, OpenRecording
from kineme.studio.storage.sidecars import (
    ListedRecording,
    read_saved_reading,
    resolve_read_options,
    write_reading,
)
from kineme.studio.storage.tables import find_table_path
from kineme.web.library_messages import CallEverywhere, TablesChanged
from kineme.web.messages import (
    BriefTable,
    Edited,
    FolderRecording,
    FolderTables,
    Progress,
    Recording,
)
from kineme.web.requests import ByHand, EditRequest, NameCluster, NameSegment, Together

Listener = Callable[[str, int], None]
File = TypeVar("File", Path, ListedRecording)
MAX_PICTURES = 6
"""Recordings whose page data stays in memory: the most recently used."""


class UnknownError(Exception):
    """Raised if there is no such recording, file or tile."""


class SupersededError(Exception):
    """Raised if a newer request replaced this one."""


class OpenRecordings:
    """Recordings of a folder, each opened once.

    ``changed`` is called with id and revision after a table has changed.
    """

    def __init__(
        self,
        folder: Folder,
        changed: Listener,
        read_options: ReadOptions | None = None,
        segment_options: SegmentOptions | None = None,
    ):
        self.folder = folder
        self._changed = changed
        self._cache = RecordingCache(read_options, segment_options)
        self._open: dict[str, OpenRecording] = {}
        self._recently_used: OrderedDict[str, None] = OrderedDict()
        self._sketcher = Sketcher(self._cache)
        self._lock = threading.Lock()
        self._opening: dict[str, threading.Lock] = {}

    def get(self, name: str) -> OpenRecording:
        """Return the recording with this id; open it if needed, and again if its file has changed.

        UnknownError if it is not listed, ReadError if it cannot be read.
        """
        self._drop_old_pictures(name)
        present = self._open.get(name)
        if present is not None and not present.loaded.has_changed():
            return present
        listed = self.find_listed(name)
        with self._opening.setdefault(name, threading.Lock()):
            # Another thread may have opened it meanwhile.
            present = self._open.get(name)
            if present is None or present.loaded.has_changed():
                return self._open_recording(listed, present)
            return present

    def find_listed(self, name: str) -> ListedRecording:
        """Return the recording with this id, opened or not; UnknownError if it is not listed."""
        return _find_or_raise(self.folder.recordings(), name, "recording")

    def _open_recording(
        self, listed: ListedRecording, previous: OpenRecording | None
    ) -> OpenRecording:
        """Open a recording; announce its segments later if they are not found yet."""
        if not self.folder.is_library:  # which has one person of a file
            _check_person(listed, self._cache)
        others = [other for other in list(self._open.values()) if other.id != listed.id]
        tables = {other.table_path for other in others}
        revision = 1 if previous is None else previous.revision + 1
        initial = self.folder.first_table(listed.path)
        opened = self._open[listed.id] = OpenRecording(
            listed, self._cache, tables, revision, initial
        )
        if opened.finding:
            self._run_in_background(self._announce_segments, opened)
        return opened

    def _drop_old_pictures(self, name: str) -> None:
        """Drop page data of the least recently used recordings."""
        with self._lock:
            self._recently_used[name] = None
            # Keep the names in order of use, the oldest first.
            self._recently_used.move_to_end(name)
            while len(self._recently_used) > MAX_PICTURES:
                oldest, _ = self._recently_used.popitem(last=False)
                # The recording stays open; only what pages draw is dropped.
                if opened := self._open.get(oldest):
                    opened.loaded.forget_pictures()
                    self._sketcher.forget(oldest)

    def _run_in_background(self, work: Callable[..., None], *arguments: object) -> None:
        def run() -> None:
            try:
                work(*arguments)
            except Exception:
                if threading.main_thread().is_alive():  # else the server is shutting down
                    raise

        threading.Thread(target=run, daemon=True).start()

    def _announce_segments(self, opened: OpenRecording) -> None:
        """Wait for the segments of a recording that is already shown, then tell the pages."""
        opened.find()
        self._changed(opened.id, opened.revision)

    def _open_sketched(self, name: str, sketch: Sketch) -> None:
        """Read a recording that is shown as a sketch, then tell the pages to reload."""
        revision = SKETCH_REVISION + 1  # any new revision makes the page reload
        with suppress(KinemeError, UnknownError):
            self._cache.read(self.find_listed(name))
            if self._sketcher.forget_closed(sketch):
                return
            opened = self.get(name)
            opened.loaded.page_data()
            revision = max(revision, opened.revision)
        sketch.reading = False
        self._changed(name, revision)

    def message(self, name: str) -> Recording:
        """Return everything that a page shows of a recording."""
        if name not in self._open:
            start = partial(self._run_in_background, self._open_sketched, name)
            if sketch := self._sketcher.open(self.find_listed(name), start):
                return sketch.message
        message, is_reloaded = self.get(name).message()
        if is_reloaded:
            self._changed(name, message.revision)
        return message

    def poses(self, name: str, n_samples: int) -> bytes:
        """Return the binary poses of a recording.

        They are those of its sketch if this has ``n_samples``, as the page still shows it.
        """
        sketch = self._sketcher.get(name)
        head = sketch.message.motion if sketch else None
        if sketch is not None and head is not None and head.n_samples == n_samples:
            return sketch.binary
        return self.get(name).loaded.page_data().binary

    def prepare(self, names: Iterable[str]) -> None:
        """Open recordings in advance. Errors are ignored: the later request raises them again."""
        for name in names:
            with suppress(KinemeError, UnknownError):
                self.message(name)

    def tables(self) -> FolderTables:
        """Return the tables of all recordings, also those that are not saved yet."""
        listed = self.folder.recordings().items()
        tables = [FolderRecording(id=name, table=self._summarize(entry)) for name, entry in listed]
        return FolderTables(recordings=tables)

    def _summarize(self, listed: ListedRecording) -> BriefTable | None:
        """Return the saved table of a recording, else the one it is shown with, or None."""
        opened = self._open.get(listed.id)
        table_path = find_table_path(listed) if opened is None else opened.table_path
        brief = read_brief(table_path) if table_path else None
        if brief is None and opened is not None and not opened.finding:
            return summarize_table(opened.table)
        initial = self.folder.first_table(listed.path) if brief is None else None
        return brief if initial is None else summarize_table(initial)

    def refresh_tables(self) -> None:
        """Update the initial tables of open recordings without a saved one."""
        for name, opened in list(self._open.items()):
            initial = self.folder.first_table(opened.path)
            if initial is not None and opened.refresh_table(initial):
                self._changed(name, opened.revision)

    def replace_table(self, name: str, make: Callable[[Segmentation], Segmentation]) -> bool:
        """Replace a recording's table; see `OpenRecording.replace_table`."""
        opened = self.get(name)
        is_other = opened.replace_table(make)
        if is_other:
            self._changed(name, opened.revision)
        return is_other

    def edit(self, name: str, sent: EditRequest) -> Edited:
        """Apply an edit to a recording's table; see `OpenRecording.edit`."""
        if sent.revision == SKETCH_REVISION:
            raise ParameterError(STILL_FINDING)
        edit_name = "" if sent.name is UNSET else sent.name
        result = self.get(name).edit(sent.revision, sent.edit, self, name=edit_name)
        self._changed(name, result.revision)
        return result

    def change_reading(
        self, name: str, options: ReadOptions, *, everybody: bool = False
    ) -> list[str]:
        """Change how a file is read; return the ids of the recordings to show.

        Saved tables are made again; the old ones are kept as versions. Another take or person has
        its own table, which stays as it is. Options that are not set keep the general value.
        KinemeError if the file cannot be read so; nothing changes then.
        """
        listed = self.find_listed(name)
        changed, person = _change_options(
            listed, options, self._cache, everybody=everybody, is_library=self.folder.is_library
        )
        listing = self.folder.recordings().values()
        entries = [entry for entry in listing if entry.path == listed.path]
        if name not in {entry.id for entry in entries}:
            self._open.pop(name, None)
            self._sketcher.forget(name)
        for entry in entries:
            is_used = (
                entry.id in self._open or self._sketcher.get(entry.id) or find_table_path(entry)
            )
            if changed and is_used:
                with suppress(ReadError):  # this person may not be in the new take
                    self._reopen(entry, with_table=changed != {"take"})
        return [entry.id for entry in entries if everybody or entry.person in ("", person)]

    def _reopen(self, listed: ListedRecording, *, with_table: bool) -> None:
        """Open a recording with changed options and segment it again if it has a saved table."""
        previous = self._open.get(listed.id)
        opened = self._open_recording(listed, previous)
        if opened.table_path.exists() and with_table:
            table = (previous or opened).table
            request = make_repeat_request(table, signals=not opened.loaded.is_motion)
            opened.edit(opened.revision, request, self)
        self._changed(listed.id, opened.revision)

    def extent(self, listed: ListedRecording) -> Extent:
        """Return the length of a recording; see `RecordingCache.extent`."""
        return self._cache.extent(listed)

    def progress(self, name: str) -> Progress:
        """Return the progress of computations for a recording, without opening it."""
        opened = self._open.get(name)
        if opened is not None:
            return opened.loaded.runs.progress()
        sketch = self._sketcher.get(name)
        return READING if sketch is not None and sketch.reading else IDLE

    def cancel(self, name: str) -> None:
        """Cancel computations for a recording; a recording that is being read is not opened."""
        opened, sketch = self._open.get(name), self._sketcher.get(name)
        if opened is not None:
            opened.loaded.runs.cancel()
        elif sketch is not None:
            sketch.is_open = False

    def knowledge_base(self, name: str) -> Path:
        """Return the knowledge base file with this id."""
        return _find_or_raise(self.folder.knowledge_bases(), name, "knowledge base")

    def annotation(self, name: str) -> Path:
        """Return the label file with this id."""
        return _find_or_raise(self.folder.annotations(), name, "label file")


def _find_or_raise(files: dict[str, File], name: str, what: str) -> File:
    if name not in files:
        raise UnknownError(f"there is no such {what}: it may have been removed")
    return files[name]


def rename_everywhere(recordings: OpenRecordings, sent: CallEverywhere) -> TablesChanged:
    """Give the new name to everything called ``before`` in other recordings, one undo step in each.

    ParameterError if the cluster had no name before.
    """
    if not sent.before:
        raise ParameterError(
            "the cluster had no name before: only named clusters can be renamed in other recordings"
        )
    changed, left = 0, []
    for name, listed in recordings.folder.recordings().items():
        table_path = find_table_path(listed)
        table = read_brief(table_path) if table_path and name != sent.recording else None
        if table is None or sent.before not in table.label:
            continue
        try:
            opened = recordings.get(name)
            edits = _make_edits(opened.table, sent.before, sent.label)
            if edits:
                edit = EditRequest(revision=opened.revision, edit=Together(edits=edits))
                recordings.edit(name, edit)
                changed += 1
        except (KinemeError, UnknownError, ConflictError) as error:
            left.append(f"{listed.name}: {error}")
    return TablesChanged(tables=changed, others=0, left=left)


def _make_edits(table: Segmentation, before: str, label: str) -> list[ByHand]:
    """Return edits that rename the clusters with this name, and the single segments with it."""
    clusters = [cluster for cluster, name in cluster_names(table).items() if name == before]
    single_rows = [row for row in table if row.label == before and row.cluster not in clusters]
    return [
        *(NameCluster(cluster=cluster, label=label) for cluster in clusters),
        *(NameSegment(level=row.level, frame=row.start_frame, label=label) for row in single_rows),
    ]


def _check_person(listed: ListedRecording, cache: RecordingCache) -> None:
    """Raise SeveralPeopleError if the file holds several people and none was selected.

    Marker files can be read without a selection, but their user should know whose markers these
    are.
    """
    if listed.person or resolve_read_options(listed, cache.read_options).person:
        return
    people = cache.read(listed).provenance.people
    if len(people) > 1:
        reason = f"{format_count(len(people), 'person')} found: choose one or all"
        raise SeveralPeopleError(listed.path, reason, people)


def _change_options(
    listed: ListedRecording,
    options: ReadOptions,
    cache: RecordingCache,
    *,
    everybody: bool,
    is_library: bool,
) -> tuple[set[str], str]:
    """Read a file with new options from now on; KinemeError if it cannot be read so.

    Return the names of the options that changed, and the person that was read.
    """
    old, known = read_saved_reading(listed.path)
    people = cache.people(listed.path, options) if everybody else ()
    person = people[0] if people else options.person or listed.person
    source = cache.read(ListedRecording(listed.path, person), options).provenance
    people, person = people or source.people, ""
    if is_library:
        people = known
    elif len(people) < 2:
        people = ()
    else:
        options = replace(options, person=old.person if listed.person else None)
        person = source.person or ""
        # A take may lack some of the known people; keep all of them listed.
        people = known if {*people} <= {*known} and not everybody else people
    write_reading(listed.path, options, people)
    # Another person is a separate recording, so it is not a change of this one.
    names = {each.name for each in fields(options)} - ({"person"} if people else set())
    return {name for name in names if getattr(options, name) != getattr(old, name)}, person
