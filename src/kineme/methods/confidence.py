"""How sure: the probability that what was found is right, from a few statistics of it.

Four things may be wrong, and each has a probability of its own:

- the *link* of an activity: its cluster is not that of the same movement elsewhere,
- its *count*: it has more repetitions, or fewer,
- a *border* of an activity: there is none close by,
- a *cut* between two repetitions: there is none close by.

Each is 1 / (1 + exp(-(w0 + w1 s1 + w2 s2 + ...))), with a few statistics s of
``evidence.py`` and weights w: logistic regression. The weights are constants of
a preset, learnt from recordings with a known truth and checked on sources that
were left out; ``benchmarks/confidence.py`` does both, and writes ``weights.py``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kineme.methods import weights
from kineme.methods.base import Preset
from kineme.methods.constants import SHARE, Limits, constant
from kineme.methods.evidence import Evidence

Floats = NDArray[np.float64]
OfTwo = tuple[float, float, float]
OfThree = tuple[float, float, float, float]

WEIGHT = Limits(-100.0, 100.0)
CLEAREST_ODDS = 5.0
"""Logarithms of the odds of borders are not told apart beyond this."""


@dataclass(frozen=True, kw_only=True)
class ConfidencePreset(Preset):
    """A preset whose method says how probable it is that what it finds is right."""

    link_weights: OfTwo = constant(
        "how sure a cluster is: a constant, and weights of the similarity to the nearest other "
        "one, and of how much samples prefer their own", limits=WEIGHT, fine=True,
    )  # fmt: skip
    border_weights: OfTwo = constant(
        "how sure a border is: a constant, and weights of how sharply similarity changes there, "
        "and of that across it", limits=WEIGHT, fine=True,
    )  # fmt: skip
    count_weights: OfThree = constant(
        "how sure a count is: a constant, and weights of the similarity of the repetitions, of how "
        "much samples prefer their own cluster, and of the logarithm of the odds of the less sure "
        "border of the activity", limits=WEIGHT, fine=True, default=weights.COUNT,
    )  # fmt: skip
    cut_weights: OfThree = constant(
        "how sure a border between repetitions is: a constant, and weights of how similar and how "
        "unequal the two are, and of the logarithm of the odds of the count", limits=WEIGHT,
        fine=True, default=weights.CUT,
    )  # fmt: skip
    unsure_action: float = constant(
        "probability below which a note says to look at the cluster of an activity",
        limits=SHARE, fine=True, default=0.5,
    )  # fmt: skip
    unsure_count: float = constant(
        "probability below which a note says to look at the repetitions of an activity",
        limits=SHARE, fine=True, default=0.5,
    )  # fmt: skip
    unsure_border: float = constant(
        "probability below which a note says to look at a border of an activity",
        limits=SHARE, fine=True, default=0.5,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Confidence:
    """Probabilities, nan where there is nothing to be right or wrong.

    Attributes
    ----------
    links, counts, borders : (segments,) array
        That the cluster of each segment, the number of its repetitions, and its start are right.
    cuts : (primitives,) array
        That the start of each is right; that of the segment where it is the first in it.
    """

    links: Floats
    counts: Floats
    borders: Floats
    cuts: Floats


def confidence(evidence: Evidence, preset: ConfidencePreset) -> Confidence:
    """How probable it is that each thing found is right."""
    borders = probability(evidence.borders, preset.border_weights)
    starts = log_odds(evidence.borders, preset.border_weights)
    counts = with_borders(evidence.counts, starts, np.append(starts[1:], np.nan))
    odds = log_odds(counts, preset.count_weights)[evidence.parents]
    cuts = probability(np.column_stack([evidence.cuts, odds]), preset.cut_weights)
    first = np.diff(evidence.parents, prepend=-1) > 0
    return Confidence(
        probability(evidence.links, preset.link_weights),
        probability(counts, preset.count_weights),
        borders,
        np.where(first, borders[evidence.parents], cuts),
    )


def with_borders(counts: Floats, starts: Floats, stops: Floats) -> Floats:
    """Statistics of counts, and the odds of the less sure border of each activity beside them.

    Parameters
    ----------
    counts : (n, 2) array
        See `kineme.methods.evidence.count_statistics`.
    starts, stops : (n,) array
        Logarithms of the odds that the activity begins and ends there; nan at the ends of
        the recording.

    Returns
    -------
    (n, 3) array
        The last is 0 where nothing is repeated, and where there is no border.
    """
    unsure = np.clip(np.nan_to_num(np.fmin(starts, stops)), -CLEAREST_ODDS, CLEAREST_ODDS)
    return np.column_stack([counts, np.where(counts.any(axis=1), unsure, 0)])


def probability(statistics: Floats, weights: tuple[float, ...]) -> Floats:
    """Probability of each row of statistics; nan where one of them is.

    Parameters
    ----------
    statistics : (n, k) array
    weights : tuple of k + 1 floats
        A constant, and one for each statistic.

    Examples
    --------
    >>> import numpy as np
    >>> probability(np.array([[0.0], [2.0]]), (0.0, 1.0)).round(2).tolist()
    [0.5, 0.88]
    """
    from scipy.special import expit

    found: Floats = expit(log_odds(statistics, weights))
    return found


def log_odds(statistics: Floats, weights: tuple[float, ...]) -> Floats:
    """Logarithm of the odds of each row; see `probability`."""
    odds: Floats = weights[0] + statistics @ np.array(weights[1:])
    return odds
