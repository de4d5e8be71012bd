"""Find the start of the first repetition of an activity and the end of the last one.

The first repetition is the span before the first cut that fits the mean of the inner
repetitions best, at any pace. If it begins before the activity, in a transition, the
activity is extended to it. If it begins later, the span before it becomes a transition
of the primitive level. The last repetition is found in the same way, backwards in time.

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
"""Shortest and longest first or last repetition, relative to the mean length of the others."""
MIN_TRANSITION = 0.1
"""Shortest transition before the first or after the last repetition, s; shorter ones are closed."""


@dataclass(frozen=True, eq=False)
class Ends:
    """Starts and ends of activities and of their repetitions.

    Attributes
    ----------
    starts, stops : (activities,) array
        Frames of the activities.
    firsts, lasts : (activities,) array
        Start of the first repetition, and end of the last one.
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
    """Fit the first and last repetition of each activity; activities do not overlap.

    Parameters
    ----------
    features : (frames, dims) array
        At the working rate.
    starts, stops : (activities,) array
        Frames of the activities, in time order.
    labels : (activities,) array
        Their clusters. A gap between two activities of one cluster is never closed.
    cuts : sequence of arrays of int
        Starts of the second, third, ... repetition of each.
    preset : KinemeConstants
    """
    n = len(features)
    # The last repetition is the first one of the reversed recording.
    reversed_features = np.ascontiguousarray(features[::-1])

    def fit(i: int) -> tuple[int, int, int, int]:
        start, first = _find_begin(features, int(starts[i]), cuts[i])
        reversed_cuts = (n - cuts[i])[::-1].copy()
        stop, last = _find_begin(reversed_features, n - int(stops[i]), reversed_cuts)
        return start, n - stop, first, n - last

    fitted = np.array(map_threads(fit, range(len(cuts))), np.int64).reshape(-1, 4)
    begins, ends, firsts, lasts = fitted.T
    for left in np.flatnonzero(ends[:-1] >= begins[1:]).tolist():
        right = left + 1
        low, high = int(stops[left]), int(starts[right])
        # Keep the pause between two activities of one cluster, or they would become one.
        if labels[left] == labels[right]:
            ends[left], begins[right] = low, high
        elif ends[left] > begins[right]:  # they overlap: meet in the middle
            middle = (ends[left] + begins[right]) // 2
            ends[left] = begins[right] = min(max(middle, low), high)
    tolerance = preset.frames(MIN_TRANSITION)
    firsts = np.where(firsts - begins < tolerance, begins, firsts)
    lasts = np.where(ends - lasts < tolerance, ends, lasts)
    return Ends(begins, ends, firsts, lasts)


def fit_edges(rows: Features, cuts: Frames) -> Frames:
    """Return the starts of the repetitions of a span, and the end of the last one.

    Parameters
    ----------
    rows : (frames, dims) array
    cuts : (cuts,) array of int
        Starts of the second, third, ... repetition.
    """
    n, reversed_rows = len(rows), np.ascontiguousarray(rows[::-1])
    _, first = _find_begin(rows, 0, cuts)
    _, last = _find_begin(reversed_rows, 0, (n - cuts)[::-1].copy())
    return np.concatenate([[first], cuts, [n - last]])


def _find_begin(rows: Features, start: int, cuts: Frames) -> tuple[int, int]:
    """Return the start of an activity found at ``start``, and that of its first repetition."""
    if len(cuts) < 2:  # there is no inner repetition
        return start, start
    lengths = np.diff(cuts)
    inner = kernels.sample_evenly(rows, cuts[:-1], lengths, PLACES)
    mean = inner.mean(axis=0)
    first = _find_first(rows, cuts, mean)
    return min(first, start), first


def _find_first(rows: Features, cuts: Frames, mean: Floats) -> int:
    """Return the start of the span before the first cut that fits the mean best; 0 without one."""
    mean_length, stop = float(np.diff(cuts).mean()), int(cuts[0])
    shortest = max(1, ceil(SHORTEST * mean_length))
    longest = min(int(LONGEST * mean_length), stop)
    if shortest > longest:
        return 0
    return stop - int(kernels.find_best_length(rows, stop, shortest, longest, mean))
