"""Scores of one result against what annotators say, uncertain borders and all: one object each.

Scores of labels read ``clusters``; scores of borders, and the published
strict and tolerant accuracies, read ``activities``; repetitions and variances
read ``primitives``. Where a method has only one level, all three are the same.

They stand beside the scores of `kineme.evaluation.score`, which compare plain labels frame
by frame: an `Annotation` has several annotators and borders that are not sure.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from kineme.evaluation.annotation import Annotation
from kineme.evaluation.borders import border_ratio, covering, cut_ratio
from kineme.evaluation.frames import cluster_ratio, mutual_information, rand_index
from kineme.evaluation.judged import Judged, Pair
from kineme.evaluation.labelling import TRANSITION, Labelling
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import SegmentTable


@dataclass(frozen=True)
class AnnotatedScore:
    """One way of judging a result by an annotation.

    Parameters
    ----------
    name : str
        In JSON and CSV.
    title : str
        In tables.
    group : str
        Under which tables show it.
    function : callable
        From a `Judged` to a number, or to None where the truth does not tell.
    """

    name: str
    title: str
    group: str
    function: Callable[[Judged], float | None]


def _of(pair: Pair | None, which: int) -> float | None:
    return None if pair is None else pair[which]


PUBLISHED, FAIR, RATIOS = "published protocols", "fair", "found / true"
REPETITIONS, WITHIN = "repetitions", "within clusters"

SCORES = (
    AnnotatedScore("strict", "strict", PUBLISHED, lambda j: j.published[0]),
    AnnotatedScore("tolerant", "tolerant", PUBLISHED, lambda j: j.published[1]),
    AnnotatedScore("majority", "majority", PUBLISHED, lambda j: j.majority[0]),
    AnnotatedScore("majority_agreed", "majority, agreed", PUBLISHED, lambda j: j.majority[1]),
    AnnotatedScore("one_to_one", "one to one", FAIR, lambda j: j.one_to_one[0]),
    AnnotatedScore("one_to_one_agreed", "one to one, agreed", FAIR, lambda j: j.one_to_one[1]),
    AnnotatedScore(
        "rand_index", "adjusted Rand", FAIR, lambda j: rand_index(j.truth, j.clusters)
    ),
    AnnotatedScore(
        "mutual_information", "mutual information", FAIR,
        lambda j: mutual_information(j.truth, j.clusters),
    ),
    AnnotatedScore("border_precision", "border precision", FAIR, lambda j: j.borders.precision),
    AnnotatedScore("border_recall", "border recall", FAIR, lambda j: j.borders.recall),
    AnnotatedScore("border_f1", "border F1", FAIR, lambda j: j.borders.f1),
    AnnotatedScore("covering", "covering", FAIR, lambda j: covering(j.truth, j.activities)),
    AnnotatedScore(
        "border_ratio", "borders", RATIOS, lambda j: border_ratio(j.truth, j.activities)
    ),
    AnnotatedScore("cut_ratio", "cuts", RATIOS, lambda j: cut_ratio(j.truth, j.activities)),
    AnnotatedScore(
        "cluster_ratio", "clusters", RATIOS, lambda j: cluster_ratio(j.truth, j.clusters)
    ),
    AnnotatedScore("count_error", "count error", REPETITIONS, lambda j: _of(j.counts, 0)),
    AnnotatedScore("count_exact", "counted exactly", REPETITIONS, lambda j: _of(j.counts, 1)),
    AnnotatedScore("cloud_distance", "cloud distance, m", WITHIN, lambda j: _of(j.clouds, 0)),
    AnnotatedScore("cloud_variance", "cloud variance, m²", WITHIN, lambda j: _of(j.clouds, 1)),
    AnnotatedScore("feature_distance", "feature distance, m", WITHIN, lambda j: _of(j.vectors, 0)),
    AnnotatedScore("feature_variance", "feature variance, m²", WITHIN, lambda j: _of(j.vectors, 1)),
    AnnotatedScore("length_mean", "length, s", WITHIN, lambda j: j.lengths[0]),
    AnnotatedScore("length_variance", "length variance, s²", WITHIN, lambda j: j.lengths[1]),
)  # fmt: skip
"""In the order in which tables show them; a score more is an object more here."""


def evaluate(
    truth: Annotation,
    clusters: Labelling,
    *,
    activities: Labelling | None = None,
    primitives: Labelling | None = None,
    positions: ArrayLike | None = None,
    features: ArrayLike | None = None,
) -> dict[str, float]:
    """All scores by name, in reading order; best is 1 unless the name says otherwise.

    ``strict``, ``tolerant``, ``majority``, ``majority_agreed`` are the
    published protocols; ``one_to_one``, ``one_to_one_agreed`` (frames on which
    the annotators agree), ``rand_index``, ``mutual_information``,
    ``border_precision``, ``border_recall``, ``border_f1``, ``covering`` the
    fair ones. ``border_ratio``, ``cut_ratio`` and ``cluster_ratio`` are found
    over true. ``count_error``, ``count_exact`` appear where the truth knows
    counts, ``cloud_distance``, ``cloud_variance`` (metres) with positions,
    ``feature_distance``, ``feature_variance`` with features: smaller is
    better, 0 is best, ``count_exact`` apart. ``length_mean`` and
    ``length_variance`` (seconds) describe the clusters and judge nothing.

    Parameters
    ----------
    truth : Annotation
        What the annotators say; its frame rate is the one of the comparison.
    clusters : Labelling
        Which frames are the same thing.
    activities : Labelling, optional
        Which spans are one activity; by default ``clusters``.
    primitives : Labelling, optional
        Single repetitions; by default ``clusters``.
    positions : array_like, (frames, joints, 3), optional
        Metres, y up, at the truth's frame rate.
    features : array_like, (frames, dims), optional
        Stacked, at the truth's frame rate.

    Returns
    -------
    dict of str to float

    Raises
    ------
    ParameterError
        Labels or data of another length than the truth.
    """
    clusters, spans, units = (
        (level or clusters).at(frames=truth.frames, fps=truth.fps)
        for level in (clusters, activities, primitives)
    )
    judged = Judged(truth, clusters, spans, units, positions, features)
    found = {score.name: score.function(judged) for score in SCORES}
    return {name: value for name, value in found.items() if value is not None}


def evaluate_segmentation(
    truth: Annotation,
    found: Segmentation,
    *,
    positions: ArrayLike | None = None,
    features: ArrayLike | None = None,
) -> dict[str, float]:
    """All scores of a segmentation; see `evaluate`.

    Its clusters are those of its activities where they have any (or labels), else those
    of its primitives. A segment in no cluster goes by its label, and without one is a cluster
    of its own.
    """
    rows = found.activities
    activities = labelling_of(rows, fps=found.fps)
    primitives = labelling_of(found.primitives, fps=found.fps) if len(found.primitives) else None
    grouped = bool(np.any((rows.cluster >= 0) | (rows.label != "")))
    return evaluate(
        truth,
        activities if grouped or primitives is None else primitives,
        activities=activities,
        primitives=primitives,
        positions=positions,
        features=features,
    )


def labelling_of(rows: SegmentTable, *, fps: float) -> Labelling:
    """The clusters of one level of a segmentation, as labels.

    Transitions are `TRANSITION`; what is in no cluster goes by its label, and without one
    gets a name of its own.
    """
    labels = [
        TRANSITION
        if row.kind == "transition"
        else f"{row.cluster}"
        if row.cluster >= 0
        else row.label or f"~{i}"
        for i, row in enumerate(rows)
    ]
    return Labelling(np.append(rows.start_frame, rows.stop_frame[-1]), tuple(labels), fps)
