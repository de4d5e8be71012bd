"""Measuring segmentations: the published protocols, fair scores, and how alike clusters are."""

from kineme.evaluation.annotations import read_frame_labels, read_intervals, read_trials
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
from kineme.evaluation.published import published
from kineme.evaluation.scores import evaluate, evaluate_segmentation, labelling_of
from kineme.evaluation.variance import (
    ClusterVariance,
    feature_variance,
    overall,
    point_cloud_variance,
)

__all__ = [
    "TRANSITION",
    "Annotation",
    "ClusterVariance",
    "Labelling",
    "border_ratio",
    "border_score",
    "cluster_ratio",
    "count_errors",
    "covering",
    "cut_ratio",
    "evaluate",
    "evaluate_segmentation",
    "feature_variance",
    "labelling_of",
    "majority_accuracy",
    "mutual_information",
    "one_to_one_accuracy",
    "overall",
    "point_cloud_variance",
    "published",
    "rand_index",
    "read_frame_labels",
    "read_intervals",
    "read_trials",
    "strict_and_tolerant",
]
