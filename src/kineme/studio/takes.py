"""A recording as the studio holds it: read once, and what was computed from it kept.

What a page draws stays; motions themselves, which of an hour take most of a
gigabyte, are kept for the recordings used last and read again when needed.
"""

from __future__ import annotations

import threading
import warnings
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kineme.errors import KinemeWarning, MotionError, ParameterError, ReadError
from kineme.formats import read
from kineme.methods.presets import DEFAULT
from kineme.recordings import Motion
from kineme.segments.segmentation import Segmentation
from kineme.studio.choices import preset_of

if TYPE_CHECKING:
    from kineme.features import Names
    from kineme.recordings import Signals
    from kineme.transfer import KnowledgeBase
    from kineme.web.recording import Footage

KEPT = 3
"""Recordings in memory."""
Mark = tuple[int, int]
Known = tuple["Motion | Signals", list[str]]


@dataclass(frozen=True)
class Reading:
    """What the files do not say themselves.

    Parameters
    ----------
    options : keywords for `kineme.read`
    effectors : the names of head, hands and feet, as `kineme.end_effectors` takes them
    """

    options: Mapping[str, Any] = field(default_factory=dict)
    effectors: Names | None = None


class Sources:
    """What the files used last hold, motion or signals, with the warnings their reading gave."""

    def __init__(self, reading: Reading) -> None:
        self.reading = reading
        self._lock = threading.Lock()
        self._known: OrderedDict[tuple[Path, Mark], Known] = OrderedDict()

    def read(self, path: Path) -> Known:
        """The recording in a file, and the warnings.

        One at a time: catching warnings is for the whole process.
        """
        with self._lock:
            key = path, mark_of(path)
            if key not in self._known:
                with warnings.catch_warnings(record=True) as caught:
                    warnings.simplefilter("always")
                    found = _read(path, self.reading.options)
                said = [str(w.message) for w in caught if issubclass(w.category, KinemeWarning)]
                self._known[key] = found, said
            self._known.move_to_end(key)
            while len(self._known) > KEPT:
                self._known.popitem(last=False)
            return self._known[key]


class Take:
    """A recording as its file was when it was opened.

    Raises
    ------
    ReadError : the file cannot be read, or is another now
    """

    def __init__(self, path: Path, sources: Sources):
        self.path = path
        self._sources = sources
        self.effectors = sources.reading.effectors
        self._mark = mark_of(path)
        found, self.warnings = sources.read(path)
        self.n_frames, self.fps = found.n_frames, found.fps
        self.provenance = found.provenance
        self._lock = threading.Lock()
        self._footage: Footage | None = None

    @property
    def source(self) -> Motion | Signals:
        """The recording, read again if need be."""
        if self.changed():
            raise ReadError(self.path, "has changed since it was opened: open it again")
        return self._sources.read(self.path)[0]

    @property
    def motion(self) -> Motion:
        """The same where it is the motion of a body; ParameterError otherwise."""
        found = self.source
        if not isinstance(found, Motion):
            raise ParameterError(f"{self.path.name} holds signals: this needs the motion of a body")
        return found

    def changed(self) -> bool:
        """Whether the file is another now, or gone."""
        try:
            return mark_of(self.path) != self._mark
        except ReadError:
            return True

    def footage(self) -> Footage:
        """All that a page draws but the segments."""
        from kineme.web.recording import footage

        with self._lock:
            if self._footage is None:
                self._footage = footage(self.source, effectors=self.effectors)
            return self._footage

    def segment(
        self, preset: str = DEFAULT, parameters: Mapping[str, float] | None = None
    ) -> Segmentation:
        """The segments by the preset of that name, with some of the constants it offers changed."""
        from kineme.segmentation.segmenter import segment

        found, chosen = self.source, preset_of(preset, parameters or {})
        if not isinstance(found, Motion):
            chosen = chosen.replace(**chosen.signal_defaults)
        return segment(found, preset=chosen, effectors=self.effectors)

    def first_table(self) -> tuple[Segmentation, list[str]]:
        """The segments by the default preset, or one for all; and what to know about them."""
        try:
            return self.segment(), []
        except MotionError as error:  # a single point
            columns: dict[str, list[str] | list[int]] = {
                "level": ["activity"],
                "kind": ["activity"],
                "start_frame": [0],
                "stop_frame": [self.n_frames],
            }
            source = self.provenance
            provenance = {
                "input": {"path": source.path, "format": source.format, "sha256": source.sha256},
                "notes": [*source.notes],
            }
            table = Segmentation.from_columns(
                columns, n_frames=self.n_frames, fps=self.fps, provenance=provenance
            )
            return table, [f"not segmented: {error}"]

    def labelled(
        self,
        segmentation: Segmentation,
        base: KnowledgeBase,
        *,
        threshold: float,
        spread: bool,
    ) -> Segmentation:
        """The segments with labels from a knowledge base."""
        from kineme.transfer import transfer_features, transfer_labels

        features = transfer_features(self.motion, effectors=self.effectors)
        return transfer_labels(segmentation, features, base, threshold=threshold, spread=spread)

    def fits(self, segmentation: Segmentation) -> bool:
        """Whether a table is of this recording: as long, and made from it if it says from what."""
        if segmentation.n_frames != self.n_frames:
            return False
        said = segmentation.provenance.get("input")
        if not isinstance(said, dict) or not said.get("sha256"):
            return True
        name = Path(str(said.get("path") or "")).name
        return said["sha256"] == self.provenance.sha256 or name == self.path.name


def _read(path: Path, options: Mapping[str, Any]) -> Motion | Signals:
    """What a file holds; a table of channels without a body is signals."""
    return read(path, **options)


def mark_of(path: Path) -> Mark:
    """What changes when a file is written; ReadError if it is gone."""
    try:
        found = path.stat()
    except OSError as error:
        raise ReadError(path, f"cannot be opened: {error.strerror or error}") from error
    return found.st_mtime_ns, found.st_size
