"""Read recordings, sketch large ones while they are read, and compute what pages show of them.

The most recently used recordings stay in memory, and so does what pages draw of the open ones. A
large recording is shown while it is read: a sample of its poses, without segments.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from msgspec import Struct

from kineme._util.json import options_to_json
from kineme._util.parallel import announce_compilation, cancellable
from kineme.errors import KinemeError, MotionError, ParameterError, ReadError
from kineme.formats import ReadOptions, list_people, read_analog, read_quietly, sketch
from kineme.labels.collections import Extent
from kineme.methods.presets import DEFAULT
from kineme.methods.segmenter import SegmentOptions, segment_with_options
from kineme.recordings import Motion, Signals
from kineme.segments.hierarchy import DEFAULT_DETAIL
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Kind
from kineme.studio.choices import check_parameters
from kineme.studio.jobs import Run, Runs, require_poses
from kineme.studio.storage.sidecars import (
    ListedRecording,
    make_video_message,
    read_saved_options,
    resolve_read_options,
)
from kineme.web.display import DrawnPicture, display_motion, draw_picture
from kineme.web.messages import MatrixHead, Recording
from kineme.web.page_data import PageData, make_page_data
from kineme.web.tables import make_segments_message

if TYPE_CHECKING:
    from kineme.web.curves import Curves
    from kineme.web.cycle_curves import CycleCurves

LONG_S = 300.0
"""Length from which a recording is shown before it is segmented, which takes seconds."""
LARGE_FILE = 16_000_000
"""Bytes from which a file takes more than a second to read."""
MAX_POSES = 18_000
"""Poses of a sketch: five per second for an hour."""
SKETCH_REVISION = 0
"""Revision of a sketch; tables have higher ones."""
MAX_RECORDINGS = 3
"""Recordings in memory; an hour can take almost a gigabyte."""
Made = TypeVar("Made")
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
            read = self.read(listed)
            self._extents[key] = Extent(read.n_frames, read.fps, read.provenance.clock)
        return self._extents[key]

    def people(self, path: Path, choice: ReadOptions) -> tuple[str, ...]:
        """Return the people in a file; empty if it does not have several."""
        options = resolve_read_options(ListedRecording(path), self.read_options, choice)
        return list_people(path, options)

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


class LoadedRecording:
    """A recording as its file was when it was opened.

    ReadError if it cannot be read, or the file has changed since.
    """

    def __init__(self, listed: ListedRecording, cache: RecordingCache):
        self.listed, self.path = listed, listed.path
        self._cache = cache
        self.effectors = cache.segment_options.effectors
        self._stamp = read_stamp(self.path)
        recording = cache.read(listed)
        self.n_frames, self.fps = recording.n_frames, recording.fps
        self.is_motion = isinstance(recording, Motion)
        self.provenance = recording.provenance
        self._lock = threading.Lock()
        self._kept: dict[str, Any] = {}
        self._found: tuple[tuple[object, ...], Segmentation] | None = None
        self.runs = Runs()

    @property
    def recording(self) -> Motion | Signals:
        """Return the recording, read again if it is no longer cached."""
        if self.has_changed():
            raise ReadError(self.path, "has changed since it was opened: open it again")
        return self._cache.read(self.listed)

    @property
    def motion(self) -> Motion:
        """Return the recording if it is a motion; ParameterError otherwise."""
        recording = self.recording
        if not isinstance(recording, Motion):
            raise ParameterError(f"{self.path.name} holds signals: this needs the motion of a body")
        return recording

    def has_changed(self) -> bool:
        """Return whether the file has changed or is missing."""
        try:
            return read_stamp(self.path) != self._stamp
        except ReadError:
            return True

    @property
    def is_long(self) -> bool:
        """Return whether segmenting takes so long that the page is shown before."""
        return self.n_frames > LONG_S * self.fps

    def page_data(self) -> PageData:
        """Return everything that a page draws except the segments."""
        return self._keep(
            "page data",
            lambda: make_page_data(self.recording, effectors=self.effectors),
        )

    def picture(self) -> DrawnPicture | None:
        """Return the keypoints drawn over the video; None if the poses are not from a video."""
        if not self.is_motion:
            return None
        return self._keep("picture", lambda: draw_picture(self.path, self.provenance.person))

    def curves(self) -> Curves:
        from kineme.web.curves import Curves

        return self._keep("curves", lambda: Curves(self.recording, self._read_analog()))

    def cycle_curves(self) -> CycleCurves:
        from kineme.web.cycle_curves import CycleCurves

        return self._keep("cycles", lambda: CycleCurves(lambda: self.recording, self._read_analog))

    def forget_pictures(self) -> None:
        """Free the page data until a page requests it again."""
        with self._lock:
            self._kept.clear()
            self._found = None

    def _keep(self, name: str, make: Callable[[], Made]) -> Made:
        """Return what ``make`` made when it was first called for this name."""
        with self._lock:
            if name not in self._kept:
                self._kept[name] = make()
            made: Made = self._kept[name]
            return made

    def _read_analog(self) -> Signals | None:
        """Return the analog channels beside a motion; None if there are none."""
        return self._cache.analog(self.listed) if self.is_motion else None

    def get_source(self, analog: bool) -> Motion | Signals:
        """Return the source of a curve: the recording or its analog channels."""
        analog_signals = self._read_analog() if analog else None
        return self.recording if analog_signals is None else analog_signals

    def segment(
        self,
        preset: str = DEFAULT,
        parameters: Mapping[str, float] | None = None,
        detail: float = DEFAULT_DETAIL,
        run: Run | None = None,
    ) -> Segmentation:
        """Return the segments by a preset with some of its constants changed.

        The last result is cached, since a preview is often applied, or shown at another detail.
        CancelledError if ``run`` or all runs were cancelled.
        """
        constants = dict[str, Any](parameters or {})
        check_parameters(preset, constants, signals=not self.is_motion)
        key = preset, *sorted(constants.items())
        cached = self._found
        # The result holds all levels of detail, so another detail needs no new run.
        if cached is not None and cached[0] == key and not self.has_changed():
            segments = cached[1]
        else:
            recording = self.recording
            with (
                self.runs.track(run or Run(preset)) as active,
                cancellable(active.check_cancelled),
                announce_compilation(active.start_stage),
            ):
                options = replace(
                    self._cache.segment_options,
                    preset=preset,
                    constants=constants,
                    detail=DEFAULT_DETAIL,
                )
                segments, _ = segment_with_options(recording, options, progress=active.start_stage)
            self._found = key, segments
        return segments if detail == DEFAULT_DETAIL else segments.at_detail(detail)

    def first_table(self) -> tuple[Segmentation, list[str]]:
        """Return the initial table by the default preset, and notes for the user.

        A recording of a single point cannot be segmented and becomes one segment.
        """
        try:
            return self.segment(), []
        except MotionError as error:  # a single point
            return self.make_single_segment("activity"), [f"not segmented: {error}"]

    def make_single_segment(self, kind: Kind) -> Segmentation:
        """Return a table of one segment, shown while the recording is segmented."""
        read = self.provenance
        provenance = {"input": read.input, "notes": [*read.notes]}
        return make_single_segment(kind, self.n_frames, self.fps, provenance)

    def fits(self, segmentation: Segmentation) -> bool:
        """Return whether a table has the recording's length and, if it names one, its file."""
        if segmentation.n_frames != self.n_frames or self.belongs_to_other(segmentation):
            return False
        digest = get_digest(segmentation)
        if not digest:
            return True
        name = Path(str(segmentation.provenance["input"].get("path") or "")).name
        return digest == self.provenance.sha256 or name == self.path.name

    def belongs_to_other(self, segmentation: Segmentation) -> bool:
        """Return whether a table names another take or person of the file."""
        source, read = _get_input(segmentation), self.provenance
        expected = {"take": read.take, "person": read.person}
        return any(source.get(option, name) != name for option, name in expected.items())


def get_digest(segmentation: Segmentation) -> str:
    """Return the digest of the recording that a table was made from; empty if it has none."""
    return str(_get_input(segmentation).get("sha256") or "")


def _get_input(segmentation: Segmentation) -> dict[str, Any]:
    """Return the provenance of the file that a table was made from."""
    read: Any = segmentation.provenance.get("input")
    return read if isinstance(read, dict) else {}


def make_single_segment(
    kind: Kind, n_frames: int, fps: float, provenance: Mapping[str, Any] | None = None
) -> Segmentation:
    """Return a table of one segment over all frames."""
    columns: dict[str, Sequence[str] | Sequence[int]] = {
        "level": ["activity"],
        "kind": [str(kind)],
        "start_frame": [0],
        "stop_frame": [n_frames],
    }
    return Segmentation.from_columns(columns, n_frames=n_frames, fps=fps, provenance=provenance)


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
        self._sketches.pop(name, None)

    def forget_closed(self, sketch: Sketch) -> bool:
        """Drop a sketch that no page has open; return whether it was dropped."""
        with self._lock:
            if not sketch.is_open:
                self.forget(sketch.message.id)
            return not sketch.is_open


class Sketch(Struct):
    """Preview of a recording that is being read; ``binary`` holds its poses.

    If no page has it open any more (``is_open``), the recording is not opened once it is read.
    """

    message: Recording
    binary: bytes
    reading: bool = True
    is_open: bool = True


def draw_sketch(listed: ListedRecording, cache: RecordingCache) -> Sketch | None:
    """Return a preview of a recording that has not been read yet.

    None for a file that is read quickly, or whose format offers no preview.
    """
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
