"""Whether a segment repeats, and how much shorter its description by one repetition is.

There are two descriptions of a segment. By its samples it costs half their mean distances to each
other. If it repeats, one repetition describes the others as well. That is so if the mean of all
others explains most of each, whatever its size. Then this share of the cost is saved:

    (1 - max((chance_period / period)², few)) · evenness
    few = min(chance_count / count, chance_duration / (count · period), 1)

Fast repetitions save little, as means over a second do not show them. Few repetitions save little,
as they may be similar by chance, unless they last long. Two movements one after the other save
nothing. They are found twice by two means, of the first repetitions and of the last, that leave
far less than one mean: once of the repetitions' shapes, once of which channels move in each.

The method is ours; see ``docs/method.md``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme.methods.kineme import _repeating_kernels as kernels
from kineme.methods.kineme._repetition_kernels import sample_repetitions
from kineme.methods.kineme.repetitions import (
    PLACES,
    Movement,
    assess_division,
    propose_visits,
    trace_movement,
)

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Frames = NDArray[np.int64]

SPAN = (1.0, 90.0)
"""Seconds of the shortest and the longest segment that can save anything."""
COMPARED = 32
"""Samples at most whose distances give the cost of a segment."""
SOFT = 0.05
"""From so far below a threshold to so far above it, a share counts more and more."""


class Division(NamedTuple):
    """A division into repetitions: from which sample to which, and the share that it saves."""

    start: int
    stop: int
    share: float


@dataclass
class Repeating:
    """What spans of a recording save by repeating themselves.

    Attributes
    ----------
    rows : (frames, dims) array
        Poses or channels at the working rate.
    preset : KinemeConstants
    """

    rows: NDArray[np.float32]
    preset: KinemeConstants

    def saved(self, view: NDArray[np.float32], unit: float, start: int, stop: int) -> float:
        """Samples at the distance `unit` that a segment of the view saves by repeating itself."""
        best = self.division(start, stop)
        if best is None:
            return 0.0
        spread: float = kernels.measure_spread(view, best.start, best.stop, COMPARED)
        return best.share * spread / unit

    def division(self, start: int, stop: int) -> Division | None:
        """Of the divisions of a span of samples, the one that saves most; None if none does."""
        rate, fps = self.preset.rate, self.preset.working_fps
        rows = self.rows[round(start / rate * fps) : round(stop / rate * fps)]
        if not SPAN[0] <= (stop - start) / rate <= SPAN[1] or len(rows) < PLACES:
            return None
        # Where a pose is visited once per repetition, the visits divide the span.
        movement = trace_movement(rows, self.preset)
        divisions = (
            (self._share(movement, visits), visits)
            for visits in propose_visits(rows, movement, self.preset)
        )
        share, visits = max(
            divisions,
            key=lambda each: each[0] * (each[1][-1] - each[1][0]),
            default=(0.0, np.empty(0, np.int64)),
        )
        if share <= 0:
            return None
        # A part of a repetition before the first visit and after the last repeats, too.
        ends = assess_division(movement, visits, self.preset, centering=1.0)
        period = (visits[-1] - visits[0]) / (len(visits) - 1)
        first = start + (visits[0] - min(ends.before, 1.0) * period) / fps * rate
        last = start + (visits[-1] + min(ends.after, 1.0) * period) / fps * rate
        return Division(max(round(first), start), min(round(last), stop), share)

    def _share(self, movement: Movement, visits: Frames) -> float:
        """Return the share that a division saves, 0 to 1."""
        # The cheap part first: nothing else is asked where it is 0.
        preset = self.preset
        share: float = kernels.share_by_times(
            visits,
            preset.working_fps,
            preset.max_repetition,
            preset.chance_period,
            preset.uneven,
            preset.chance_count,
            preset.chance_duration,
        )
        if share <= 0:
            return 0.0
        repetitions = sample_repetitions(movement.poses, movement.path, visits, PLACES)
        kernels.center_repetitions(repetitions)
        explained = kernels.explain_variance(movement.poses, movement.path, visits, repetitions)
        share *= _ramp_up(explained, preset.min_explained)
        return share and share * share_of_one_movement(repetitions, preset)


def share_of_one_movement(repetitions: NDArray[np.float64], preset: KinemeConstants) -> float:
    """Return 1 if repetitions are one movement and 0 if they are two, with a soft border.

    Parameters
    ----------
    repetitions : (repetitions, places, dims) array
        Each with a mean of 0.
    preset : KinemeConstants
    """
    share = _ramp_up(kernels.find_best_parting(repetitions), preset.two_movements)
    return share and share * _ramp_up(
        kernels.find_best_parting(measure_channel_energies(repetitions)), preset.same_channels
    )


def measure_channel_energies(centered: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how strongly each channel moves in each repetition, whatever the repetition's size.

    Parameters
    ----------
    centered : (repetitions, places, dims) array
        Repetitions, each with a mean of 0.

    Returns
    -------
    (repetitions, 1, dims) array
        Root mean squares over the places, divided by their norm over the channels.

    Examples
    --------
    >>> measure_channel_energies(np.array([[[3.0, 4.0], [-3.0, -4.0]]])).tolist()
    [[[0.6, 0.8]]]
    """
    energies = np.sqrt((centered**2).mean(axis=1, keepdims=True))
    norms = np.linalg.norm(energies, axis=2, keepdims=True)
    energies /= np.maximum(norms, 1e-12)  # a repetition without movement has no channels
    return np.ascontiguousarray(energies)


def _ramp_up(share: float, threshold: float) -> float:
    """0 below the threshold and 1 above it, evenly between within `SOFT` of it."""
    return min(max((share - threshold) / (2 * SOFT) + 0.5, 0.0), 1.0)
