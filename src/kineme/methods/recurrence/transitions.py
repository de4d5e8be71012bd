"""Transitions: from where one activity ends to where the next begins.

An activity lasts for as long as its poses are found again in it. So the left
one of two neighbours ends where its samples begin to recur badly, the right
one begins where its samples recur well, and what lies between is transition.
How badly is a matter of degree: a range of thresholds votes, and their mean
counts. Where the two overlap both explain what is seen, as when somebody
stands still after the one and before the other. There the border is where
movement is slowest, which is where people see one event end and another begin
(Zacks, Kumar, Abrams and Mehta 2009).

The method is ours. See ``docs/method.md`` for what each step contributes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme._threads import even_slices, map_threads
from kineme.methods.recurrence import _recurrence_kernels as kernels
from kineme.methods.recurrence.actions import Actions
from kineme.methods.recurrence.change_points import Samples
from kineme.methods.recurrence.recurrence import SHORT, Recurrence

# So many thresholds vote.
VOTES = 7


def activity_ends(
    actions: Actions,
    recurrence: Recurrence,
    *,
    factor: float,
    spread: float,
    usual: float,
    longest: int,
    largest_share: float,
) -> tuple[Samples, Samples]:
    """Frames where each segment but the last ends, and where each but the first begins.

    Equal where two segments touch; segments of no action have the ends that
    their neighbours leave them.

    Parameters
    ----------
    actions : Actions
    recurrence : Recurrence
    factor : float
        Samples recur badly if they are farther from the rest of their action than this
        times its usual distance.
    spread : float
        Factors from one minus this to one plus this times `factor` vote.
    usual : float
        Quantile of an action's distances that is its usual distance.
    longest : int
        Samples that a transition reaches into a segment at most.
    largest_share : float
        Share of a segment that it reaches into at most.

    Returns
    -------
    ends, begins : (segments - 1,) array
    """
    votes = np.linspace(1 - spread, 1 + spread, VOTES)
    per_sample = np.repeat(actions.labels, np.diff(actions.borders))
    thresholds = factor * votes[:, None] * _usual_distances(recurrence, per_sample, usual)
    reach = np.minimum(longest, largest_share * np.diff(actions.borders)).astype(np.int64)
    ends, begins = [], []
    for g, border in enumerate(actions.borders[1:-1].tolist()):
        around = slice(border - int(reach[g]), border + int(reach[g + 1]))
        at = border - around.start
        shifts = []
        for side, action in enumerate(actions.labels[g : g + 2].tolist()):
            if action >= 0 and np.isfinite(thresholds[0, action]):
                distances = _distances(recurrence, per_sample, action, around)
                unfamiliar = distances > thresholds[:, action, None]
                shifts.append(np.mean([(_end, _begin)[side](vote, at) for vote in unfamiliar]))
        left, right = (shifts[0], shifts[-1]) if shifts else (at, at)
        end, begin = (round(recurrence.step * (around.start + float(s))) for s in (left, right))
        if end > begin:
            end = begin = _slowest(recurrence, begin, end)
        ends.append(end)
        begins.append(begin)
    return np.array(ends, np.int64), np.array(begins, np.int64)


def _usual_distances(
    recurrence: Recurrence, per_sample: Samples, quantile: float
) -> NDArray[np.float64]:
    """How far most samples of each action are from the rest of it at most; infinite if unknown."""
    nearest = np.empty(len(per_sample), np.float32)

    def measure(part: slice) -> None:
        kernels.class_distances(
            recurrence.near,
            per_sample,
            per_sample,
            recurrence.phase,
            part.start,
            part.stop,
            nearest,
        )

    map_threads(measure, even_slices(len(per_sample), SHORT))
    usual = np.full(int(per_sample.max()) + 1, np.inf)
    for action in range(len(usual)):
        known = nearest[(per_sample == action) & np.isfinite(nearest)]
        if known.size:
            usual[action] = np.quantile(known, quantile)
    return usual


def _distances(
    recurrence: Recurrence, per_sample: Samples, action: int, around: slice
) -> NDArray[np.float32]:
    """How far some samples are from the nearest of an action."""
    nearest = np.empty(len(per_sample), np.float32)
    wanted = np.empty(len(per_sample), np.int64)
    wanted[around] = action
    kernels.class_distances(
        recurrence.near, per_sample, wanted, recurrence.phase, around.start, around.stop, nearest
    )
    return nearest[around]


def _end(unfamiliar: NDArray[np.bool_], border: int) -> int:
    """Where the familiar ends: before the border if it is not familiar there, else after it."""
    back = leading(unfamiliar[:border][::-1])
    return border - back if back else border + leading(~unfamiliar[border:])


def _begin(unfamiliar: NDArray[np.bool_], border: int) -> int:
    """Where the familiar begins: after the border if it is not familiar there, else before it."""
    return len(unfamiliar) - _end(unfamiliar[::-1], len(unfamiliar) - border)


def _slowest(recurrence: Recurrence, first: int, last: int) -> int:
    """The frame from first to last about which the features change least."""
    rows, step = recurrence.features, recurrence.step
    frames = np.arange(first, last + 1)
    before, after = np.maximum(frames - step, 0), np.minimum(frames + step, len(rows) - 1)
    return first + int(np.linalg.norm(rows[after] - rows[before], axis=1).argmin())


def leading(mask: NDArray[np.bool_]) -> int:
    """How many of the first values are true."""
    return len(mask) if mask.all() else int(np.argmin(mask))
