"""Compare results of programs (`Labelling`) with what people marked (`Truth`).

A `Labelling` consists of adjacent intervals with labels. A `Truth`, by one or more people, consists
of actions in order, and of the span of each border between two of them.

Frames count from 0, and intervals are half-open, ``[start, stop)``: a border at frame b is before
frame b. The label `TRANSITION` marks frames outside of actions; it is a class, not a cluster.

`make_labelling` and `make_truth` convert segmentations. People label repetitions either as adjacent
segments with the same name, or on the level ``primitive``. Both give the same truth
(`add_repetitions`): adjacent segments with equal labels are one activity, and each of them is a
repetition. A column ``count`` gives only their number.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import floor
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Ints
from kineme._util.checks import as_floats, as_texts
from kineme.errors import ParameterError
from kineme.recordings.arrays import find_spans
from kineme.segments.editing.borders import replace_rows
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment, SegmentTable, choose_kind

Texts = NDArray[np.object_]
Count = int | None
"""Number of repetitions; None if unknown."""

TRANSITION = "transition"
UNLABELLED = -1
"""Number of `TRANSITION` if labels are numbers."""
TOLERANCE_S = 0.25
"""Tolerance of a border beyond the span in which people put it, s."""
FPS = 30.0
"""Highest rate of comparison, Hz."""
SHORT_TRANSITION_S = 1.0
"""Length up to which a transition is one border, s; a longer one has two."""


@dataclass(frozen=True, eq=False)
class Labelling:
    """Adjacent intervals: ``labels[i]`` is the label of frames ``[borders[i], borders[i + 1])``.

    Parameters
    ----------
    borders : ndarray
        Ascending frames, from 0 to the length of the recording.
    labels : tuple of str
        One per interval.
    fps : float
        Frames per second.

    Raises
    ------
    ParameterError
        Borders are not a list of frames from 0 on that ascend, or the number of labels differs.

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
        frames = as_floats(self.borders, "borders")
        if frames.ndim != 1 or len(frames) < 2 or frames[0] != 0 or not np.isfinite(frames).all():
            raise ParameterError(
                "borders must be a list of frames that begins with 0 and has at least two, not "
                f"{frames.tolist()!r:.60}"
            )
        object.__setattr__(self, "borders", frames.astype(np.int64))
        object.__setattr__(self, "labels", tuple(map(str, self.labels)))
        # Report the first fault, if any.
        for i in np.flatnonzero(np.diff(self.borders) <= 0)[:1]:
            before, after = self.borders[i : i + 2]
            raise ParameterError(f"borders must increase: {after} follows {before}")
        if len(self.labels) != self.borders.size - 1:
            raise ParameterError(
                f"{len(self.labels)} labels for {self.borders.size - 1} intervals: give one for "
                "each"
            )

    @classmethod
    def from_cuts(
        cls, cuts: ArrayLike, labels: Sequence[object] | None = None, *, frames: int, fps: float
    ) -> Labelling:
        """Create a labelling from cuts; by default each interval has a unique label."""
        # 0 and the length are also borders.
        borders: Any = [0, *np.atleast_1d(as_floats(cuts, "cuts")).tolist(), frames]
        names = range(len(borders) - 1) if labels is None else labels
        return cls(borders, tuple(map(str, names)), fps)

    @classmethod
    def from_frames(
        cls, labels: Sequence[object] | NDArray[np.generic], *, fps: float
    ) -> Labelling:
        """Create a labelling from one label per frame: one interval per run of equal labels."""
        # Compared as texts: nan differs from itself, and numpy would convert mixed types.
        names = np.array([str(label) for label in labels], dtype=object)
        if not names.size:
            raise ParameterError("no labels: give one label per frame")
        # + 1: the first frame of each new label.
        cuts = np.flatnonzero(names[1:] != names[:-1]) + 1
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
        """Return the distinct labels without transitions, in the order of `numbers`."""
        return [label for label in dict.fromkeys(self.labels) if label != TRANSITION]

    def numbers(self) -> Ints:
        """Return the number of the label of each frame; `UNLABELLED` in transitions."""
        numbers = {name: i for i, name in enumerate(self.names())}
        values = [numbers.get(label, UNLABELLED) for label in self.labels]
        return np.repeat(np.array(values, np.int64), np.diff(self.borders))

    def find_short_transitions(self) -> NDArray[np.bool_]:
        """Return whether each interval is a transition of up to 1 s between two others."""
        is_short = np.diff(self.borders) <= SHORT_TRANSITION_S * self.fps
        is_short &= np.array([label == TRANSITION for label in self.labels])
        # A transition at an end of the recording has only one border anyway.
        is_short[[0, -1]] = False
        return is_short

    def within(self, frames: NDArray[np.bool_], *, slack: float = 0.0) -> Labelling:
        """Remove the frames that are False; intervals without frames are dropped.

        Parts of up to ``slack`` frames of intervals that are mostly removed are dropped, too: they
        only show that borders are inexact.
        """
        # Number of kept frames before each frame.
        kept = np.concatenate([[0], np.cumsum(frames)])
        borders = self.borders.copy()
        is_removed = 2 * np.diff(kept[borders]) < np.diff(borders)
        for first, last in find_spans(frames).tolist():
            # The intervals that reach into this span from before it, and from after it.
            into = int(np.searchsorted(borders, first)) - 1
            if into >= 0 and is_removed[into] and borders[into + 1] <= min(first + slack, last - 1):
                borders[into + 1] = first
            back = int(np.searchsorted(borders, last)) - 1
            if is_removed[back] and borders[back] >= max(last - slack, first + 1):
                borders[back] = last
        # The new position of each border.
        return self._move(kept[borders], self.fps)

    def merged(self) -> Labelling:
        """Merge neighbours with equal labels."""
        labels = self.labels
        # Rows at which the label changes.
        rows = [i for i, label in enumerate(labels) if not i or label != labels[i - 1]]
        return Labelling(
            np.append(self.borders[rows], self.frames), tuple(labels[i] for i in rows), self.fps
        )

    def at(self, *, frames: int, fps: float) -> Labelling:
        """Convert to another frame rate.

        Borders are rounded to the nearest frame, halves up; empty intervals are dropped.

        Raises
        ------
        ParameterError
            The lengths in seconds differ by more than one frame of the slower rate.
        """
        check_length(self.frames, self.fps, frames, fps)
        moved = round_half_up(self.borders * (fps / self.fps))
        # Rounding must not exceed the end; the last border is the end itself.
        return self._move(np.append(np.minimum(moved[:-1], frames), frames), float(fps))

    def _move(self, borders: Ints, fps: float) -> Labelling:
        """Move the borders, and drop intervals that are then empty."""
        rows = np.flatnonzero(np.diff(borders) > 0)
        labels = tuple(self.labels[i] for i in rows)
        return Labelling(np.append(borders[rows], borders[-1]), labels, fps)


@dataclass(frozen=True, eq=False)
class Truth:
    """Actions in order, with the span in which people put each border.

    Action i is before border i. An exact border has ``earliest == mean == latest``.

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
        Number of repetitions of each action, None if unknown; empty if all are unknown.
    tolerance_s : float
        Seconds beyond these spans within which a found border is right.
    repetitions : Labelling, optional
        Single repetitions if people cut them, with transitions elsewhere; same length.

    Raises
    ------
    ParameterError
        Borders run backwards, overlap or are beyond the end, or there is no action.

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
        if not (np.isfinite(self.tolerance_s) and self.tolerance_s >= 0):
            raise ParameterError(f"the tolerance must be 0 s or more, not {self.tolerance_s}")
        if not set(self.labels) - {TRANSITION}:
            raise ParameterError("annotations need at least one action")
        if self.counts and len(self.counts) != len(self.labels):
            raise ParameterError(
                f"{len(self.counts)} counts for {len(self.labels)} actions: give one for each, "
                "None if unknown"
            )
        if self.repetitions is not None and self.repetitions.frames != self.frames:
            raise ParameterError(
                f"the repetitions are of {self.repetitions.frames} frames, not {self.frames}"
            )
        for name in ("earliest", "mean", "latest"):
            frames = np.asarray(getattr(self, name), np.int64)
            object.__setattr__(self, name, frames)
            if frames.shape != (len(self.labels) - 1,):
                shape = " x ".join(map(str, frames.shape))
                raise ParameterError(
                    f"{name} has {shape} borders, but {len(self.labels)} actions have "
                    f"{len(self.labels) - 1} between them"
                )
        # Report the first border whose mean is outside the span.
        for i in np.flatnonzero((self.mean < self.earliest) | (self.latest < self.mean))[:1]:
            raise ParameterError(
                f"the border after action {i + 1} ({self.labels[i]}) is not in order: "
                f"earliest {self.earliest[i]}, mean {self.mean[i]}, latest {self.latest[i]}"
            )
        for i in np.flatnonzero(self.latest >= self.frames)[:1]:
            raise ParameterError(
                f"the border after action {i + 1} ({self.labels[i]}) at frame {self.latest[i]} "
                f"is not before the end of the recording, frame {self.frames}"
            )
        # Certain part of each action: from its latest start to its earliest end.
        begins = np.concatenate([[0], self.latest])
        ends = np.concatenate([self.earliest, [self.frames]])
        for i in np.flatnonzero(ends <= begins)[:1]:
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
        """Create a truth: short transitions between two actions become uncertain borders.

        The middle of a transition of up to 1 s is the mean. A longer one, or one at the start or
        the end of the recording, stays an action. There is one count for each interval.
        """
        if len(counts) not in (0, len(labelling.labels)):
            raise ParameterError(
                f"counts has {len(counts)} entries for {len(labelling.labels)} intervals: give one "
                "for each, None if unknown"
            )
        # Short transitions between two actions are borders; at the ends they stay rows.
        middle = labelling.find_short_transitions()
        rows = np.flatnonzero(~middle).tolist()
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
        """Return actions, with the uncertain spans between them as transitions."""
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
        """Return actions only, cut at the mean marks."""
        return Labelling.from_cuts(self.mean, self.labels, frames=self.frames, fps=self.fps)


def round_half_up(values: ArrayLike) -> Ints:
    """Round to whole numbers, halves up, as in MATLAB; `np.round` rounds halves to even."""
    return np.floor(np.asarray(values, np.float64) + 0.5).astype(np.int64)


def check_length(frames: int, fps: float, others: int, rate: float) -> None:
    """Raise ParameterError if labels and recording (``others``, ``rate``) differ in length."""
    length, other = frames / fps, others / rate
    # Tolerate one frame of the slower rate, for rounding.
    if abs(length - other) > 1 / min(fps, rate) + 1e-9:
        raise ParameterError(
            f"the labels cover {length:.3f} s ({frames} frames at {fps:g} fps), but the "
            f"recording lasts {other:.3f} s ({others} frames at {rate:g} fps)"
        )


def check_rate(fps: float) -> None:
    """Raise ParameterError unless the frame rate is finite and positive."""
    if not (np.isfinite(fps) and fps > 0):
        raise ParameterError(f"the frame rate must be a positive number, not {fps}")


def add_repetitions(labels: Segmentation) -> Segmentation:
    """Convert labels to both levels: activities, and their repetitions as primitives.

    Neighbours with the same name become one activity. Without primitives or a count, they are its
    repetitions. In a file of primitives only, each is a repetition, and a pause that is not longer
    than its neighbours does not end the activity. The provenance holds the counts in
    ``["labels"]["counts"]``: one for each activity, None if unknown.

    Examples
    --------
    >>> columns = {"level": ["activity"] * 3, "kind": ["activity"] * 3, "start_frame": [0, 30, 60],
    ...     "stop_frame": [30, 60, 90], "label": ["squat", "squat", "walk"]}
    >>> labels = add_repetitions(Segmentation.from_columns(columns, n_frames=90, fps=30))
    >>> labels.cuts().tolist(), labels.provenance["labels"]["counts"]
    ([60], [2, None])
    """
    rows = list(labels.activities)
    origin = labels.provenance.get("labels", {})
    known_counts = _count_repetitions(labels)
    single = origin.get("level") == "primitive"
    groups = _group_rows(rows, pauses=single)
    primitives = list(labels.primitives) or _make_repetitions(
        rows, groups, known_counts, single=single
    )
    # A sum is known only if the count of each row is known.
    known = [[known_counts[i] for i in group if not _is_transition(rows[i])] for group in groups]
    counts: list[Count] = [
        sum(count or 0 for count in some) if some and None not in some else None for some in known
    ]
    starts = [rows[group[0]].start_frame for group in groups]
    found = [row.start_frame for row in primitives if not _is_transition(row)]
    # Number of repetitions that start in each group.
    numbers = np.bincount(np.searchsorted(starts, found, "right") - 1, minlength=len(groups))
    for i, group in enumerate(groups):
        # Counts given by people are kept.
        if all(known_counts[row] is None for row in group) and numbers[i]:
            counts[i] = int(numbers[i])
    joined = [replace(rows[g[0]], stop_frame=rows[g[-1]].stop_frame) for g in groups]
    provenance = {**labels.provenance, "labels": {**origin, "counts": counts}}
    return replace(replace_rows(labels, [*joined, *primitives]), provenance=provenance)


def make_truth(truth: Segmentation, *, n_frames: int, fps: float) -> Truth:
    """Convert the activities of a segmentation to a truth at a frame rate.

    Transitions become uncertain borders. Names of activities are their labels, or else their
    clusters. Counts are taken from the provenance, and repetitions are the primitives, see
    `add_repetitions`.
    """
    rows = truth.activities
    clusters = make_labelling(rows, fps=truth.fps)
    names = [
        TRANSITION if _is_transition(row) else _name_class(row.label) or name
        for row, name in zip(rows, clusters.labels, strict=True)
    ]
    # Numbers instead of labels identify the rows that remain at the new rate.
    numbered = replace(clusters, labels=tuple(map(str, range(len(names)))))
    numbered = numbered.at(frames=n_frames, fps=fps)
    kept = [int(label) for label in numbered.labels]  # others are shorter than a frame
    labels = replace(numbered, labels=tuple(names[i] for i in kept))
    counts = _count_repetitions(truth)
    actions = Truth.from_labelling(labels, counts=[counts[i] for i in kept])
    if not len(truth.primitives):
        return actions
    repetitions = make_labelling(truth.primitives, fps=truth.fps).at(frames=n_frames, fps=fps)
    return replace(actions, repetitions=repetitions)


def choose_comparison_rate(n_frames: int, fps: float) -> tuple[int, float]:
    """Return number of frames and rate of comparison of a result: 30 Hz, or its own if lower."""
    rate = min(FPS, fps)
    # Number of frames up to the last one; 1e-9 guards against rounding.
    return floor((n_frames - 1) * rate / fps + 1e-9) + 1, rate


def make_labelling(rows: SegmentTable, *, fps: float) -> Labelling:
    """Convert the clusters of one level of a segmentation to a labelling.

    Transitions are `TRANSITION`. Segments without a cluster have their label as name, or else a
    unique name.

    Parameters
    ----------
    rows : SegmentTable
        Segments of one level.
    fps : float
        Frames per second.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> make_labelling(found.activities, fps=found.fps).labels[:4]
    ('0', 'transition', '1', 'transition')
    """
    labels = [
        TRANSITION
        if row.kind == "transition"
        else f"{row.cluster}"
        if row.cluster >= 0
        else _name_class(row.label) or f"~{i}"
        for i, row in enumerate(rows)
    ]
    return Labelling(np.append(rows.start_frame, rows.stop_frame[-1]), tuple(labels), fps)


def _count_repetitions(labels: Segmentation) -> Sequence[Count]:
    """Return the known number of repetitions of each row of the activity level, or None."""
    counts: Sequence[Count] = labels.provenance.get("labels", {}).get("counts", ())
    rows = len(labels.activities)
    # Counts of another length are those of the table before it was edited.
    return counts if len(counts) == rows else [None] * rows


def _name_class(label: str) -> str:
    """Return a label as the name of a class, distinct from `TRANSITION`."""
    return f"{label} (activity)" if label == TRANSITION else label


def _is_transition(row: Segment) -> bool:
    return row.kind == "transition"


def _get_activity_name(row: Segment) -> str:
    """Return the name of an activity: label or cluster; empty for transitions or if unknown."""
    if _is_transition(row):
        return ""
    return row.label or (f"cluster {row.cluster}" if row.cluster >= 0 else "")


def _group_rows(rows: Sequence[Segment], *, pauses: bool) -> list[list[int]]:
    """Group the indices of rows that form one activity, or one transition."""
    groups: list[list[int]] = []
    for i, row in enumerate(rows):
        name = _get_activity_name(row)
        if name and groups and name == _get_activity_name(rows[groups[-1][-1]]):
            groups[-1].append(i)
        elif pauses and name and len(groups) > 1 and _is_pause(*rows[i - 2 : i + 1]):
            # Merge the pause and this row with the group before the pause.
            groups[-2:] = [[*groups[-2], i - 1, i]]
        else:
            groups.append([i])
    return groups


def _is_pause(before: Segment, between: Segment, after: Segment) -> bool:
    shorter = min(before.duration_s, after.duration_s)
    equal = _is_transition(between) and _get_activity_name(before) == _get_activity_name(after)
    return equal and between.duration_s <= shorter


def _make_repetitions(
    rows: Sequence[Segment],
    groups: Sequence[Sequence[int]],
    given: Sequence[Count],
    *,
    single: bool,
) -> list[Segment]:
    """Return primitives for groups of rows that are repetitions; empty if there are none."""
    primitives: list[Segment] = []
    for group in groups:
        first, last = rows[group[0]], rows[group[-1]]
        cut = not _is_transition(first) and all(given[i] is None for i in group)
        if cut and (single or len(group) > 1):
            for row in (rows[i] for i in group):
                kind = choose_kind("primitive", transition=_is_transition(row))
                primitives.append(replace(row, level="primitive", kind=kind))
        else:
            # Primitives must tile the recording, so fill unknown parts with a transition.
            primitives.append(
                Segment("primitive", "transition", first.start_frame, last.stop_frame, 0.0, 0.0)
            )
    return primitives if any(row.kind == "primitive" for row in primitives) else []
