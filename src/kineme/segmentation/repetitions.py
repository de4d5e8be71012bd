"""Repetitions: how often an activity repeats itself, and where each one begins.

Every pose of an activity is visited once per repetition. How often it is
visited depends on how near counts as a visit, and on the pose: a rest between
repetitions is visited once more than there are repetitions, a pose that is
passed on the way up and on the way down twice as often. So all poses vote, at
several thresholds, each with the speed at which it is passed; the number that
most agree on is the count, and the share of votes it got is the agreement.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kineme.segmentation import _distance_kernels as kernels

# A pose is visited when the distance falls below these shares of its large distances.
THRESHOLDS = (0.3, 0.4, 0.5, 0.6, 0.7)
LARGE = 0.9  # quantile
# So many poses vote, evenly spread: enough, and bounded in the length of the activity.
VOTERS = 80


@dataclass(frozen=True, eq=False)
class Repetitions:
    """Frames at which the second, third, ... repetition begins, and how far the poses agree."""

    cuts: NDArray[np.int64]
    agreement: float


def repetitions(
    features: NDArray[np.float32], start: int, stop: int, core: tuple[int, int]
) -> Repetitions:
    """Where the repetitions of an activity begin, by consensus of its poses.

    The first begins with the activity; cuts are at equal phase, namely that
    which divides the activity most evenly.

    Parameters
    ----------
    features : (frames, dims)
    start, stop : frames of the activity
    core : frames of it that certainly repeat; only these are counted
    """
    first, last = core
    references = np.unique(np.linspace(first, last - 1, min(VOTERS, last - first)).astype(np.int64))
    distances = kernels.distances_to(features, references, first, last)
    rank = int(LARGE * (last - first - 1))
    large = np.partition(distances, rank, axis=1)[:, rank]
    weights = _speeds(features, references)
    visits = [kernels.visit_centers(distances, share * large) for share in THRESHOLDS]
    votes = np.zeros(last - first)
    for counts, _ in visits:
        votes += np.bincount(counts, weights=weights, minlength=len(votes))
    # One visit is no evidence: every pose visits itself.
    if votes[2:].sum() > 0.1 * votes.sum():
        votes[:2] = 0
    count = int(votes.argmax())
    agreement = float(votes[count] / max(votes.sum(), 1e-12))
    if count < 2:
        return Repetitions(np.empty(0, np.int64), agreement)
    candidates = np.concatenate([centers[counts == count, :count] for counts, centers in visits])
    borders = np.column_stack(
        [np.full(len(candidates), start), first + candidates[:, 1:], np.full(len(candidates), stop)]
    )
    even = int(np.argmin(np.diff(borders).std(axis=1)))
    return Repetitions(borders[even, 1:-1], agreement)


def _speeds(features: NDArray[np.float32], frames: NDArray[np.int64]) -> NDArray[np.float64]:
    before, after = np.maximum(frames - 1, 0), np.minimum(frames + 1, len(features) - 1)
    step = (features[after] - features[before]).astype(np.float64)
    speeds: NDArray[np.float64] = np.linalg.norm(step, axis=1) + 1e-12
    return speeds
