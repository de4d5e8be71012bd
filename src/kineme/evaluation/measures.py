"""Scores that come with the package: of frames, of segments, of borders, and of repetitions.

*Frames.* Is each in the right class, and in one class only?

*Segments.* Are they right, in kind and order? They are scored as in action segmentation: a segment
is a run of frames of one class, once clusters have been given the classes that they stand for. A
border that is a little off costs nothing, a segment too many does (Lea, Flynn, Vidal, Reiter and
Hager, "Temporal Convolutional Networks for Action Segmentation and Detection", CVPR 2017, section
4). Repetitions are counted where the truth knows their number.

*Borders.* Is each where people put one, and none elsewhere, and are there as many? A found border
is right within the span in which people put one, and the tolerance of the truth beyond it; each
border of the truth can be met once. Neighbours with equal labels have no border between them. A
found transition of less than 1 s is one border, at its middle; a longer one is a segment of its
own, with a border at either side.

*Repetitions.* Between those of an action there are borders, too, where people cut them. A pause
between two repetitions is one border. One is right within 0.5 s, or a quarter of a repetition where
that is less. What is found near the end of an action is the border of that.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from sklearn.metrics import adjusted_rand_score, normalized_mutual_info_score

from kineme._util.arrays import Floats, Ints
from kineme.evaluation.comparison import Comparison, Run, count_frames
from kineme.evaluation.score import Ratio, Score, choose_number
from kineme.evaluation.truth import TRANSITION, UNLABELLED, Labelling

OVERLAPS = (10, 25, 50)
"""Intersection over union, in percent, from which a segment counts as found."""
SHORT_TRANSITION_S = 1.0
REPETITION_TOLERANCE_S = 0.5
REPETITION_TOLERANCE = 0.25
"""Of the shorter of the two repetitions, where that is less."""


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
    found, true, frames = count_frames(compared.mapped, compared.truth)
    # Places of the classes that both sides have.
    row, column = np.nonzero(found[:, None] == true)
    shares = frames / frames.sum()
    right = shares[row, column].sum()
    # Expected agreement: the product of both sides' shares, for each class.
    by_chance = (shares.sum(axis=1)[row] * shares.sum(axis=0)[column]).sum()
    return float((right - by_chance) / (1 - by_chance)) if by_chance < 1 else 1.0


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
    return 1 - compute_edit_distance(true, found) / max(len(true), len(found))


def compute_edit_distance(a: Sequence[int], b: Sequence[int]) -> int:
    """Return the fewest insertions, deletions and exchanges that turn one sequence into another.

    Examples
    --------
    >>> compute_edit_distance([1, 2, 3], [1, 3, 3, 4])
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
    hits = _count_hits(compared.true_runs, compared.mapped_runs, percent / 100)
    return Ratio(2 * hits, len(compared.true_runs) + len(compared.mapped_runs))


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
    >>> from kineme.evaluation import Truth
    >>> truth = Truth(("jump", "rest"), [60], [60], [60], frames=90, fps=30, counts=(3, None))
    >>> found = Labelling.from_cuts([15, 30, 60], ["0", "0", "0", "1"], frames=90, fps=30)
    >>> count_errors(Comparison.of(truth, found))
    (0.0, 1.0)
    """
    truth, primitives = compared.repetitions
    starts, stops = _find_ends(primitives)
    # A repetition belongs to the action that its middle lies in.
    found = np.histogram((starts + stops) / 2, bins=truth.at_means().borders)[0]
    # There are no counts where the truth knows none.
    pairs = zip(found.tolist(), truth.counts, strict=False)
    errors = [abs(count - true) for count, true in pairs if true is not None]
    return (float(np.mean(errors)), float(np.mean(np.array(errors) == 0))) if errors else None


def _count_hits(true: Sequence[Run], found: Sequence[Run], least: float) -> int:
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
    truth, found = compared.spans.actions, find_border_frames(compared.spans.activities)
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

    None where there is none.
    """
    truth, primitives = compared.repetitions
    if truth.repetitions is None:
        return None
    ends = truth.at_means().borders
    starts, stops = _find_ends(truth.repetitions)
    # Action of each repetition, by its middle.
    actions = np.searchsorted(ends, (starts + stops) / 2, "right")
    # Neighbouring repetitions of one action have a border between them.
    before = np.flatnonzero(actions[1:] == actions[:-1])
    # A pause between two repetitions is one border, anywhere in it.
    earliest, latest = stops[before], starts[before + 1]
    lengths = np.minimum((stops - starts)[before], (stops - starts)[before + 1])
    slack = np.minimum(REPETITION_TOLERANCE_S * truth.fps, REPETITION_TOLERANCE * lengths)

    first, last = _find_ends(primitives)
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


def find_border_frames(found: Labelling) -> Floats:
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
    found = find_border_frames(compared.spans.activities)
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


def _find_ends(repetitions: Labelling) -> tuple[Ints, Ints]:
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
    Score("edit", "Edit", "order of segments: 1 - edit distance", "segments", edit_score),
    *(
        Score(f"f1@{percent}", f"F1@{percent}",
              f"F1 of segments that overlap by at least {percent} %", "segments",
              partial(overlap_f1, percent=percent))
        for percent in OVERLAPS
    ),
    Score("count_error", "count error", "repetitions too many or too few", "repetitions",
          choose_number(count_errors, 0)),
    Score("count_exact", "counted exactly", "share of actions counted right", "repetitions",
          choose_number(count_errors, 1)),
    Score("border_precision", "border precision", "share of found borders that are right",
          "borders", choose_number(border_score, 0)),
    Score("border_recall", "border recall", "share of true borders that are found",
          "borders", choose_number(border_score, 1)),
    Score("border_f1", "border F1", "harmonic mean of border precision and recall",
          "borders", choose_number(border_score, 2)),
    Score("covering", "covering", "overlap of true segments with found ones", "borders", covering),
    Score("border_ratio", "borders, found / true", "how many, short transitions being one",
          "borders", border_ratio),
    Score("cut_ratio", "cuts, found / true", "how many, both sides of transitions being cuts",
          "borders", cut_ratio),
    Score("cluster_ratio", "clusters, found / true", "how many", "borders", cluster_ratio),
    Score("repetition_f1", "repetition border F1", "F1 of the borders between repetitions",
          "repetitions", repetition_f1),
)  # fmt: skip
