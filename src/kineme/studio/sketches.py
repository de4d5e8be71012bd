"""Show a large recording while it is read: a sample of its poses, without segments."""

from __future__ import annotations

import threading
from collections.abc import Callable

from msgspec import Struct

from kineme._util.json import options_to_json
from kineme.errors import KinemeError
from kineme.formats import sketch
from kineme.studio.loading import make_single_segment
from kineme.studio.recording_cache import RecordingCache
from kineme.studio.storage.listed_recording import ListedRecording
from kineme.studio.storage.sidecars import (
    make_video_message,
    read_saved_options,
    resolve_read_options,
)
from kineme.web.messages import MatrixHead, Recording

LARGE_FILE = 16_000_000
"""Bytes from which a file takes more than a second to read."""
MAX_POSES = 18_000
"""Poses of a sketch: five per second for an hour."""
SKETCH_REVISION = 0
"""Revision of a sketch; tables have higher ones."""


class Sketch(Struct):
    """Preview of a recording that is being read; ``binary`` holds its poses.

    If no page has it open any more (``is_open``), the recording is not opened once it is read.
    """

    message: Recording
    binary: bytes
    reading: bool = True
    is_open: bool = True


class Sketcher:
    """Sketches of recordings, by id."""

    def __init__(self, cache: RecordingCache):
        self._cache = cache
        self._sketches: dict[str, Sketch | None] = {}
        self._lock = threading.Lock()

    def open(self, listed: ListedRecording, read: Callable[[Sketch], None]) -> Sketch | None:
        """Return the sketch of a recording while it is being read, if its format allows one.

        ``read`` is called when the sketch is made and starts to read the recording.
        """
        with self._lock:
            if listed.id not in self._sketches:
                sketch = self._sketches[listed.id] = draw_sketch(listed, self._cache)
                if sketch is not None:
                    read(sketch)
            sketch = self._sketches[listed.id]
            if sketch is not None:
                sketch.is_open = True
        return sketch if sketch is not None and sketch.reading else None

    def get(self, name: str) -> Sketch | None:
        """Return the sketch of a recording, even if the recording has been read since."""
        return self._sketches.get(name)

    def forget(self, name: str) -> None:
        """Drop the sketch of a recording."""
        self._sketches.pop(name, None)

    def forget_closed(self, sketch: Sketch) -> bool:
        """Drop a sketch that no page has open; return whether it was dropped."""
        with self._lock:
            if not sketch.is_open:
                self.forget(sketch.message.id)
            return not sketch.is_open


def draw_sketch(listed: ListedRecording, cache: RecordingCache) -> Sketch | None:
    """Return a preview of a recording that has not been read yet.

    None for a file that is read quickly, or whose format offers no preview.
    """
    from kineme.web.display import display_motion
    from kineme.web.tables import make_segments_message

    path = listed.path
    try:
        if path.stat().st_size < LARGE_FILE:
            return None
        preview = sketch(path, resolve_read_options(listed, cache.read_options), MAX_POSES)
        if preview is None:
            return None
        effectors = cache.segment_options.effectors
        head, binary = display_motion(preview.motion, effectors=effectors)
    except (OSError, KinemeError):  # reading the file will report it
        return None
    table = make_single_segment("transition", preview.n_frames, preview.fps)
    message = Recording(
        id=listed.id,
        name=listed.name,
        n_frames=preview.n_frames,
        fps=preview.fps,
        motion=head,
        matrix=MatrixHead(fps=1.0, tile=1, sizes=[]),
        segmentation=make_segments_message(table),
        levels=[],
        video=make_video_message(path),
        read_options=options_to_json(read_saved_options(path)),
        revision=SKETCH_REVISION,
        can_undo=False,
        can_redo=False,
        saved="",
        finding=True,
        being_read=True,
        warnings=[],
    )
    return Sketch(message, binary)
