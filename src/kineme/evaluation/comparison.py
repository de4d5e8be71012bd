"""Truth and result of a recording, frame by frame, and the classes that clusters stand for.

Frames without a label count in nothing: they are cut out of both sides before anything is
compared, as is usual in action segmentation. A method names clusters, people name classes; a
one-to-one assignment that gets the most frames right (Kuhn's Hungarian method) says which
cluster stands for which class. A cluster that none is left for is wrong everywhere.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import linear_sum_assignment

from kineme.errors import ParameterError
from kineme.labels.spans import text_of
from kineme.segments.segmentation import Segmentation

Ints = NDArray[np.int64]

UNLABELLED = -1
"""The class of frames of which people say nothing; the cluster of a result's transitions."""


class Run(NamedTuple):
    """Frames ``[start, stop)`` in a row that have one label."""

    label: int
    start: int
    stop: int


@dataclass(frozen=True, eq=False)
class Comparison:
    """What people say about the frames of a recording, and what a method found there.

    Parameters
    ----------
    truth : array_like of int, (frames,)
        The class of each frame that has one.
    found : array_like of int, (frames,)
        The cluster of each of these frames.
    fps : float
        Frames per second.
    mapping : mapping of int to int, optional
        The class of each cluster; by default the best for this recording alone.

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

    def __post_init__(self) -> None:
        for name in ("truth", "found"):
            object.__setattr__(self, name, np.asarray(getattr(self, name), np.int64))
        if self.truth.shape != self.found.shape or self.truth.ndim != 1 or not self.truth.size:
            raise ParameterError(
                f"truth and result need one label for each of the same frames, not shapes "
                f"{self.truth.shape} and {self.found.shape}"
            )

    @cached_property
    def mapped(self) -> Ints:
        """The class that each frame's cluster stands for; below 0 where it stands for none."""
        mapping = best_mapping([self]) if self.mapping is None else self.mapping
        clusters, where = np.unique(self.found, return_inverse=True)
        classes = [mapping.get(int(c), -2 - i) for i, c in enumerate(clusters)]
        return np.asarray(classes, np.int64)[where]

    @cached_property
    def true_runs(self) -> list[Run]:
        """The runs of one class."""
        return runs(self.truth)

    @cached_property
    def mapped_runs(self) -> list[Run]:
        """The runs of clusters that stand for one class."""
        return runs(self.mapped)

    @cached_property
    def found_runs(self) -> list[Run]:
        """The runs of one cluster."""
        return runs(self.found)


def compare(
    truth: Segmentation, found: Segmentation, *, classes: dict[str, int] | None = None
) -> Comparison:
    """The frames of a recording to which people gave a label, and the clusters found there.

    Parameters
    ----------
    truth : Segmentation
        Its activities' labels are the classes; its transitions are frames without a label.
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
    numbers = {} if classes is None else classes
    wanted = [
        UNLABELLED if row.kind == "transition" else numbers.setdefault(text_of(row), len(numbers))
        for row in truth.activities
    ]
    lonely = 1 + max(found.activities.cluster.tolist(), default=0)
    given = [
        UNLABELLED if row.kind == "transition" else row.cluster if row.cluster >= 0 else lonely + i
        for i, row in enumerate(found.activities)
    ]
    labels, clusters = _spread(truth, wanted), _spread(found, given)
    counted = labels != UNLABELLED
    if not counted.any():
        raise ParameterError("the labels say nothing of this recording: every frame is unlabelled")
    return Comparison(labels[counted], clusters[counted], found.fps)


def best_mapping(comparisons: Sequence[Comparison]) -> dict[int, int]:
    """The class of each cluster by which most frames of all the recordings are right.

    One-to-one: of more clusters than classes, those that would add least stand for none.

    Parameters
    ----------
    comparisons : sequence of Comparison
        Equal numbers mean the same cluster, and the same class, in all of them.

    Returns
    -------
    dict of int to int
        Clusters that stand for no class are missing.

    Examples
    --------
    >>> best_mapping([Comparison([0, 0, 1], [4, 4, 4], fps=1), Comparison([1], [9], fps=1)])
    {4: 0, 9: 1}
    """
    classes, wanted = np.unique(np.concatenate([c.truth for c in comparisons]), return_inverse=True)
    clusters, given = np.unique(np.concatenate([c.found for c in comparisons]), return_inverse=True)
    frames = np.zeros((len(clusters), len(classes)), np.int64)
    np.add.at(frames, (given, wanted), 1)
    pairs = zip(*linear_sum_assignment(frames, maximize=True), strict=True)
    return {int(clusters[row]): int(classes[column]) for row, column in pairs}


def runs(labels: ArrayLike) -> list[Run]:
    """The runs of equal labels, in order.

    Parameters
    ----------
    labels : array_like of int, (frames,)

    Returns
    -------
    list of Run

    Examples
    --------
    >>> runs([3, 3, 5])
    [Run(label=3, start=0, stop=2), Run(label=5, start=2, stop=3)]
    """
    per_frame = np.asarray(labels, np.int64)
    borders = [0, *(np.flatnonzero(np.diff(per_frame)) + 1).tolist(), len(per_frame)]
    return [Run(int(per_frame[a]), a, b) for a, b in pairwise(borders) if a < b]


def _spread(segmentation: Segmentation, values: Sequence[int]) -> Ints:
    rows = segmentation.activities
    return np.repeat(np.asarray(values, np.int64), rows.stop_frame - rows.start_frame)
