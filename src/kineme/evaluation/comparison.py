"""Truth and result of a recording beside each other: what every score is a function of.

Frame by frame, classes and clusters are numbers. People name classes, a method clusters; a
one-to-one assignment that gets the most frames right (Kuhn's Hungarian method) says which
cluster stands for which class. A cluster that none is left for is wrong everywhere. Scores that
count more than frames read the spans of both sides (`Spans`).

There are two ways to put the two sides together, by what the truth is:

- labels (`compare`): frames without a label count in nothing and are cut out of both sides, as
  is usual in action segmentation; transitions of the result are one more cluster. Borders are
  right within 0.5 s.
- a `Truth` with uncertain borders (`Comparison.of`): every frame counts, and where people
  disagree is a class of its own. Transitions of the result must match those of the truth;
  where it has none, one of its clusters may stand for them. Borders are right within the truth's
  own tolerance.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import linear_sum_assignment

from kineme._util.arrays import Ints
from kineme.errors import ParameterError
from kineme.evaluation.label_truth import add_repetitions, make_labelling, make_truth
from kineme.evaluation.truth import TRANSITION, UNLABELLED, Labelling, Truth
from kineme.labels.spans import format_text
from kineme.segments.segmentation import Segmentation

LABELS_TOLERANCE_S = 0.5
"""Seconds within which a border is right where the truth is labels."""

R = TypeVar("R")


class Run(NamedTuple):
    """Frames ``[start, stop)`` in a row that have one label."""

    label: int
    start: int
    stop: int


class Repetitions(NamedTuple):
    """Actions of the truth with the repetitions in them, and what was found, of every frame."""

    actions: Truth
    primitives: Labelling


@dataclass(frozen=True, eq=False)
class Spans:
    """Both sides of a comparison in intervals, all of the same frames.

    Attributes
    ----------
    actions : Truth
        What people say.
    activities, primitives : Labelling
        What was found: spans of one activity, single repetitions.
    positions : array_like, (frames, joints, 3), optional
        Of the recording: metres, y up.
    features : array_like, (frames, dims), optional
        Of the recording, stacked.
    repetitions : Repetitions, optional
        Both sides of every frame, where the others are of those alone that count; by default
        ``actions`` and ``primitives``.

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
    """What people say about the frames of a recording, and what a method found there.

    Parameters
    ----------
    truth : array_like of int, (frames,)
        The class of each frame that counts.
    found : array_like of int, (frames,)
        The cluster of each of these frames.
    fps : float
        Frames per second.
    mapping : mapping of int to int, optional
        The class of each cluster; by default the best for this recording alone.
    transitions : bool
        Whether -1 on either side is a transition: then a found one is right in those of the
        truth and nowhere else. By default -1 is a cluster as any other.
    intervals : Spans, optional
        Both sides in intervals; by default the runs of these numbers.

    Raises
    ------
    ParameterError
        The two are not of one length, or empty.

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
    _results: dict[Callable[[Comparison], Any], Any] = field(
        default_factory=dict, init=False, repr=False
    )

    def __post_init__(self) -> None:
        for name in ("truth", "found"):
            object.__setattr__(self, name, np.asarray(getattr(self, name), np.int64))
        if self.truth.shape != self.found.shape or self.truth.ndim != 1 or not self.truth.size:
            raise ParameterError(
                f"truth and result need one label for each of the same frames, not shapes "
                f"{self.truth.shape} and {self.found.shape}"
            )

    @classmethod
    def of(
        cls,
        truth: Truth,
        clusters: Labelling,
        *,
        activities: Labelling | None = None,
        primitives: Labelling | None = None,
        positions: ArrayLike | None = None,
        features: ArrayLike | None = None,
    ) -> Comparison:
        """Return a result beside a truth whose borders are uncertain, at the truth's frame rate.

        Parameters are those of `kineme.evaluation.evaluate`.

        Raises
        ------
        ParameterError
            Labels of another length than the truth.
        """
        # Activities and primitives are the clusters by default.
        groups, spans, units = (
            (level or clusters).at(frames=truth.frames, fps=truth.fps)
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
        """Class that each frame's cluster stands for; below 0 where it stands for none."""
        mapping = map_clusters([self]) if self.mapping is None else self.mapping
        clusters, where = np.unique(self.found, return_inverse=True)
        # Clusters without a class get numbers of their own, below that of transitions.
        classes = [mapping.get(int(c), -2 - i) for i, c in enumerate(clusters)]
        return np.asarray(classes, np.int64)[where]

    @cached_property
    def agreed(self) -> Comparison:
        """Return the same of the frames on which people agree, with a mapping of their own."""
        certain = self.truth != UNLABELLED
        # Without certain frames there is nothing to cut out.
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
        """Both sides in intervals."""
        if self.intervals is not None:
            return self.intervals
        found = _make_labelling(self.found_runs, self.fps)
        truth = _make_labelling(self.true_runs, self.fps)
        actions = Truth.from_labelling(truth, tolerance_s=LABELS_TOLERANCE_S)
        return Spans(actions, found, found)

    @property
    def repetitions(self) -> Repetitions:
        """Return what repetitions are counted on: every frame of the recording."""
        spans = self.spans
        return spans.repetitions or Repetitions(spans.actions, spans.primitives)

    def without_silence(self) -> Comparison:
        """Return the same between the start of the first action and the end of the last.

        Beyond them the truth says nothing, and nothing is right or wrong there.
        """
        spans, actions = self.spans, self.spans.actions
        first, last = (actions.labels[i] == TRANSITION for i in (0, -1))
        if not first and not last:
            return self
        # Silence ends at the latest mark at which the first action may begin.
        start = int(actions.latest[0]) if first else 0
        stop = int(actions.earliest[-1]) if last else actions.frames
        # A border lies between two actions, so there is one less.
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
        intervals = Spans(
            inner,
            spans.activities.within(counted),
            spans.primitives.within(counted),
            None if spans.positions is None else np.asarray(spans.positions)[counted],
            None if spans.features is None else np.asarray(spans.features)[counted],
            self.repetitions,
        )
        return replace(
            self, truth=self.truth[counted], found=self.found[counted], intervals=intervals
        )

    @cached_property
    def true_runs(self) -> list[Run]:
        """Return the runs of one class."""
        return find_runs(self.truth)

    @cached_property
    def mapped_runs(self) -> list[Run]:
        """Return the runs of clusters that stand for one class."""
        return find_runs(self.mapped)

    @cached_property
    def found_runs(self) -> list[Run]:
        """Return the runs of one cluster."""
        return find_runs(self.found)

    def once(self, measure: Callable[[Comparison], R]) -> R:
        """What a function gives of this comparison, computed once for all scores that ask."""
        if measure not in self._results:
            self._results[measure] = measure(self)
        result: R = self._results[measure]
        return result


def compare(
    truth: Segmentation, found: Segmentation, *, classes: dict[str, int] | None = None
) -> Comparison:
    """Return the frames of a recording to which people gave a label, and the clusters found there.

    Parameters
    ----------
    truth : Segmentation
        Its activities' labels are the classes; its transitions are frames without a label. What
        it says of repetitions, `kineme.evaluation.label_truth` tells.
    found : Segmentation
        Its activities' clusters. Transitions are one cluster; an activity in no cluster is
        one of its own.
    classes : dict of str to int, optional
        Numbers of classes; new ones are added. Give the same one for several recordings.

    Returns
    -------
    Comparison
        At the frames of both.

    Raises
    ------
    ParameterError
        Truth and result are of another length, or nothing is labelled.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> truth = kineme.read_segments(bundled_truth())
    >>> compared = compare(truth, truth)
    >>> bool((compared.mapped == compared.truth).all())
    True
    """
    if truth.n_frames != found.n_frames:
        raise ParameterError(
            f"the labels are of {truth.n_frames} frames, the result of {found.n_frames}"
        )
    truth = add_repetitions(truth)
    numbers = {} if classes is None else classes
    classes_of_rows = [
        UNLABELLED
        if row.kind == "transition"
        else numbers.setdefault(format_text(row), len(numbers))
        for row in truth.activities
    ]
    # Activities in no cluster get numbers above all clusters.
    lonely = 1 + max(found.activities.cluster.tolist(), default=0)
    groups = [
        UNLABELLED if row.kind == "transition" else row.cluster if row.cluster >= 0 else lonely + i
        for i, row in enumerate(found.activities)
    ]
    labels, clusters = _spread_labels(truth, classes_of_rows), _spread_labels(found, groups)
    counted = labels != UNLABELLED
    if not counted.any():
        raise ParameterError("the labels say nothing of this recording: every frame is unlabelled")
    # Frames without a label are cut out of both sides.
    compared = Comparison(labels[counted], clusters[counted], found.fps)
    spans = compared.spans
    single = make_labelling(found.primitives or found.activities, fps=truth.fps)
    actions = make_truth(truth, n_frames=truth.n_frames, fps=truth.fps)
    intervals = replace(
        spans,
        # Primitives without the frames that were cut out; repetitions are counted on every frame.
        primitives=single.within(counted) if len(found.primitives) else spans.primitives,
        repetitions=Repetitions(actions, single),
    )
    return replace(compared, intervals=intervals)


def map_clusters(comparisons: Sequence[Comparison]) -> dict[int, int]:
    """Return the class of each cluster by which most frames of all the recordings are right.

    One-to-one: of more clusters than classes, those that would add least stand for none.

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
        # A transition can only stand for a transition, so it takes no part in the assignment.
        mapping = {UNLABELLED: UNLABELLED}
        free = (found != UNLABELLED) & (truth != UNLABELLED)
        truth, found = truth[free], found[free]
    clusters, classes, frames = count_frames(found, truth)
    # Hungarian method: the assignment of clusters to classes with the most common frames.
    pairs = zip(*linear_sum_assignment(frames, maximize=True), strict=True)
    return mapping | {int(clusters[row]): int(classes[column]) for row, column in pairs}


def count_frames(found: Ints, truth: Ints) -> tuple[Ints, Ints, Ints]:
    """Clusters, classes, and how many frames are of each cluster (row) and class (column)."""
    clusters, given = np.unique(found, return_inverse=True)
    classes, true = np.unique(truth, return_inverse=True)
    frames = np.zeros((len(clusters), len(classes)), np.int64)
    # `add.at` adds repeated index pairs one by one.
    np.add.at(frames, (given, true), 1)
    return clusters, classes, frames


def find_runs(labels: ArrayLike) -> list[Run]:
    """Return the runs of equal labels, in order.

    Examples
    --------
    >>> find_runs([3, 3, 5])
    [Run(label=3, start=0, stop=2), Run(label=5, start=2, stop=3)]
    """
    per_frame = np.asarray(labels, np.int64)
    # A run begins where the number changes: the difference belongs to the frame before.
    borders = [0, *(np.flatnonzero(np.diff(per_frame)) + 1).tolist(), len(per_frame)]
    return [Run(int(per_frame[a]), a, b) for a, b in pairwise(borders) if a < b]


def _make_labelling(found: Sequence[Run], fps: float) -> Labelling:
    """Runs as intervals; the number of a label is its name, that of transitions, too."""
    borders = [*(run.start for run in found), found[-1].stop]
    return Labelling(np.array(borders), tuple(f"{run.label}" for run in found), fps)


def _spread_labels(segmentation: Segmentation, values: Sequence[int]) -> Ints:
    rows = segmentation.activities
    return np.repeat(np.asarray(values, np.int64), rows.stop_frame - rows.start_frame)
