"""A library in the studio: opened once, and reloaded when another program has changed it.

Its recordings are shown as a folder of the studio. A new search cancels the previous one. The name
of a hit is that of the segment it shows, from the table beside the recording. Naming hits changes
these tables, not the library. `LibraryApi` has the routes, also of small figures of spans.
"""

from __future__ import annotations

import os
import threading
from base64 import b64encode
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Literal, TypeVar

import numpy as np
from msgspec import UNSET, structs
from starlette.requests import Request
from starlette.routing import Route
from threadpoolctl import threadpool_limits

from kineme._util.checks import format_count
from kineme._util.files import is_remote
from kineme._util.parallel import map_threads
from kineme.errors import KinemeError, ParameterError
from kineme.formats import ReadOptions
from kineme.labels import read_segments
from kineme.library import Example, Library
from kineme.library.edits import read_edits
from kineme.library.finding import Named
from kineme.library.planning import read_recording
from kineme.methods.segmenter import SegmentOptions
from kineme.recordings import Motion, Signals
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment
from kineme.studio.folder import Folder, count_progress
from kineme.studio.http.bodies import make_route
from kineme.studio.library_tables import (
    LibraryHistory,
    LibraryTables,
    apply_library_clusters,
    match_library_clusters,
)
from kineme.studio.loading import Stamp, read_stamp
from kineme.studio.open_recording import ConflictError
from kineme.studio.open_recordings import OpenRecordings, SupersededError, UnknownError
from kineme.studio.storage.sidecars import ListedRecording, make_file_id
from kineme.studio.storage.tables import find_table_path
from kineme.web.display import display_motion
from kineme.web.library_messages import (
    CallCluster,
    CallEverywhere,
    CallHits,
    JoinClusters,
    LibraryCluster,
    LibraryEdit,
    LibraryFigure,
    LibraryHit,
    LibraryHits,
    LibraryRecording,
    LibraryState,
    NamedHits,
    PartCluster,
    SearchRequest,
    Span,
    TablesChanged,
    TablesRequest,
    UndoEdit,
)
from kineme.web.requests import EditRequest, NameSegment

MIN_OVERLAP = 1 / 3
"""Least overlap (intersection over union) of a hit and the segment that it shows. 1/3 is half of
each if both have the same length. Hits begin anywhere in a cycle, so a higher limit would drop half
of them.
"""
MAX_TABLES = 100
"""Tables cached in memory."""
TASKS_PER_CHECK = 8
"""Tasks of a search between two checks for a newer search."""
Task = TypeVar("Task")
Outcome = TypeVar("Outcome")
MAX_RECORDINGS = 4
"""Recordings cached in memory."""
MAX_FIGURE_S = 30.0
"""Longest span that a figure shows."""
MAX_CHANNELS, MAX_POINTS = 6, 120
"""Points of each curve; ``MAX_CHANNELS`` is the number of curves."""


class LibraryApi:
    """Routes under ``/api/library``."""

    def __init__(self, library: StudioLibrary, recordings: OpenRecordings):
        self._library, self._recordings = library, recordings
        self._reading = threading.Lock()

    def routes(self) -> list[Route]:
        library, recordings = self._library, self._recordings
        return [
            make_route("/api/library", lambda _: library.state()),
            make_route("/api/library/edits", self.edit, LibraryEdit),
            make_route(
                "/api/library/tables",
                lambda _, sent: library.update_tables(recordings, names=sent.names),
                TablesRequest,
            ),
            make_route(
                "/api/library/everywhere",
                lambda _, sent: library.rename_everywhere(sent, recordings),
                CallEverywhere,
            ),
            make_route("/api/library/search", lambda _, sent: library.search(sent), SearchRequest),
            make_route(
                "/api/library/names", lambda _, sent: library.name_hits(sent, recordings), CallHits
            ),
            make_route("/api/library/figure", self.figure),
        ]

    def edit(self, _: Request, sent: LibraryEdit) -> LibraryState:
        state = self._library.edit(sent)
        self._recordings.refresh_tables()
        return state

    def figure(self, request: Request) -> LibraryFigure:
        """Return the poses or curves of a span.

        ParameterError for an unknown recording or an empty span, ReadError if the file is missing.
        """
        query = request.query_params
        try:
            start_s, stop_s = float(query["start"]), float(query["stop"])
        except (KeyError, ValueError):
            raise ParameterError("a figure needs start and stop in seconds") from None
        library, name = self._library.library, query.get("recording", "")
        if not 0 <= start_s < stop_s:
            raise ParameterError("the stop of a figure must be after its start")
        with self._reading:  # a page requests many figures of a recording at once
            path = library.path_of(name)
            recording = _read_recording(path, library.read_options, read_stamp(path))
        span = recording.seconds(start_s, min(stop_s, start_s + MAX_FIGURE_S))
        return _make_figure(span, library.segment_options.effectors)


class StudioLibrary:
    """A library as pages see it; ReadError if it cannot be read."""

    def __init__(self, folder: Path):
        self._folder = folder
        self._lock = threading.Lock()
        self._searching = threading.Lock()
        self._newest_search = object()
        self.library = Library(folder)
        self._history = LibraryHistory(folder)
        self._tables: LibraryTables | None = None

    def find_table(self, path: Path) -> Segmentation | None:
        """Return the library's table of a recording; None if it has none."""
        segments = self.library.table("segments")
        with self._lock:
            if self._tables is None or self._tables.segments is not segments:
                self._tables = LibraryTables(self.library)
            tables = self._tables
        return tables.find_table(path)

    def options(self) -> tuple[ReadOptions, SegmentOptions]:
        """Return the options for reading and segmenting its recordings."""
        return self.library.read_options, self.library.segment_options

    def files(self) -> list[Path]:
        """Return the files of its recordings, without those at URLs."""
        names = self.library.recordings["recording"]
        paths = map(self.library.path_of, names)
        return [path for path in paths if not is_remote(path)]

    def as_folder(self) -> LibraryFolder:
        return LibraryFolder(self)

    def state(self) -> LibraryState:
        """Return everything that the page shows except the figures."""
        library = self.library
        columns = library.recordings
        names = ("recording", "path", "vocabulary", "duration_s")
        rows = zip(*(columns[name] for name in names), strict=True)
        return LibraryState(
            folder=str(self._folder.absolute()),
            hours=library.hours,
            recordings=[
                LibraryRecording(
                    recording=name,
                    id=make_file_id(Path(path)) if Path(path).is_file() else "",
                    status=_find_status(Path(path)),
                    vocabulary=vocabulary,
                    duration_s=duration_s,
                )
                for name, path, vocabulary, duration_s in rows
            ],
            clusters=_list_clusters(library),
            failed=library.failed,
            undo=self._history.last(),
        )

    def edit(self, edit: LibraryEdit) -> LibraryState:
        """Apply an edit, save it, and return the new state."""
        with self._lock:
            before = self._history.present()
            if isinstance(edit, UndoEdit):
                self._history.undo()
                self.library = Library(self._folder)
            else:
                self._history.add(_make_edit(self.library, edit), before)
        return self.state()

    def update_tables(self, recordings: OpenRecordings, *, names: bool) -> TablesChanged:
        """Update clusters and names of saved tables from the library, one undo step per table.

        Clusters with a different name keep it unless ``names`` is True.
        """
        n_changed, n_kept, failures = 0, 0, []
        edits = read_edits(self._folder)
        for path in self.files():
            library_table = (
                self.find_table(path) if find_table_path(ListedRecording(path)) else None
            )
            if library_table is None:
                continue
            n_others = 0

            def make(
                table: Segmentation, library_table: Segmentation = library_table
            ) -> Segmentation:
                nonlocal n_others
                after, n_others = apply_library_clusters(
                    table, library_table, edits, replace_names=names
                )
                return after

            try:
                n_changed += recordings.replace_table(make_file_id(path), make)
                n_kept += n_others
            except (KinemeError, UnknownError, ConflictError) as error:
                failures.append(f"{path.name}: {error}")
        return TablesChanged(tables=n_changed, others=n_kept, left=failures)

    def rename_everywhere(self, sent: CallEverywhere, recordings: OpenRecordings) -> TablesChanged:
        """Name the library cluster of a recording's cluster, in the library and in all tables."""
        opened = recordings.get(sent.recording)
        library_table = self.find_table(opened.path)
        cluster = (
            match_library_clusters(opened.table, library_table).get(sent.cluster)
            if library_table
            else None
        )
        if cluster is None:
            raise ParameterError(f"cluster {sent.cluster} is not a cluster of the library")
        self.edit(CallCluster(cluster=cluster, name=sent.label))
        recordings.refresh_tables()
        return self.update_tables(recordings, names=False)

    def search(self, sent: SearchRequest) -> LibraryHits:
        """Return the best matches; SupersededError if a newer search was started.

        ParameterError without anything to search for.
        """
        library, this_search = self.library, object()
        self._newest_search = this_search

        def check() -> None:
            if this_search is not self._newest_search:
                raise SupersededError("a newer search replaced this one")

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
                client=CancellableThreads(check),
            )
        return LibraryHits(hits=[self._add_name(LibraryHit(**hit._asdict())) for hit in hits])

    def name_hits(self, sent: CallHits, recordings: OpenRecordings) -> NamedHits:
        """Name the segments that hits show, in the tables beside their recordings.

        An empty name removes the name. Hits that cannot be named are reported.
        """
        named, failures = 0, []
        for span in sent.hits:
            try:
                self._name_hit(span, sent.name.strip(), recordings)
                named += 1
            except (KinemeError, UnknownError) as error:
                where = f"{span.recording}, {span.start_s:.2f} to {span.stop_s:.2f} s"
                failures.append(f"{where}: {error}")
        return NamedHits(named=named, left=failures)

    def _name_hit(self, span: Span, name: str, recordings: OpenRecordings) -> None:
        """Name the segment at a span of a recording, as an edit of its table."""
        path = self._find_file(span.recording)
        if path is None:
            raise UnknownError("its file is missing")
        opened = recordings.get(make_file_id(path))
        row = find_segment(opened.table, span.start_s, span.stop_s)
        if row is None:
            raise UnknownError("there is no segment")
        if row.label != name:
            edit = NameSegment(level=row.level, frame=row.start_frame, label=name)
            recordings.edit(opened.id, EditRequest(revision=opened.revision, edit=edit))

    def _add_name(self, hit: LibraryHit) -> LibraryHit:
        """Return a hit with the name of its segment in the saved table, if there is one."""
        path = self._find_file(hit.recording)
        table_path = find_table_path(ListedRecording(path)) if path else None
        table = _read_table(table_path, *read_stamp(table_path)) if table_path else None
        row = find_segment(table, hit.start_s, hit.stop_s) if table else None
        return structs.replace(hit, name=row.label) if row else hit

    def _find_file(self, recording: str) -> Path | None:
        """Return the file of a recording of the library, if it exists."""
        library = self.library
        if recording not in {*library.recordings["recording"]}:
            return None
        path = library.path_of(recording)
        return None if is_remote(path) or not path.is_file() else path


class LibraryFolder(Folder):
    """Recordings of a library as a folder of the studio, plus files that were added later."""

    is_library = True

    def __init__(self, library: StudioLibrary):
        super().__init__(_find_common_folder(library.files()), [])
        self._library = library

    def first_table(self, path: Path) -> Segmentation | None:
        return self._library.find_table(path)

    def recordings(self) -> dict[str, ListedRecording]:
        """Return the recordings whose files exist, by id.

        A library has only one person of a file.
        """
        files = [path for path in self._library.files() if path.is_file()]
        return {
            **{make_file_id(path): ListedRecording(path) for path in files},
            **super().recordings(),
        }


class CancellableThreads:
    """Executor with threads of this process; ``check`` is called regularly and may raise."""

    def __init__(self, check: Callable[[], None]):
        self._check = check

    def completed(
        self, work: Callable[[Task], Outcome], tasks: Sequence[Task]
    ) -> Iterator[tuple[Task, Outcome | None]]:
        """Yield each task with its result; see `kineme.library.executors.Executor`."""
        for first in range(0, len(tasks), TASKS_PER_CHECK):
            self._check()
            chunk = tasks[first : first + TASKS_PER_CHECK]
            with threadpool_limits(1):
                yield from zip(chunk, map_threads(work, chunk), strict=True)


def find_segment(table: Segmentation, start_s: float, stop_s: float) -> Segment | None:
    """Return the segment that a span shows, on the level that fits best.

    None if no segment overlaps it enough.
    """

    def measure_overlap(row: Segment) -> float:
        intersection = min(row.stop_s, stop_s) - max(row.start_s, start_s)
        return intersection / (max(row.stop_s, stop_s) - min(row.start_s, start_s))

    best = max(table, key=measure_overlap, default=None)
    return best if best is not None and measure_overlap(best) >= MIN_OVERLAP else None


def _make_edit(library: Library, edit: CallCluster | JoinClusters | PartCluster) -> str:
    """Apply an edit of the clusters and return a description of it."""
    if isinstance(edit, CallCluster):
        library.name(edit.cluster, edit.name.strip())
        return f"cluster {edit.cluster} is called “{edit.name.strip()}”"
    if isinstance(edit, JoinClusters):
        library.merge(edit.cluster, *edit.others)
        return f"{format_count(len(edit.others), 'cluster')} merged into {edit.cluster}"
    into = library.split(edit.cluster, edit.recordings)
    return f"cluster {into} split from {edit.cluster}"


def _find_common_folder(files: list[Path]) -> Path:
    """Return the folder that holds all files; that of the first if there is none."""
    folders = [str(path.absolute().parent) for path in files] or [str(Path.cwd())]
    with suppress(ValueError):  # on several drives
        return Path(os.path.commonpath(folders))
    return Path(folders[0])


def _find_status(path: Path) -> Literal["gone", "as found", "corrected", "checked"]:
    if not path.is_file():
        return "gone"
    counts = count_progress(ListedRecording(path))
    if counts is None:
        return "as found"
    return "checked" if counts.segments and counts.checked == counts.segments else "corrected"


def _list_clusters(library: Library) -> list[LibraryCluster]:
    rows = {name: row for row, name in enumerate(library.recordings["recording"])}
    local_clusters = library.table("local_clusters").select(["cluster", "recording"]).to_pydict()
    rows_by_cluster: dict[int, set[int]] = {}
    for cluster, name in zip(local_clusters["cluster"], local_clusters["recording"], strict=True):
        rows_by_cluster.setdefault(cluster, set()).add(rows[name])
    unsure = Counter(part["cluster"] for part in library.unsure())
    return [
        LibraryCluster(
            **{**cluster._asdict(), "recordings": sorted(rows_by_cluster[cluster.cluster])},
            unsure=unsure[cluster.cluster],
        )
        for cluster in library.clusters()
    ]


@lru_cache(MAX_TABLES)
def _read_table(path: Path, *_: int) -> Segmentation | None:
    """Return the table in a file; None if it is no table. The stamp is part of the cache key."""
    try:
        return read_segments(path, format="json")
    except KinemeError:
        return None


def _make_examples(spans: Sequence[Span], names: set[str]) -> list[Example]:
    """Return spans as examples; only recordings of the library are accepted."""
    for span in spans:
        if span.recording not in names:
            raise ParameterError(f"the library has no recording {span.recording!r:.80}")
    return [Example(Named(span.recording), span.start_s, span.stop_s) for span in spans]


@lru_cache(MAX_RECORDINGS)
def _read_recording(path: Path, options: ReadOptions, _: Stamp) -> Motion | Signals:
    """Return a recording of a library; the stamp of its file is part of the cache key."""
    return read_recording(path, options)


def _make_figure(
    span: Motion | Signals, effectors: Mapping[str, str] | Sequence[str] | None
) -> LibraryFigure:
    if isinstance(span, Signals):
        return LibraryFigure(motion=None, numbers="", curves=_sample_curves(span))
    try:
        head, numbers = display_motion(span, effectors=effectors)
    except KinemeError:  # this skeleton lacks the named effectors
        head, numbers = display_motion(span)
    return LibraryFigure(motion=head, numbers=b64encode(numbers).decode(), curves=[])


def _sample_curves(signals: Signals) -> list[list[float]]:
    """Return the first channels, thinned and scaled to 0 to 1; missing values become 0.5."""
    step = max(1, signals.n_frames // MAX_POINTS)
    samples = signals.values[::step, :MAX_CHANNELS].astype(float)
    low, high = np.nanmin(samples, axis=0), np.nanmax(samples, axis=0)
    scaled = (samples - low) / np.where(high > low, high - low, 1)
    curves: list[list[float]] = np.nan_to_num(scaled, nan=0.5).T.round(3).tolist()
    return curves
