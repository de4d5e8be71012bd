"""Every score of one result against one truth, in one call (as ``mir_eval`` does).

Scores of labels read ``clusters``; scores of borders, and the published
strict and tolerant accuracies, read ``activities``; repetitions and variances
read ``primitives``. Where a method has only one level, all three are the same.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from kineme.evaluation.borders import border_ratio, border_score, covering, cut_ratio
from kineme.evaluation.counts import count_errors
from kineme.evaluation.frames import (
    cluster_ratio,
    mutual_information,
    one_to_one_accuracy,
    rand_index,
)
from kineme.evaluation.labelling import TRANSITION, Annotation, Labelling
from kineme.evaluation.paper import majority_accuracy, strict_and_tolerant
from kineme.evaluation.variance import (
    feature_variance,
    length_variance,
    overall,
    point_cloud_variance,
)
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import SegmentTable


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
    scores: dict[str, float] = {}
    scores["strict"], scores["tolerant"] = strict_and_tolerant(truth, spans)
    scores["majority"], scores["majority_agreed"] = majority_accuracy(truth, clusters)
    scores["one_to_one"], scores["one_to_one_agreed"] = one_to_one_accuracy(truth, clusters)
    scores["rand_index"] = rand_index(truth, clusters)
    scores["mutual_information"] = mutual_information(truth, clusters)
    for name, value in border_score(truth, spans)._asdict().items():
        scores[f"border_{name}"] = value
    scores["covering"] = covering(truth, spans)
    scores["border_ratio"] = border_ratio(truth, spans)
    scores["cut_ratio"] = cut_ratio(truth, spans)
    scores["cluster_ratio"] = cluster_ratio(truth, clusters)
    if any(count is not None for count in truth.counts):
        scores["count_error"], scores["count_exact"] = count_errors(truth, units)
    scores["length_mean"], scores["length_variance"] = length_variance(units)
    if positions is not None:
        clouds = point_cloud_variance(positions, units)
        scores["cloud_distance"], scores["cloud_variance"] = overall(clouds)
    if features is not None:
        vectors = feature_variance(features, units)
        scores["feature_distance"], scores["feature_variance"] = overall(vectors)
    return scores


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
