"""Ends: where the first repetition of an activity begins and where the last one ends.

The repetitions between the first cut and the last have a mean over time. The first
repetition is the span before the first cut that fits this mean best, at whatever pace.
Where it begins before the activity does, in a transition, the activity begins with it.
Where it begins later, the span before it is part of no repetition: a transition of the
primitive level. The last repetition is found the same way, back in time.

The method is ours; see ``docs/method.md``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.parallel import map_threads
from kineme.methods.kineme import _repetition_kernels as kernels
from kineme.methods.kineme.repetitions import PLACES

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Frames = NDArray[np.int64]
Features = NDArray[np.float32]

SHORTEST, LONGEST = 0.5, 1.5
"""Shortest and longest first or last repetition, times the mean length of the others."""
ERROR = 0.1
"""Seconds that are no transition: the first repetition begins with its activity."""


@dataclass(frozen=True, eq=False)
class Ends:
    """Where activities and their repetitions begin and end.

    Attributes
    ----------
    starts, stops : (activities,) array
        Frames of the activities.
    firsts, lasts : (activities,) array
        Where the first repetition begins and where the last one ends.
    """

    starts: Frames
    stops: Frames
    firsts: Frames
    lasts: Frames


def fit_ends(
    features: Features,
    starts: Frames,
    stops: Frames,
    labels: Frames,
    cuts: Sequence[Frames],
    preset: KinemeConstants,
) -> Ends:
    """Return the ends of activities where repetitions fit; neighbours do not overlap.

    Parameters
    ----------
    features : (frames, dims) array
        At the working rate.
    starts, stops : (activities,) array
        Frames of the activities, in time order.
    labels : (activities,) array
        Their clusters. Two of one cluster do not touch afterwards, if they did not before.
    cuts : sequence of arrays of int
        Where the second, third, ... repetition of each begins.
    preset : KinemeConstants
    """
    n = len(features)
    # The last repetition is the first one of the recording played backwards.
    back = np.ascontiguousarray(features[::-1])

    def fitted(i: int) -> tuple[int, int, int, int]:
        start, first = _find_begin(features, int(starts[i]), cuts[i])
        stop, last = _find_begin(back, n - int(stops[i]), (n - cuts[i])[::-1].copy())
        return start, n - stop, first, n - last

    found = np.array(map_threads(fitted, range(len(cuts))), np.int64).reshape(-1, 4)
    begins, ends, firsts, lasts = found.T
    for left in np.flatnonzero(ends[:-1] >= begins[1:]).tolist():
        right = left + 1
        low, high = int(stops[left]), int(starts[right])
        # One movement with a pause: the pause stays, or both would become one activity.
        if labels[left] == labels[right]:
            ends[left], begins[right] = low, high
        elif ends[left] > begins[right]:  # both reach into the time between them
            middle = (ends[left] + begins[right]) // 2
            ends[left] = begins[right] = min(max(middle, low), high)
    error = preset.frames(ERROR)
    firsts = np.where(firsts - begins < error, begins, firsts)
    lasts = np.where(ends - lasts < error, ends, lasts)
    return Ends(begins, ends, firsts, lasts)


def fit_edges(rows: Features, cuts: Frames) -> Frames:
    """Return where repetitions of a span begin, and where the last one ends, if two cuts are known.

    Parameters
    ----------
    rows : (frames, dims) array
    cuts : (cuts,) array of int
        Where the second, third, ... repetition begins.
    """
    n, back = len(rows), np.ascontiguousarray(rows[::-1])
    _, first = _find_begin(rows, 0, cuts)
    _, last = _find_begin(back, 0, (n - cuts)[::-1].copy())
    return np.concatenate([[first], cuts, [n - last]])


def _find_begin(rows: Features, start: int, cuts: Frames) -> tuple[int, int]:
    """Where the activity that was found from ``start`` on begins, and its first repetition."""
    if len(cuts) < 2:  # nothing lies between two cuts
        return start, start
    lengths = np.diff(cuts)
    inner = kernels.sample_evenly(rows, cuts[:-1], lengths, PLACES)
    mean = inner.mean(axis=0)
    first = _find_first(rows, cuts, mean)
    return min(first, start), first


def _find_first(rows: Features, cuts: Frames, mean: Floats) -> int:
    """Where the span before the first cut begins that fits the mean best; 0 if none fits."""
    usual, stop = float(np.diff(cuts).mean()), int(cuts[0])
    shortest, longest = max(1, ceil(SHORTEST * usual)), min(int(LONGEST * usual), stop)
    if shortest > longest:
        return 0
    return stop - int(kernels.find_best_length(rows, stop, shortest, longest, mean))
