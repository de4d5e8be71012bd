"""Which of two segmentations of a recording other ones agree with most.

Where there is no truth, what is found in one way only is doubtful. The
agreement of two segmentations is the adjusted Rand index of their clusters
(Hubert and Arabie 1985), 1 where they are the same and 0 where they have no
more in common than by chance.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Labels = NDArray[np.int64]


def most_agreed(answers: Sequence[Sequence[Labels]]) -> int:
    """The first or the last answer: the one that all agree with more; the first of equals.

    Parameters
    ----------
    answers : sequence of sequence of (samples,) array
        Per answer the cluster of each sample, in each part of the recording.

    Examples
    --------
    >>> first, other, last = np.array([[0, 1, 0, 1, 0], [0, 0, 0, 1, 1], [0, 0, 1, 1, 1]])
    >>> most_agreed([[first], [other], [last]])
    2
    """
    first, last = (
        sum(
            len(a) * adjusted_rand_index(a, b)
            for other in answers
            for a, b in zip(answers[one], other, strict=True)
        )
        for one in (0, -1)
    )
    return 0 if first >= last else len(answers) - 1


def adjusted_rand_index(first: Labels, second: Labels) -> float:
    """How far two clusterings of the same samples agree, beyond chance.

    Examples
    --------
    >>> adjusted_rand_index(np.array([0, 0, 1, 1]), np.array([5, 5, 3, 3]))
    1.0
    """
    width = int(second.max()) + 1
    together = np.bincount(first * width + second, minlength=(int(first.max()) + 1) * width)
    table = together.reshape(-1, width).astype(np.float64)
    both, one, other = (
        float((counts * (counts - 1)).sum() / 2)
        for counts in (table, table.sum(axis=1), table.sum(axis=0))
    )
    pairs = len(first) * (len(first) - 1) / 2
    chance = one * other / max(pairs, 1.0)
    most = (one + other) / 2
    return 1.0 if most == chance else (both - chance) / (most - chance)
