"""A library that pages look at: opened once, and again when others have changed it."""

from __future__ import annotations

import os
import threading
from collections import Counter
from contextlib import suppress
from pathlib import Path
from typing import Literal

from msgspec import structs

from kineme.library import Library
from kineme.library.storage.layout import EDITS, HEAD
from kineme.library.storage.places import is_remote
from kineme.studio.folder import Folder, file_id
from kineme.studio.library.names import call, name_of
from kineme.studio.library.searches import Searches
from kineme.studio.open_recordings import OpenRecordings
from kineme.studio.progress import progress
from kineme.studio.reading import ReadingOptions
from kineme.web.library_messages import (
    CallCluster,
    CallHits,
    JoinClusters,
    LibraryCluster,
    LibraryEdit,
    LibraryHit,
    LibraryHits,
    LibraryRecording,
    LibraryState,
    NamedHits,
    SearchRequest,
)


class ShownLibrary:
    """A library, as pages see it.

    Parameters
    ----------
    folder : Path

    Raises
    ------
    ReadError
        There is no library, it is damaged, or of another version.
    """

    def __init__(self, folder: Path):
        self._folder = folder
        self._lock = threading.Lock()
        self._searches = Searches()
        self._stamp = self._changed()
        self._library = Library(folder)

    def library(self) -> Library:
        """The library as it is on the disk now."""
        with self._lock:
            stamp = self._changed()
            if stamp != self._stamp:
                self._library, self._stamp = Library(self._folder), stamp
            return self._library

    def options(self) -> ReadingOptions:
        """How its recordings are read."""
        settings = self.library().settings
        return ReadingOptions(settings.options(), settings.effectors)

    def files(self) -> list[Path]:
        """The files of its recordings, without those at URLs."""
        library = self.library()
        found = (library.path_of(name) for name in library.recordings["recording"])
        return [path for path in found if not is_remote(path)]

    def as_folder(self) -> LibraryFolder:
        """Its recordings as a folder of the studio."""
        return LibraryFolder(self)

    def state(self) -> LibraryState:
        """All that the page shows but the figures."""
        library = self.library()
        told = library.recordings
        columns = (told[name] for name in ("recording", "path", "vocabulary", "duration_s"))
        return LibraryState(
            folder=str(self._folder.absolute()),
            hours=library.hours,
            recordings=[
                _recording(name, Path(path), kind, lasts)
                for name, path, kind, lasts in zip(*columns, strict=True)
            ],
            clusters=_clusters(library),
            failed=library.failed,
        )

    def edit(self, edit: LibraryEdit) -> LibraryState:
        """The library after an edit, which is on the disk."""
        library = self.library()
        with self._lock:
            if isinstance(edit, CallCluster):
                library.name(edit.cluster, edit.name.strip())
            elif isinstance(edit, JoinClusters):
                library.merge(edit.cluster, *edit.others)
            else:
                library.split(edit.cluster, edit.recordings)
            self._stamp = self._changed()
        return self.state()

    def search(self, sent: SearchRequest) -> LibraryHits:
        """What is like the examples; SupersededError where a newer search was asked for."""
        found = self._searches.search(self.library(), sent)
        return LibraryHits(hits=[self._with_name(hit) for hit in found.hits])

    def call(self, sent: CallHits, recordings: OpenRecordings) -> NamedHits:
        """Name the segments that hits show, in the tables beside their recordings."""
        hits = [(span, self._file(span.recording)) for span in sent.hits]
        return call(recordings, hits, sent.name.strip())

    def _with_name(self, hit: LibraryHit) -> LibraryHit:
        path = self._file(hit.recording)
        name = name_of(path, hit.start_s, hit.stop_s) if path else ""
        return structs.replace(hit, name=name) if name else hit

    def _file(self, recording: str) -> Path | None:
        """The file of a recording of the library, where it is there."""
        library = self.library()
        if recording not in {*library.recordings["recording"]}:
            return None
        path = library.path_of(recording)
        return None if is_remote(path) or not path.is_file() else path

    def _changed(self) -> tuple[int, ...]:
        """What is another one when somebody has written the library."""
        return tuple(_written(self._folder / name) for name in (HEAD, EDITS))


class LibraryFolder(Folder):
    """The recordings of a library as a folder of the studio, and files that came later.

    Parameters
    ----------
    shown : ShownLibrary
    """

    of_library = True

    def __init__(self, shown: ShownLibrary):
        super().__init__(_above(shown.files()), [])
        self._shown = shown

    def recordings(self) -> dict[str, Path]:
        """The recordings by id, whose files are there."""
        listed = {file_id(path): path for path in self._shown.files() if path.is_file()}
        return {**listed, **super().recordings()}


def _above(files: list[Path]) -> Path:
    """The folder that holds all files; that of the first where there is none."""
    folders = [str(path.absolute().parent) for path in files] or [str(Path.cwd())]
    with suppress(ValueError):  # several drives
        return Path(os.path.commonpath(folders))
    return Path(folders[0])


def _written(path: Path) -> int:
    try:
        return path.stat().st_mtime_ns
    except OSError:
        return 0


def _recording(name: str, path: Path, vocabulary: str, lasts: float) -> LibraryRecording:
    there = path.is_file()
    return LibraryRecording(
        recording=name,
        id=file_id(path) if there else "",
        status=_status(path) if there else "gone",
        vocabulary=vocabulary,
        duration_s=lasts,
    )


def _status(path: Path) -> Literal["as found", "corrected", "checked"]:
    said = progress(path)
    if said is None:
        return "as found"
    return "checked" if said.segments and said.checked == said.segments else "corrected"


def _clusters(library: Library) -> list[LibraryCluster]:
    rows = {name: row for row, name in enumerate(library.recordings["recording"])}
    words = library.table("words").select(["cluster", "recording"]).to_pydict()
    where: dict[int, set[int]] = {}
    for cluster, name in zip(words["cluster"], words["recording"], strict=True):
        where.setdefault(cluster, set()).add(rows[name])
    unsure = Counter(word.cluster for word in library.unsure())
    return [
        LibraryCluster(
            **{**each._asdict(), "recordings": sorted(where[each.cluster])},
            unsure=unsure[each.cluster],
        )
        for each in library.clusters()
    ]
