"""Compare the truth and the result of a recording; all scores are functions of a `Comparison`.

Each frame has a class (truth) and a cluster (result), both as numbers. Clusters are mapped to
classes by the one-to-one assignment with the most right frames (Kuhn's Hungarian method). A cluster
without a class is wrong everywhere. Scores that need more than frames use the spans of both sides
(`Spans`).

There are two kinds of truth:

- Labels (`compare`). Frames without a label are removed from both sides, as is usual in action
  segmentation. Transitions of the result are an additional cluster. Borders are right within 0.5 s.
- A `Truth` with uncertain borders (`Comparison.of`). Every frame counts, and spans in which people
  disagree are transitions. Transitions of the result must match those of the truth; if the result
  has none, one of its clusters may be mapped to them. Borders are right within the truth's own
  tolerance.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import linear_sum_assignment

from kineme._util.arrays import Ints
from kineme._util.checks import check_type
from kineme.errors import ParameterError
from kineme.evaluation.truth import (
    TRANSITION,
    UNLABELLED,
    Labelling,
    Truth,
    add_repetitions,
    choose_comparison_rate,
    make_labelling,
    make_truth,
)
from kineme.labels.spans import format_text
from kineme.segments.segmentation import Segmentation

LABELS_TOLERANCE_S = 0.5
"""Tolerance of borders if the truth is labels, s."""

R = TypeVar("R")


class Run(NamedTuple):
    """Consecutive frames ``[start, stop)`` with the same label."""

    label: int
    start: int
    stop: int


class Repetitions(NamedTuple):
    """Actions of the truth with their repetitions, and found primitives, on all frames."""

    actions: Truth
    primitives: Labelling


@dataclass(frozen=True, eq=False)
class Spans:
    """Both sides of a comparison as intervals of the same frames.

    Attributes
    ----------
    actions : Truth
        The truth.
    activities, primitives : Labelling
        The result: activities, and single repetitions.
    positions : array_like, (frames, joints, 3), optional
        Positions of the recording: metres, y up.
    features : array_like, (frames, dims), optional
        Stacked features of the recording.
    repetitions : Repetitions, optional
        Both sides on all frames, if frames were removed from the others; by default ``actions``
        and ``primitives``.

    Examples
    --------
    >>> spans = Comparison([0, 0, 1, 1], [5, 5, 5, 3], fps=10).spans
    >>> spans.actions.labels, spans.activities.borders.tolist()
    (('0', '1'), [0, 3, 4])
    """

    actions: Truth
    activities: Labelling
    primitives: Labelling
    positions: ArrayLike | None = None
    features: ArrayLike | None = None
    repetitions: Repetitions | None = None


@dataclass(frozen=True, eq=False)
class Comparison:
    """Truth and result for the frames of a recording.

    Parameters
    ----------
    truth : array_like of int, (frames,)
        Class of each frame that counts.
    found : array_like of int, (frames,)
        Cluster of each of these frames.
    fps : float
        Frames per second.
    mapping : mapping of int to int, optional
        Class of each cluster; by default the best mapping for this recording.
    transitions : bool
        Whether -1 means a transition, which is right only in transitions of the truth. By
        default -1 is a cluster like all others.
    intervals : Spans, optional
        Both sides as intervals; by default the runs of these numbers.
    segments : array_like of int, (frames,), optional
        Cluster of each frame for scores of segments, if frames were removed: without parts of
        removed segments that remain next to them. By default ``found``.

    Raises
    ------
    ParameterError
        Both have different lengths, or are empty.

    Examples
    --------
    >>> compared = Comparison([0, 0, 1, 1], [5, 5, 5, 3], fps=10)
    >>> compared.mapped.tolist()
    [0, 0, 0, 1]
    >>> compared.true_runs
    [Run(label=0, start=0, stop=2), Run(label=1, start=2, stop=4)]
    """

    truth: Ints
    found: Ints
    fps: float
    mapping: Mapping[int, int] | None = None
    transitions: bool = False
    intervals: Spans | None = None
    segments: ArrayLike = ()
    _results: dict[Callable[[Comparison], Any], Any] = field(
        default_factory=dict, init=False, repr=False
    )

    def __post_init__(self) -> None:
        segments = self.segments if np.size(self.segments) else self.found
        for name, side in (("truth", self.truth), ("found", self.found), ("segments", segments)):
            object.__setattr__(self, name, np.asarray(side, np.int64))
        if self.truth.shape != self.found.shape or self.truth.ndim != 1 or not self.truth.size:
            raise ParameterError(
                f"truth and result need one label for each of the same frames, not shapes "
                f"{self.truth.shape} and {self.found.shape}"
            )

    @classmethod
    def of(
        cls,
        truth: Truth | Segmentation,
        found: Segmentation | Labelling,
        *,
        positions: ArrayLike | None = None,
        features: ArrayLike | None = None,
    ) -> Comparison:
        """Compare a result with a truth that has uncertain borders.

        The parameters are those of `kineme.evaluation.evaluate`.

        Raises
        ------
        ParameterError
            The result has another length than the truth, or one of them is something else.
        """
        advice = "kineme.read_segments(path) reads labels, kineme.segment(recording) gives a result"
        check_type(truth, (Segmentation, Truth), "evaluate", advice)
        check_type(found, (Segmentation, Labelling), "evaluate", advice)
        if isinstance(found, Segmentation):
            rows = found.activities
            activities = primitives = clusters = make_labelling(rows, fps=found.fps)
            if len(found.primitives):
                primitives = make_labelling(found.primitives, fps=found.fps)
            # If no activity has a cluster or label, compare primitives.
            if not np.any((rows.cluster >= 0) | (rows.label != "")):
                clusters = primitives
        else:
            activities = primitives = clusters = found
        if isinstance(truth, Segmentation):
            n_frames, fps = choose_comparison_rate(activities.frames, activities.fps)
            truth = make_truth(add_repetitions(truth), n_frames=n_frames, fps=fps)
        groups, spans, units = (
            level.at(frames=truth.frames, fps=truth.fps)
            for level in (clusters, activities, primitives)
        )
        return cls(
            truth.labelling().numbers(),
            groups.numbers(),
            truth.fps,
            transitions=True,
            intervals=Spans(truth, spans, units, positions, features),
        )

    @cached_property
    def mapped(self) -> Ints:
        """Return the class of the cluster of each frame; below 0 if it has none."""
        return self._map(self.found)

    def _map(self, found: ArrayLike) -> Ints:
        """Return the class of the cluster of each of these frames."""
        mapping = map_clusters([self]) if self.mapping is None else self.mapping
        clusters, inverse = np.unique(found, return_inverse=True)
        # Clusters without a class get distinct numbers below -1, which means transition.
        classes = [mapping.get(int(c), -2 - i) for i, c in enumerate(clusters)]
        return np.asarray(classes, np.int64)[inverse]

    @cached_property
    def agreed(self) -> Comparison:
        """Return the comparison of the frames on which people agree, with its own mapping."""
        certain = self.truth != UNLABELLED
        if certain.all() or not certain.any():
            return self
        return Comparison(
            self.truth[certain],
            self.found[certain],
            self.fps,
            self.mapping,
            transitions=self.transitions,
        )

    @cached_property
    def spans(self) -> Spans:
        """Return both sides as intervals."""
        if self.intervals is not None:
            return self.intervals
        found, truth = (
            Labelling.from_frames(each, fps=self.fps) for each in (self.found, self.truth)
        )
        actions = Truth.from_labelling(truth, tolerance_s=LABELS_TOLERANCE_S)
        return Spans(actions, found, found)

    @property
    def repetitions(self) -> Repetitions:
        """Return both sides for counting repetitions: on all frames of the recording."""
        spans = self.spans
        return spans.repetitions or Repetitions(spans.actions, spans.primitives)

    def without_silence(self) -> Comparison:
        """Return the comparison between the start of the first action and the end of the last.

        Outside, the truth is unknown.
        """
        spans, actions = self.spans, self.spans.actions
        first, last = (actions.labels[i] == TRANSITION for i in (0, -1))
        if not first and not last:
            return self
        # Start at the latest mark of the first action.
        start = int(actions.latest[0]) if first else 0
        stop = int(actions.earliest[-1]) if last else actions.frames
        # There is one border less than actions.
        rows = slice(int(first), len(actions.labels) - int(last))
        between = slice(rows.start, rows.stop - 1)
        inner = replace(
            actions,
            labels=actions.labels[rows],
            earliest=actions.earliest[between] - start,
            mean=actions.mean[between] - start,
            latest=actions.latest[between] - start,
            frames=stop - start,
            counts=actions.counts[rows],
            repetitions=None,
        )
        counted = np.zeros(actions.frames, np.bool_)
        counted[start:stop] = True
        slack = actions.tolerance_s * actions.fps
        intervals = Spans(
            inner,
            spans.activities.merged().within(counted, slack=slack),
            primitives=spans.primitives.within(counted),
            positions=None if spans.positions is None else np.asarray(spans.positions)[counted],
            features=None if spans.features is None else np.asarray(spans.features)[counted],
            repetitions=self.repetitions,
        )
        return replace(
            self,
            truth=self.truth[counted],
            found=self.found[counted],
            intervals=intervals,
            segments=_select_frames(self.found, counted, slack),
        )

    @cached_property
    def true_runs(self) -> list[Run]:
        """Return the runs of frames of one class."""
        return find_runs(self.truth)

    @cached_property
    def mapped_runs(self) -> list[Run]:
        """Return the runs of frames whose clusters are mapped to one class."""
        return find_runs(self._map(self.segments))

    @cached_property
    def found_runs(self) -> list[Run]:
        """Return the runs of frames of one cluster."""
        return find_runs(self.found)

    def once(self, measure: Callable[[Comparison], R]) -> R:
        """Return the value of a function of this comparison, cached for all scores that use it."""
        if measure not in self._results:
            self._results[measure] = measure(self)
        result: R = self._results[measure]
        return result


def compare(
    truth: Segmentation, found: Segmentation, *, classes: dict[str, int] | None = None
) -> Comparison:
    """Compare a result with labels, on the frames that have a label.

    Parameters
    ----------
    truth : Segmentation
        The labels of its activities are the classes; its transitions are frames without a label.
        For its repetitions see `kineme.evaluation.truth`.
    found : Segmentation
        The clusters of its activities are compared. Transitions are one cluster; each activity
        without a cluster is a separate one.
    classes : dict of str to int, optional
        Numbers of classes; new ones are added. Use the same dict for several recordings.

    Returns
    -------
    Comparison
        At the common frame rate.

    Raises
    ------
    ParameterError
        Truth and result have different lengths, or nothing is labelled.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> truth = kineme.read_segments(bundled_truth())
    >>> compared = compare(truth, truth)
    >>> bool((compared.mapped == compared.truth).all())
    True
    """
    for table in (truth, found):
        check_type(table, Segmentation, "compare", "kineme.read_segments(path) reads one")
    if truth.n_frames != found.n_frames:
        raise ParameterError(
            f"the labels have {truth.n_frames} frames, but the result has {found.n_frames}"
        )
    truth = add_repetitions(truth)
    numbers = {} if classes is None else classes
    row_classes = [
        UNLABELLED
        if row.kind == "transition"
        else numbers.setdefault(format_text(row), len(numbers))
        for row in truth.activities
    ]
    rows = found.activities
    # Activities in no cluster get numbers above all clusters.
    unique = 1 + rows.cluster.max() + np.arange(len(rows))
    row_clusters = np.where(rows.cluster >= 0, rows.cluster, unique)
    row_clusters[rows.kind == "transition"] = UNLABELLED
    labels, clusters = _expand_to_frames(truth, row_classes), _expand_to_frames(found, row_clusters)
    counted = labels != UNLABELLED
    if not counted.any():
        raise ParameterError("the labels do not cover this recording: every frame is unlabelled")
    # Remove frames without a label from both sides.
    segments = _select_frames(clusters, counted, LABELS_TOLERANCE_S * found.fps)
    spans = Comparison(labels[counted], segments, found.fps).spans
    single = make_labelling(found.primitives or found.activities, fps=truth.fps)
    actions = make_truth(truth, n_frames=truth.n_frames, fps=truth.fps)
    intervals = replace(
        spans,
        # Without the removed frames; but repetitions are counted on all frames.
        primitives=single.within(counted) if len(found.primitives) else spans.primitives,
        repetitions=Repetitions(actions, single),
    )
    return Comparison(
        labels[counted], clusters[counted], found.fps, intervals=intervals, segments=segments
    )


def map_clusters(comparisons: Sequence[Comparison]) -> dict[int, int]:
    """Map clusters to classes one to one, so that most frames of all recordings are right.

    If there are more clusters than classes, the least useful clusters have no class.

    Examples
    --------
    >>> map_clusters([Comparison([0, 0, 1], [4, 4, 4], fps=1), Comparison([1], [9], fps=1)])
    {4: 0, 9: 1}
    """
    truth, found = (
        np.concatenate([getattr(c, side) for c in comparisons]) for side in ("truth", "found")
    )
    mapping = {}
    if any(c.transitions for c in comparisons) and (found == UNLABELLED).any():
        # Transitions are only mapped to transitions, so leave them out of the assignment.
        mapping = {UNLABELLED: UNLABELLED}
        free = (found != UNLABELLED) & (truth != UNLABELLED)
        truth, found = truth[free], found[free]
    clusters, classes, frames = count_frames(found, truth)
    # Hungarian method: the assignment of clusters to classes with the most common frames.
    pairs = zip(*linear_sum_assignment(frames, maximize=True), strict=True)
    return mapping | {int(clusters[row]): int(classes[column]) for row, column in pairs}


def count_frames(found: Ints, truth: Ints) -> tuple[Ints, Ints, Ints]:
    """Return clusters, classes, and the frames of each cluster (row) and class (column)."""
    clusters, rows = np.unique(found, return_inverse=True)
    classes, columns = np.unique(truth, return_inverse=True)
    frames = np.zeros((len(clusters), len(classes)), np.int64)
    # `add.at` also counts repeated index pairs, unlike `+=`.
    np.add.at(frames, (rows, columns), 1)
    return clusters, classes, frames


def find_runs(labels: ArrayLike) -> list[Run]:
    """Return the runs of equal labels, in order.

    Examples
    --------
    >>> find_runs([3, 3, 5])
    [Run(label=3, start=0, stop=2), Run(label=5, start=2, stop=3)]
    """
    per_frame = np.asarray(labels, np.int64)
    # + 1: a difference at i is a change between frames i and i + 1.
    borders = [0, *(np.flatnonzero(np.diff(per_frame)) + 1).tolist(), len(per_frame)]
    return [Run(int(per_frame[a]), a, b) for a, b in pairwise(borders) if a < b]


def _select_frames(found: Ints, counted: NDArray[np.bool_], slack: float) -> Ints:
    """Return the numbers of counted frames, see `Labelling.within`."""
    kept = Labelling.from_frames(found, fps=1).within(counted, slack=slack)
    return kept.per_frame().astype(np.int64)


def _expand_to_frames(segmentation: Segmentation, values: ArrayLike) -> Ints:
    """Repeat one value per activity for each of its frames."""
    rows = segmentation.activities
    return np.repeat(np.asarray(values, np.int64), rows.stop_frame - rows.start_frame)
