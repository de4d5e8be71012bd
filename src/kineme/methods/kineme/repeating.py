"""Whether a segment repeats, and what is saved by telling it by one repetition.

A segment has two forms of description. *Samples that stay alike* cost half their distances to each
other. *A movement that repeats* is told by one repetition: where a segment divides into repetitions
such that the mean of all others explains most of each, whatever its size, these distances need
not be told again. What is saved of them is the share

    told = (1 - max((chance_period / period)², chance_count / count)) · evenness

for means over a second see what is faster as one thing anyway, and a few repetitions may be alike
by chance. Two movements one after the other are not one: where the first repetitions and the last
ones have means of their own that leave far less than one mean, nothing is saved.

The method is ours. ``docs/method.md`` says what else was tried.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme.methods.kineme import _repeating_kernels as kernels
from kineme.methods.kineme._repetition_kernels import repetitions_between
from kineme.methods.kineme.repetitions import PLACES, Movement, candidate, movement, visits_tried

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Frames = NDArray[np.int64]

SPAN = (1.0, 90.0)
"""Seconds of the shortest and the longest segment that is asked; longer ones are so in parts."""
COMPARED = 32
"""Samples at most that tell how far a segment spreads."""
SOFT = 0.05
"""On either side of a threshold a share counts in part, so that no decimal decides."""


class Division(NamedTuple):
    """A division of a span into repetitions: its samples, and the share that is saved."""

    start: int
    stop: int
    told: float


@dataclass
class Repeating:
    """Whether spans of a recording repeat.

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
        spread: float = kernels.spread(view, best.start, best.stop, COMPARED)
        return best.told * spread / unit

    def division(self, start: int, stop: int) -> Division | None:
        """Of the divisions of a span of samples, the one by which most is saved."""
        rate, fps = self.preset.rate, self.preset.working_fps
        rows = self.rows[round(start / rate * fps) : round(stop / rate * fps)]
        if not SPAN[0] <= (stop - start) / rate <= SPAN[1] or len(rows) < PLACES:
            return None
        along = movement(rows, self.preset)
        told, visits = max(
            (
                (self._told(along, visits), visits)
                for visits in visits_tried(rows, along, self.preset)
            ),
            key=lambda each: each[0] * np.ptp(each[1]),
            default=(0.0, np.empty(0, np.int64)),
        )
        if told <= 0:
            return None
        whole = candidate(along, visits, self.preset, centering=1.0)
        period = (visits[-1] - visits[0]) / (len(visits) - 1)
        first = start + (visits[0] - min(whole.before, 1.0) * period) / fps * rate
        last = start + (visits[-1] + min(whole.after, 1.0) * period) / fps * rate
        return Division(max(round(first), start), min(round(last), stop), told)

    def _told(self, along: Movement, visits: Frames) -> float:
        """The share that is told by one repetition, 0 to 1."""
        preset, count = self.preset, len(visits)  # what lies at both ends is about one more
        durations = np.diff(visits) / preset.working_fps
        if count < 3 or durations.max() > preset.max_repetition:
            return 0.0
        faster = min(preset.chance_period / float(durations.mean()), 1.0) ** 2
        even = 1 - min(float(np.log(durations).std()) / preset.uneven, 1.0) ** 2
        share = even * (1 - max(faster, min(preset.chance_count / count, 1.0)))
        if share <= 0:
            return 0.0
        repetitions = repetitions_between(along.poses, along.path, visits, PLACES)
        kernels.center(repetitions)
        alike = kernels.explained(along.poses, along.path, visits, repetitions)
        share *= _beyond(alike, preset.alike)
        return share and share * _beyond(kernels.best_parted(repetitions), preset.two_movements)


def _beyond(share: float, threshold: float) -> float:
    """0 below the threshold and 1 above it, evenly between within `SOFT` of it."""
    return min(max((share - threshold) / (2 * SOFT) + 0.5, 0.0), 1.0)
