"""A library in the studio: opened once, and again when others have changed it.

Its recordings are a folder of the studio. A search ends the one before it. A hit is called as the
segment is that it shows: a segment and its name are in the table beside the recording, as
everything is that the studio corrects; nothing changes in the library.
"""

from __future__ import annotations

import os
import threading
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from functools import lru_cache
from itertools import count
from pathlib import Path
from typing import Literal, TypeVar

from msgspec import UNSET, structs
from threadpoolctl import threadpool_limits

from kineme._util.checks import format_count
from kineme._util.parallel import map_threads
from kineme.errors import KinemeError, ParameterError
from kineme.formats import ReadOptions
from kineme.labels import read_segments
from kineme.library import Example, Library
from kineme.library.edits import read_edits
from kineme.library.searching import Named
from kineme.library.storage.layout import EDITS, HEAD
from kineme.library.storage.places import is_remote
from kineme.methods.segmenter import SegmentOptions
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment
from kineme.studio.folder import Folder, count_progress
from kineme.studio.library_history import LibraryHistory
from kineme.studio.library_tables import (
    LibraryTables,
    apply_library_clusters,
    match_library_clusters,
)
from kineme.studio.open_recording import ConflictError
from kineme.studio.open_recordings import OpenRecordings, SupersededError, UnknownError
from kineme.studio.reading import read_stamp
from kineme.studio.storage.listed import ListedRecording, make_file_id
from kineme.studio.storage.tables import find_table_path
from kineme.web.library_messages import (
    CallCluster,
    CallEverywhere,
    CallHits,
    JoinClusters,
    LibraryCluster,
    LibraryEdit,
    LibraryHit,
    LibraryHits,
    LibraryRecording,
    LibraryState,
    NamedHits,
    PartCluster,
    SearchRequest,
    Span,
    TablesChanged,
    UndoEdit,
)
from kineme.web.requests import EditRequest, NameSegment

SAME = 1 / 3
"""Seconds in common over those in either from which a hit shows a segment: half of each, where
both are as long. Hits begin anywhere in a cycle, so that more would leave half of them out."""
MOST_TABLES = 100
"""In memory."""
AT_ONCE = 8
"""Tasks of a search between two looks for a newer one."""
Task = TypeVar("Task")
Outcome = TypeVar("Outcome")


class ShownLibrary:
    """A library, as pages see it; ReadError where there is none that can be read."""

    def __init__(self, folder: Path):
        self._folder = folder
        self._lock = threading.Lock()
        self._searches = Searches()
        self._stamp = self._changed()
        self._library = Library(folder)
        self._history = LibraryHistory(folder)
        self._tables: LibraryTables | None = None

    def library(self) -> Library:
        """Return the library as it is on the disk now."""
        with self._lock:
            stamp = self._changed()
            if stamp != self._stamp:
                self._library, self._stamp = Library(self._folder), stamp
                self._tables = None
            return self._library

    def table_of(self, path: Path) -> Segmentation | None:
        """Return the table of a recording as the library has it; None where it has none."""
        library = self.library()
        with self._lock:
            if self._tables is None:
                self._tables = LibraryTables(library)
            tables = self._tables
        return tables.of(path)

    def options(self) -> tuple[ReadOptions, SegmentOptions]:
        """Return how its recordings are read and segmented."""
        library = self.library()
        return library.read_options, library.segment_options

    def files(self) -> list[Path]:
        """Return the files of its recordings, without those at URLs."""
        library = self.library()
        found = (library.path_of(name) for name in library.recordings["recording"])
        return [path for path in found if not is_remote(path)]

    def as_folder(self) -> LibraryFolder:
        """Its recordings as a folder of the studio."""
        return LibraryFolder(self)

    def state(self) -> LibraryState:
        """Return all that the page shows but the figures."""
        library = self.library()
        columns = library.recordings
        rows = zip(
            *(columns[name] for name in ("recording", "path", "vocabulary", "duration_s")),
            strict=True,
        )
        return LibraryState(
            folder=str(self._folder.absolute()),
            hours=library.hours,
            recordings=[
                _describe_recording(name, Path(path), kind, lasts)
                for name, path, kind, lasts in rows
            ],
            clusters=_list_clusters(library),
            failed=library.failed,
            undo=self._history.last(),
        )

    def edit(self, edit: LibraryEdit) -> LibraryState:
        """Return the library after an edit, which is on the disk."""
        library = self.library()
        with self._lock:
            before = self._history.present()
            if isinstance(edit, UndoEdit):
                self._history.undo()
                self._library = Library(self._folder)
            else:
                self._history.add(_make_edit(library, edit), before)
            self._stamp, self._tables = self._changed(), None
        return self.state()

    def update_tables(self, recordings: OpenRecordings, *, names: bool) -> TablesChanged:
        """Give saved tables the numbers and names of the library, each as one step of undo.

        Clusters that have another name keep it, unless ``names``.
        """
        changed, kept, left = 0, 0, []
        edits = read_edits(self._folder)
        for path in self.files():
            of_library = self.table_of(path) if find_table_path(ListedRecording(path)) else None
            if of_library is None:
                continue
            others = 0

            def make(table: Segmentation, of_library: Segmentation = of_library) -> Segmentation:
                nonlocal others
                after, others = apply_library_clusters(
                    table, of_library, edits, replace_names=names
                )
                return after

            try:
                changed += recordings.take(make_file_id(path), make)
                kept += others
            except (KinemeError, UnknownError, ConflictError) as error:
                left.append(f"{path.name}: {error}")
        return TablesChanged(tables=changed, others=kept, left=left)

    def call_everywhere(self, sent: CallEverywhere, recordings: OpenRecordings) -> TablesChanged:
        """Name the cluster of the library that one of a recording is, there and in all tables."""
        opened = recordings.get(sent.recording)
        of_library = self.table_of(opened.path)
        place = (
            match_library_clusters(opened.table, of_library).get(sent.cluster)
            if of_library
            else None
        )
        if place is None:
            raise ParameterError(f"cluster {sent.cluster} is none of the library")
        self.edit(CallCluster(cluster=place, name=sent.label))
        recordings.renew()
        return self.update_tables(recordings, names=False)

    def search(self, sent: SearchRequest) -> LibraryHits:
        """Return what is like the examples; SupersededError where a newer search was asked for."""
        found = self._searches.search(self.library(), sent)
        return LibraryHits(hits=[self._with_name(hit) for hit in found.hits])

    def call(self, sent: CallHits, recordings: OpenRecordings) -> NamedHits:
        """Name the segments that hits show, in the tables beside their recordings."""
        hits = [(span, self._file(span.recording)) for span in sent.hits]
        return name_hits(recordings, hits, sent.name.strip())

    def _with_name(self, hit: LibraryHit) -> LibraryHit:
        path = self._file(hit.recording)
        name = find_segment_name(path, hit.start_s, hit.stop_s) if path else ""
        return structs.replace(hit, name=name) if name else hit

    def _file(self, recording: str) -> Path | None:
        """Return the file of a recording of the library, where it is there."""
        library = self.library()
        if recording not in {*library.recordings["recording"]}:
            return None
        path = library.path_of(recording)
        return None if is_remote(path) or not path.is_file() else path

    def _changed(self) -> tuple[int, ...]:
        """Return what is another one when somebody has written the library."""
        return tuple(_read_modified(self._folder / name) for name in (HEAD, EDITS))


class LibraryFolder(Folder):
    """Recordings of a library as a folder of the studio, and files that came later."""

    of_library = True

    def __init__(self, shown: ShownLibrary):
        super().__init__(_find_common_folder(shown.files()), [])
        self._shown = shown

    def first_table(self, path: Path) -> Segmentation | None:
        """Return the table of a recording as the library has it."""
        return self._shown.table_of(path)

    def recordings(self) -> dict[str, ListedRecording]:
        """Return the recordings by id, whose files are there.

        Of several people the library has one.
        """
        files = [path for path in self._shown.files() if path.is_file()]
        return {
            **{make_file_id(path): ListedRecording(path) for path in files},
            **super().recordings(),
        }


class Searches:
    """Searches, each of which ends those before it."""

    def __init__(self) -> None:
        self._numbers = count(1)
        self._newest = 0
        self._searching = threading.Lock()

    def search(self, library: Library, sent: SearchRequest) -> LibraryHits:
        """Return what a library has that is like the examples.

        SupersededError where a newer search was asked for meanwhile, ParameterError where there is
        nothing to search for.
        """
        number = self._newest = next(self._numbers)

        def check() -> None:
            if number != self._newest:
                raise SupersededError("a newer search took the place of this one")

        names = {*library.recordings["recording"]}
        with self._searching:
            check()
            hits = library.search(
                _make_examples(sent.like, names),
                cluster=None if sent.cluster is UNSET else sent.cluster,
                unlike=_make_examples(sent.unlike, names),
                threshold=sent.threshold,
                top=sent.top,
                mirror=sent.mirror,
                client=Interruptible(check),
            )
        return LibraryHits(hits=[LibraryHit(**hit._asdict()) for hit in hits])


class Interruptible:
    """Threads of this process; ``check``, called now and then, raises what ends the work."""

    def __init__(self, check: Callable[[], None]):
        self._check = check

    def completed(
        self, work: Callable[[Task], Outcome], tasks: Sequence[Task]
    ) -> Iterator[tuple[Task, Outcome | None]]:
        """Yield each task and what came of it; see `kineme.library.executors.Executor`."""
        for first in range(0, len(tasks), AT_ONCE):
            self._check()
            some = tasks[first : first + AT_ONCE]
            with threadpool_limits(1):
                yield from zip(some, map_threads(work, some), strict=True)


def find_segment(table: Segmentation, start_s: float, stop_s: float) -> Segment | None:
    """Return the segment that a span shows, of the level that fits it best.

    None where none does.
    """

    def share(row: Segment) -> float:
        common = min(row.stop_s, stop_s) - max(row.start_s, start_s)
        return common / (max(row.stop_s, stop_s) - min(row.start_s, start_s))

    best = max(table, key=share, default=None)
    return best if best is not None and share(best) >= SAME else None


def find_segment_name(recording: Path, start_s: float, stop_s: float) -> str:
    """What the segment that a span shows is called in the table beside its recording, if at all."""
    path = find_table_path(ListedRecording(recording))
    table = _read_table(path, *read_stamp(path)) if path else None
    row = find_segment(table, start_s, stop_s) if table is not None else None
    return row.label if row is not None else ""


def name_hits(
    recordings: OpenRecordings, hits: Iterable[tuple[Span, Path | None]], name: str
) -> NamedHits:
    """Give the segments that hits show a name; what cannot be named costs itself.

    Hits come with the files of their recordings, where those are there; an empty name takes it
    away.
    """
    named, failures = 0, []
    for span, path in hits:
        where = f"{span.recording}, {span.start_s:.2f} to {span.stop_s:.2f} s"
        if path is None:
            failures.append(f"{where}: its file is not there")
            continue
        try:
            opened = recordings.get(make_file_id(path))
            row = find_segment(opened.table, span.start_s, span.stop_s)
            if row is None:
                failures.append(f"{where}: no segment lies there")
                continue
            if row.label != name:
                edit = NameSegment(level=row.level, frame=row.start_frame, label=name)
                recordings.edit(opened.id, EditRequest(revision=opened.revision, edit=edit))
            named += 1
        except (KinemeError, UnknownError) as error:
            failures.append(f"{where}: {error}")
    return NamedHits(named=named, left=failures)


def _make_edit(library: Library, edit: CallCluster | JoinClusters | PartCluster) -> str:
    """Make an edit of the clusters of a library; what it was, in words."""
    if isinstance(edit, CallCluster):
        library.name(edit.cluster, edit.name.strip())
        return f"cluster {edit.cluster} is called “{edit.name.strip()}”"
    if isinstance(edit, JoinClusters):
        library.merge(edit.cluster, *edit.others)
        return f"{format_count(len(edit.others), 'cluster')} merged into {edit.cluster}"
    into = library.split(edit.cluster, edit.recordings)
    return f"cluster {into} split from {edit.cluster}"


def _find_common_folder(files: list[Path]) -> Path:
    """Return the folder that holds all files; that of the first where there is none."""
    folders = [str(path.absolute().parent) for path in files] or [str(Path.cwd())]
    with suppress(ValueError):  # several drives
        return Path(os.path.commonpath(folders))
    return Path(folders[0])


def _read_modified(path: Path) -> int:
    try:
        return path.stat().st_mtime_ns
    except OSError:
        return 0


def _describe_recording(name: str, path: Path, vocabulary: str, lasts: float) -> LibraryRecording:
    exists = path.is_file()
    return LibraryRecording(
        recording=name,
        id=make_file_id(path) if exists else "",
        status=_find_status(path) if exists else "gone",
        vocabulary=vocabulary,
        duration_s=lasts,
    )


def _find_status(path: Path) -> Literal["as found", "corrected", "checked"]:
    counts = count_progress(ListedRecording(path))
    if counts is None:
        return "as found"
    return "checked" if counts.segments and counts.checked == counts.segments else "corrected"


def _list_clusters(library: Library) -> list[LibraryCluster]:
    rows = {name: row for row, name in enumerate(library.recordings["recording"])}
    local = library.table("local_clusters").select(["cluster", "recording"]).to_pydict()
    where: dict[int, set[int]] = {}
    for cluster, name in zip(local["cluster"], local["recording"], strict=True):
        where.setdefault(cluster, set()).add(rows[name])
    unsure = Counter(each["cluster"] for each in library.unsure())
    return [
        LibraryCluster(
            **{**each._asdict(), "recordings": sorted(where[each.cluster])},
            unsure=unsure[each.cluster],
        )
        for each in library.clusters()
    ]


@lru_cache(MOST_TABLES)
def _read_table(path: Path, *_: int) -> Segmentation | None:
    """Of the file as it was at that time; None where it is no table."""
    try:
        return read_segments(path, format="json")
    except KinemeError:
        return None


def _make_examples(spans: Sequence[Span], names: set[str]) -> list[Example]:
    """Spans as examples, each of a recording of the library and of no other file."""
    for span in spans:
        if span.recording not in names:
            raise ParameterError(f"the library has no recording {span.recording!r:.80}")
    return [Example(Named(span.recording), span.start_s, span.stop_s) for span in spans]
