"""Links: which of the segments between change points are one action, and which repeat at all.

Segments whose samples are similar belong to one action, wherever they are. A segment
that repeats neither itself nor another is an activity of none.

The method is ours. See ``docs/method.md`` for what each step contributes.
"""

from __future__ import annotations

from itertools import pairwise
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
    max_lag: int | None,
) -> Samples:
    """One label per segment: equal where the samples of two segments are similar.

    Average linkage on the mean similarity of two segments, relative to that
    within each. Of a segment that hardly recurs in itself this tells little, so it
    counts the less the less of the poses of either segment the other has.

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
    max_lag : int, optional
        Samples; segments farther apart are not compared, and differ.
    """
    from scipy.cluster.hierarchy import fcluster, linkage
    from scipy.spatial.distance import squareform

    k = len(borders) - 1
    if k == 1:
        return np.zeros(1, np.int64)
    reach = borders[-1] if max_lag is None else max_lag
    within_reach = np.searchsorted(borders[:-1], borders[1:] + reach, side="right")
    step = recurrence.step
    reaches = step * np.array(recurrence.phases)
    chosen = [spread(start, stop, samples) for start, stop in pairwise(borders.tolist())]
    scales = [recurrence.scales[each] for each in chosen]
    frames = [step * each for each in chosen]
    gaps = (gap_share * np.diff(borders)).astype(np.int64)
    gaps = np.maximum(np.minimum(gaps, recurrence.phase), narrow) * step
    columns = np.ascontiguousarray(poses.T)
    mean, shared = np.zeros((k, k)), np.ones((k, k))

    def covered(g: int, h: int) -> float:
        share: float = _distance_kernels.mean_recurrence(
            columns, frames[g], scales[g], step * borders[h], step * borders[h + 1], softness
        )
        return share

    def compare(g: int) -> None:
        for h in range(g, within_reach[g]):
            mean[g, h] = mean[h, g] = _distance_kernels.mean_similarity(
                columns, frames[g], frames[h], reaches, scales[g], scales[h],
                softness, min(gaps[g], gaps[h]),
            )  # fmt: skip
            if g < h:
                shared[g, h] = shared[h, g] = min(covered(g, h), covered(h, g))

    map_threads(compare, range(k))
    within = np.sqrt(np.maximum(mean.diagonal(), least))
    alike = np.clip(mean / np.outer(within, within), 0, 1)
    distance = 1 - alike * np.minimum(shared / common, 1)
    np.fill_diagonal(distance, 0)
    tree = linkage(squareform(distance, checks=False), "average")
    return by_first_appearance(fcluster(tree, 1 - similarity, "distance"))


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
