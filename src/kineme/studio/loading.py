"""A recording as the studio works with it, with what was computed from it.

What a page draws stays in memory; the recording itself is read again when it
is needed after others were.
"""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kineme._util.parallel import announce_compilation, cancellable
from kineme.errors import MotionError, ParameterError, ReadError
from kineme.methods.presets import DEFAULT
from kineme.recordings import Motion, Skeleton
from kineme.segments.hierarchy import DEFAULT_DETAIL
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Kind
from kineme.studio.choices import check_parameters
from kineme.studio.reading import RecordingCache, read_stamp
from kineme.studio.running import Run, Runs
from kineme.studio.storage.listed import ListedRecording

if TYPE_CHECKING:
    from kineme.recordings import Signals
    from kineme.transfer import KnowledgeBase
    from kineme.web.curves import Curves
    from kineme.web.cycle_curves import CycleCurves
    from kineme.web.film import DrawnPicture
    from kineme.web.page_data import PageData


LONG = 300.0
"""Seconds of a recording that is shown before it is segmented, which takes some seconds."""


class LoadedRecording:
    """A recording as its file was when it was opened.

    ReadError where it cannot be read, or is another now.
    """

    def __init__(self, listed: ListedRecording, cache: RecordingCache):
        self.listed, self.path = listed, listed.path
        self._cache = cache
        self.effectors = cache.segment_options.effectors
        self._stamp = read_stamp(self.path)
        found = cache.read(listed)
        self.n_frames, self.fps = found.n_frames, found.fps
        self.is_motion = isinstance(found, Motion)
        self.provenance = found.provenance
        self._lock = threading.Lock()
        self._page_data: PageData | None = None
        self._picture: DrawnPicture | None = None
        self._has_picture = self.is_motion  # until it was looked for
        self._curves: Curves | None = None
        self._cycle_curves: CycleCurves | None = None
        self._found: tuple[tuple[object, ...], Segmentation] | None = None
        self.runs = Runs()

    @property
    def recording(self) -> Motion | Signals:
        """Return the recording itself, read again if need be."""
        if self.changed():
            raise ReadError(self.path, "has changed since it was opened: open it again")
        return self._cache.read(self.listed)

    @property
    def motion(self) -> Motion:
        """Return the same where it is the motion of a body; ParameterError otherwise."""
        found = self.recording
        if not isinstance(found, Motion):
            raise ParameterError(f"{self.path.name} holds signals: this needs the motion of a body")
        return found

    def changed(self) -> bool:
        """Return whether the file is another now, or gone."""
        try:
            return read_stamp(self.path) != self._stamp
        except ReadError:
            return True

    @property
    def is_long(self) -> bool:
        """Return whether segmenting it takes longer than people like to wait for a picture."""
        return self.n_frames > LONG * self.fps

    def page_data(self) -> PageData:
        """Return all that a page draws but the segments."""
        from kineme.web.page_data import make_page_data

        with self._lock:
            if self._page_data is None:
                shown = drop_other_people(self.recording)
                self._page_data = make_page_data(shown, effectors=self.effectors)
            return self._page_data

    def picture(self) -> DrawnPicture | None:
        """Return what is drawn over the video that the poses come from, where they do."""
        from kineme.web.film import draw_picture

        with self._lock:
            if self._has_picture and self._picture is None:
                self._picture = draw_picture(self.path, self.provenance.person)
                self._has_picture = self._picture is not None
            return self._picture

    def forget_pictures(self) -> None:
        """Let go of what pages draw, until one asks again."""
        with self._lock:
            self._page_data = self._curves = self._cycle_curves = self._found = None
            self._picture = None

    def curves(self) -> Curves:
        """Return what is drawn over time."""
        from kineme.web.curves import Curves

        with self._lock:
            if self._curves is None:
                self._curves = Curves(self.recording, self._analog())
            return self._curves

    def cycle_curves(self) -> CycleCurves:
        """Return what is drawn of repetitions."""
        from kineme.web.cycle_curves import CycleCurves

        with self._lock:
            if self._cycle_curves is None:
                self._cycle_curves = CycleCurves(lambda: self.recording, self._analog)
            return self._cycle_curves

    def _analog(self) -> Signals | None:
        """Return the channels beside a motion."""
        return self._cache.analog(self.listed) if self.is_motion else None

    def source(self, analog: bool) -> Motion | Signals:
        """Return what a curve is of: the recording, or the channels beside it."""
        found = self._analog() if analog else None
        return self.recording if found is None else found

    def segment(
        self,
        preset: str = DEFAULT,
        parameters: Mapping[str, float] | None = None,
        detail: float = DEFAULT_DETAIL,
        run: Run | None = None,
    ) -> Segmentation:
        """Return the segments by a preset, with some of the constants it offers changed.

        Those found last are kept: what was looked at is often taken, or looked at in another
        detail. CancelledError where ``run`` was cancelled, or all of them (`runs`).
        """
        from kineme.methods.segmenter import segment_with_options

        changed = dict[str, Any](parameters or {})
        check_parameters(preset, changed, signals=not self.is_motion)
        key = preset, *sorted(changed.items())
        former = self._found
        # Another detail of the same segments needs no new run.
        if former is not None and former[0] == key and not self.changed():
            segments = former[1]
        else:
            found = self.recording
            with (
                self.runs.one(run or Run(preset)) as present,
                cancellable(present.go_on),
                announce_compilation(present.stage),
            ):
                options = replace(
                    self._cache.segment_options,
                    preset=preset,
                    constants=changed,
                    detail=DEFAULT_DETAIL,
                )
                segments, _ = segment_with_options(found, options, progress=present.stage)
            self._found = key, segments
        return segments if detail == DEFAULT_DETAIL else segments.at_detail(detail)

    def first_table(self) -> tuple[Segmentation, list[str]]:
        """Return the table before anybody made another, and what people should know about it.

        By the default preset; one segment for all where there is a single point only.
        """
        try:
            return self.segment(), []
        except MotionError as error:  # a single point
            return self._one_segment("activity"), [f"not segmented: {error}"]

    def not_segmented(self) -> Segmentation:
        """Return the table while segments are being found: one transition."""
        return self._one_segment("transition")

    def labelled(
        self,
        segmentation: Segmentation,
        base: KnowledgeBase,
        *,
        threshold: float,
        spread: bool,
    ) -> Segmentation:
        """Return the segments with labels, as `kineme.transfer.transfer_labels` gives them."""
        from kineme.transfer import transfer_features, transfer_labels

        features = transfer_features(self.motion, effectors=self.effectors)
        return transfer_labels(segmentation, features, base, threshold=threshold, spread=spread)

    def fits(self, segmentation: Segmentation) -> bool:
        """Whether a table is of this recording: as long, and made from it if it says from what."""
        if segmentation.n_frames != self.n_frames or self.is_of_another(segmentation):
            return False
        digest = get_digest(segmentation)
        if not digest:
            return True
        name = Path(str(segmentation.provenance["input"].get("path") or "")).name
        return digest == self.provenance.sha256 or name == self.path.name

    def is_of_another(self, segmentation: Segmentation) -> bool:
        """Return whether a table says that it is of another take or person of the file."""
        file, read = _get_input(segmentation), self.provenance
        names = {"take": read.take, "person": read.person}
        return any(file.get(option, name) != name for option, name in names.items())

    def _one_segment(self, kind: Kind) -> Segmentation:
        read = self.provenance
        provenance = {
            "input": read.input,
            "notes": [*read.notes],
        }
        return make_single_segment(kind, self.n_frames, self.fps, provenance)


def drop_other_people(recording: Motion | Signals) -> Motion | Signals:
    """Return the recording without the markers of the other people in its file."""
    provenance = recording.provenance
    others = {*provenance.people} - {provenance.person}
    if not others or not isinstance(recording, Motion) or recording.rotations is not None:
        return recording
    skeleton = recording.skeleton
    kept = [i for i, name in enumerate(skeleton.names) if name.rpartition(":")[0] not in others]
    # New numbers of the joints that stay.
    places = {joint: place for place, joint in enumerate(kept)}
    parents = [skeleton.parents[joint] for joint in kept]
    # A joint that hangs on one of the others cannot be parted from it.
    if len(kept) == skeleton.n_joints or not {*parents} <= {-1, *kept}:
        return recording
    names = tuple(skeleton.names[joint] for joint in kept)
    above = tuple(places.get(parent, -1) for parent in parents)
    alone = Skeleton(names, above, skeleton.offsets[kept])
    return replace(recording, skeleton=alone, positions=recording.positions[:, kept])


def get_digest(segmentation: Segmentation) -> str:
    """Return the digest of the recording that a table was made from, empty if it does not say."""
    return str(_get_input(segmentation).get("sha256") or "")


def _get_input(segmentation: Segmentation) -> dict[str, Any]:
    """Return what a table says of the file it was made from."""
    read: Any = segmentation.provenance.get("input")
    return read if isinstance(read, dict) else {}


def make_single_segment(
    kind: Kind, n_frames: int, fps: float, provenance: Mapping[str, Any] | None = None
) -> Segmentation:
    """Return a table of one segment for all."""
    columns: dict[str, Sequence[str] | Sequence[int]] = {
        "level": ["activity"],
        "kind": [str(kind)],
        "start_frame": [0],
        "stop_frame": [n_frames],
    }
    return Segmentation.from_columns(columns, n_frames=n_frames, fps=fps, provenance=provenance)
