"""Is each border where people put one, and none elsewhere, and are there as many?

A found border is right within the span in which people put one, and the tolerance of the truth
beyond it; each border of the truth can be met once. Neighbours with equal labels have no border
between them. A found transition of less than 1 s is one border, at its middle; a longer one is
a segment of its own, with a border at either side.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme.evaluation.comparison import Comparison
from kineme.evaluation.score import Ratio, Score, one_of
from kineme.evaluation.truth import TRANSITION, UNLABELLED, Labelling

SHORT_TRANSITION_S = 1.0


class BorderScore(NamedTuple):
    """Shares of the found borders that are right, of the true ones met, and their harmonic mean.

    Examples
    --------
    >>> border_score(Comparison([0, 0, 1, 1], [5, 5, 5, 3], fps=10))
    BorderScore(precision=1.0, recall=1.0, f1=1.0)
    """

    precision: float
    recall: float
    f1: float


def border_score(compared: Comparison) -> BorderScore:
    """Precision, recall and F1 of the found borders.

    As many pairs are made as can be: in time order each true border takes the first found one
    that is right. With nothing to find and nothing found all three are 1.

    Examples
    --------
    >>> border_score(Comparison([0, 0, 1, 1], [5, 5, 5, 3], fps=10)).f1
    1.0
    """
    truth, found = compared.spans.actions, border_frames(compared.spans.activities)
    if not truth.mean.size + found.size:
        return BorderScore(1.0, 1.0, 1.0)
    slack = truth.tolerance_s * truth.fps
    hits = following = 0
    for first, last in zip(truth.earliest - slack, truth.latest + slack, strict=True):
        following = max(following, int(np.searchsorted(found, first)))
        if following < found.size and found[following] <= last:
            hits += 1
            following += 1
    return BorderScore(
        hits / found.size if found.size else 0.0,
        hits / truth.mean.size if truth.mean.size else 0.0,
        2 * hits / (found.size + truth.mean.size),
    )


def border_frames(found: Labelling) -> NDArray[np.float64]:
    """Where the result changes from one thing to another, frames.

    A transition shorter than 1 s between two others gives its middle alone.
    """
    runs = found.merged()
    short = [
        label == TRANSITION and stop - start < SHORT_TRANSITION_S * found.fps
        for label, start, stop in zip(runs.labels, runs.starts, runs.stops, strict=True)
    ]
    short[0] = short[-1] = False
    borders: list[float] = []
    for i in range(1, len(short)):
        if short[i]:
            borders.append((runs.starts[i] + runs.stops[i]) / 2)
        elif not short[i - 1]:
            borders.append(float(runs.starts[i]))
    return np.array(borders)


def covering(compared: Comparison) -> float:
    """How well each action is met by one found interval, weighted by length: 0 to 1.

    For each action of the truth, cut at the mean marks, the best
    intersection over union with any found interval. Source: Arbeláez et al.
    2011, equation 4; used for change points by van den Burg and Williams 2020.

    Examples
    --------
    >>> covering(Comparison([0, 0, 1, 1], [5, 5, 5, 5], fps=10))
    0.5
    """
    actions, found = compared.spans.actions.at_means(), compared.spans.activities.merged()
    best = []
    for start, stop in zip(actions.starts, actions.stops, strict=True):
        inner = np.minimum(stop, found.stops) - np.maximum(start, found.starts)
        union = np.maximum(stop, found.stops) - np.minimum(start, found.starts)
        best.append((np.maximum(inner, 0) / union).max())
    return float(np.average(best, weights=np.diff(actions.borders)))


def border_ratio(compared: Comparison) -> Ratio:
    """Borders found over true borders: 1 is as many, above is too many.

    Examples
    --------
    >>> border_ratio(Comparison([0, 0, 1, 1], [5, 6, 5, 6], fps=10))
    Ratio(part=3, total=1)
    """
    found = border_frames(compared.spans.activities)
    return Ratio(found.size, compared.spans.actions.mean.size)


def cut_ratio(compared: Comparison) -> Ratio:
    """The same where both sides of any found transition are cuts.

    Examples
    --------
    >>> cut_ratio(Comparison([0, 0, 1, 1], [5, 6, 5, 6], fps=10))
    Ratio(part=3, total=1)
    """
    cuts = compared.spans.activities.merged().borders.size - 2
    return Ratio(cuts, compared.spans.actions.mean.size)


def cluster_ratio(compared: Comparison) -> Ratio:
    """Clusters found over classes: 1 is as many, above is too many; transitions are no classes.

    Examples
    --------
    >>> cluster_ratio(Comparison([0, 0, 1, 1], [5, 6, 5, 6], fps=10))
    Ratio(part=2, total=2)
    """
    neither = {UNLABELLED} if compared.transitions else set()
    sides = ({*np.unique(side).tolist()} - neither for side in (compared.found, compared.truth))
    return Ratio(*map(len, sides))


SCORES = (
    Score("border_precision", "border precision", "share of found borders that are right",
          "borders", one_of(border_score, 0)),
    Score("border_recall", "border recall", "share of true borders that are found",
          "borders", one_of(border_score, 1)),
    Score("border_f1", "border F1", "harmonic mean of border precision and recall",
          "borders", one_of(border_score, 2)),
    Score("covering", "covering", "overlap of true segments with found ones", "borders", covering),
    Score("border_ratio", "borders, found / true", "how many, short transitions being one",
          "borders", border_ratio),
    Score("cut_ratio", "cuts, found / true", "how many, both sides of transitions being cuts",
          "borders", cut_ratio),
    Score("cluster_ratio", "clusters, found / true", "how many", "borders", cluster_ratio),
)  # fmt: skip
