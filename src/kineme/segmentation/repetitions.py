"""Repetitions: how often an activity repeats itself, and where each one begins.

Every pose of an activity is visited once per repetition: its distance to the
activity, as that goes by, dips as often. How deep a dip must be to count as a
visit differs from pose to pose, and some poses are visited more often: a rest
between repetitions once more, a pose that is passed on the way up and on the
way down twice as often. So all poses vote, each with the speed at which it is
passed. Its dips, deepest first, fall off where the visits end; it votes for
each number of dips by how much the next is shallower. The number that gathers
most is the count, and its share of all votes the agreement.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kineme.segmentation import _distance_kernels as kernels

# Poses are compared with those so many seconds before and after: that tells up from down.
SURROUNDINGS = 0.2
# Depths are measured against a pose's large distances; less than this share of them is noise.
LARGE = 0.9  # quantile
SHALLOW = 0.05
# So many poses vote, evenly spread: enough, and bounded in the length of the activity.
VOTERS = 80


@dataclass(frozen=True, eq=False)
class Repetitions:
    """Frames at which the second, third, ... repetition begins, and how far the poses agree."""

    cuts: NDArray[np.int64]
    agreement: float


def repetitions(
    features: NDArray[np.float32],
    start: int,
    stop: int,
    core: tuple[int, int],
    *,
    surroundings: int,
) -> Repetitions:
    """Where the repetitions of an activity begin, by consensus of its poses.

    The first begins with the activity; cuts are at equal phase, namely that
    which divides the activity most evenly.

    Parameters
    ----------
    features : (frames, dims)
    start, stop : frames of the activity
    core : frames of it that certainly repeat; only these are counted
    surroundings : poses are compared with those so many frames before and after
    """
    first, last = core
    references = np.unique(np.linspace(first, last - 1, min(VOTERS, last - first)).astype(np.int64))
    depths, centers = _dips(features, references, core, surroundings)
    falls = depths - np.pad(depths[:, 1:], ((0, 0), (0, 1)))
    votes = np.append(0, _speeds(features, references) @ falls)
    # One visit is no evidence: every pose visits itself.
    if votes[2:].sum() > 0.1 * votes.sum():
        votes[:2] = 0
    count = int(votes.argmax())
    agreement = float(votes[count] / max(votes.sum(), 1e-12))
    if count < 2:
        return Repetitions(np.empty(0, np.int64), agreement)
    clear = falls[:, count - 1] >= falls[:, count - 1].max() / 2
    candidates = np.sort(centers[clear, :count], axis=1)
    borders = np.column_stack(
        [np.full(len(candidates), start), first + candidates[:, 1:], np.full(len(candidates), stop)]
    )
    even = int(np.argmin(np.diff(borders).std(axis=1)))
    return Repetitions(borders[even, 1:-1], agreement)


def _dips(
    features: NDArray[np.float32],
    references: NDArray[np.int64],
    core: tuple[int, int],
    surroundings: int,
) -> tuple[NDArray[np.float32], NDArray[np.int64]]:
    """Depths, 0 to 1, of each reference's dips over the core, deepest first, and where they are."""
    first, last = core
    shifts = np.array([-surroundings, 0, surroundings])
    frames = np.clip(np.arange(first, last)[:, None] + shifts, 0, len(features) - 1)
    wider = features[frames].reshape(last - first, -1)
    distances = kernels.distances_to(wider, references - first, 0, last - first)
    rank = int(LARGE * (last - first - 1))
    large = np.maximum(np.partition(distances, rank, axis=1)[:, rank], np.float32(1e-6))
    depths, centers = kernels.dips(distances, np.float32(SHALLOW) * large)
    shares = np.minimum(depths / large[:, None], 1)
    return np.maximum(shares - np.float32(SHALLOW), 0), centers


def _speeds(features: NDArray[np.float32], frames: NDArray[np.int64]) -> NDArray[np.float64]:
    before, after = np.maximum(frames - 1, 0), np.minimum(frames + 1, len(features) - 1)
    step = (features[after] - features[before]).astype(np.float64)
    speeds: NDArray[np.float64] = np.linalg.norm(step, axis=1) + 1e-12
    return speeds
