"""Read recordings and cache the most recently used ones."""

from __future__ import annotations

import threading
from collections import OrderedDict
from pathlib import Path
from typing import TYPE_CHECKING

from kineme.errors import ReadError
from kineme.formats import ReadOptions, list_people, read_analog, read_quietly
from kineme.labels.collections import Extent
from kineme.methods.segmenter import SegmentOptions
from kineme.studio.jobs import require_poses
from kineme.studio.storage.sidecars import ListedRecording, resolve_read_options

if TYPE_CHECKING:
    from kineme.recordings import Motion, Signals

MAX_RECORDINGS = 3
"""Recordings in memory; an hour can take almost a gigabyte."""
Stamp = tuple[int, int]
"""Modification time in nanoseconds, and size in bytes."""


class RecordingCache:
    """Cache of recordings; several can be read at once.

    The options given here apply unless the user set others for a recording.
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
        """Return a recording, from memory or from its file; ReadError if it cannot be read.

        ``choice`` replaces the saved options of the recording. PosesNeededError for a video whose
        poses have not been estimated. Warnings are in the provenance of the result.
        """
        path, options = listed.path, resolve_read_options(listed, self.read_options, choice)
        key = path, read_stamp(path), repr(options)
        with self._lock:
            reading = self._reading.setdefault(key, threading.Lock())
        with reading:
            with self._lock:
                cached = self._recent.get(key)
            if cached is None:
                require_poses(path)
            recording = read_quietly(path, options) if cached is None else cached
            with self._lock:
                self._recent[key] = recording
                self._recent.move_to_end(key)
                while len(self._recent) > MAX_RECORDINGS:
                    self._recent.popitem(last=False)
                self._reading.pop(key, None)
        return recording

    def extent(self, listed: ListedRecording) -> Extent:
        """Return the length of a recording, which is read once for this."""
        options = resolve_read_options(listed, self.read_options)
        key = listed.path, read_stamp(listed.path), repr(options)
        if key not in self._extents:
            recording = self.read(listed)
            self._extents[key] = Extent(
                recording.n_frames, recording.fps, recording.provenance.clock
            )
        return self._extents[key]

    def people(self, path: Path, choice: ReadOptions) -> tuple[str, ...]:
        """Return the people in a file; empty if it does not have several."""
        return list_people(
            path, resolve_read_options(ListedRecording(path), self.read_options, choice)
        )

    def analog(self, listed: ListedRecording) -> Signals | None:
        """Read the analog channels beside a motion, uncached; None if there are none."""
        return read_analog(listed.path, resolve_read_options(listed, self.read_options))


def read_stamp(path: Path) -> Stamp:
    """Return modification time and size of a file; ReadError if it is missing."""
    try:
        status = path.stat()
    except OSError as error:
        raise ReadError(path, f"cannot be opened: {error.strerror or error}") from error
    return status.st_mtime_ns, status.st_size
