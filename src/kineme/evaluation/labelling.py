"""Who says what when: the plain form in which results and truths are compared.

A `Labelling` is what a program says: touching intervals with labels. What people say is an
`Annotation` (`kineme.evaluation.annotation`): actions in order, and for each border between
two of them the span in which the annotators disagree.

Frames count from 0 and intervals are half-open, ``[start, stop)``: a border
at frame b stands before frame b. The label `TRANSITION` marks what
belongs to no action; it is a class of its own, not a cluster.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme.errors import ParameterError

Ints = NDArray[np.int64]
Texts = NDArray[np.object_]

TRANSITION = "transition"


@dataclass(frozen=True, eq=False)
class Labelling:
    """Touching intervals: ``labels[i]`` holds on frames ``[borders[i], borders[i + 1])``.

    Parameters
    ----------
    borders : ndarray
        Rising frames, from 0 to the length of the recording.
    labels : tuple of str
        One per interval.
    fps : float
        Frames per second.

    Raises
    ------
    ParameterError
        Borders do not start at 0 or do not rise, or the number of labels does not fit.
    """

    borders: Ints
    labels: tuple[str, ...]
    fps: float

    def __post_init__(self) -> None:
        check_rate(self.fps)
        object.__setattr__(self, "borders", np.asarray(self.borders, np.int64))
        object.__setattr__(self, "labels", tuple(map(str, self.labels)))
        if self.borders.size < 2 or self.borders[0] != 0:
            raise ParameterError("a labelling starts at frame 0 and has at least one interval")
        falls = np.flatnonzero(np.diff(self.borders) <= 0)
        if falls.size:
            before, after = self.borders[falls[0] : falls[0] + 2]
            raise ParameterError(f"borders must rise: {after} follows {before}")
        if len(self.labels) != self.borders.size - 1:
            raise ParameterError(
                f"{self.borders.size - 1} intervals need as many labels, not {len(self.labels)}"
            )

    @classmethod
    def from_cuts(
        cls, cuts: ArrayLike, labels: Sequence[object] | None = None, *, frames: int, fps: float
    ) -> Labelling:
        """The intervals between cuts; without labels each gets one of its own."""
        borders = np.concatenate([[0], np.asarray(cuts, np.int64), [frames]])
        names = range(borders.size - 1) if labels is None else labels
        return cls(borders, tuple(map(str, names)), fps)

    @classmethod
    def from_frames(
        cls, labels: Sequence[object] | NDArray[np.generic], *, fps: float
    ) -> Labelling:
        """One interval per run of equal labels, from one label per frame."""
        names = np.array([str(label) for label in labels], dtype=object)
        if not names.size:
            raise ParameterError("one label per frame is needed, there are none")
        cuts = np.flatnonzero(names[1:] != names[:-1]) + 1
        starts = np.concatenate([[0], cuts])
        return cls.from_cuts(cuts, names[starts].tolist(), frames=names.size, fps=fps)

    @property
    def frames(self) -> int:
        """The length of the recording."""
        return int(self.borders[-1])

    @property
    def starts(self) -> Ints:
        return self.borders[:-1]

    @property
    def stops(self) -> Ints:
        return self.borders[1:]

    def per_frame(self) -> Texts:
        """The label of each frame."""
        return np.repeat(np.array(self.labels, dtype=object), np.diff(self.borders))

    def merged(self) -> Labelling:
        """The same labels with equal neighbours joined."""
        return Labelling.from_frames(self.per_frame(), fps=self.fps)

    def at(self, *, frames: int, fps: float) -> Labelling:
        """The same intervals counted in frames of another rate.

        Borders go to the nearest frame, halves up; what vanishes is left out.

        Raises
        ------
        ParameterError
            The lengths in seconds differ by more than one frame of the slower rate.
        """
        own, other = self.frames / self.fps, frames / fps
        if abs(own - other) > 1 / min(self.fps, fps) + 1e-9:
            raise ParameterError(
                f"the labels cover {own:.3f} s ({self.frames} frames at {self.fps:g} fps), the "
                f"recording lasts {other:.3f} s ({frames} frames at {fps:g} fps)"
            )
        moved = round_half_up(self.borders * (fps / self.fps))
        moved = np.append(np.minimum(moved[:-1], frames), frames)
        kept = np.flatnonzero(np.diff(moved) > 0)
        return Labelling(
            np.append(moved[kept], frames), tuple(self.labels[i] for i in kept), float(fps)
        )


def round_half_up(values: ArrayLike) -> Ints:
    """Whole numbers; halves go up, as MATLAB rounds."""
    return np.floor(np.asarray(values, np.float64) + 0.5).astype(np.int64)


def check_rate(fps: float) -> None:
    """A `ParameterError` where that is no frame rate."""
    if not (np.isfinite(fps) and fps > 0):
        raise ParameterError(f"the frame rate must be a positive number, not {fps}")
