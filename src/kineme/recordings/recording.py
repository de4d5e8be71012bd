"""Protocol of all recordings, whether of a body or of sensors.

A recording consists of frames at an even rate, counted from 0; spans of frames are
half-open, ``[start, stop)``. Gaps are spans in which nothing was recorded. Recordings are
immutable: arrays are read-only, and operations return a new recording with a note in its
provenance.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Sequence
from dataclasses import replace
from operator import index
from typing import Any, ClassVar, Protocol, Self, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from kineme._util.checks import as_spans, is_number
from kineme.errors import MotionError, ParameterError
from kineme.recordings.provenance import Note, Provenance

Spans = tuple[tuple[int, int], ...]


@runtime_checkable
class Recording(Protocol):
    """Frames at an even rate: the common interface of `Motion` and `Signals`.

    Attributes
    ----------
    fps : float
        Frames per second.
    gaps : tuple of (int, int)
        Frames [start, stop) in which nothing was recorded, in time order, neither touching nor
        overlapping. The values in them have no meaning.
    provenance : Provenance
        The source file, and what was inferred from it.

    Examples
    --------
    >>> from kineme import Signals
    >>> signals = Signals([[0.0], [1.0], [2.0], [3.0]], 2.0)
    >>> signals[1:3]
    <Signals of 2 frames (1.0 s) at 2 Hz: 1 channel>
    >>> signals.seconds(0.5).n_frames, signals.spans()
    (3, [(0, 4)])
    """

    fps: float
    gaps: Sequence[tuple[int, int]]
    provenance: Provenance

    @property
    @abstractmethod
    def n_frames(self) -> int: ...

    @abstractmethod
    def _sliced(self, start: int, stop: int, gaps: Spans, provenance: Provenance) -> Self:
        """Return frames [start, stop), which exist, with these gaps and this provenance."""

    @abstractmethod
    def _facts(self) -> list[tuple[str, str]]:
        """Return the names and values that a notebook shows for this kind of recording."""

    @abstractmethod
    def _picture(self) -> str:
        """Return a small SVG of the recording."""

    @property
    def duration(self) -> float:
        """Return the duration in seconds: frames / fps."""
        return self.n_frames / self.fps

    @property
    def times(self) -> NDArray[np.float64]:
        """Return the second at which each frame was taken, from 0."""
        return np.arange(self.n_frames) / self.fps

    def spans(self) -> list[tuple[int, int]]:
        """Return the spans [start, stop) of frames between gaps, in time order."""
        # The spans between gaps: from the end of each to the start of the next.
        starts = [0, *(stop for _, stop in self.gaps)]
        stops = [*(start for start, _ in self.gaps), self.n_frames]
        return [(a, b) for a, b in zip(starts, stops, strict=True) if a < b]

    def noted(self, *notes: Note | str) -> Self:
        """Return a copy with notes added to the provenance."""
        return replace(self, provenance=self.provenance.noted(*notes))  # type: ignore[type-var]

    def seconds(self, start: float = 0.0, stop: float | None = None) -> Self:
        """Return the frames between two times, rounded to the nearest frame.

        Parameters
        ----------
        start : float
            Seconds from the first frame.
        stop : float, optional
            Seconds; limited to the end, which is also the default.

        Returns
        -------
        Motion or Signals

        Raises
        ------
        ParameterError
            Times are not numbers, negative, or have no frame between them.
        """
        for at in (start, 0.0 if stop is None else stop):
            if not is_number(at) or at < 0:
                raise ParameterError(
                    f"{at!r:.60} is not a time in a recording: give seconds from 0"
                )
        last = self.duration if stop is None else min(stop, self.duration)
        # Seconds beyond the end count as the end.
        first, end = round(min(start, self.duration) * self.fps), round(last * self.fps)
        if first >= end:
            until = "the end" if stop is None else f"{stop:g} s"
            raise ParameterError(
                f"there is no frame from {start:g} s to {until} in a recording of "
                f"{self.duration:g} s"
            )
        return self[first:end]

    def __len__(self) -> int:
        return self.n_frames

    __iter__: ClassVar[None] = None  # frames are no recordings: slices are

    def __getitem__(self, frames: slice) -> Self:
        """Return the frames of a slice with the gaps and events in them, indexed as in numpy."""
        if not isinstance(frames, slice):
            raise ParameterError(
                f"a recording must be sliced by frames, as in [0:600], not {frames!r}"
            )
        try:
            step = 1 if frames.step is None else index(frames.step)
            # `indices` resolves negative and missing bounds as numpy does.
            start, stop, _ = slice(frames.start, frames.stop).indices(self.n_frames)
        except TypeError:
            raise ParameterError(
                "a recording must be sliced by whole numbers of frames: use seconds(start, "
                "stop) for seconds"
            ) from None
        if step != 1:
            raise ParameterError(
                f"a recording cannot be sliced with step {step}: use kineme.resample to "
                "change the rate of a motion"
            )
        if start >= stop:
            raise ParameterError(f"frames {start} to {stop} of {self.n_frames} contain no frame")
        # Gaps are cut to the slice and counted from its start; those outside become empty.
        gaps = [(max(a, start) - start, min(b, stop) - start) for a, b in self.gaps]
        return self._sliced(
            start,
            stop,
            tuple((a, b) for a, b in gaps if a < b),
            _cut_provenance(self.provenance, start, stop, self.fps),
        )

    def _repr_html_(self) -> str:
        from kineme.recordings.notebook import make_page

        facts = [
            ("frames", f"{self.n_frames} ({self.duration:.2f} s at {self.fps:g} Hz)"),
            *self._facts(),
        ]
        if self.gaps:
            lost = sum(stop - start for start, stop in self.gaps)
            facts.append(("gaps", f"{len(self.gaps)} ({lost / self.fps:.2f} s)"))
        return make_page(repr(self), self._picture(), facts, self.provenance)


def as_gaps(
    gaps: Any, n_frames: int, *, error: type[ParameterError | MotionError] = ParameterError
) -> Spans:
    """Return gaps as pairs of frames [start, stop) of a recording with ``n_frames`` frames.

    Raise ``error`` if they are not pairs, empty, out of order, touching or out of range.
    """
    found = as_spans(gaps, error=error)
    before = -1
    for start, stop in found:
        if not before < start < stop <= n_frames:
            raise error(
                f"gap {start} to {stop} must be within the {n_frames} frames and after the "
                "previous gap"
            )
        before = stop
    return found


def _cut_provenance(provenance: Provenance, start: int, stop: int, fps: float) -> Provenance:
    """Return the provenance of frames [start, stop), with the events in them and their clock."""
    first, last = start / fps, stop / fps
    events: Iterable[tuple[float, str]] = (
        (at - first, name) for at, name in provenance.events if first <= at < last
    )
    clock = provenance.clock and provenance.clock.cut(first, last)
    rows = None if provenance.rows is None else provenance.rows - first
    return provenance.noted(f"cut to frames {start} to {stop}").marked(events).timed(clock, rows)
