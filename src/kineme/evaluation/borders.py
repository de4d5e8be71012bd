"""Fair scores of borders: is each where the annotators put one, and none elsewhere?

A found border is right within the annotators' span ± 0.25 s, and each border
of the truth can be met once. Neighbours with equal labels have no border
between them. A found transition of less than 1 s is one border, at its
middle; a longer one is a segment of its own, with a border at either side.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import maximum_bipartite_matching

from kineme.evaluation.annotation import Annotation
from kineme.evaluation.labelling import TRANSITION, Labelling

TOLERANCE_S = 0.25
SHORT_TRANSITION_S = 1.0


class BorderScore(NamedTuple):
    """Shares of the found borders that are right, of the true ones met, and their harmonic mean."""

    precision: float
    recall: float
    f1: float


def border_score(
    truth: Annotation, found: Labelling, *, tolerance_s: float = TOLERANCE_S
) -> BorderScore:
    """Precision, recall and F1 of the found borders.

    Matched by a maximum one-to-one matching, so that no order of matching can
    lose a pair. With nothing to find and nothing found all three are 1.

    Parameters
    ----------
    truth : Annotation
    found : Labelling
        Of one recording at one frame rate.
    tolerance_s : float
        Seconds added to both sides of the annotators' span.

    Returns
    -------
    BorderScore
    """
    borders = border_frames(found)[:, None]
    slack = tolerance_s * truth.fps
    near = (truth.earliest - slack <= borders) & (borders <= truth.latest + slack)
    hits = int((maximum_bipartite_matching(csr_array(near)) >= 0).sum()) if near.size else 0
    n_found, n_true = near.shape
    if n_found + n_true == 0:
        return BorderScore(1.0, 1.0, 1.0)
    return BorderScore(
        hits / n_found if n_found else 0.0,
        hits / n_true if n_true else 0.0,
        2 * hits / (n_found + n_true),
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


def border_ratio(truth: Annotation, found: Labelling) -> float:
    """Found borders over true ones; nan where there is none to find."""
    return _ratio(border_frames(found).size, truth.mean.size)


def cut_ratio(truth: Annotation, found: Labelling) -> float:
    """Found cuts over true borders, where both sides of any transition are cuts."""
    return _ratio(found.merged().borders.size - 2, truth.mean.size)


def covering(truth: Annotation, found: Labelling) -> float:
    """How well each action is met by one found interval, weighted by length: 0 to 1.

    For each action of the truth, cut at the mean marks, the best
    intersection over union with any found interval. Source: Arbeláez et al.
    2011, equation 4; used for change points by van den Burg and Williams 2020.
    """
    wanted, runs = truth.at_means(), found.merged()
    start, stop = wanted.starts[:, None], wanted.stops[:, None]
    inner = np.minimum(stop, runs.stops) - np.maximum(start, runs.starts)
    union = np.maximum(stop, runs.stops) - np.minimum(start, runs.starts)
    best = (np.maximum(inner, 0) / union).max(axis=1)
    return float(np.average(best, weights=np.diff(wanted.borders)))


def _ratio(found: int, true: int) -> float:
    return found / true if true else float("nan")
