"""Are the cuts where people put them, and as many? Clusters play no part but for their number."""

from __future__ import annotations

import numpy as np

from kineme.evaluation.comparison import Comparison, Run
from kineme.evaluation.score import Ratio, Score

TOLERANCE_S = 0.5


def border_f1(compared: Comparison, *, tolerance_s: float = TOLERANCE_S) -> float:
    """Harmonic mean of the shares of true borders met, and of found ones that meet one.

    In time order each true border takes the nearest found one within the tolerance that none
    before it has taken.

    Parameters
    ----------
    compared : Comparison
    tolerance_s : float
        Seconds on either side.

    Returns
    -------
    float
        From 0 to 1; 1 where there is nothing to find and nothing was found.

    Examples
    --------
    >>> border_f1(Comparison([0, 0, 1, 1], [5, 5, 5, 3], fps=10))
    1.0
    """
    true, found = _borders(compared.true_runs), _borders(compared.found_runs)
    if not true.size or not found.size:
        return float(true.size == found.size)
    slack = tolerance_s * compared.fps
    free = np.ones(found.size, bool)
    hits = 0
    for border in true:
        distance = np.where(free, np.abs(found - border), np.inf)
        nearest = int(np.argmin(distance))
        if distance[nearest] <= slack:
            free[nearest] = False
            hits += 1
    return 2 * hits / (true.size + found.size)


def covering(compared: Comparison) -> float:
    """How well each true segment is met by one found segment, weighted by length: 0 to 1.

    The best intersection over union of each true segment with any found one.
    Source: Arbeláez et al. 2011, equation 4; for time series van den Burg and Williams 2020.

    Parameters
    ----------
    compared : Comparison

    Returns
    -------
    float

    Examples
    --------
    >>> covering(Comparison([0, 0, 1, 1], [5, 5, 5, 5], fps=10))
    0.5
    """
    _, starts, stops = np.array(compared.found_runs).T
    covered = 0.0
    for _, start, stop in compared.true_runs:
        inner = np.minimum(stops, stop) - np.maximum(starts, start)
        union = np.maximum(stops, stop) - np.minimum(starts, start)
        covered += (stop - start) * max(0.0, float((inner / union).max()))
    return covered / compared.truth.size


def cut_ratio(compared: Comparison) -> Ratio:
    """Borders found over true borders: 1 is as many, above is too many.

    Parameters
    ----------
    compared : Comparison

    Returns
    -------
    Ratio

    Examples
    --------
    >>> cut_ratio(Comparison([0, 0, 1, 1], [5, 6, 5, 6], fps=10))
    Ratio(part=3, whole=1)
    """
    return Ratio(len(compared.found_runs) - 1, len(compared.true_runs) - 1)


def cluster_ratio(compared: Comparison) -> Ratio:
    """Clusters found over classes: 1 is as many, above is too many.

    Parameters
    ----------
    compared : Comparison

    Returns
    -------
    Ratio

    Examples
    --------
    >>> cluster_ratio(Comparison([0, 0, 1, 1], [5, 6, 5, 6], fps=10))
    Ratio(part=2, whole=2)
    """
    return Ratio(len(np.unique(compared.found)), len(np.unique(compared.truth)))


def _borders(found: list[Run]) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    return np.array([run.start for run in found[1:]], np.float64)


SCORES = (
    Score(
        "border_f1",
        f"border F1 ({TOLERANCE_S:g} s)",
        f"F1 of borders, right within {TOLERANCE_S:g} s",
        "borders",
        border_f1,
    ),
    Score("covering", "covering", "overlap of true segments with found ones", "borders", covering),
    Score("cut_ratio", "borders, found / true", "how many are found", "borders", cut_ratio),
    Score("cluster_ratio", "clusters, found / true", "how many", "clusters", cluster_ratio),
)
