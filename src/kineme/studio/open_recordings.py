"""The open recordings of a folder, each found by its id.

A large recording is shown while it is read: poses evenly apart, without segments.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeVar

from msgspec import UNSET, Struct

from kineme._counts import counted
from kineme.errors import KinemeError, ParameterError, ReadError, SeveralPeopleError
from kineme.formats import sketch
from kineme.labels.collections import Extent
from kineme.segments.segmentation import Segmentation
from kineme.studio.choices import same_again
from kineme.studio.folder import Folder
from kineme.studio.loading import one_segment
from kineme.studio.open_recording import STILL_FINDING, OpenRecording
from kineme.studio.overview import brief_of, saved_brief
from kineme.studio.reading import ReadingOptions, RecordingCache
from kineme.studio.running import NOTHING, READING
from kineme.studio.storage.listed import ListedRecording
from kineme.studio.storage.sidecars import (
    Reading,
    given,
    keep_reading,
    options_of,
    read_options,
    reading_of,
    video_message,
)
from kineme.studio.storage.tables import usual_table
from kineme.web.messages import (
    BriefTable,
    Edited,
    FolderRecording,
    FolderTables,
    MatrixHead,
    Progress,
    Recording,
)
from kineme.web.requests import EditRequest

Listener = Callable[[str, int], None]
File = TypeVar("File", Path, ListedRecording)
MOST_DRAWN = 6
"""Recordings whose pictures stay in memory: those asked for last."""
LARGE = 16_000_000
"""Bytes of a file that takes more than a second to read."""
POSES = 18_000
"""Of a sketch, at most: five a second of an hour."""
OF_SKETCH = 0
"""The revision that a sketch has; tables have others."""
NO_OPTIONS = ReadingOptions()


class UnknownError(Exception):
    """There is no such recording, file or tile."""


class SupersededError(Exception):
    """Something newer was asked for."""


class OpenRecordings:
    """The recordings of a folder, each opened once.

    ``changed`` is called with id and revision when a table has changed.
    """

    def __init__(self, folder: Folder, changed: Listener, options: ReadingOptions = NO_OPTIONS):
        self.folder = folder
        self._changed = changed
        self._cache = RecordingCache(options)
        self._open: dict[str, OpenRecording] = {}
        self._asked: OrderedDict[str, None] = OrderedDict()
        self._sketches: dict[str, Sketched | None] = {}
        self._sketching = threading.Lock()
        self._lock = threading.Lock()
        self._opening: dict[str, threading.Lock] = {}

    def get(self, name: str) -> OpenRecording:
        """The recording of that id, opened if it is not, and again if its file has changed.

        UnknownError where none is listed, ReadError where it cannot be read.
        """
        self._forget_others(name)
        present = self._open.get(name)
        if present is not None and not present.loaded.changed():
            return present
        listed = _found(self.folder.recordings(), name, "recording")
        with self._lock:
            opening = self._opening.setdefault(name, threading.Lock())
        with opening:
            present = self._open.get(name)
            if present is None or present.loaded.changed():
                return self._opened(listed, present)
            return present

    def _opened(self, listed: ListedRecording, before: OpenRecording | None) -> OpenRecording:
        """Open a recording, perhaps once more, and say later when its segments are there."""
        self._check_person(listed)
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

    def _check_person(self, listed: ListedRecording) -> None:
        """SeveralPeopleError where nobody has said who of several people it is to be.

        Markers are read without being told; but which are whose people should know. Where a table
        of them has been saved, or a library was made of them, it is that person.
        """
        person = listed.person or read_options(listed, self._cache.options.file).person
        if person or self.folder.of_library or usual_table(listed):
            return
        people = self._cache.read(listed).provenance.people
        if len(people) > 1:
            reason = f"{counted(len(people), 'person')} are in it: choose one of them, or all"
            raise SeveralPeopleError(listed.path, reason, people)

    def _forget_others(self, name: str) -> None:
        """Let go of the pictures of recordings that nobody has asked for since many others."""
        with self._lock:
            self._asked[name] = None
            self._asked.move_to_end(name)
            while len(self._asked) > MOST_DRAWN:
                last, _ = self._asked.popitem(last=False)
                idle = self._open.get(last)
                if idle is not None:
                    idle.loaded.forget_pictures()
                    self._sketches.pop(last, None)

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

    def _sketch(self, name: str) -> Sketched | None:
        """What there is to show of a recording that is being read; made once, and read then."""
        if name in self._open:
            return None
        listed = _found(self.folder.recordings(), name, "recording")
        with self._sketching:
            if name not in self._sketches:
                made = self._sketches[name] = sketched(listed, self._cache.options)
                if made is not None:
                    self._in_background(lambda: self._read(name, made))
            present = self._sketches[name]
            if present is not None:
                present.is_open = True
        return present if present is not None and present.reading else None

    def _read(self, name: str, instead: Sketched) -> None:
        """Open a recording that is shown as a sketch, and say when it is there, or cannot be."""
        revision = OF_SKETCH + 1  # a page asks anew for any other than its own
        with suppress(KinemeError, UnknownError):
            self._cache.read(_found(self.folder.recordings(), name, "recording"))
            with self._sketching:
                if not instead.is_open:
                    self._sketches.pop(name, None)
                    return
            opened = self.get(name)
            opened.loaded.page_data()
            revision = max(revision, opened.revision)
        instead.reading = False
        self._changed(name, revision)

    def message(self, name: str) -> Recording:
        """All that a page shows of the recording of that id."""
        if instead := self._sketch(name):
            return instead.message
        message, anew = self.get(name).message()
        if anew:
            self._changed(name, message.revision)
        return message

    def poses(self, name: str, n_samples: int) -> bytes:
        """The poses that a message named so many of; those of all it has, otherwise."""
        instead = self._sketches.get(name)
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
        """The tables of all recordings, those that were found and not saved among them."""
        listed = self.folder.recordings().items()
        return FolderTables(
            recordings=[FolderRecording(id=name, table=self._brief(each)) for name, each in listed]
        )

    def _brief(self, listed: ListedRecording) -> BriefTable | None:
        opened = self._open.get(listed.id)
        at = usual_table(listed) if opened is None else opened.table_path
        found = saved_brief(at) if at else None
        if found is None and opened is not None and not opened.finding:
            return brief_of(opened.table)
        initial = self.folder.first_table(listed.path) if found is None else None
        return found if initial is None else brief_of(initial)

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
        """The recording's table after an edit, as `OpenRecording.edit` makes it."""
        if sent.revision == OF_SKETCH:
            raise ParameterError(STILL_FINDING)
        result = self.get(name).edit(
            sent.revision,
            sent.edit,
            self,
            name="" if sent.name is UNSET else sent.name,
            brief=False if sent.brief is UNSET else sent.brief,
        )
        self._changed(name, result.revision)
        return result

    def read_as(self, name: str, options: dict[str, Any], *, everybody: bool = False) -> list[str]:
        """Read a file otherwise from now on; the ids of the recordings that are asked for.

        Tables are made anew, those before kept. Another take of the file has a table of its own,
        and so has each of several people in it, once one or ``everybody`` was chosen: these are as
        they were left. Options have the names of `kineme.formats.ReadOptions`; others are as for
        all. KinemeError where it cannot be read so: it is read as before.
        """
        listed = _found(self.folder.recordings(), name, "recording")
        before = reading_of(listed.path)
        after, person = self._read_so(listed, Reading(given(options), before.people), everybody)
        keep_reading(listed.path, after)
        present = [each for each in self.folder.recordings().values() if each.path == listed.path]
        if name not in {each.id for each in present}:
            self._open.pop(name, None)
            self._sketches.pop(name, None)
        differ = after.differs_from(before)
        for each in present:
            is_present = each.id in self._open or self._sketches.get(each.id) or usual_table(each)
            if differ and is_present:
                with suppress(ReadError):  # who is not in another take
                    self._open_anew(each, with_table=differ != {"take"})
        return [each.id for each in present if everybody or each.person in ("", person)]

    def _read_so(
        self, listed: ListedRecording, choice: Reading, everybody: bool
    ) -> tuple[Reading, str]:
        """What to keep of how a file is read from now on, and which of several people was read.

        ``choice`` has the people of before. KinemeError where it cannot be read so.
        """
        people = self._cache.people(listed.path, choice) if everybody else ()
        person = people[0] if people else choice.options.get("person") or listed.person
        found = self._cache.read(ListedRecording(listed.path, person), choice).provenance
        people = people or found.people
        if self.folder.of_library:
            return choice, ""
        if len(people) < 2:
            return Reading(choice.options), ""
        before = options_of(listed.path).get("person", "")
        first = before if listed.person else self._first_person(listed)
        kept = choice.people if {*people} <= {*choice.people} and not everybody else people
        return Reading({**choice.options, "person": first}, kept), found.person or ""

    def _first_person(self, listed: ListedRecording) -> str:
        """Whose the table of a file is, where somebody was read before any were told apart."""
        if usual_table(listed) is None:
            return ""
        try:
            return self._cache.read(listed).provenance.person or ""
        except KinemeError:
            return ""

    def _open_anew(self, listed: ListedRecording, *, with_table: bool) -> None:
        """Open a recording that is read otherwise now, and make its saved table anew."""
        former = self._open.get(listed.id)
        opened = self._opened(listed, former)
        if opened.table_path.exists() and with_table:
            shown = opened if former is None else former
            signals = not opened.loaded.is_motion
            opened.edit(opened.revision, same_again(shown.table, signals=signals), self)
        self._changed(listed.id, opened.revision)

    def extent(self, listed: ListedRecording) -> Extent:
        """How long a recording is, as `RecordingCache.extent`."""
        return self._cache.extent(listed)

    def progress(self, name: str) -> Progress:
        """What is being computed for a recording, which nobody opens for it."""
        opened = self._open.get(name)
        if opened is not None:
            return opened.loaded.runs.progress()
        instead = self._sketches.get(name)
        return READING if instead is not None and instead.reading else NOTHING

    def cancel(self, name: str) -> None:
        """Have what is being computed for a recording end; one that is being read is not opened."""
        opened, instead = self._open.get(name), self._sketches.get(name)
        if opened is not None:
            opened.loaded.runs.cancel()
        elif instead is not None:
            instead.is_open = False

    def knowledge_base(self, name: str) -> Path:
        """The file of the knowledge base of that id."""
        return _found(self.folder.knowledge_bases(), name, "knowledge base")

    def annotation(self, name: str) -> Path:
        """The label file of that id."""
        return _found(self.folder.annotations(), name, "label file")


def _found(files: dict[str, File], name: str, what: str) -> File:
    if name not in files:
        raise UnknownError(f"there is no such {what}; it may have been taken away")
    return files[name]


class Sketched(Struct):
    """A recording that is being read, as a page shows it; ``binary`` are its poses.

    One that no page has open any more (``is_open``) is not opened once it is read.
    """

    message: Recording
    binary: bytes
    reading: bool = True
    is_open: bool = True


def sketched(listed: ListedRecording, options: ReadingOptions) -> Sketched | None:
    """What can be shown of a recording before it is read.

    None for a file that is soon read, or whose format has no shorter way.
    """
    from kineme.web.display import display_motion
    from kineme.web.page_data import segments_message

    path = listed.path
    try:
        if path.stat().st_size < LARGE:
            return None
        found = sketch(path, read_options(listed, options.file), POSES)
        if found is None:
            return None
        head, binary = display_motion(found.motion, effectors=options.effectors)
    except (OSError, KinemeError):  # reading will say what is wrong
        return None
    table = one_segment("transition", found.n_frames, found.fps)
    message = Recording(
        id=listed.id,
        name=listed.name,
        n_frames=found.n_frames,
        fps=found.fps,
        motion=head,
        matrix=MatrixHead(fps=1.0, tile=1, sizes=[], band=None),
        segmentation=segments_message(table),
        levels=[],
        video=video_message(path),
        reading=options_of(path),
        revision=OF_SKETCH,
        can_undo=False,
        can_redo=False,
        saved="",
        finding=True,
        being_read=True,
        warnings=[],
    )
    return Sketched(message, binary)
