"""Scores of any result against any truth.

Three ways, by what the truth says:

- labels per frame, where unlabelled frames count in nothing (`Comparison`): the registered scores
  of action segmentation, for folders of recordings (`kineme.evaluation.folder`);
- annotations whose borders are uncertain (`Annotation`): the published protocols of CMU subject 86
  and fair ones, all in `evaluate`;
- how similar the segments of a cluster are: `kineme.evaluation.variance`.
"""

from kineme.evaluation.annotated_scores import evaluate, evaluate_segmentation, labelling_of
from kineme.evaluation.annotation import Annotation
from kineme.evaluation.borders import border_ratio, border_score, covering, cut_ratio
from kineme.evaluation.comparison import Comparison, compare
from kineme.evaluation.counts import count_errors
from kineme.evaluation.frames import (
    cluster_ratio,
    mutual_information,
    one_to_one_accuracy,
    rand_index,
)
from kineme.evaluation.labelling import TRANSITION, Labelling
from kineme.evaluation.paper import majority_accuracy, strict_and_tolerant
from kineme.evaluation.score import Ratio, Score, register, scores
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
    "Comparison",
    "Labelling",
    "Ratio",
    "Score",
    "border_ratio",
    "border_score",
    "cluster_ratio",
    "compare",
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
    "rand_index",
    "register",
    "scores",
    "strict_and_tolerant",
]
