"""Open recordings of a folder, each found by its id."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import TypeVar

from msgspec import UNSET

from kineme.errors import KinemeError, ParameterError, ReadError
from kineme.formats import ReadOptions
from kineme.labels.collections import Extent
from kineme.methods.segmenter import SegmentOptions
from kineme.segments.segmentation import Segmentation
from kineme.studio.choices import make_repeat_request
from kineme.studio.folder import Folder
from kineme.studio.open_recording import STILL_FINDING, OpenRecording
from kineme.studio.overview import read_brief, summarize_table
from kineme.studio.reader import Reader
from kineme.studio.reading import RecordingCache
from kineme.studio.running import NOTHING, READING
from kineme.studio.sketches import SKETCH_REVISION, Sketch, Sketcher
from kineme.studio.storage.listed import ListedRecording
from kineme.studio.storage.tables import find_table_path
from kineme.web.messages import (
    BriefTable,
    Edited,
    FolderRecording,
    FolderTables,
    Progress,
    Recording,
)
from kineme.web.requests import EditRequest

Listener = Callable[[str, int], None]
File = TypeVar("File", Path, ListedRecording)
MOST_DRAWN = 6
"""Recordings whose pictures stay in memory: those asked for last."""


class UnknownError(Exception):
    """There is no such recording, file or tile."""


class SupersededError(Exception):
    """Something newer was asked for."""


class OpenRecordings:
    """Recordings of a folder, each opened once.

    ``changed`` is called with id and revision when a table has changed.
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
        self._asked: OrderedDict[str, None] = OrderedDict()
        self._reader = Reader(folder, self._cache)
        self._sketcher = Sketcher(self._cache)
        self._lock = threading.Lock()
        self._opening: dict[str, threading.Lock] = {}

    def get(self, name: str) -> OpenRecording:
        """Return the recording of that id, opened if it is not, and again if its file has changed.

        UnknownError where none is listed, ReadError where it cannot be read.
        """
        self._forget_others(name)
        present = self._open.get(name)
        # Checked again, since another thread may have opened it meanwhile.
        if present is not None and not present.loaded.changed():
            return present
        listed = self.listed(name)
        with self._opening.setdefault(name, threading.Lock()):
            present = self._open.get(name)
            if present is None or present.loaded.changed():
                return self._opened(listed, present)
            return present

    def listed(self, name: str) -> ListedRecording:
        """Return the recording of that id, opened or not; UnknownError where none is listed."""
        return _find_or_raise(self.folder.recordings(), name, "recording")

    def _opened(self, listed: ListedRecording, before: OpenRecording | None) -> OpenRecording:
        """Open a recording, perhaps once more, and say later when its segments are there."""
        self._reader.check_person(listed)
        others = [other for other in list(self._open.values()) if other.id != listed.id]
        tables = {other.table_path for other in others}
        revision = 1 if before is None else before.revision + 1
        initial = self.folder.first_table(listed.path)
        opened = self._open[listed.id] = OpenRecording(
            listed, self._cache, tables, revision, initial
        )
        if opened.finding:
            self._in_background(lambda: self._find(opened))
        return opened

    def _forget_others(self, name: str) -> None:
        """Drop cached pictures of the least recently used recordings."""
        with self._lock:
            self._asked[name] = None
            # The first name is thus the one asked for longest ago.
            self._asked.move_to_end(name)
            while len(self._asked) > MOST_DRAWN:
                last, _ = self._asked.popitem(last=False)
                # The recording stays open; only what pages draw is dropped.
                idle = self._open.get(last)
                if idle is not None:
                    idle.loaded.forget_pictures()
                    self._sketcher.forget(last)

    def _in_background(self, work: Callable[[], None]) -> None:
        def run() -> None:
            try:
                work()
            except Exception:
                if threading.main_thread().is_alive():  # else the server has ended
                    raise

        threading.Thread(target=run, daemon=True).start()

    def _find(self, opened: OpenRecording) -> None:
        """Say when the segments of a recording are there that is shown without."""
        opened.find()
        self._changed(opened.id, opened.revision)

    def _sketch(self, name: str) -> Sketch | None:
        """Return what there is to show of a recording that is being read, which is opened then."""
        if name in self._open:
            return None
        listed = self.listed(name)
        return self._sketcher.open(
            listed, lambda made: self._in_background(lambda: self._read(name, made))
        )

    def _read(self, name: str, instead: Sketch) -> None:
        """Open a recording that is shown as a sketch, and say when it is there, or cannot be."""
        revision = SKETCH_REVISION + 1  # a page asks anew for any other than its own
        with suppress(KinemeError, UnknownError):
            self._cache.read(self.listed(name))
            if self._sketcher.forget_closed(instead):
                return
            opened = self.get(name)
            opened.loaded.page_data()
            revision = max(revision, opened.revision)
        instead.reading = False
        self._changed(name, revision)

    def message(self, name: str) -> Recording:
        """Return all that a page shows of the recording of that id."""
        if instead := self._sketch(name):
            return instead.message
        message, anew = self.get(name).message()
        if anew:
            self._changed(name, message.revision)
        return message

    def poses(self, name: str, n_samples: int) -> bytes:
        """Return the poses that a message named so many of; those of all it has, otherwise."""
        instead = self._sketcher.get(name)
        head = instead.message.motion if instead else None
        if instead is not None and head is not None and head.n_samples == n_samples:
            return instead.binary
        return self.get(name).loaded.page_data().binary

    def prepare(self, names: Iterable[str]) -> None:
        """Open recordings before they are asked for; what is wrong with one is said then."""
        for name in names:
            with suppress(KinemeError, UnknownError):
                self.message(name)

    def tables(self) -> FolderTables:
        """Return the tables of all recordings, those that were found and not saved among them."""
        listed = self.folder.recordings().items()
        return FolderTables(
            recordings=[FolderRecording(id=name, table=self._brief(each)) for name, each in listed]
        )

    def _brief(self, listed: ListedRecording) -> BriefTable | None:
        opened = self._open.get(listed.id)
        at = find_table_path(listed) if opened is None else opened.table_path
        found = read_brief(at) if at else None
        if found is None and opened is not None and not opened.finding:
            return summarize_table(opened.table)
        initial = self.folder.first_table(listed.path) if found is None else None
        return found if initial is None else summarize_table(initial)

    def renew(self) -> None:
        """Show what is known of open recordings now where nobody has saved a table."""
        for name, opened in list(self._open.items()):
            initial = self.folder.first_table(opened.path)
            if initial is not None and opened.renew(initial):
                self._changed(name, opened.revision)

    def take(self, name: str, make: Callable[[Segmentation], Segmentation]) -> bool:
        """Save what becomes of a recording's table, as `OpenRecording.take`."""
        opened = self.get(name)
        is_other = opened.take(make)
        if is_other:
            self._changed(name, opened.revision)
        return is_other

    def edit(self, name: str, sent: EditRequest) -> Edited:
        """Return what an edit made of the recording's table, as `OpenRecording.edit`."""
        if sent.revision == SKETCH_REVISION:
            raise ParameterError(STILL_FINDING)
        result = self.get(name).edit(
            sent.revision,
            sent.edit,
            self,
            name="" if sent.name is UNSET else sent.name,
        )
        self._changed(name, result.revision)
        return result

    def read_as(self, name: str, options: ReadOptions, *, everybody: bool = False) -> list[str]:
        """Read a file otherwise from now on; the ids of the recordings that are asked for.

        Tables are made anew, those before kept. Another take of the file has a table of its own,
        and so has each of several people in it, once one or ``everybody`` was chosen: these are as
        they were left. What ``options`` leave out is as for all. KinemeError where it cannot be
        read so: it is read as before.
        """
        listed = self.listed(name)
        changed, person = self._reader.change_options(listed, options, everybody=everybody)
        present = [each for each in self.folder.recordings().values() if each.path == listed.path]
        if name not in {each.id for each in present}:
            self._open.pop(name, None)
            self._sketcher.forget(name)
        for each in present:
            is_present = (
                each.id in self._open or self._sketcher.get(each.id) or find_table_path(each)
            )
            if changed and is_present:
                with suppress(ReadError):  # who is not in another take
                    self._open_anew(each, with_table=changed != {"take"})
        return [each.id for each in present if everybody or each.person in ("", person)]

    def _open_anew(self, listed: ListedRecording, *, with_table: bool) -> None:
        """Open a recording that is read otherwise now, and make its saved table anew."""
        former = self._open.get(listed.id)
        opened = self._opened(listed, former)
        if opened.table_path.exists() and with_table:
            shown = opened if former is None else former
            signals = not opened.loaded.is_motion
            opened.edit(opened.revision, make_repeat_request(shown.table, signals=signals), self)
        self._changed(listed.id, opened.revision)

    def extent(self, listed: ListedRecording) -> Extent:
        """How long a recording is, as `RecordingCache.extent`."""
        return self._cache.extent(listed)

    def progress(self, name: str) -> Progress:
        """Return what is being computed for a recording, which nobody opens for it."""
        opened = self._open.get(name)
        if opened is not None:
            return opened.loaded.runs.progress()
        instead = self._sketcher.get(name)
        return READING if instead is not None and instead.reading else NOTHING

    def cancel(self, name: str) -> None:
        """Have what is being computed for a recording end; one that is being read is not opened."""
        opened, instead = self._open.get(name), self._sketcher.get(name)
        if opened is not None:
            opened.loaded.runs.cancel()
        elif instead is not None:
            instead.is_open = False

    def knowledge_base(self, name: str) -> Path:
        """Return the file of the knowledge base of that id."""
        return _find_or_raise(self.folder.knowledge_bases(), name, "knowledge base")

    def annotation(self, name: str) -> Path:
        """Return the label file of that id."""
        return _find_or_raise(self.folder.annotations(), name, "label file")


def _find_or_raise(files: dict[str, File], name: str, what: str) -> File:
    if name not in files:
        raise UnknownError(f"there is no such {what}; it may have been taken away")
    return files[name]
