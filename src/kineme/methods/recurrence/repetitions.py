"""Repetitions: how often an activity repeats itself, and where each one begins.

Every pose of an activity is visited once per repetition: its distance to the
activity, as that goes by, dips as often. How many of its dips are visits is not
known. So the deepest two, three, ... of several poses each are one *way* to
divide the activity, and the best way is the one whose parts are most alike:
each is compared with the mean of all others. Of a way, what lies before the
first visit and after the last counts by how far it goes along with the mean.

Parts are compared along their path, not in time, so that pace does not matter
and a rest has no length; and apart from their size, so that a deep bend and a
shallow one are two bends, where a step with the left foot and one with the
right are halves of one repetition.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kineme.methods.recurrence import _distance_kernels as kernels
from kineme.methods.recurrence import _way_kernels as way_kernels

Floats = NDArray[np.float64]
Frames = NDArray[np.int64]

# Speeds are those of poses averaged over so many seconds before and after.
SMOOTHING = 0.07
# Depths are measured against a pose's large distances; less than this share of them is noise.
LARGE = 0.9  # quantile
SHALLOW = 0.05
# So many poses vote, evenly spread: enough, and bounded in the length of the activity.
VOTERS = 80
# The numbers of visits with the most votes are tried, each with the poses that tell it best.
NUMBERS, POSES = 8, 4
# Parts are compared at so many places along their path.
PLACES = 16
# An end is followed for as long as one and a half repetitions.
STEPS = (np.arange(PLACES * 3 // 2) + 0.5) / PLACES
# An end goes along as long as it is nearer than this share of the variance, squared.
NEAR = 0.5
# Cost of the repetition that the others are compared with, per share of the activity.
LENGTH = 1.5
# Where more than this share stays unexplained, likeness is chance.
CHANCE = 0.7
# Ways that cost little more than the best say with it how long the ends are,
# and those that cost somewhat more whether the count is certain.
SAME, RIVAL = 0.1, 0.3


@dataclass(frozen=True, eq=False)
class Repetitions:
    """Frames at which the second, third, ... repetition begins, and how certain their number is."""

    cuts: Frames
    agreement: float


@dataclass(frozen=True, eq=False)
class _Movement:
    """An activity along its path.

    Parameters
    ----------
    poses : (frames, dims), smoothed, the mean subtracted
    path : (frames + 1,) length of the path up to each frame, and to the end
    variance : mean square of the poses along the path
    """

    poses: Floats
    path: Floats
    variance: float


@dataclass(frozen=True, eq=False)
class _Way:
    """One way to divide an activity.

    Parameters
    ----------
    visits : frames at which a pose is visited
    before, after : share of a repetition before the first visit, and after the last
    unexplained : share of the activity that the other repetitions do not explain
    """

    visits: Frames
    before: float
    after: float
    unexplained: float

    @property
    def cost(self) -> float:
        return self.unexplained + LENGTH / self.number

    @property
    def number(self) -> float:
        return len(self.visits) - 1 + self.before + self.after

    @property
    def whole(self) -> int:
        return int(self.number + 0.5)

    def cuts(self, count: int) -> Frames | None:
        """The visits at which one of so many repetitions ends and the next begins."""
        spare = len(self.visits) - (count - 1)
        if not 0 <= spare <= 2:
            return None
        first = spare == 2 or (spare == 1 and self.before < self.after)
        return self.visits[int(first) : len(self.visits) - (spare - int(first))]


def repetitions(
    features: NDArray[np.float32], start: int, stop: int, *, smoothing: int
) -> Repetitions:
    """Where the repetitions of an activity begin, at equal phase.

    The first begins with the activity.

    Parameters
    ----------
    features : (frames, dims)
    start, stop : frames of the activity
    smoothing : speeds are those of poses averaged over so many frames before and after
    """
    rows = features[start:stop]
    movement = _movement(rows, smoothing)
    ways = _ways(rows, movement)
    if not ways:
        return Repetitions(np.empty(0, np.int64), 1.0)
    best = min(ways, key=lambda way: way.cost)
    same = [w for w in ways if w.cost < best.cost + SAME and abs(w.number - best.number) < 0.75]
    count = int(np.mean([way.number for way in same]) + 0.5)
    divisions = [cuts for way in same if (cuts := way.cuts(count)) is not None]
    if not divisions:
        count = best.whole
        divisions = [cuts for cuts in [best.cuts(count)] if cuts is not None]
    even = min(divisions, key=lambda cuts: np.diff([0, *cuts, len(rows)]).std())
    weights = np.array([max(best.cost + RIVAL - way.cost, 0) for way in ways])
    agreeing = np.array([way.whole == count for way in ways])
    return Repetitions(start + even, float(weights[agreeing].sum() / weights.sum()))


def _movement(rows: NDArray[np.float32], smoothing: int) -> _Movement:
    frames = np.arange(len(rows))
    before, after = np.maximum(frames - smoothing, 0), np.minimum(frames + smoothing, len(rows) - 1)
    sums = np.cumsum(np.pad(rows.astype(np.float64), ((1, 0), (0, 0))), axis=0)
    poses = (sums[after + 1] - sums[before]) / (after + 1 - before)[:, None]
    speeds = np.linalg.norm(poses[after] - poses[before], axis=1) / np.maximum(after - before, 1)
    path = np.append(0, np.cumsum(speeds))
    shares = speeds / max(path[-1], 1e-12)
    poses = poses - shares @ poses
    return _Movement(poses, path, float(shares @ (poses**2).sum(axis=1)))


def _ways(rows: NDArray[np.float32], movement: _Movement) -> list[_Way]:
    """Ways to divide an activity that more than one repetition comes of."""
    references = np.unique(np.linspace(0, len(rows) - 1, min(VOTERS, len(rows))).astype(np.int64))
    depths, centers = _dips(rows, references)
    falls = depths - np.pad(depths[:, 1:], ((0, 0), (0, 1)))
    votes = np.diff(movement.path)[references] @ falls
    votes[0] = 0  # every pose visits itself
    ways = []
    for column in np.argsort(-votes, kind="stable")[:NUMBERS]:
        clear = np.argsort(-falls[:, column], kind="stable")[:POSES]
        visits = centers[clear[falls[clear, column] > 0], : column + 1]
        ways += [_way(movement, row) for row in np.sort(visits, axis=1) if votes[column] > 0]
    return [way for way in ways if way.whole > 1 and way.unexplained < CHANCE]


def _dips(
    rows: NDArray[np.float32], references: Frames
) -> tuple[NDArray[np.float32], NDArray[np.int64]]:
    """Depths, 0 to 1, of each reference's dips, deepest first, and where they are."""
    distances = kernels.distances_to(rows, references, 0, len(rows))
    rank = int(LARGE * (len(rows) - 1))
    large = np.maximum(np.partition(distances, rank, axis=1)[:, rank], np.float32(1e-6))
    depths, centers = kernels.dips(distances, np.float32(SHALLOW) * large)
    shares = np.minimum(depths / large[:, None], 1)
    return np.maximum(shares - np.float32(SHALLOW), 0), centers


def _way(movement: _Movement, visits: Frames) -> _Way:
    poses, path = movement.poses, movement.path
    whole, at = path[-1], path[visits]
    lengths = np.diff(at)
    length = max(float(np.sort(lengths)[len(lengths) // 2]), 1e-12)
    parts = way_kernels.parts_between(poses, path, visits, PLACES)
    mean = parts.sum(axis=0) / len(parts)
    before = _along(movement, at[0] - STEPS * length, np.ascontiguousarray(mean[::-1]))
    after = _along(movement, at[-1] + STEPS * length, mean)
    strange = max(at[0] - before * length, 0) + max(whole - at[-1] - after * length, 0)
    number = len(lengths) + before + after
    if len(parts) == 1:  # compared with what comes after it, and goes on at the beginning
        ahead = at[-1] + (whole - length) * STEPS[:PLACES]
        rest = way_kernels.poses_at(poses, path, np.where(ahead < whole, ahead, ahead - whole))
        parts = np.stack([parts[0], rest])
    unlike = way_kernels.unlike(parts)[: len(lengths)]
    known = max(whole - strange - lengths.sum(), 0)
    # A part counts as a repetition, however short.
    shares = np.maximum(lengths / whole, 1 / number)
    unexplained = shares @ unlike + (unlike.sum() / len(unlike) * known + strange) / whole
    return _Way(visits, before, after, float(unexplained))


def _along(movement: _Movement, lengths: Floats, mean: Floats) -> float:
    """How much of a repetition an end goes along with the mean of the others, 0 to 1."""
    poses, path = movement.poses, movement.path
    inside = lengths[(lengths >= 0) & (lengths <= path[-1])]
    near = NEAR * movement.variance
    return float(way_kernels.along(poses, path, inside, mean, near)) / PLACES
