"""Links: which of the segments between change points are one action, and which repeat at all.

Segments whose samples are similar belong to one action, wherever they are. A segment
that repeats neither itself nor another is an activity of none.

The method is ours. See ``docs/method.md`` for what each step contributes.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise, product
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme._threads import map_threads
from kineme.methods.recurrence import _distance_kernels
from kineme.methods.recurrence import _recurrence_kernels as kernels
from kineme.methods.recurrence.recurrence import Recurrence
from kineme.methods.recurrence.repeating.repetitions import repetitions
from kineme.methods.samples import spread
from kineme.methods.segments import by_first_appearance

if TYPE_CHECKING:
    from kineme.methods.recurrence.constants import RecurrenceConstants

Samples = NDArray[np.int64]
Alike = Callable[[int, int], float]


def link(
    borders: Samples,
    recurrence: Recurrence,
    poses: NDArray[np.float32],
    *,
    narrow: int,
    gap_share: float,
    similarity: float,
    softness: float,
    common: float,
    samples: int,
    least: float,
    part: int,
    max_lag: int | None,
) -> Samples:
    """One label per segment: equal where the samples of two segments are similar.

    Average linkage on the mean similarity of two segments, relative to that
    within each. Of a segment that hardly recurs in itself this tells little, so it
    counts the less the less of the poses of either segment the other has.

    A long recording is linked part by part, so that the work grows with its length and not with
    its square: an action of a part is that of those known before to which it is most similar.

    Parameters
    ----------
    borders : array of int
        Samples, ends included.
    recurrence : Recurrence
    poses : (frames, dims) array
        By which segments are compared, in the unit of the scales.
    narrow : int
        Samples; pairs no farther apart never count. Of long segments those within the widest
        phase window do not, either.
    gap_share : float
        Nor do, of shorter ones, those within this share of the shorter segment.
    similarity : float
        Relative similarity from which segments are one action, 0 to 1.
    softness : float
        Scales at which similarity has fallen to 1/e.
    common : float
        Share of the poses of each segment that must be in the other for their similarity to
        count in full.
    samples : int
        Segments are compared by so many of their samples at most.
    least : float
        A segment is taken to be at least so similar within.
    part : int
        Samples that are linked at a time.
    max_lag : int, optional
        Samples; segments farther apart are not compared, and differ.
    """
    k = len(borders) - 1
    if k == 1:
        return np.zeros(1, np.int64)
    reach = borders[-1] if max_lag is None else max_lag
    step = recurrence.step
    reaches = step * np.array(recurrence.phases)
    chosen = [spread(start, stop, samples) for start, stop in pairwise(borders.tolist())]
    scales = [recurrence.scales[each] for each in chosen]
    frames = [step * each for each in chosen]
    gaps = (gap_share * np.diff(borders)).astype(np.int64)
    gaps = np.maximum(np.minimum(gaps, recurrence.phase), narrow) * step
    columns = np.ascontiguousarray(poses.T)

    def mean(g: int, h: int) -> float:
        found: float = _distance_kernels.mean_similarity(
            columns, frames[g], frames[h], reaches, scales[g], scales[h], softness,
            min(gaps[g], gaps[h]),
        )  # fmt: skip
        return found

    def covered(g: int, h: int) -> float:
        share: float = _distance_kernels.mean_recurrence(
            columns, frames[g], scales[g], step * borders[h], step * borders[h + 1], softness
        )
        return share

    within = np.sqrt(np.maximum(map_threads(lambda g: mean(g, g), range(k)), least))

    def alike(g: int, h: int) -> float:
        if borders[h] > borders[g + 1] + reach:
            return 0.0
        relative = min(mean(g, h) / (within[g] * within[h]), 1.0)
        return float(relative * min(min(covered(g, h), covered(h, g)) / common, 1.0))

    firsts = np.unique(borders[:-1] // part, return_index=True)[1]
    return by_first_appearance(_linked(alike, np.append(firsts, k), similarity))


def _linked(alike: Alike, edges: Samples, least: float) -> Samples:
    """An action for each segment: those of a part are linked, then with what is known before it.

    An action is known by two of its segments, by that which is most similar to the others and
    by the latest.

    Parameters
    ----------
    alike : callable
        How similar two segments are, the earlier one first, 0 to 1.
    edges : array of int
        The first segment of each part, and the number of all.
    least : float
        From how similar on, in the mean, segments are one action.
    """
    labels = np.empty(edges[-1], np.int64)
    known: list[tuple[int, int]] = []
    for start, stop in pairwise(edges.tolist()):
        pairs = _pairs(alike, start, stop)
        numbers = _average_linkage(pairs, least)
        members = [np.flatnonzero(numbers == number) for number in range(numbers.max() + 1)]
        usual = [int(own[pairs[np.ix_(own, own)].sum(axis=0).argmax()]) for own in members]
        now = [
            (start + each, start + int(own[0])) for each, own in zip(usual, members, strict=True)
        ]
        for shares, own, (central, _) in zip(
            _mean_similarities(alike, known, now), members, now, strict=True
        ):
            action = int(np.argmax(shares)) if max(shares, default=0) >= least else len(known)
            if action == len(known):
                known.append((central, 0))
            known[action] = known[action][0], start + int(own[-1])
            labels[start + own] = action
    return labels


def _mean_similarities(
    alike: Alike, known: list[tuple[int, int]], now: list[tuple[int, int]]
) -> list[list[float]]:
    """Of each action of a part, how similar it is to those known, by the segments of each.

    Segments too far apart to be compared say nothing.
    """

    def of(action: tuple[int, int]) -> list[float]:
        found = [[alike(g, h) for g, h in product(before, action)] for before in known]
        return [sum(each) / max(sum(share > 0 for share in each), 1) for each in found]

    return map_threads(of, now)


def _pairs(alike: Alike, start: int, stop: int) -> NDArray[np.float64]:
    """How similar each two segments of ``[start, stop)`` are."""

    def row(g: int) -> list[float]:
        return [alike(g, h) for h in range(g + 1, stop)]

    pairs = np.zeros((stop - start, stop - start))
    for g, found in enumerate(map_threads(row, range(start, stop))):
        pairs[g, g + 1 :] = pairs[g + 1 :, g] = found
    return pairs


def _average_linkage(pairs: NDArray[np.float64], least: float) -> Samples:
    """A number for each row, from 0; equal where they are similar in the mean."""
    from scipy.cluster.hierarchy import fcluster, linkage
    from scipy.spatial.distance import squareform

    if len(pairs) == 1:
        return np.zeros(1, np.int64)
    distance = 1 - pairs
    np.fill_diagonal(distance, 0)
    tree = linkage(squareform(distance, checks=False), "average")
    numbers: Samples = fcluster(tree, 1 - least, "distance") - 1
    return numbers


def repeating(
    borders: Samples, labels: Samples, recurrence: Recurrence, preset: RecurrenceConstants
) -> NDArray[np.bool_]:
    """Which segments repeat: within themselves, or in another segment of their action.

    What repeats within the phase window, where nothing counts as recurrence, is counted, where
    there is something else beside it that it can be told from.

    Parameters
    ----------
    borders, labels : array of int
        Segments and their actions.
    recurrence : Recurrence
    preset : RecurrenceConstants
    """
    shared = np.bincount(labels)[labels] > 1
    frames = np.minimum(borders * recurrence.step, len(recurrence.features))

    def repeats(g: int) -> bool:
        span = int(borders[g]), int(borders[g + 1])
        within = kernels.coverage(
            recurrence.near, recurrence.scales, *span, *span, recurrence.phase,
            preset.merge_softness,
        )  # fmt: skip
        recurs = bool(shared[g]) or within >= preset.min_repetition
        if recurs or len(labels) == 1:
            return recurs
        found = repetitions(recurrence.features, int(frames[g]), int(frames[g + 1]), preset)
        return len(found.cuts) > 0

    return np.array(map_threads(repeats, range(len(labels))))
