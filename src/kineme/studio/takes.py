"""A recording as the studio holds it: read once, and what was computed from it kept.

What is small stays (what a page draws, features); motions themselves, which of
an hour take most of a gigabyte, are kept for the recordings used last and read
again when needed.
"""

from __future__ import annotations

import threading
import warnings
from collections import OrderedDict
from pathlib import Path
from typing import TYPE_CHECKING

from kineme.errors import EndEffectorError, KinemeWarning, ReadError
from kineme.formats import read
from kineme.motion import Motion
from kineme.report.display import display_motion
from kineme.report.matrix import Matrix, matrix_of_motion
from kineme.report.messages import MotionHead
from kineme.segmentation.presets import DEFAULT, PRESETS, Preset
from kineme.segmentation.result import Segmentation
from kineme.segmentation.segmenter import segment_and_analysis

if TYPE_CHECKING:
    from kineme.transfer import KnowledgeBase

KEPT = 3
"""Motions in memory."""
Mark = tuple[int, int]


class Motions:
    """The motions of the files used last, with the warnings their reading gave."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._known: OrderedDict[tuple[Path, Mark], tuple[Motion, list[str]]] = OrderedDict()

    def read(self, path: Path) -> tuple[Motion, list[str]]:
        """The motion in a file, and the warnings.

        One at a time: catching warnings is for the whole process.
        """
        with self._lock:
            key = path, mark_of(path)
            if key not in self._known:
                with warnings.catch_warnings(record=True) as caught:
                    warnings.simplefilter("always")
                    motion = read(path)
                said = [str(w.message) for w in caught if issubclass(w.category, KinemeWarning)]
                self._known[key] = motion, said
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

    def __init__(self, path: Path, motions: Motions):
        self.path = path
        self._motions = motions
        self._mark = mark_of(path)
        motion, self.warnings = motions.read(path)
        self.n_frames, self.fps = motion.n_frames, motion.fps
        self.source = motion.provenance
        self._lock = threading.Lock()
        self._display: tuple[MotionHead, bytes] | None = None
        self._matrix: Matrix | None = None

    @property
    def motion(self) -> Motion:
        """The motion, read again if need be."""
        if self.changed():
            raise ReadError(self.path, "has changed since it was opened: open it again")
        return self._motions.read(self.path)[0]

    def changed(self) -> bool:
        """Whether the file is another now, or gone."""
        try:
            return mark_of(self.path) != self._mark
        except ReadError:
            return True

    def display(self) -> tuple[MotionHead, bytes]:
        """What a page draws, and how to read it."""
        with self._lock:
            if self._display is None:
                self._display = display_motion(self.motion)
            return self._display

    def matrix(self) -> Matrix:
        """How alike its moments look."""
        with self._lock:
            if self._matrix is None:
                self._matrix = matrix_of_motion(self.motion)
            return self._matrix

    def segment(self, preset: Preset) -> Segmentation:
        """The segments by a preset."""
        return segment_and_analysis(self.motion, preset)[0]

    def first_table(self) -> tuple[Segmentation, list[str]]:
        """The segments by the default preset, or one for all; and what to know about them."""
        try:
            return self.segment(PRESETS[DEFAULT]), []
        except EndEffectorError as error:
            columns: dict[str, list[str] | list[int]] = {
                "level": ["activity"],
                "kind": ["activity"],
                "start_frame": [0],
                "stop_frame": [self.n_frames],
            }
            source = self.source
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

        features = transfer_features(self.motion)
        return transfer_labels(segmentation, features, base, threshold=threshold, spread=spread)

    def fits(self, segmentation: Segmentation) -> bool:
        """Whether a table is of this recording: as long, and made from it if it says from what."""
        if segmentation.n_frames != self.n_frames:
            return False
        said = segmentation.provenance.get("input")
        if not isinstance(said, dict) or not said.get("sha256"):
            return True
        name = Path(str(said.get("path") or "")).name
        return said["sha256"] == self.source.sha256 or name == self.path.name


def mark_of(path: Path) -> Mark:
    """What changes when a file is written; ReadError if it is gone."""
    try:
        found = path.stat()
    except OSError as error:
        raise ReadError(path, f"cannot be opened: {error.strerror or error}") from error
    return found.st_mtime_ns, found.st_size
