"""Repetitions: how often an activity repeats itself, and where each one begins.

Every pose of an activity is visited once per repetition: its distance to the
activity, as that goes by, dips as often. How many of its dips are visits is not
known. So the deepest two, three, ... of several poses each are one *candidate*
division of the activity, and the best is the one whose repetitions are most
similar: each is compared with the mean of all others. Of a candidate, what lies
before the first visit and after the last counts by how far it follows the mean,
and the less the farther it is from it than repetitions are: a step that fades into
the next movement is part of one. Their paths should be about as long as each other.

Repetitions are compared along their path, not in time, so that pace does not
matter and a rest has no length; and apart from their size, so that a deep bend
and a shallow one are two bends, where a step with the left foot and one with
the right are halves of one repetition. Where they are, such as how a sensor is
held, is left out of it as far as the preset says (`centering`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme.methods.kineme import _repetition_kernels as kernels
from kineme.methods.kineme.rests import at_rest

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Floats = NDArray[np.float64]
Frames = NDArray[np.int64]

PLACES = 16
"""Places along a repetition's path at which it is compared."""
VOTERS, COUNTS, POSES = 80, 8, 4
"""Poses that vote on the number of repetitions, numbers that are tried, and poses for each."""
DEEP = 0.9
"""Depths of dips are measured against this quantile of a pose's distances."""
SMOOTHED = 0.14
"""Seconds before and after a frame, over which poses are averaged."""
FOLLOWED = 1.5
"""Repetitions for which an end is followed."""
REST_AVERAGED = 0.1
"""Seconds before and after a frame, over which its speed is the mean."""
ROUNDED_UP = 0.35
"""From this on a part of a repetition is one."""
SAME_COUNT = 0.75
"""Repetitions by which divisions differ at most that say together how long the ends are."""


@dataclass(frozen=True, eq=False)
class Repetitions:
    """Where the repetitions of an activity begin.

    Attributes
    ----------
    cuts : array of int
        Frames at which the second, third, ... repetition begins.
    """

    cuts: Frames


@dataclass(frozen=True, eq=False)
class Movement:
    """An activity along its path.

    Attributes
    ----------
    poses : (frames, dims) array
        Smoothed, the mean subtracted.
    middle : (dims,) array
        That mean, along the path.
    path : (frames + 1,) array
        Length of the path up to each frame, and to the end.
    variance : float
        Mean square of the poses along the path.
    """

    poses: Floats
    middle: Floats
    path: Floats
    variance: float


@dataclass(frozen=True, eq=False)
class Candidate:
    """One division of an activity.

    Attributes
    ----------
    visits : array of int
        Frames at which a pose is visited.
    before, after : float
        Share of a repetition before the first visit, and after the last.
    ends : float
        What of these counts, the less the farther it is from the others.
    unexplained : float
        Share of the activity that the other repetitions do not explain.
    preset : KinemeConstants
    """

    visits: Frames
    before: float
    after: float
    ends: float
    unexplained: float
    preset: KinemeConstants

    @property
    def cost(self) -> float:
        length_cost = self.preset.length_cost / self.number
        return self.unexplained + length_cost

    @property
    def number(self) -> float:
        return len(self.visits) - 1 + self.ends

    @property
    def whole(self) -> int:
        return _whole(self.number)

    def is_chance(self, most: float) -> bool:
        """Whether the mean of however many repetitions would leave more than ``most`` unexplained.

        The mean of few others has noise of its own, and explains less: so much, where any two
        correlate by ``common``.
        """
        common, others = 1 - most, max(self.number - 1, 1)
        explained = common**2 * others / (1 + (others - 1) * common)
        return self.unexplained >= 1 - explained

    def cuts(self, count: int) -> Frames | None:
        """The visits at which one of so many repetitions ends and the next begins."""
        spare = len(self.visits) - (count - 1)
        if not 0 <= spare <= 2:
            return None
        first = spare == 2 or (spare == 1 and self.before < self.after)
        return self.visits[int(first) : len(self.visits) - (spare - int(first))]


def repetitions(
    features: NDArray[np.float32], start: int, stop: int, preset: KinemeConstants
) -> Repetitions:
    """Where the repetitions of an activity begin, at equal phase.

    The first begins with the activity, the others where somebody rests, if anywhere.

    Parameters
    ----------
    features : (frames, dims) array
        At the working rate.
    start, stop : int
        Frames of the activity.
    preset : KinemeConstants

    Returns
    -------
    Repetitions
    """
    rows = features[start:stop]
    along = movement(rows, preset)
    candidates = _candidates(rows, along, preset)
    if not candidates:
        return Repetitions(np.empty(0, np.int64))
    best = min(candidates, key=lambda each: each.cost)
    same = [
        each
        for each in candidates
        if each.cost <= best.cost + preset.same_cost
        and abs(each.number - best.number) <= SAME_COUNT
    ]
    count = _whole(float(np.mean([each.number for each in same])))
    divisions = [cuts for each in same if (cuts := each.cuts(count)) is not None]
    if not divisions:
        count = best.whole
        divisions = [cuts for cuts in [best.cuts(count)] if cuts is not None]
    lengths = np.diff(np.array(divisions), axis=1, prepend=0, append=len(rows))
    cuts = divisions[lengths.std(axis=1).argmin()]
    return Repetitions(start + at_rest(cuts, along.path, preset.frames(REST_AVERAGED)))


def movement(rows: NDArray[np.float32], preset: KinemeConstants) -> Movement:
    """An activity along its path."""
    poses, speeds = kernels.smoothed(rows, preset.frames(SMOOTHED))
    path = np.append(0, np.cumsum(speeds))
    shares = speeds / max(path[-1], 1e-12)
    middle = shares @ poses
    poses = poses - middle
    return Movement(poses, middle, path, float(shares @ (poses**2).sum(axis=1)))


def visits_tried(
    rows: NDArray[np.float32], movement: Movement, preset: KinemeConstants
) -> Iterator[Frames]:
    """Frames at which a pose is visited, once per repetition, of each division that is tried."""
    references = np.unique(np.linspace(0, len(rows) - 1, min(VOTERS, len(rows))).astype(np.int64))
    depths, centers = _dips(rows, references, preset)
    falls = depths - np.pad(depths[:, 1:], ((0, 0), (0, 1)))
    votes = np.diff(movement.path)[references] @ falls
    votes[0] = 0  # every pose visits itself
    for column in np.argsort(-votes, kind="stable")[:COUNTS]:
        clear = np.argsort(-falls[:, column], kind="stable")[:POSES]
        if votes[column] > 0:
            yield from np.sort(centers[clear[falls[clear, column] > 0], : column + 1], axis=1)


def _candidates(
    rows: NDArray[np.float32], movement: Movement, preset: KinemeConstants
) -> list[Candidate]:
    """Divisions of an activity into more than one repetition."""
    found = [
        candidate(movement, visits, preset, preset.centering)
        for visits in visits_tried(rows, movement, preset)
    ]
    return [each for each in found if each.whole > 1 and not _is_chance(each, movement, preset)]


def _is_chance(division: Candidate, movement: Movement, preset: KinemeConstants) -> bool:
    """Whether its repetitions are alike by chance in how they move, wherever they are.

    Who stands, and leans now to one side, now to the other, repeats nothing.
    """
    if preset.centering < 1:
        division = candidate(movement, division.visits, preset, centering=1.0)
    return division.is_chance(preset.max_unexplained)


def _dips(
    rows: NDArray[np.float32], references: Frames, preset: KinemeConstants
) -> tuple[NDArray[np.float32], NDArray[np.int64]]:
    """Depths, 0 to 1, of each reference's dips, deepest first, and where they are."""
    distances = kernels.distances_to(rows, references, 0, len(rows))
    rank = int(DEEP * (len(rows) - 1))
    large = np.maximum(np.partition(distances, rank, axis=1)[:, rank], np.float32(1e-6))
    noise = np.float32(preset.noise_share)
    depths, centers = kernels.dips(distances, noise * large)
    most = max(int(np.count_nonzero(depths.any(axis=0))), 1)  # the others have none
    depths, centers = depths[:, :most], centers[:, :most]
    shares = np.minimum(depths / large[:, None], 1)
    return np.maximum(shares - noise, 0), centers


def candidate(
    movement: Movement, visits: Frames, preset: KinemeConstants, centering: float
) -> Candidate:
    """The division of an activity at these visits, with its ends."""
    before, after, ends, unexplained = kernels.judged(
        movement.poses, movement.path, visits, PLACES,
        preset.end_distance * movement.variance, FOLLOWED, centering,
        preset.end_scatter,
    )  # fmt: skip
    return Candidate(visits, before, after, ends, unexplained, preset)


def _whole(number: float) -> int:
    """How many repetitions so many are, parts of them included."""
    return int(number + 1 - ROUNDED_UP)
