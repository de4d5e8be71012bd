"""Recordings from files: those used last stay in memory."""

from __future__ import annotations

import threading
from collections import OrderedDict
from pathlib import Path
from typing import TYPE_CHECKING

from kineme.errors import ReadError
from kineme.formats import ReadOptions, list_people, read_analog, read_quietly
from kineme.labels.collections import Extent
from kineme.methods.segmenter import SegmentOptions
from kineme.studio.poses import require_poses
from kineme.studio.storage.listed import ListedRecording
from kineme.studio.storage.sidecars import resolve_read_options

if TYPE_CHECKING:
    from kineme.recordings import Motion, Signals

MOST_IN_MEMORY = 3
"""Recordings; that of an hour can have most of a gigabyte."""
Stamp = tuple[int, int]


class RecordingCache:
    """Recordings used last; several can be read at once.

    They are read and segmented with these options where people say nothing else of one.
    """

    def __init__(
        self, read_options: ReadOptions | None = None, segment_options: SegmentOptions | None = None
    ) -> None:
        self.read_options = read_options or ReadOptions()
        self.segment_options = segment_options or SegmentOptions()
        self._lock = threading.Lock()
        self._reading: dict[tuple[Path, Stamp, str], threading.Lock] = {}
        self._recent: OrderedDict[tuple[Path, Stamp, str], Motion | Signals] = OrderedDict()
        self._extents: dict[tuple[Path, Stamp, str], Extent] = {}

    def read(self, listed: ListedRecording, choice: ReadOptions | None = None) -> Motion | Signals:
        """A recording, read from its file if it is not in memory; ReadError where it cannot be.

        PosesNeededError for a video whose poses have not been estimated.

        It is read as people said of it, or as a ``choice`` says. Its provenance has what there is
        to warn of.
        """
        path, options = listed.path, resolve_read_options(listed, self.read_options, choice)
        key = path, read_stamp(path), repr(options)
        with self._lock:
            reading = self._reading.setdefault(key, threading.Lock())
        with reading:
            with self._lock:
                former = self._recent.get(key)
            if former is None:
                require_poses(path)
            found = read_quietly(path, options) if former is None else former
            with self._lock:
                self._recent[key] = found
                self._recent.move_to_end(key)
                while len(self._recent) > MOST_IN_MEMORY:
                    self._recent.popitem(last=False)
                self._reading.pop(key, None)
        return found

    def extent(self, listed: ListedRecording) -> Extent:
        """How long a recording is, for which it is read once."""
        options = resolve_read_options(listed, self.read_options)
        key = listed.path, read_stamp(listed.path), repr(options)
        if key not in self._extents:
            found = self.read(listed)
            self._extents[key] = Extent(found.n_frames, found.fps, found.provenance.clock)
        return self._extents[key]

    def people(self, path: Path, choice: ReadOptions) -> tuple[str, ...]:
        """Those in a file that is read so, where there are several; it is read for it."""
        return list_people(
            path, resolve_read_options(ListedRecording(path), self.read_options, choice)
        )

    def analog(self, listed: ListedRecording) -> Signals | None:
        """Return the channels beside the motion in a file, read each time.

        None where there are none.
        """
        return read_analog(listed.path, resolve_read_options(listed, self.read_options))


def read_stamp(path: Path) -> Stamp:
    """What changes when a file is written: nanoseconds and bytes; ReadError where it is gone."""
    try:
        found = path.stat()
    except OSError as error:
        raise ReadError(path, f"cannot be opened: {error.strerror or error}") from error
    return found.st_mtime_ns, found.st_size
