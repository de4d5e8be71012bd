"""A result beside what annotators say: what the scores of `annotated_scores` are functions of."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from numpy.typing import ArrayLike

from kineme.evaluation.annotation import Annotation
from kineme.evaluation.borders import BorderScore, border_score
from kineme.evaluation.counts import count_errors
from kineme.evaluation.frames import one_to_one_accuracy
from kineme.evaluation.labelling import Labelling
from kineme.evaluation.paper import majority_accuracy, strict_and_tolerant
from kineme.evaluation.variance import (
    feature_variance,
    length_variance,
    overall,
    point_cloud_variance,
)

Pair = tuple[float, float]


@dataclass(frozen=True, eq=False)
class Judged:
    """A result beside what annotators say; what gives two scores is computed once.

    Attributes
    ----------
    truth : Annotation
    clusters, activities, primitives : Labelling
        Of the same frames: which are the same thing, spans of one activity, single repetitions.
    positions : array_like, optional
    features : array_like, optional
    """

    truth: Annotation
    clusters: Labelling
    activities: Labelling
    primitives: Labelling
    positions: ArrayLike | None = None
    features: ArrayLike | None = None

    @cached_property
    def published(self) -> Pair:
        return strict_and_tolerant(self.truth, self.activities)

    @cached_property
    def majority(self) -> Pair:
        return majority_accuracy(self.truth, self.clusters)

    @cached_property
    def one_to_one(self) -> Pair:
        return one_to_one_accuracy(self.truth, self.clusters)

    @cached_property
    def borders(self) -> BorderScore:
        return border_score(self.truth, self.activities)

    @cached_property
    def counts(self) -> Pair | None:
        known = any(count is not None for count in self.truth.counts)
        return count_errors(self.truth, self.primitives) if known else None

    @cached_property
    def lengths(self) -> Pair:
        return length_variance(self.primitives)

    @cached_property
    def clouds(self) -> Pair | None:
        if self.positions is None:
            return None
        return overall(point_cloud_variance(self.positions, self.primitives))

    @cached_property
    def vectors(self) -> Pair | None:
        if self.features is None:
            return None
        return overall(feature_variance(self.features, self.primitives))
