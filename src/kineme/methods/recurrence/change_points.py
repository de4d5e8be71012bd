"""Change points: a recording divided where its samples stop being similar.

1. Borders are the change points of the phase-blurred similarity: the cheapest
   division into segments whose samples are similar.
2. A segment that repeats less within itself than in its neighbour is part of
   that neighbour (one slow repetition of several).
3. A segment is divided where a part of it, between change points at a narrower
   phase window, repeats itself and recurs nowhere else in it (short exercises,
   one after the other).

Sources: kernel change-point detection after Arlot, Celisse and Harchaoui 2019;
the rest is ours. See ``docs/method.md`` for what each step contributes.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from kineme.methods.recurrence import _action_kernels
from kineme.methods.recurrence import _recurrence_kernels as kernels
from kineme.methods.recurrence.recurrence import Recurrence

Samples = NDArray[np.int64]


def change_points(recurrence: Recurrence, *, penalty: float, min_length: int) -> Samples:
    """Borders of the segments whose samples are most similar, ends included.

    Parameters
    ----------
    recurrence : Recurrence
    penalty : float
        Samples of similarity that a border must gain.
    min_length : int
        Shortest segment, samples.

    Returns
    -------
    (segments + 1,) array
        From 0 to the number of samples.
    """
    borders: Samples = _action_kernels.change_points(recurrence.similarity, penalty, min_length)
    return borders


def merge_neighbors(
    borders: Samples, recurrence: Recurrence, *, gap: int, softness: float, least: float
) -> Samples:
    """Borders without those between a segment and the neighbour in which it recurs.

    A border falls if one side recurs in the other more than in itself, and by
    at least ``least``; the clearest first.

    Parameters
    ----------
    borders : array of int
        Samples, ends included.
    recurrence : Recurrence
    gap : int
        Samples; what is no farther away does not count as recurrence.
    softness : float
        Scales at which recurrence has fallen to 1/e.
    least : float
        Share of the segment that must recur.
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


def divided(
    borders: Samples,
    finer: Samples,
    narrow: Recurrence,
    *,
    softness: float,
    least: float,
    elsewhere: float,
    min_length: int,
) -> Samples:
    """Borders with those of a finer division around parts that are movements of their own.

    Such a part repeats itself, and recurs little in what is before and after it in its
    segment. The phases of a slow repetition do not: they recur in the next one.

    Parameters
    ----------
    borders, finer : array of int
        Samples, ends included.
    narrow : Recurrence
        With the phase windows of the finer division.
    softness : float
        Scales at which recurrence has fallen to 1/e.
    least : float
        Share of the part that must recur within it.
    elsewhere : float
        Recurrence in what is before or after it, as a share of that, at most.
    min_length : int
        Samples; no new border is nearer to one of the borders.

    Returns
    -------
    (segments + 1,) array
    """

    def covered(of: tuple[int, int], by: tuple[int, int]) -> float:
        share: float = kernels.coverage(
            narrow.near, narrow.scales, *of, *by, narrow.phase, softness
        )
        return share

    found = set(borders.tolist())
    for start, stop in pairwise(borders.tolist()):
        inside = finer[(finer >= start + min_length) & (finer <= stop - min_length)]
        if not len(inside):
            continue
        for part in pairwise([start, *inside.tolist(), stop]):
            within = covered(part, part)
            others = ((start, part[0]), (part[1], stop))
            beside = max(covered(part, other) for other in others if other[0] < other[1])
            if within >= least and beside <= elsewhere * within:
                found.update(part)
    return np.array(sorted(found), np.int64)
