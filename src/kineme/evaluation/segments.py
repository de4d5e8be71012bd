"""Are the segments right, in kind and order, and are repetitions counted right?

Scores of segments are those of action segmentation: a segment is a run of frames of one class,
once clusters have been given the classes that they stand for. A border that is a little off costs
nothing, a segment too many does. Repetitions are counted where the truth knows their number.

Source: Lea, Flynn, Vidal, Reiter and Hager, "Temporal Convolutional Networks for Action
Segmentation and Detection", CVPR 2017, section 4.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from kineme.evaluation.comparison import Comparison, Run
from kineme.evaluation.score import Ratio, Score, one_of
from kineme.evaluation.truth import TRANSITION, Labelling, Truth

OVERLAPS = (10, 25, 50)
"""Intersection over union, in percent, from which a segment counts as found."""


def edit_score(compared: Comparison) -> float:
    """How similar the orders of the segments are: 1 is the same order, 0 has nothing of it.

    1 - distance / length: the fewest segments to add, leave out or exchange that turn one order
    of classes into the other, over the number of segments of the longer one.

    Parameters
    ----------
    compared : Comparison

    Returns
    -------
    float
        From 0 to 1; over a folder the mean.

    Examples
    --------
    >>> round(edit_score(Comparison([0, 0, 1, 1], [4, 6, 6, 6], fps=1)), 3)
    1.0
    >>> round(edit_score(Comparison([0, 0, 1, 1], [4, 4, 4, 4], fps=1)), 3)
    0.5
    """
    true = [run.label for run in compared.true_runs]
    found = [run.label for run in compared.mapped_runs]
    return 1 - edit_distance(true, found) / max(len(true), len(found))


def edit_distance(a: Sequence[int], b: Sequence[int]) -> int:
    """Return the fewest insertions, deletions and exchanges that turn one sequence into another.

    Examples
    --------
    >>> edit_distance([1, 2, 3], [1, 3, 3, 4])
    2
    """
    # Distances from the empty sequence: as many insertions.
    row = np.arange(len(b) + 1)
    columns = np.arange(len(b) + 1)
    other = np.asarray(b)
    for i, label in enumerate(a, 1):
        best = np.minimum(row[1:] + 1, row[:-1] + (other != label))
        # an insertion costs 1 a column: the least of what stands to the left, plus the way
        row = np.minimum.accumulate(np.concatenate([[i], best]) - columns) + columns
    return int(row[-1])


def overlap_f1(compared: Comparison, *, percent: float) -> Ratio:
    """F1 of the found segments, one being right where it overlaps a true one of its class enough.

    Each found segment is held against the true segment of its class with which it has the
    largest intersection over union; a true segment is found once.

    Parameters
    ----------
    compared : Comparison
    percent : float
        The least intersection over union, in percent.

    Returns
    -------
    Ratio
        Over a folder, segments are counted over all recordings.

    Examples
    --------
    >>> overlap_f1(Comparison([0, 0, 1, 1], [4, 6, 6, 6], fps=1), percent=50).value
    1.0
    """
    hits = _hits(compared.true_runs, compared.mapped_runs, percent / 100)
    return Ratio(2 * hits, len(compared.true_runs) + len(compared.mapped_runs))


def found_counts(truth: Truth, primitives: Labelling) -> list[int]:
    """Return how many primitives have their middle in each action of the truth.

    Actions are cut at the mean marks; transitions are no primitives.
    """
    kept = np.array([label != TRANSITION for label in primitives.labels])
    middles = (primitives.starts + primitives.stops)[kept] / 2
    # Histogram by the borders of the actions; a middle belongs to one action.
    counts: list[int] = np.histogram(middles, bins=truth.at_means().borders)[0].tolist()
    return counts


def count_errors(compared: Comparison) -> tuple[float, float] | None:
    """Mean difference from the true number of repetitions, and the share counted exactly.

    Parameters
    ----------
    compared : Comparison

    Returns
    -------
    error, exact : float
        None where the truth knows no count.

    Examples
    --------
    >>> truth = Truth(("jump", "rest"), [60], [60], [60], frames=90, fps=30, counts=(3, None))
    >>> found = Labelling.from_cuts([15, 30, 60], ["0", "0", "0", "1"], frames=90, fps=30)
    >>> count_errors(Comparison.of(truth, found))
    (0.0, 1.0)
    """
    truth, primitives = compared.repetitions
    found = found_counts(truth, primitives)
    errors = [
        abs(count - true)
        for count, true in zip(found, truth.counts, strict=False)
        if true is not None
    ]
    return (float(np.mean(errors)), float(np.mean(np.array(errors) == 0))) if errors else None


def _hits(true: Sequence[Run], found: Sequence[Run], least: float) -> int:
    """Return how many true segments are found."""
    # Columns of the runs: label, start, stop.
    labels, starts, stops = np.array(true).T
    hits: set[int] = set()
    for label, start, stop in found:
        # Negative where the two are apart; the hull is then too large, but never chosen.
        inner = np.minimum(stops, stop) - np.maximum(starts, start)
        union = np.maximum(stops, stop) - np.minimum(starts, start)
        overlap = np.where(labels == label, inner / union, -1.0)
        best = int(np.argmax(overlap))
        if overlap[best] > 0 and overlap[best] >= least:
            hits.add(best)  # a second one that meets it is wrong
    return len(hits)


SCORES = (
    Score("edit", "Edit", "order of segments: 1 - edit distance", "segments", edit_score),
    *(
        Score(f"f1@{percent}", f"F1@{percent}",
              f"F1 of segments that overlap by at least {percent} %", "segments",
              partial(overlap_f1, percent=percent))
        for percent in OVERLAPS
    ),
    Score("count_error", "count error", "repetitions too many or too few", "repetitions",
          one_of(count_errors, 0)),
    Score("count_exact", "counted exactly", "share of actions counted right", "repetitions",
          one_of(count_errors, 1)),
)  # fmt: skip
