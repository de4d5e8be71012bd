"""Is each frame in the right class, and in one class only? Scores that count frames."""

from __future__ import annotations

import numpy as np
from sklearn.metrics import adjusted_rand_score, normalized_mutual_info_score

from kineme.evaluation.comparison import Comparison, contingency
from kineme.evaluation.score import Ratio, Score


def frames_right(compared: Comparison) -> Ratio:
    """Frames whose cluster stands for their class, of all that count (MoF).

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
    Ratio(part=2, total=3)
    """
    return Ratio(int(np.sum(compared.mapped == compared.truth)), compared.truth.size)


def one_to_one_accuracy(compared: Comparison) -> float:
    """Return share of a recording's frames that are right: over a folder recordings weigh the same.

    A cluster stands for one class at most, so that an action split into many clusters loses.

    Parameters
    ----------
    compared : Comparison
        Of all frames; its `Comparison.agreed` has those on which people agree.

    Returns
    -------
    float
        From 0 to 1.

    Examples
    --------
    >>> one_to_one_accuracy(Comparison([0, 0, 1, 1], [4, 4, 4, 4], fps=1))
    0.5
    """
    return frames_right(compared).value


def rand_index(compared: Comparison) -> float:
    """Adjusted Rand index of classes and clusters: 1 is equal, 0 is chance, below is worse.

    Examples
    --------
    >>> rand_index(Comparison([0, 0, 1, 1], [7, 7, 2, 2], fps=1))
    1.0
    """
    return float(adjusted_rand_score(compared.truth, compared.found))


def mutual_information(compared: Comparison) -> float:
    """Mutual information of classes and clusters over the mean of both entropies: 0 to 1.

    Examples
    --------
    >>> mutual_information(Comparison([0, 0, 1, 1], [7, 7, 7, 7], fps=1))
    0.0
    """
    return float(normalized_mutual_info_score(compared.truth, compared.found))


def cohen_kappa(compared: Comparison) -> float:
    """Cohen's kappa: how far frames are right beyond what chance would give.

    Chance gives each side's classes the shares of frames that they have, wherever these lie. A
    cluster goes by the class that it stands for. Source: Cohen, A coefficient of agreement for
    nominal scales, 1960.

    Parameters
    ----------
    compared : Comparison
        Of a result, or of a second person, and the truth.

    Returns
    -------
    float
        1 is equal, 0 is chance, below is worse; also 1 where both sides are one and the same class.

    Examples
    --------
    >>> cohen_kappa(Comparison([0, 0, 0, 1], [4, 4, 7, 7], fps=1))
    0.5
    >>> cohen_kappa(Comparison([0, 0, 1, 1], [4, 4, 4, 4], fps=1))
    0.0
    """
    found, true, frames = contingency(compared.mapped, compared.truth)
    # Places of the classes that both sides have.
    row, column = np.nonzero(found[:, None] == true)
    shares = frames / frames.sum()
    right = shares[row, column].sum()
    # Expected agreement: the product of both sides' shares, for each class.
    by_chance = (shares.sum(axis=1)[row] * shares.sum(axis=0)[column]).sum()
    return float((right - by_chance) / (1 - by_chance)) if by_chance < 1 else 1.0


SCORES = (
    Score("mof", "MoF", "share of all frames that are right", "frames", frames_right),
    Score("one_to_one", "one to one", "share of frames that are right, the mean over recordings",
          "frames", one_to_one_accuracy),
    Score("one_to_one_agreed", "one to one, agreed",
          "share of frames right, of those on which people agree",
          "frames", lambda compared: one_to_one_accuracy(compared.agreed)),
    Score("rand_index", "ARI", "adjusted Rand index: pairs of frames together in both, 0 is chance",
          "frames", rand_index),
    Score("mutual_information", "NMI",
          "normalised mutual information: how much one side tells of the other", "frames",
          mutual_information),
    Score("cohen_kappa", "Cohen's kappa", "frames right beyond chance: 1 is equal, 0 is chance",
          "frames", cohen_kappa),
)  # fmt: skip
