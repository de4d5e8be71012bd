"""What people and programs say of a recording: the two forms in which they are compared.

A `Labelling` is what a program says: touching intervals with labels. A `Truth` is what people
say, one or several: actions in order, and for each border between two of them the span in which
they put it.

Frames count from 0 and intervals are half-open, ``[start, stop)``: a border
at frame b stands before frame b. The label `TRANSITION` marks what
belongs to no action; it is a class of its own, not a cluster.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Ints
from kineme._util.checks import as_texts
from kineme.errors import ParameterError

Texts = NDArray[np.object_]

TRANSITION = "transition"
UNLABELLED = -1
"""Number of `TRANSITION` where labels are numbers."""
TOLERANCE_S = 0.25
"""Seconds beyond the span in which people put a border: within, a found one is right."""


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

    Examples
    --------
    >>> labels = Labelling([0, 30, 50], ("walk", "run"), fps=10)
    >>> labels.frames, labels.per_frame()[30]
    (50, 'run')
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
        """Return the intervals between cuts; without labels each gets one of its own."""
        # 0 and the length are borders, too.
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
        # Index of the first frame of each new label.
        cuts = np.flatnonzero(names[1:] != names[:-1]) + 1
        # The first frame of every run tells its label.
        starts = np.concatenate([[0], cuts])
        return cls.from_cuts(cuts, names[starts].tolist(), frames=names.size, fps=fps)

    @property
    def frames(self) -> int:
        """Return the length of the recording."""
        return int(self.borders[-1])

    @property
    def starts(self) -> Ints:
        return self.borders[:-1]

    @property
    def stops(self) -> Ints:
        return self.borders[1:]

    def per_frame(self) -> Texts:
        """Return the label of each frame."""
        return np.repeat(np.array(self.labels, dtype=object), np.diff(self.borders))

    def names(self) -> list[str]:
        """Return each label once, in the order of `numbers`; transitions are none."""
        return [label for label in dict.fromkeys(self.labels) if label != TRANSITION]

    def numbers(self) -> Ints:
        """Return the number of each frame's label, by `names`; `UNLABELLED` in transitions."""
        numbers = {name: i for i, name in enumerate(self.names())}
        values = [numbers.get(label, UNLABELLED) for label in self.labels]
        return np.repeat(np.array(values, np.int64), np.diff(self.borders))

    def within(self, frames: NDArray[np.bool_]) -> Labelling:
        """Return the same without the frames that are False; what vanishes is left out."""
        # New place of each border: how many kept frames come before it.
        moved = np.concatenate([[0], np.cumsum(frames)])[self.borders]
        rows = np.flatnonzero(np.diff(moved) > 0)
        return Labelling(
            np.append(moved[rows], moved[-1]), tuple(self.labels[i] for i in rows), self.fps
        )

    def merged(self) -> Labelling:
        """Return the same labels with equal neighbours joined."""
        labels = self.labels
        # Rows at which the label changes.
        rows = [i for i, label in enumerate(labels) if not i or label != labels[i - 1]]
        return Labelling(
            np.append(self.borders[rows], self.frames), tuple(labels[i] for i in rows), self.fps
        )

    def at(self, *, frames: int, fps: float) -> Labelling:
        """Return the same intervals counted in frames of another rate.

        Borders go to the nearest frame, halves up; what vanishes is left out.

        Raises
        ------
        ParameterError
            The lengths in seconds differ by more than one frame of the slower rate.
        """
        check_length(self.frames, self.fps, frames, fps)
        moved = round_half_up(self.borders * (fps / self.fps))
        # Rounding must not lead beyond the end; the last border is the end itself.
        moved = np.append(np.minimum(moved[:-1], frames), frames)
        # Intervals that round to no frame vanish.
        kept = np.flatnonzero(np.diff(moved) > 0)
        return Labelling(
            np.append(moved[kept], frames), tuple(self.labels[i] for i in kept), float(fps)
        )


@dataclass(frozen=True, eq=False)
class Truth:
    """Actions in order, with the span in which people put each border.

    Action i lies before border i. A border known exactly has
    ``earliest == mean == latest``.

    Parameters
    ----------
    labels : tuple of str
        One per action.
    earliest, mean, latest : ndarray
        Frames, one per border between two actions.
    frames : int
        Length of the recording.
    fps : float
        Frames per second.
    counts : tuple of int or None, optional
        Repetitions in each action, None where not known; empty: none is.
    tolerance_s : float
        Seconds beyond these spans within which a found border is right.
    repetitions : Labelling, optional
        Single repetitions where people cut them, transitions elsewhere; of as many frames.

    Raises
    ------
    ParameterError
        Borders run backwards, overlap or pass the end, or there is no action.

    Examples
    --------
    >>> truth = Truth(("walk", "run"), [28], [30], [33], frames=50, fps=10)
    >>> truth.labelling().labels
    ('walk', 'transition', 'run')
    """

    labels: tuple[str, ...]
    earliest: Ints
    mean: Ints
    latest: Ints
    frames: int
    fps: float
    counts: tuple[int | None, ...] = ()
    tolerance_s: float = TOLERANCE_S
    repetitions: Labelling | None = None

    def __post_init__(self) -> None:
        check_rate(self.fps)
        object.__setattr__(self, "labels", as_texts(self.labels, "labels"))
        if not set(self.labels) - {TRANSITION}:
            raise ParameterError("a truth needs at least one action")
        if self.counts and len(self.counts) != len(self.labels):
            raise ParameterError(
                f"{len(self.labels)} actions need as many counts, not {len(self.counts)}"
            )
        if self.repetitions is not None and self.repetitions.frames != self.frames:
            raise ParameterError(
                f"the repetitions are of {self.repetitions.frames} frames, not {self.frames}"
            )
        for name in ("earliest", "mean", "latest"):
            frames = np.asarray(getattr(self, name), np.int64)
            object.__setattr__(self, name, frames)
            if frames.shape != (len(self.labels) - 1,):
                raise ParameterError(
                    f"{len(self.labels)} actions have {len(self.labels) - 1} borders between "
                    f"them, not {frames.size} ({name})"
                )
        # A border must lie within the span in which people put it.
        backwards = np.flatnonzero((self.mean < self.earliest) | (self.latest < self.mean))
        if backwards.size:
            i = backwards[0]
            raise ParameterError(
                f"the border after action {i + 1} ({self.labels[i]}) runs backwards: earliest "
                f"{self.earliest[i]}, mean {self.mean[i]}, latest {self.latest[i]}"
            )
        # Certain part of each action: after the latest start, before the earliest end.
        begins = np.concatenate([[0], self.latest])
        ends = np.concatenate([self.earliest, [self.frames]])
        if self.latest.size and self.latest.max() >= self.frames:
            i = int(np.argmax(self.latest >= self.frames))
            raise ParameterError(
                f"the border after action {i + 1} ({self.labels[i]}) at frame {self.latest[i]} "
                f"is not before the end of the recording, frame {self.frames}"
            )
        overlap = np.flatnonzero(ends <= begins)
        if overlap.size:
            i = overlap[0]
            raise ParameterError(
                f"action {i + 1} ({self.labels[i]}) would last from frame {begins[i]} to "
                f"{ends[i]}: its borders overlap"
            )

    @classmethod
    def from_labelling(
        cls,
        labelling: Labelling,
        *,
        counts: Sequence[int | None] = (),
        tolerance_s: float = TOLERANCE_S,
    ) -> Truth:
        """Return the truth in a labelling: a transition between two actions is an uncertain border.

        Its middle counts as the mean. A transition at the beginning or the
        end of the recording stays a row of its own. Counts are one for each interval.
        """
        # Only transitions between two actions are borders; at the ends they stay rows.
        middle = [
            0 < i < len(labelling.labels) - 1 and label == TRANSITION
            for i, label in enumerate(labelling.labels)
        ]
        rows = [i for i, between in enumerate(middle) if not between]
        # A border's span is from the end of one action to the start of the next.
        earliest = labelling.stops[rows[:-1]]
        latest = labelling.starts[rows[1:]]
        return cls(
            tuple(labelling.labels[i] for i in rows),
            earliest,
            round_half_up((earliest + latest) / 2),
            latest,
            labelling.frames,
            labelling.fps,
            tuple(counts[i] for i in rows) if any(c is not None for c in counts) else (),
            tolerance_s=tolerance_s,
        )

    def labelling(self) -> Labelling:
        """Actions, and the uncertain spans between them as transitions."""
        borders, labels = [0], []
        for label, start, stop in zip(
            self.labels, self.earliest.tolist(), self.latest.tolist(), strict=False
        ):
            borders.append(start)
            labels.append(label)
            if stop > start:
                borders.append(stop)
                labels.append(TRANSITION)
        return Labelling(np.array([*borders, self.frames]), (*labels, self.labels[-1]), self.fps)

    def at_means(self) -> Labelling:
        """Actions only, cut at the mean marks."""
        return Labelling.from_cuts(self.mean, self.labels, frames=self.frames, fps=self.fps)


def round_half_up(values: ArrayLike) -> Ints:
    """Whole numbers; halves go up, as MATLAB rounds."""
    # `np.round` would round halves to even numbers.
    return np.floor(np.asarray(values, np.float64) + 0.5).astype(np.int64)


def check_length(frames: int, fps: float, others: int, rate: float) -> None:
    """A `ParameterError` where labels are not as long as their recording, which has the others."""
    length, other = frames / fps, others / rate
    # One frame of the slower rate, which rounding of the length can cost.
    if abs(length - other) > 1 / min(fps, rate) + 1e-9:
        raise ParameterError(
            f"the labels cover {length:.3f} s ({frames} frames at {fps:g} fps), the "
            f"recording lasts {other:.3f} s ({others} frames at {rate:g} fps)"
        )


def check_rate(fps: float) -> None:
    """A `ParameterError` where that is no frame rate."""
    if not (np.isfinite(fps) and fps > 0):
        raise ParameterError(f"the frame rate must be a positive number, not {fps}")
