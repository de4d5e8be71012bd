"""Which of two segmentations of a recording other ones agree with most.

Where there is no truth, what is found in one way only is doubtful. The
agreement of two segmentations is the normalised mutual information of their
clusters: by how much the one tells the other, 1 where they are the same and 0
where they have nothing in common.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Labels = NDArray[np.int64]
Answer = Sequence[Labels]
"""The cluster of each sample, in each part of the recording."""

DIGITS = 9
"""Agreements that differ less are equal: rounding decides nothing."""


def most_agreed(answers: Sequence[Answer], others: Sequence[Answer] = ()) -> int:
    """The first or the last answer: the one that all agree with more; the first of equals.

    Parameters
    ----------
    answers : sequence of sequence of (samples,) array
        Per answer the cluster of each sample, in each part of the recording.
    others : sequence of sequence of (samples,) array
        Answers that are asked, too, but cannot be taken.

    Examples
    --------
    >>> first, other, last = np.array([[0, 1, 0, 1, 0], [0, 0, 0, 1, 1], [0, 0, 1, 1, 1]])
    >>> most_agreed([[first], [other], [last]])
    2
    """
    first, last = (
        sum(
            len(a) * mutual_information(a, b)
            for other in (*answers, *others)
            for a, b in zip(answers[one], other, strict=True)
        )
        for one in (0, -1)
    )
    return 0 if round(first - last, DIGITS) >= 0 else len(answers) - 1


def mutual_information(first: Labels, second: Labels) -> float:
    """What two clusterings of the same samples tell of each other, as a share of what they tell.

    Examples
    --------
    >>> mutual_information(np.array([0, 0, 1, 1]), np.array([5, 5, 3, 3]))
    1.0
    >>> mutual_information(np.array([0, 0, 1, 1]), np.array([0, 1, 0, 1]))
    0.0
    """
    width = int(second.max()) + 1
    together = np.bincount(first * width + second, minlength=(int(first.max()) + 1) * width)
    table = together.reshape(-1, width)
    one, other = _entropy(table.sum(axis=1)), _entropy(table.sum(axis=0))
    if one + other == 0:
        return 1.0
    return max(0.0, 2 * (1 - _entropy(table.ravel()) / (one + other)))


def _entropy(counts: Labels) -> float:
    """Of the shares that counts are."""
    shares = counts[counts > 0] / counts.sum()
    return float(-(shares * np.log(shares)).sum()) + 0.0
