"""Scores of results against a truth.

A `Comparison` holds a truth and a result, by frames and by spans; a `Score` is a function of it.
`scores` lists all scores, and `register` adds more. A truth is a labelled segmentation (`compare`),
or a `Truth` with several annotators and uncertain borders (`evaluate`). `annotator_agreement`
compares several people. `kineme.evaluation.folder` evaluates folders of recordings.
"""

from kineme.evaluation.annotators import (
    AnnotatorAgreement,
    annotator_agreement,
    fleiss_kappa,
)
from kineme.evaluation.comparison import Comparison, Spans, compare
from kineme.evaluation.measures import (
    BorderScore,
    border_ratio,
    border_score,
    cluster_ratio,
    cohen_kappa,
    count_errors,
    covering,
    cut_ratio,
    edit_score,
    frames_right,
    mutual_information,
    one_to_one_accuracy,
    overlap_f1,
    rand_index,
)
from kineme.evaluation.score import (
    Ratio,
    Score,
    evaluate,
    register,
    scores,
)
from kineme.evaluation.truth import TRANSITION, Labelling, Truth, make_labelling

__all__ = [
    "TRANSITION",
    "AnnotatorAgreement",
    "BorderScore",
    "Comparison",
    "Labelling",
    "Ratio",
    "Score",
    "Spans",
    "Truth",
    "annotator_agreement",
    "border_ratio",
    "border_score",
    "cluster_ratio",
    "cohen_kappa",
    "compare",
    "count_errors",
    "covering",
    "cut_ratio",
    "edit_score",
    "evaluate",
    "fleiss_kappa",
    "frames_right",
    "make_labelling",
    "mutual_information",
    "one_to_one_accuracy",
    "overlap_f1",
    "rand_index",
    "register",
    "scores",
]
