"""What people say: actions in order, and the span in which they put each border."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kineme._checks import as_texts
from kineme.errors import ParameterError
from kineme.evaluation.labelling import TRANSITION, Ints, Labelling, check_rate, round_half_up


@dataclass(frozen=True, eq=False)
class Annotation:
    """Actions in order, with the span in which annotators put each border.

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

    Raises
    ------
    ParameterError
        Borders run backwards, overlap or pass the end, or there is no action.
    """

    labels: tuple[str, ...]
    earliest: Ints
    mean: Ints
    latest: Ints
    frames: int
    fps: float
    counts: tuple[int | None, ...] = ()

    def __post_init__(self) -> None:
        check_rate(self.fps)
        object.__setattr__(self, "labels", as_texts(self.labels, "labels"))
        if not set(self.labels) - {TRANSITION}:
            raise ParameterError("an annotation needs at least one action")
        if self.counts and len(self.counts) != len(self.labels):
            raise ParameterError(
                f"{len(self.labels)} actions need as many counts, not {len(self.counts)}"
            )
        for name in ("earliest", "mean", "latest"):
            marks = np.asarray(getattr(self, name), np.int64)
            object.__setattr__(self, name, marks)
            if marks.shape != (len(self.labels) - 1,):
                raise ParameterError(
                    f"{len(self.labels)} actions have {len(self.labels) - 1} borders between "
                    f"them, not {marks.size} ({name})"
                )
        backwards = np.flatnonzero((self.mean < self.earliest) | (self.latest < self.mean))
        if backwards.size:
            i = backwards[0]
            raise ParameterError(
                f"the border after action {i + 1} ({self.labels[i]}) runs backwards: earliest "
                f"{self.earliest[i]}, mean {self.mean[i]}, latest {self.latest[i]}"
            )
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
    def from_labelling(cls, labelling: Labelling) -> Annotation:
        """The truth in a labelling: a transition between two actions is an uncertain border.

        Its middle counts as the mean. A transition at the beginning or the
        end of the recording stays a row of its own.
        """
        middle = [
            0 < i < len(labelling.labels) - 1 and label == TRANSITION
            for i, label in enumerate(labelling.labels)
        ]
        rows = [i for i, between in enumerate(middle) if not between]
        earliest = labelling.stops[rows[:-1]]
        latest = labelling.starts[rows[1:]]
        return cls(
            tuple(labelling.labels[i] for i in rows),
            earliest,
            round_half_up((earliest + latest) / 2),
            latest,
            labelling.frames,
            labelling.fps,
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
