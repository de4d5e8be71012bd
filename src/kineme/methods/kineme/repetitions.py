"""Repetitions: how often an activity repeats itself, and where each one begins.

Each repetition passes every pose of the activity once. So the distance of an activity to one of
its poses has a dip for each repetition. Some dips are not such *visits*. So the deepest two,
three, ... dips of several poses are *candidates*: divisions of the activity. The best is the one
whose repetitions are most similar to the mean of the others.

The ends, before the first visit and after the last, count by how far they follow the mean, and the
less the farther they are from it than repetitions are. The paths of repetitions should be about as
long as each other.

Repetitions are compared by position on their path, not in time, so that pace does not matter and a
rest has no length. They are compared by correlation: a deep bend and a shallow one are two bends,
while a step with the left foot and one with the right are halves of one repetition. Posture counts
as far as `centering` leaves it.

Repetitions begin at rest, where there is a rest between them. People see events begin and end
where movement is slowest (Zacks, Kumar, Abrams and Mehta 2009), and a clip that begins there can
be used.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme.methods.kineme import _repetition_kernels as kernels

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Frames = NDArray[np.int64]
Rows = NDArray[np.float32]

PLACES = 16
"""Places on a repetition's path at which it is compared."""
VOTERS, COUNTS, POSES = 80, 8, 4
"""Poses that vote on the number of repetitions, numbers that are tried, and poses for each."""
DEEP = 0.9
"""Depths of dips are measured against this quantile of a pose's distances."""
SMOOTHED = 0.14
"""Seconds before and after a frame, over which poses are averaged."""
FOLLOWED = 1.5
"""Longest end, in repetitions."""
ROUNDED_UP = 0.35
"""From this on a part of a repetition is one."""
SAME_COUNT = 0.75
"""Candidates whose numbers differ by this at most are averaged for the length of the ends."""
REST_AVERAGED = 0.1
"""Seconds before and after a frame, over which its speed is the mean."""
RESTING = 0.25
"""Share of the mean speed below which there is a rest."""
NEAR = 0.15
"""Share of a repetition within which each rest is searched."""


@dataclass(frozen=True, eq=False)
class Movement:
    """A span of a recording as a path of poses.

    Attributes
    ----------
    poses : (frames, dims) array
        Smoothed, the mean subtracted.
    middle : (dims,) array
        That mean, each pose weighted by its speed.
    path : (frames + 1,) array
        Length of the path up to each frame, and to the end.
    variance : float
        Mean square of the poses, each weighted by its speed.
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
        return self.unexplained + self.preset.length_cost / self.number

    @property
    def number(self) -> float:
        return len(self.visits) - 1 + self.ends

    @property
    def count(self) -> int:
        return _round_count(self.number)

    def is_chance(self, most: float) -> bool:
        """Return whether the mean of many repetitions would leave more than ``most`` unexplained.

        The mean of few others has noise of its own, and explains less. That is allowed for: with
        the correlation 1 - ``most`` between any two, the mean of these others explains so much.
        """
        # Variance of a mean: the common part stays, the noise of each is divided by their number.
        common, others = 1 - most, max(self.number - 1, 1)
        explained = common**2 * others / (1 + (others - 1) * common)
        return self.unexplained >= 1 - explained

    def cuts(self, count: int) -> Frames | None:
        """Return the visits at which one of so many repetitions ends and the next begins.

        None if there are too few visits, or more than one too many at either end.
        """
        spare = len(self.visits) - (count - 1)
        if not 0 <= spare <= 2:
            return None
        first = spare == 2 or (spare == 1 and self.before < self.after)
        return self.visits[int(first) : len(self.visits) - (spare - int(first))]


def find_repetitions(features: Rows, start: int, stop: int, preset: KinemeConstants) -> Frames:
    """Frames at which the second, third, ... repetition of an activity begins, at equal phase.

    The first begins with the activity, the others at rest if there are rests.

    Parameters
    ----------
    features : (frames, dims) array
        At the working rate.
    start, stop : int
        Frames of the activity.
    preset : KinemeConstants
    """
    rows = features[start:stop]
    movement = trace_movement(rows, preset)
    candidates = _find_candidates(rows, movement, preset)
    if not candidates:
        return np.empty(0, np.int64)
    best = min(candidates, key=lambda each: each.cost)
    same = [
        each
        for each in candidates
        if each.cost <= best.cost + preset.same_cost
        and abs(each.number - best.number) <= SAME_COUNT
    ]
    # Several divisions of nearly the same cost are more certain about the ends than one.
    count = _round_count(float(np.mean([each.number for each in same])))
    divisions = [cuts for each in same if (cuts := each.cuts(count)) is not None]
    if not divisions:
        divisions = [cuts for cuts in [best.cuts(best.count)] if cuts is not None]
    # Of divisions with that count the one with the most even repetitions.
    lengths = np.diff(np.array(divisions), axis=1, prepend=0, append=len(rows))
    cuts = divisions[lengths.std(axis=1).argmin()]
    return start + shift_to_rest(cuts, movement.path, preset.frames(REST_AVERAGED))


def trace_movement(rows: Rows, preset: KinemeConstants) -> Movement:
    """Return a span of a recording as a path of poses."""
    poses, speeds = kernels.smooth_rows(rows, preset.frames(SMOOTHED))
    path = np.append(0, np.cumsum(speeds))
    shares = speeds / max(path[-1], 1e-12)
    middle = shares @ poses
    poses = poses - middle
    return Movement(poses, middle, path, float(shares @ (poses**2).sum(axis=1)))


def propose_visits(rows: Rows, movement: Movement, preset: KinemeConstants) -> Iterator[Frames]:
    """Frames at which a pose is visited, once per repetition, of each division that is tried."""
    # Some poses, evenly in time, each of which is searched everywhere.
    references = np.unique(np.linspace(0, len(rows) - 1, min(VOTERS, len(rows))).astype(np.int64))
    depths, centers = _find_dips(rows, references, preset)
    # Dips are sorted by depth: after the last true visit the next dip is much shallower.
    falls = depths - np.pad(depths[:, 1:], ((0, 0), (0, 1)))
    # A pose votes with its speed, since poses at rest are visited without a repetition.
    votes = np.diff(movement.path)[references] @ falls
    votes[0] = 0  # every pose visits itself
    # Numbers of visits with most votes; for each the poses that are clearest about it.
    for column in np.argsort(-votes, kind="stable")[:COUNTS]:
        clear = np.argsort(-falls[:, column], kind="stable")[:POSES]
        if votes[column] > 0:
            yield from np.sort(centers[clear[falls[clear, column] > 0], : column + 1], axis=1)


def _find_dips(rows: Rows, references: Frames, preset: KinemeConstants) -> tuple[Rows, Frames]:
    """Depths, 0 to 1, of each reference's dips, deepest first, and where they are."""
    distances = kernels.measure_distances(rows, references)
    rank = int(DEEP * (len(rows) - 1))
    # A quantile in place of the largest distance, which one outlier decides.
    large = np.maximum(np.partition(distances, rank, axis=1)[:, rank], np.float32(1e-6))
    noise = np.float32(preset.noise_share)
    depths, centers = kernels.find_dips(distances, noise * large)
    most = max(int(np.count_nonzero(depths.any(axis=0))), 1)  # the others have none
    depths, centers = depths[:, :most], centers[:, :most]
    shares = np.minimum(depths / large[:, None], 1)
    return np.maximum(shares - noise, 0), centers


def _find_candidates(rows: Rows, movement: Movement, preset: KinemeConstants) -> list[Candidate]:
    """Divisions of an activity into more than one repetition."""
    found = [
        assess_division(movement, visits, preset, preset.centering)
        for visits in propose_visits(rows, movement, preset)
    ]
    return [each for each in found if each.count > 1 and not _is_chance(each, movement, preset)]


def _is_chance(division: Candidate, movement: Movement, preset: KinemeConstants) -> bool:
    """Return whether its repetitions are similar by chance in how they move, wherever they are.

    Standing and leaning now to one side, now to the other, is no repetition.
    """
    if preset.centering < 1:
        division = assess_division(movement, division.visits, preset, centering=1.0)
    return division.is_chance(preset.max_unexplained)


def assess_division(
    movement: Movement, visits: Frames, preset: KinemeConstants, centering: float
) -> Candidate:
    """Return the division of an activity at these visits, with its ends."""
    near, scattered = preset.end_distance * movement.variance, preset.end_scatter
    before, after, ends, unexplained = kernels.measure_division(
        movement.poses, movement.path, visits, PLACES, near, FOLLOWED, centering, scattered
    )
    return Candidate(visits, before, after, ends, unexplained, preset)


def _round_count(number: float) -> int:
    """Return a number of repetitions in whole ones, parts of them included."""
    return int(number + 1 - ROUNDED_UP)


def shift_to_rest(cuts: Frames, path: Floats, averaged: int) -> Frames:
    """Return the cuts, all moved by the same phase to where movement is slowest.

    They stay where there is no rest, and where the first or the last repetition would be less
    than half of one.

    Parameters
    ----------
    cuts : (cuts,) array of int
        Frames at which the second, third, ... repetition begins, ascending.
    path : (frames + 1,) array
        Length of the path up to each frame, and to the end.
    averaged : int
        Frames before and after one, over which its speed is the mean.

    Examples
    --------
    >>> path = np.append(0, np.cumsum(np.tile([1.0, 1, 1, 1, 0, 0, 0, 1], 3)))
    >>> shift_to_rest(np.array([8, 16]), path, 1).tolist()
    [5, 13]
    """
    if not len(cuts):
        return cuts
    n = len(path) - 1
    # All cuts move by the same phase: by half a repetition to either side at most.
    usual = float(np.median(np.diff(cuts, prepend=0, append=n)))
    half = usual / 2
    shifts = np.arange(-int(half), int(half) + 1)
    shifts = shifts[(cuts[0] + shifts >= half) & (cuts[-1] + shifts <= n - half)]
    if not len(shifts):
        return cuts
    frames = np.arange(n)
    first, last = np.maximum(frames - averaged, 0), np.minimum(frames + averaged + 1, n)
    # The path is a running sum of speeds, so differences give means at once.
    speeds = (path[last] - path[first]) / (last - first)
    # (shifts,): mean speed at all cuts, if they were moved by that much.
    slowness = speeds[cuts[:, None] + shifts].mean(axis=0)
    if slowness.min() > RESTING * path[-1] / n:
        return cuts
    # Then each cut goes to the slowest frame close by, as rests are never exactly even.
    rests = cuts + shifts[slowness.argmin()]
    reach = int(NEAR * usual)
    near = np.arange(-reach, reach + 1)
    around = np.clip(rests[:, None] + near, 1, n - 1)
    slowest = np.take_along_axis(around, speeds[around].argmin(axis=1)[:, None], axis=1)[:, 0]
    return slowest if (np.diff(slowest) > 0).all() else rests
