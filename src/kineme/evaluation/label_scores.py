"""Is each frame in the right class? Scores that count frames."""

from __future__ import annotations

import numpy as np
from sklearn.metrics import adjusted_rand_score, normalized_mutual_info_score

from kineme.evaluation.comparison import Comparison
from kineme.evaluation.score import Ratio, Score


def frames_right(compared: Comparison) -> Ratio:
    """Frames whose cluster stands for their class, of all that have one (MoF).

    Parameters
    ----------
    compared : Comparison

    Returns
    -------
    Ratio
        Over a folder every frame weighs the same.

    Examples
    --------
    >>> frames_right(Comparison([0, 0, 1], [4, 4, 4], fps=1))
    Ratio(part=2, whole=3)
    """
    return Ratio(int(np.sum(compared.mapped == compared.truth)), compared.truth.size)


def share_right(compared: Comparison) -> float:
    """The share of a recording's frames that are right: over a folder recordings weigh the same.

    Parameters
    ----------
    compared : Comparison

    Returns
    -------
    float
        From 0 to 1.

    Examples
    --------
    >>> share_right(Comparison([0, 0, 1, 1], [4, 4, 4, 4], fps=1))
    0.5
    """
    return frames_right(compared).value


def adjusted_rand(compared: Comparison) -> float:
    """Adjusted Rand index of classes and clusters: 1 is equal, 0 is chance, below is worse.

    Parameters
    ----------
    compared : Comparison

    Returns
    -------
    float

    Examples
    --------
    >>> adjusted_rand(Comparison([0, 0, 1, 1], [7, 7, 2, 2], fps=1))
    1.0
    """
    return float(adjusted_rand_score(compared.truth, compared.found))


def mutual_information(compared: Comparison) -> float:
    """Mutual information of classes and clusters over the mean of both entropies: 0 to 1.

    Parameters
    ----------
    compared : Comparison

    Returns
    -------
    float

    Examples
    --------
    >>> mutual_information(Comparison([0, 0, 1, 1], [7, 7, 7, 7], fps=1))
    0.0
    """
    return float(normalized_mutual_info_score(compared.truth, compared.found))


SCORES = (
    Score("mof", "MoF", "share of all frames that are right", "frames", frames_right),
    Score(
        "one_to_one",
        "one to one",
        "share of frames that are right, the mean over recordings",
        "frames",
        share_right,
    ),
    Score("ari", "ARI", "adjusted Rand index of frames", "frames", adjusted_rand),
    Score("nmi", "NMI", "normalised mutual information of frames", "frames", mutual_information),
)
