"""Show a large recording while it is read: poses evenly apart, without segments."""

from __future__ import annotations

import threading
from collections.abc import Callable

from msgspec import Struct

from kineme._util.json import options_to_json
from kineme.errors import KinemeError
from kineme.formats import sketch
from kineme.studio.loading import make_single_segment
from kineme.studio.reading import RecordingCache
from kineme.studio.storage.listed import ListedRecording
from kineme.studio.storage.sidecars import (
    make_video_message,
    read_saved_options,
    resolve_read_options,
)
from kineme.web.messages import MatrixHead, Recording

LARGE = 16_000_000
"""Bytes of a file that takes more than a second to read."""
POSES = 18_000
"""Of a sketch, at most: five a second of an hour."""
SKETCH_REVISION = 0
"""Revision that a sketch has; tables have others."""


class Sketch(Struct):
    """A recording that is being read, as a page shows it; ``binary`` holds its poses.

    One that no page has open any more (``is_open``) is not opened once it is read.
    """

    message: Recording
    binary: bytes
    reading: bool = True
    is_open: bool = True


class Sketcher:
    """Sketches of recordings, by their ids."""

    def __init__(self, cache: RecordingCache):
        self._cache = cache
        self._sketches: dict[str, Sketch | None] = {}
        self._lock = threading.Lock()

    def open(self, listed: ListedRecording, read: Callable[[Sketch], None]) -> Sketch | None:
        """Return what there is to show of a recording that is being read, if anything.

        It is made once; ``read``, which starts to read the recording, is called then.
        """
        with self._lock:
            if listed.id not in self._sketches:
                made = self._sketches[listed.id] = draw_sketch(listed, self._cache)
                if made is not None:
                    read(made)
            present = self._sketches[listed.id]
            if present is not None:
                present.is_open = True
        return present if present is not None and present.reading else None

    def get(self, name: str) -> Sketch | None:
        """Return the sketch of a recording, whether it has been read by now or not."""
        return self._sketches.get(name)

    def forget(self, name: str) -> None:
        """Drop the sketch of a recording."""
        self._sketches.pop(name, None)

    def forget_closed(self, made: Sketch) -> bool:
        """Drop a sketch that no page has open; return whether that was so."""
        with self._lock:
            if not made.is_open:
                self.forget(made.message.id)
            return not made.is_open


def draw_sketch(listed: ListedRecording, cache: RecordingCache) -> Sketch | None:
    """Return what can be shown of a recording before it is read.

    None for a file that is soon read, or whose format has no shorter way.
    """
    from kineme.web.display import display_motion
    from kineme.web.tables import make_segments_message

    path = listed.path
    try:
        if path.stat().st_size < LARGE:
            return None
        found = sketch(path, resolve_read_options(listed, cache.read_options), POSES)
        if found is None:
            return None
        effectors = cache.segment_options.effectors
        head, binary = display_motion(found.motion, effectors=effectors)
    except (OSError, KinemeError):  # reading will say what is wrong
        return None
    table = make_single_segment("transition", found.n_frames, found.fps)
    message = Recording(
        id=listed.id,
        name=listed.name,
        n_frames=found.n_frames,
        fps=found.fps,
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
