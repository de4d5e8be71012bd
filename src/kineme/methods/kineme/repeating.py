"""Decide whether a segment repeats, and how much this shortens its description.

A segment can be described in two ways. By its samples it costs half of their mean distances to
each other. If it repeats, one repetition describes all. It repeats if the mean of the other
repetitions, scaled, explains most of each one. Then this share of the cost is saved:

    (1 - max((chance_period / period)², few)) · evenness
    few = min(chance_count / count, chance_duration / (count · period), 1)

Fast repetitions save little, because the averaged view does not show them. Few repetitions save
little, because they may be similar by chance, unless they last long. Two different movements in
sequence save nothing. They are detected by comparing two means, of the first and of the last
repetitions, with a single mean: once for the shapes of the repetitions, once for which channels
move.

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
"""Shortest and longest segment that is tested, s."""
MAX_COMPARED = 32
"""Largest number of samples whose distances give the cost of a segment."""
RAMP = 0.05
"""Half width of the linear ramp around a threshold."""


class Division(NamedTuple):
    """A division into repetitions: its first sample, its end, and the share of cost it saves."""

    start: int
    stop: int
    share: float


@dataclass
class Repeating:
    """Savings of spans of a recording that repeat themselves.

    Attributes
    ----------
    rows : (frames, dims) array
        Poses or channels at the working rate.
    preset : KinemeConstants
    """

    rows: NDArray[np.float32]
    preset: KinemeConstants

    def measure_saving(
        self, view: NDArray[np.float32], unit: float, start: int, stop: int
    ) -> float:
        """Return the cost that a segment of the view saves, in samples at the distance `unit`."""
        best = self.find_division(start, stop)
        if best is None:
            return 0.0
        spread: float = kernels.measure_spread(view, best.start, best.stop, MAX_COMPARED)
        return best.share * spread / unit

    def find_division(self, start: int, stop: int) -> Division | None:
        """Return the division of a span of samples that saves most; None if none saves."""
        rate, fps = self.preset.rate, self.preset.working_fps
        rows = self.rows[round(start / rate * fps) : round(stop / rate * fps)]
        if not SPAN[0] <= (stop - start) / rate <= SPAN[1] or len(rows) < PLACES:
            return None
        # A pose that is visited once per repetition divides the span.
        movement = trace_movement(rows, self.preset)
        divisions = (
            (self._compute_share(movement, visits), visits)
            for visits in propose_visits(rows, movement, self.preset)
        )
        share, visits = max(
            divisions,
            key=lambda each: each[0] * (each[1][-1] - each[1][0]),
            default=(0.0, np.empty(0, np.int64)),
        )
        if share <= 0:
            return None
        # Extend by the partial repetitions before the first visit and after the last.
        ends = assess_division(movement, visits, self.preset, centering=1.0)
        period = (visits[-1] - visits[0]) / (len(visits) - 1)
        first = start + (visits[0] - min(ends.before, 1.0) * period) / fps * rate
        last = start + (visits[-1] + min(ends.after, 1.0) * period) / fps * rate
        return Division(max(round(first), start), min(round(last), stop), share)

    def _compute_share(self, movement: Movement, visits: Frames) -> float:
        """Return the share of cost that a division saves, 0 to 1."""
        # Cheap tests first: the others are skipped if they fail.
        preset = self.preset
        share: float = kernels.score_durations(
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
        return share and share * score_one_movement(repetitions, preset)


def score_one_movement(repetitions: NDArray[np.float64], preset: KinemeConstants) -> float:
    """Return 1 if repetitions are one movement, 0 if they are two, and values between on a ramp.

    Parameters
    ----------
    repetitions : (repetitions, places, dims) array
        Each centred.
    preset : KinemeConstants
    """
    share = _ramp_up(kernels.find_best_parting(repetitions), preset.two_movements)
    return share and share * _ramp_up(
        kernels.find_best_parting(measure_channel_energies(repetitions)), preset.same_channels
    )


def measure_channel_energies(centered: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the relative strength of movement of each channel in each repetition.

    Parameters
    ----------
    centered : (repetitions, places, dims) array
        Repetitions, each centred.

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
    energies /= np.maximum(norms, 1e-12)  # zeros stay zeros
    return np.ascontiguousarray(energies)


def _ramp_up(share: float, threshold: float) -> float:
    """Return 0 below the threshold and 1 above it, with a linear ramp within `RAMP` of it."""
    return min(max((share - threshold) / (2 * RAMP) + 0.5, 0.0), 1.0)
