"""Fair scores of labels: is each frame in the right group, and in one group only?

Truth and result are compared frame by frame. The spans in which the
annotators disagree are a class of their own, `TRANSITION`.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import linear_sum_assignment
from sklearn.metrics import adjusted_rand_score, normalized_mutual_info_score
from sklearn.metrics.cluster import contingency_matrix

from kineme.evaluation.annotation import Annotation
from kineme.evaluation.labelling import TRANSITION, Labelling, Texts


def one_to_one_accuracy(truth: Annotation, found: Labelling) -> tuple[float, float]:
    """Shares of frames right under the best one-to-one assignment of clusters to classes.

    The first is of all frames, the second of the frames on which the
    annotators agree; each has its own best assignment. A cluster counts for
    one class at most, so that an action split into many clusters loses.

    A result that names transitions means them: its ``transition`` is right on
    the truth's transitions and nowhere else. A result that does not may use
    up a cluster for them. Source of the assignment: Hungarian method, scipy.

    Parameters
    ----------
    truth : Annotation
        Of one recording at one frame rate.
    found : Labelling
        See `truth`.
    """
    wanted = truth.labelling().per_frame()
    given = found.per_frame()
    agreed = wanted != TRANSITION
    return _assigned(wanted, given), _assigned(wanted[agreed], given[agreed])


def rand_index(truth: Annotation, found: Labelling) -> float:
    """Adjusted Rand index over all frames: 1 is equal, 0 is chance, below is worse."""
    wanted, given = truth.labelling().per_frame(), found.per_frame()
    return float(adjusted_rand_score(wanted.astype(str), given.astype(str)))


def mutual_information(truth: Annotation, found: Labelling) -> float:
    """Mutual information over all frames, normalised by the mean of both entropies: 0 to 1."""
    wanted, given = truth.labelling().per_frame(), found.per_frame()
    return float(normalized_mutual_info_score(wanted.astype(str), given.astype(str)))


def cluster_ratio(truth: Annotation, found: Labelling) -> float:
    """The number of clusters over the number of classes; transitions are neither."""
    return len({*found.labels} - {TRANSITION}) / len({*truth.labels} - {TRANSITION})


def _assigned(wanted: Texts, given: Texts) -> float:
    named = given == TRANSITION
    right = int(np.sum(named & (wanted == TRANSITION)))
    free = ~named & (wanted != TRANSITION) if named.any() else ~named
    if free.any():
        table = contingency_matrix(wanted[free].astype(str), given[free].astype(str))
        right += int(table[linear_sum_assignment(table, maximize=True)].sum())
    return right / wanted.size
