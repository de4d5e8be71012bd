"""The accuracy by which ACA and HACA were measured.

Truth is cut at the mean of the annotators' marks, with no class for
transitions. Source: Zhou, De la Torre and Hodgins, TPAMI 35(3), 2013, as in
their program (``genConMatrix``, ``matchSeg``).
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import linear_sum_assignment
from sklearn.metrics.cluster import contingency_matrix

from kineme.evaluation.annotation import Annotation
from kineme.evaluation.labelling import Ints, Labelling


def aca_accuracy(truth: Annotation, found: Labelling, *, blocks: Ints | None = None) -> float:
    """The share right under the best one-to-one assignment of clusters to classes.

    Parameters
    ----------
    truth : Annotation
        Of one recording at one frame rate.
    found : Labelling
        See `truth`.
    blocks : ndarray, optional
        First frames of the blocks to which the recording was reduced. The authors count blocks, a
        border of the truth being that of the block it lies in: a block has the labels of its last
        frame. None counts frames.
    """
    counted = np.arange(found.frames) if blocks is None else np.append(blocks[1:], found.frames) - 1
    table = contingency_matrix(
        truth.at_means().per_frame()[counted].astype(str), found.per_frame()[counted].astype(str)
    )
    return float(table[linear_sum_assignment(table, maximize=True)].sum() / counted.size)
