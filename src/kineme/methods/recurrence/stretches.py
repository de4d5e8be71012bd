"""Stretches: a recording divided where its moments stop being alike.

1. Borders are the change points of the phase-blurred similarity: the cheapest
   division into stretches whose moments are alike.
2. A stretch that repeats less within itself than in its neighbour is part of
   that neighbour (one slow repetition of several).
3. Stretches whose moments are alike belong to one action, wherever they are.

Sources: kernel change-point detection after Arlot, Celisse and Harchaoui 2019;
the rest is ours. See ``docs/method.md`` for what each step contributes.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from kineme._threads import map_threads
from kineme.methods.numbering import by_first_appearance
from kineme.methods.recurrence import _action_kernels, _distance_kernels
from kineme.methods.recurrence import _recurrence_kernels as kernels
from kineme.methods.recurrence.recurrence import Recurrence, phase_windows

Bins = NDArray[np.int64]


def change_points(recurrence: Recurrence, *, penalty: float, min_length: int) -> Bins:
    """Borders of the stretches whose moments are most alike, ends included.

    Parameters
    ----------
    recurrence : Recurrence
    penalty : bins of likeness that a border must gain
    min_length : shortest stretch, bins
    """
    borders: Bins = _action_kernels.change_points(recurrence.similarity, penalty, min_length)
    return borders


def merge_parts(
    borders: Bins, recurrence: Recurrence, *, gap: int, softness: float, least: float
) -> Bins:
    """Borders without those between a stretch and the neighbour in which it recurs.

    A border falls if one side recurs in the other more than in itself, and by
    at least ``least``; the clearest first.

    Parameters
    ----------
    borders : bins, ends included
    recurrence : Recurrence
    gap : bins; what is no farther away does not count as recurrence
    softness : scales at which recurrence has fallen to 1/e
    least : share of the stretch that must recur
    """
    cuts = borders.tolist()

    def covered(g: int, h: int) -> float:
        share: float = kernels.coverage(
            recurrence.near, recurrence.scales, cuts[g], cuts[g + 1], cuts[h], cuts[h + 1],
            gap, softness,
        )  # fmt: skip
        return share

    def gain(left: int) -> float:
        pairs = ((left, left + 1), (left + 1, left))
        return max(covered(g, h) / max(covered(g, g), least) for g, h in pairs)

    gains = [gain(left) for left in range(len(cuts) - 2)]
    while gains and max(gains) >= 1:
        best = int(np.argmax(gains))
        del cuts[best + 1], gains[best]
        for left in (best - 1, best):
            if 0 <= left < len(gains):
                gains[left] = gain(left)
    return np.array(cuts, np.int64)


def link(
    borders: Bins,
    recurrence: Recurrence,
    poses: NDArray[np.float32],
    *,
    likeness: float,
    softness: float,
    max_lag: int | None,
) -> Bins:
    """One label per stretch: equal where the moments of two stretches are alike.

    Average linkage on the mean similarity of two stretches, relative to that
    within each.

    Parameters
    ----------
    borders : bins, ends included
    recurrence : Recurrence
    poses : (frames, dims) by which stretches are compared, in the unit of the scales
    likeness : relative similarity from which stretches are one action, 0 to 1
    softness : scales at which similarity has fallen to 1/e
    max_lag : bins; stretches farther apart are not compared, and differ
    """
    from scipy.cluster.hierarchy import fcluster, linkage
    from scipy.spatial.distance import squareform

    k = len(borders) - 1
    if k == 1:
        return np.zeros(1, np.int64)
    reach = borders[-1] if max_lag is None else max_lag
    within_reach = np.searchsorted(borders[:-1], borders[1:] + reach, side="right")
    step = recurrence.step
    gap = recurrence.phase * step
    reaches = step * np.array(phase_windows(recurrence.phase))
    bins = [_spread(start, stop) for start, stop in pairwise(borders.tolist())]
    scales = [recurrence.scales[each] for each in bins]
    frames = [step * each for each in bins]
    mean = np.zeros((k, k))

    def compare(g: int) -> None:
        for h in range(g, within_reach[g]):
            mean[g, h] = mean[h, g] = _distance_kernels.mean_likeness(
                poses, frames[g], frames[h], reaches, scales[g], scales[h],
                softness, gap,
            )  # fmt: skip

    map_threads(compare, range(k))
    within = np.sqrt(np.maximum(mean.diagonal(), LEAST))
    distance = 1 - np.clip(mean / np.outer(within, within), 0, 1)
    np.fill_diagonal(distance, 0)
    tree = linkage(squareform(distance, checks=False), "average")
    return by_first_appearance(fcluster(tree, 1 - likeness, "distance"))


# Stretches are compared by so many of their moments.
MOMENTS = 20
# A stretch is taken to be at least so much alike within.
LEAST = 0.05


def _spread(start: int, stop: int) -> Bins:
    """Moments of a stretch, evenly spread."""
    n = min(stop - start, MOMENTS)
    return start + (2 * np.arange(n) + 1) * (stop - start) // (2 * n)


def repeating(
    borders: Bins, labels: Bins, recurrence: Recurrence, *, softness: float, least: float
) -> NDArray[np.bool_]:
    """Which stretches repeat: within themselves, or in another stretch of their action.

    Parameters
    ----------
    borders, labels : stretches and their actions
    recurrence : Recurrence
    softness : scales at which recurrence has fallen to 1/e
    least : share of a stretch that must recur within it
    """
    shared = np.bincount(labels)[labels] > 1
    within = [
        kernels.coverage(
            recurrence.near, recurrence.scales, start, stop, start, stop, recurrence.phase, softness
        )
        for start, stop in pairwise(borders.tolist())
    ]
    return shared | (np.array(within) >= least)
