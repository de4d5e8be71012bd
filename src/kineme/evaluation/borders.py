"""Is each border where people put one, and none elsewhere, and are there as many?

A found border is right within the span in which people put one, and the tolerance of the truth
beyond it; each border of the truth can be met once. Neighbours with equal labels have no border
between them. A found transition of less than 1 s is one border, at its middle; a longer one is
a segment of its own, with a border at either side.

Between the repetitions of an action there are borders, too, where people cut them. A pause between
two repetitions is one border. One is right within 0.5 s, or a quarter of a repetition where that
is less. What is found near the end of an action is the border of that.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Floats, Ints
from kineme.evaluation.comparison import Comparison
from kineme.evaluation.score import Ratio, Score, one_of
from kineme.evaluation.truth import TRANSITION, UNLABELLED, Labelling

SHORT_TRANSITION_S = 1.0
REPETITION_TOLERANCE_S = 0.5
REPETITION_TOLERANCE = 0.25
"""Of the shorter of the two repetitions, where that is less."""


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
    # The tolerance beyond the span in which people put the border, in frames.
    slack = truth.tolerance_s * truth.fps
    hits = len(_matches(truth.earliest - slack, truth.latest + slack, found))
    # A share of nothing is 0.
    return BorderScore(
        hits / found.size if found.size else 0.0,
        hits / truth.mean.size if truth.mean.size else 0.0,
        2 * hits / (found.size + truth.mean.size),
    )


def repetition_f1(compared: Comparison) -> Ratio | None:
    """F1 of the borders between repetitions, in the actions whose repetitions people cut.

    Parameters
    ----------
    compared : Comparison

    Returns
    -------
    Ratio
        Over a folder, borders are counted over all recordings. None where there is none.

    Examples
    --------
    >>> from kineme.evaluation import Truth
    >>> cut = Labelling.from_cuts([30, 60], ["squat"] * 3, frames=90, fps=30)
    >>> truth = Truth(("squat",), [], [], [], frames=90, fps=30, repetitions=cut)
    >>> found = Labelling.from_cuts([31, 45, 60], ["0"] * 4, frames=90, fps=30)
    >>> repetition_f1(Comparison.of(truth, found))
    Ratio(part=4, total=5)
    """
    truth, primitives = compared.repetitions
    if truth.repetitions is None:
        return None
    ends = truth.at_means().borders
    starts, stops = _single(truth.repetitions)
    # Action of each repetition, by its middle.
    actions = np.searchsorted(ends, (starts + stops) / 2, "right")
    # Neighbouring repetitions of one action have a border between them.
    before = np.flatnonzero(actions[1:] == actions[:-1])
    # A pause between two repetitions is one border, anywhere in it.
    earliest, latest = stops[before], starts[before + 1]
    lengths = np.minimum((stops - starts)[before], (stops - starts)[before + 1])
    slack = np.minimum(REPETITION_TOLERANCE_S * truth.fps, REPETITION_TOLERANCE * lengths)

    first, last = _single(primitives)
    found = (last[:-1] + first[1:]) / 2
    # Only within actions whose repetitions people cut.
    found = found[np.isin(np.searchsorted(ends, found, "right"), actions)]
    hits = _matches(earliest - slack, latest + slack, found)
    near = REPETITION_TOLERANCE_S * truth.fps
    begin, end = truth.earliest - near, truth.latest + near
    # (found, borders): a border near the end of an action is no wrong repetition.
    at_ends = np.any((begin <= found[:, None]) & (found[:, None] <= end), axis=1)
    # Neither right nor near an end of an action.
    wrong = np.delete(~at_ends, hits)
    # 2 TP + FN + FP: true borders, hits, and wrong ones.
    total = len(earliest) + len(hits) + int(wrong.sum())
    return Ratio(2 * len(hits), total) if total else None


def border_frames(found: Labelling) -> Floats:
    """Where the result changes from one thing to another, frames.

    A transition shorter than 1 s between two others gives its middle alone.
    """
    runs = found.merged()
    short = [
        label == TRANSITION and stop - start < SHORT_TRANSITION_S * found.fps
        for label, start, stop in zip(runs.labels, runs.starts, runs.stops, strict=True)
    ]
    # At an end of the recording a transition has one border anyway.
    short[0] = short[-1] = False
    borders: list[float] = []
    for i in range(1, len(short)):
        if short[i]:
            borders.append((runs.starts[i] + runs.stops[i]) / 2)
        elif not short[i - 1]:
            # Not after a short transition, whose middle stands for both of its sides.
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
        # Where the two do not overlap this is negative, and counts as 0 below.
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
    """Return the same where both sides of any found transition are cuts.

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
    # The number -1 is a transition only if the comparison says so.
    neither = {UNLABELLED} if compared.transitions else set()
    sides = ({*np.unique(side).tolist()} - neither for side in (compared.found, compared.truth))
    return Ratio(*map(len, sides))


def _single(repetitions: Labelling) -> tuple[Ints, Ints]:
    """Where repetitions start and stop."""
    kept = np.array([label != TRANSITION for label in repetitions.labels])
    return repetitions.starts[kept], repetitions.stops[kept]


def _matches(first: ArrayLike, last: ArrayLike, found: Floats) -> list[int]:
    """Which of the found borders are right; each true one takes the first that lies in its span."""
    hits: list[int] = []
    following = 0
    for start, stop in zip(np.asarray(first), np.asarray(last), strict=True):
        # Borders are in order, so an earlier found border is never needed again.
        following = max(following, int(np.searchsorted(found, start)))
        if following < found.size and found[following] <= stop:
            hits.append(following)
            following += 1
    return hits


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
    Score("repetition_f1", "repetition border F1", "F1 of the borders between repetitions",
          "repetitions", repetition_f1),
)  # fmt: skip
