"""Built-in scores of frames, segments, borders and repetitions.

*Frames*: whether each frame is in the right class, and each class in one cluster.

*Segments*: whether their classes and order are right, as in action segmentation. A segment is a run
of frames of one class, after clusters are mapped to classes. Small shifts of a border cost nothing,
additional segments do (Lea, Flynn, Vidal, Reiter and Hager, "Temporal Convolutional Networks for
Action Segmentation and Detection", CVPR 2017, section 4). Repetitions are counted if the truth has
their number.

*Borders*: whether borders are found where people put them, and nowhere else. A found border is
right within the span in which people put one, extended by the tolerance of the truth. Each true
border can be matched once. Neighbours with equal labels have no border between them. A found
transition of less than 1 s is one border, at its middle; a longer one is a segment with two
borders.

*Repetitions*: whether borders between repetitions of an action are found, if people cut them. A
pause between two repetitions is one border. A border is right within 0.5 s, or a quarter of a
repetition if that is less. Borders found near the end of an action are ignored.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from sklearn.metrics import adjusted_rand_score, cohen_kappa_score, normalized_mutual_info_score

from kineme._util.arrays import Floats, Ints
from kineme.evaluation.comparison import Comparison, Run
from kineme.evaluation.score import Ratio, Score, choose_number
from kineme.evaluation.truth import TRANSITION, UNLABELLED, Labelling

OVERLAPS = (10, 25, 50)
"""Intersection over union, in percent, from which a segment counts as found."""
REPETITION_TOLERANCE_S = 0.5
"""Largest tolerance of borders between repetitions, s."""
REPETITION_TOLERANCE = 0.25
"""Largest tolerance of borders between repetitions, as a share of the shorter repetition."""


def frames_right(compared: Comparison) -> Ratio:
    """Return the share of frames whose cluster is mapped to their class (MoF).

    Returns
    -------
    Ratio
        Over a folder, every frame has the same weight.

    Examples
    --------
    >>> frames_right(Comparison([0, 0, 1], [4, 4, 4], fps=1))
    Ratio(part=2, total=3)
    """
    return Ratio(int(np.sum(compared.mapped == compared.truth)), compared.truth.size)


def one_to_one_accuracy(compared: Comparison) -> float:
    """Return the share of right frames; over a folder, every recording has the same weight.

    A cluster is mapped to at most one class, so splitting an action into many clusters lowers it.

    Parameters
    ----------
    compared : Comparison
        Of all frames; `Comparison.agreed` has only those on which people agree.

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
    """Return the adjusted Rand index of classes and clusters: 1 is equal, 0 is chance.

    Examples
    --------
    >>> rand_index(Comparison([0, 0, 1, 1], [7, 7, 2, 2], fps=1))
    1.0
    """
    return float(adjusted_rand_score(compared.truth, compared.found))


def mutual_information(compared: Comparison) -> float:
    """Return the mutual information of classes and clusters over their mean entropy: 0 to 1.

    Examples
    --------
    >>> mutual_information(Comparison([0, 0, 1, 1], [7, 7, 7, 7], fps=1))
    0.0
    """
    return float(normalized_mutual_info_score(compared.truth, compared.found))


def cohen_kappa(compared: Comparison) -> float:
    """Return Cohen's kappa: the share of right frames, corrected for chance.

    Expected agreement follows from the shares of the classes on both sides. Clusters are mapped to
    classes. Source: Cohen, A coefficient of agreement for nominal scales, 1960.

    Parameters
    ----------
    compared : Comparison
        Comparison of a result, or of a second person, with the truth.

    Returns
    -------
    float
        1 is equal, 0 is chance, below 0 is worse. It is 1 if both sides have one common class.

    Examples
    --------
    >>> cohen_kappa(Comparison([0, 0, 0, 1], [4, 4, 7, 7], fps=1))
    0.5
    >>> cohen_kappa(Comparison([0, 0, 1, 1], [4, 4, 4, 4], fps=1))
    0.0
    """
    # A single common class is expected by chance, too: 0 / 0.
    if np.ptp([compared.truth, compared.mapped]) == 0:
        return 1.0
    return float(cohen_kappa_score(compared.truth, compared.mapped))


def edit_score(compared: Comparison) -> float:
    """Return the similarity of the orders of segments: 1 is equal, 0 is completely different.

    It is 1 - distance / length: the fewest insertions, deletions and exchanges of segments that
    turn one order of classes into the other, divided by the larger number of segments.

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
    # First row of the table: distances from the empty sequence.
    row = np.arange(len(b) + 1)
    columns = np.arange(len(b) + 1)
    other = np.asarray(b)
    for i, label in enumerate(a, 1):
        best = np.minimum(row[1:] + 1, row[:-1] + (other != label))
        # An insertion costs 1 per column: a running minimum of costs minus columns.
        row = np.minimum.accumulate(np.concatenate([[i], best]) - columns) + columns
    return int(row[-1])


def overlap_f1(compared: Comparison, *, percent: float) -> Ratio:
    """Return the F1 of the found segments, which are right if they overlap a true one enough.

    Each found segment is compared with the true segment of its class that has the largest
    intersection over union. A true segment can be found only once.

    Parameters
    ----------
    compared : Comparison
    percent : float
        Smallest intersection over union, in percent.

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
    """Return the mean error of the number of repetitions, and the share of exact counts.

    Returns
    -------
    error, exact : float
        None if the truth has no counts.

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
    # A repetition belongs to the action that contains its middle.
    found = np.histogram((starts + stops) / 2, bins=truth.at_means().borders)[0]
    # `strict=False`: counts are empty if the truth has none.
    pairs = zip(found.tolist(), truth.counts, strict=False)
    errors = [abs(count - true) for count, true in pairs if true is not None]
    return (float(np.mean(errors)), float(np.mean(np.array(errors) == 0))) if errors else None


def _count_hits(true: Sequence[Run], found: Sequence[Run], min_overlap: float) -> int:
    """Count the true segments that are the best match of a found one of their class.

    ``min_overlap`` is the smallest intersection over union, 0 to 1.
    """
    # Columns of the runs: label, start, stop.
    labels, starts, stops = np.array(true).T
    hits: set[int] = set()
    for label, start, stop in found:
        overlap = np.where(labels == label, _measure_overlaps(start, stop, starts, stops), 0.0)
        best = int(np.argmax(overlap))
        if overlap[best] > 0 and overlap[best] >= min_overlap:
            hits.add(best)  # a set: each true segment counts once
    return len(hits)


def _measure_overlaps(start: int, stop: int, starts: Ints, stops: Ints) -> Floats:
    """Return the intersection over union of a span and each of others; 0 for disjoint ones."""
    shared = np.minimum(stops, stop) - np.maximum(starts, start)
    union = np.maximum(stops, stop) - np.minimum(starts, start)
    return np.asarray(np.maximum(shared, 0) / union)


class BorderScore(NamedTuple):
    """Share of found borders that are right, share of true borders found, and harmonic mean.

    Examples
    --------
    >>> border_score(Comparison([0, 0, 1, 1], [5, 5, 5, 3], fps=10))
    BorderScore(precision=1.0, recall=1.0, f1=1.0)
    """

    precision: float
    recall: float
    f1: float


def border_score(compared: Comparison) -> BorderScore:
    """Return precision, recall and F1 of the found borders.

    The number of pairs is maximal: in time order, each true border takes the first found one that
    is right. Without true and found borders all three are 1.

    Examples
    --------
    >>> border_score(Comparison([0, 0, 1, 1], [5, 5, 5, 3], fps=10)).f1
    1.0
    """
    truth, found = compared.spans.actions, find_border_frames(compared.spans.activities)
    if not truth.mean.size + found.size:
        return BorderScore(1.0, 1.0, 1.0)
    # Tolerance in frames, beyond the span in which people put the border.
    slack = truth.tolerance_s * truth.fps
    hits = len(_match_borders(truth.earliest - slack, truth.latest + slack, found))
    return BorderScore(
        hits / found.size if found.size else 0.0,
        hits / truth.mean.size if truth.mean.size else 0.0,
        2 * hits / (found.size + truth.mean.size),
    )


def repetition_f1(compared: Comparison) -> Ratio | None:
    """Return the F1 of borders between repetitions, in actions whose repetitions people cut.

    Return None if there are none.
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
    # A pause between two repetitions is one border, which may be anywhere in it.
    earliest, latest = stops[before], starts[before + 1]
    lengths = np.minimum((stops - starts)[before], (stops - starts)[before + 1])
    slack = np.minimum(REPETITION_TOLERANCE_S * truth.fps, REPETITION_TOLERANCE * lengths)

    first, last = _find_ends(primitives)
    found = (last[:-1] + first[1:]) / 2
    # Only within actions whose repetitions people cut.
    found = found[np.isin(np.searchsorted(ends, found, "right"), actions)]
    hits = _match_borders(earliest - slack, latest + slack, found)
    near = REPETITION_TOLERANCE_S * truth.fps
    begin, end = truth.earliest - near, truth.latest + near
    # Borders found near the end of an action are not wrong; (found, borders).
    at_ends = np.any((begin <= found[:, None]) & (found[:, None] <= end), axis=1)
    # Neither right nor near the end of an action.
    wrong = np.delete(~at_ends, hits)
    # 2 TP + FN + FP = true borders + hits + wrong ones.
    total = len(earliest) + len(hits) + int(wrong.sum())
    return Ratio(2 * len(hits), total) if total else None


def find_border_frames(found: Labelling) -> Floats:
    """Return the frames at which the label changes; a short transition has only one border."""
    runs = found.merged()
    is_short = runs.find_short_transitions()
    borders: list[float] = []
    for i in range(1, len(is_short)):
        if is_short[i]:
            borders.append((runs.starts[i] + runs.stops[i]) / 2)
        elif not is_short[i - 1]:
            # Skip the end of a short transition, which is represented by its middle.
            borders.append(float(runs.starts[i]))
    return np.array(borders)


def covering(compared: Comparison) -> float:
    """Return how well actions are covered by found intervals, weighted by length: 0 to 1.

    For each action of the truth, cut at the mean marks, this is the best intersection
    over union with any found interval. Source: Arbeláez et al. 2011, equation 4; used for
    change points by van den Burg and Williams 2020.

    Examples
    --------
    >>> covering(Comparison([0, 0, 1, 1], [5, 5, 5, 5], fps=10))
    0.5
    """
    actions, found = compared.spans.actions.at_means(), compared.spans.activities.merged()
    best = [
        _measure_overlaps(start, stop, found.starts, found.stops).max()
        for start, stop in zip(actions.starts, actions.stops, strict=True)
    ]
    return float(np.average(best, weights=np.diff(actions.borders)))


def border_ratio(compared: Comparison) -> Ratio:
    """Return the number of found borders over that of true ones; above 1 there are too many.

    Examples
    --------
    >>> border_ratio(Comparison([0, 0, 1, 1], [5, 6, 5, 6], fps=10))
    Ratio(part=3, total=1)
    """
    found = find_border_frames(compared.spans.activities)
    return Ratio(found.size, compared.spans.actions.mean.size)


def cut_ratio(compared: Comparison) -> Ratio:
    """Return the ratio as `border_ratio`, with both ends of all found transitions as borders.

    Examples
    --------
    >>> cut_ratio(Comparison([0, 0, 1, 1], [5, 6, 5, 6], fps=10))
    Ratio(part=3, total=1)
    """
    cuts = compared.spans.activities.merged().borders.size - 2
    return Ratio(cuts, compared.spans.actions.mean.size)


def cluster_ratio(compared: Comparison) -> Ratio:
    """Return the number of found clusters over that of classes, both without transitions.

    Examples
    --------
    >>> cluster_ratio(Comparison([0, 0, 1, 1], [5, 6, 5, 6], fps=10))
    Ratio(part=2, total=2)
    """
    ignored = {UNLABELLED} if compared.transitions else set()
    sides = ({*np.unique(side).tolist()} - ignored for side in (compared.segments, compared.truth))
    return Ratio(*map(len, sides))


def _find_ends(repetitions: Labelling) -> tuple[Ints, Ints]:
    """Return starts and stops of repetitions, without transitions."""
    kept = np.array([label != TRANSITION for label in repetitions.labels])
    return repetitions.starts[kept], repetitions.stops[kept]


def _match_borders(first: ArrayLike, last: ArrayLike, found: Floats) -> list[int]:
    """Match each true span with the first found border in it; return indices of found borders."""
    hits: list[int] = []
    next_found = 0
    for start, stop in zip(np.asarray(first), np.asarray(last), strict=True):
        # Borders are sorted, so earlier found borders are not needed again.
        next_found = max(next_found, int(np.searchsorted(found, start)))
        if next_found < found.size and found[next_found] <= stop:
            hits.append(next_found)
            next_found += 1
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
