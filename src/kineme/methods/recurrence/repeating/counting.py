"""The constants by which an activity is divided into repetitions, shared by several methods."""

from __future__ import annotations

from dataclasses import dataclass

from kineme.methods.confidence import ConfidencePreset
from kineme.methods.constants import FACTOR, SHARE, SOME, TIME, Limits, constant


@dataclass(frozen=True, kw_only=True)
class CountingPreset(ConfidencePreset):
    """A preset whose method counts repetitions, as `kineme.methods.recurrence.repeating` does."""

    repetition_smoothing: float = constant(
        "speeds are those of poses averaged over this time before and after", unit="s",
        limits=TIME, fine=True, default=0.07,
    )  # fmt: skip
    deep_quantile: float = constant(
        "depths of dips are measured against this quantile of a pose's distances",
        limits=SHARE, fine=True, default=0.9,
    )  # fmt: skip
    noise_share: float = constant(
        "share of that below which a dip is noise", limits=SHARE, fine=True, default=0.05
    )
    voters: int = constant(
        "poses that vote on the number of repetitions, evenly spread",
        limits=SOME,
        fine=True,
        default=80,
    )
    counts_tried: int = constant(
        "numbers of repetitions with the most votes that are tried",
        limits=SOME,
        fine=True,
        default=8,
    )
    poses_tried: int = constant(
        "poses with which each is tried, those that tell it best", limits=SOME, fine=True, default=4
    )
    path_points: int = constant(
        "places along a repetition's path at which it is compared", limits=Limits(2, 1000),
        fine=True, default=16,
    )  # fmt: skip
    end_distance: float = constant(
        "an end belongs to a repetition as long as it is nearer than this share of the variance",
        limits=SHARE, fine=True, default=0.5,
    )  # fmt: skip
    end_scatter: float = constant(
        "an end counts whole where its square distance from the mean repetition is this times that "
        "of repetitions at most, and less beyond", limits=FACTOR, fine=True, default=2.0,
    )  # fmt: skip
    centering: float = constant(
        "share of its mean pose taken off each repetition before it is compared with others: of 1, "
        "only how it moves counts, of 0, where it is counts as much",
        limits=SHARE, fine=True, default=1.0,
    )  # fmt: skip
    length_cost: float = constant(
        "cost of the repetition that the others are compared with, per share of the activity",
        limits=FACTOR, fine=True, default=1.5,
    )  # fmt: skip
    uneven_cost: float = constant(
        "cost of repetitions with paths of uneven length, per standard deviation of its logarithm",
        limits=FACTOR, fine=True, default=0.2,
    )  # fmt: skip
    max_unexplained: float = constant(
        "where the mean of any number of repetitions would leave more than this share unexplained, "
        "similarity is chance", limits=SHARE, fine=True, default=0.7,
    )  # fmt: skip
    same_cost: float = constant(
        "divisions that cost no more than this above the best say with it how long the ends are",
        limits=FACTOR, fine=True, default=0.1,
    )  # fmt: skip
    same_count: float = constant(
        "repetitions by which these differ at most", limits=FACTOR, fine=True, default=0.75
    )
