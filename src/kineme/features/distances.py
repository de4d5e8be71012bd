"""Poses without a body: the distances between their points.

Where ankles, head and wrists cannot all be found, a pose is described by how far its points are
from each other: markers of two legs, say, or of a wheelchair. That depends neither on where they
are, nor on the direction they face, nor on which axis points up.

Of many points some that lie far apart stand for all. Each distance counts by the root of its
deviation. That is halfway between metres, in which the largest movement hides all others, and
standard deviations, in which noise counts as much as movement. What their fifteen main axes hold is
scaled so that it varies as the fifteen numbers of a pose do, whose methods and constants then
apply.

`have_bones` tells whether points without a skeleton are those of a body. However a body moves, each
of its points keeps its distance from some other one, as a wrist from its elbow, while both go
elsewhere. Others come nearer and part, which the points of a box do not. What sensors measure does
neither.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Floats
from kineme.errors import MotionError

Indices = NDArray[np.intp]

AXES = 15
"""Numbers in a pose."""

VARIATION, SIZE = 0.52, 1.65
"""By how much a pose varies, and the body's size, both in metres: subject 86 of the CMU
database. The first is the root of the summed variances of the fifteen numbers, in the mean."""

MOST_POINTS = 16
CONSIDERED = 1000
"""Points of which some are taken; of more, so many: there are as many distances squared."""
_FRAMES = 200  # enough to tell how points lie and move
_SAME = 0.01  # of the largest distance: two points nearer than this are one
_CONSTANT = 0.001  # of the largest distance: by less than this, a distance does not vary
_STILL = 0.01  # of the largest movement: less than this is none
_APART = 0.5  # of its movement: a point's distance from what it is fixed to varies less


def compute_distance_features(positions: ArrayLike) -> tuple[Floats, Indices]:
    """Features (frames, at most 15) that vary by `VARIATION` metres, and the points they are of.

    All zero where no distance varies.

    Parameters
    ----------
    positions : array_like of shape (frames, points, 3)
        Metres, at least two points.

    Raises
    ------
    MotionError
        A single point.

    Notes
    -----
    Rows are in time order: what sticks out for one frame is left out. They are
    centred. Moving, turning and scaling the whole changes no distance between
    two of them, but what an axis stands for is arbitrary.

    Examples
    --------
    >>> import kineme
    >>> from kineme.features import compute_distance_features
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> features, points = compute_distance_features(motion.positions)
    >>> features.shape
    (2898, 15)
    """
    array = np.asarray(positions, np.float64)
    if array.shape[1] < 2:
        raise MotionError("a single point is in no distance: segment its coordinates as signals")
    points = choose_spread_points(array)
    features = _filter_median(_compute_distances(array[:, points]))
    # Before centring: the largest mean distance tells the size of the whole.
    largest = float(features.mean(axis=0).max(initial=0))
    features -= features.mean(axis=0)
    deviation = features.std(axis=0)
    varies = deviation > _CONSTANT * largest
    if not varies.any():
        return np.zeros((len(array), 1)), points
    features, deviation = features[:, varies], deviation[varies]
    # Divided by the root of each deviation; the summed variance is then `VARIATION` squared.
    features *= VARIATION / np.sqrt(deviation * deviation.sum())
    if features.shape[1] > AXES:
        axes = np.linalg.eigh(features.T @ features)[1]
        # Eigenvalues ascend: the last axes hold most of the variance.
        features = features @ axes[:, -AXES:]
    return features, points


def choose_spread_points(positions: Floats, most: int = MOST_POINTS) -> Indices:
    """Return the points (at most so many, ascending) that lie farthest from each other in the mean.

    Points of the lab, which stay where they are while the others go elsewhere,
    are left out; so is all but one of those in the same place.

    Parameters
    ----------
    positions : ndarray of shape (frames, points, 3)
    """
    n = positions.shape[1]
    # Evenly spread over all points.
    considered = np.arange(min(n, CONSIDERED)) * n // min(n, CONSIDERED)
    few = positions[:: max(1, len(positions) // _FRAMES), considered]
    apart, varying = _mean_and_deviation(few)
    kept = np.flatnonzero(~_find_lab_points(few, varying))
    # Rows and columns of the points that are kept.
    apart, varying = apart[np.ix_(kept, kept)], varying[np.ix_(kept, kept)]
    # The point whose distances vary most, then always the one farthest from those chosen.
    chosen = [int(varying.sum(axis=1).argmax())]
    # Mean distance of each point to the nearest of those chosen.
    nearest = apart[chosen[0]]
    while len(chosen) < most and nearest.max() > _SAME * apart.max():
        chosen.append(int(nearest.argmax()))
        nearest = np.minimum(nearest, apart[chosen[-1]])
    return np.sort(considered[kept[chosen]])


def _find_lab_points(positions: Floats, varying: Floats) -> NDArray[np.bool_]:
    """Return which points never move, though none that move keep their distance from them."""
    # Root mean square of the distance from the mean place, for each point.
    movement = np.linalg.norm(positions - positions.mean(axis=0), axis=2)
    movement = np.sqrt((movement**2).mean(axis=0))
    moves = movement > _STILL * movement.max()
    if moves.sum() < 2:
        return np.zeros(len(moves), np.bool_)
    # Fixed to a point that moves: their distance varies less than that point moves.
    tied = (varying[:, moves] < _APART * movement[moves]).any(axis=1)
    lonely: NDArray[np.bool_] = ~(moves | tied)
    return lonely


def _mean_and_deviation(positions: Floats) -> tuple[Floats, Floats]:
    """Mean and standard deviation (points, points) of the distances."""
    n = positions.shape[1]
    mean, deviation = np.empty((n, n)), np.empty((n, n))
    # One row at a time: all distances of all frames would not fit in memory.
    for point in range(n):
        distances = np.linalg.norm(positions - positions[:, point, None], axis=2)
        mean[point], deviation[point] = distances.mean(axis=0), distances.std(axis=0)
    return mean, deviation


def _filter_median(values: Floats) -> Floats:
    """Return each value the median of itself and its two neighbours in time.

    A marker that is taken for another for a frame or two would outweigh all movement.
    """
    before, here, after = values[:-2], values[1:-1], values[2:]
    # The median of three by minimum and maximum; the first and the last value stay.
    middle = np.maximum(np.minimum(before, here), np.minimum(np.maximum(before, here), after))
    return np.concatenate([values[:1], middle, values[1:][-1:]])


def _compute_distances(positions: Floats) -> Floats:
    """(frames, pairs)"""
    pairs = list(combinations(range(positions.shape[1]), 2))
    distances = np.empty((len(positions), len(pairs)))
    for column, (a, b) in enumerate(pairs):
        distances[:, column] = np.linalg.norm(positions[:, a] - positions[:, b], axis=1)
    return distances


POINTS = 5
"""A body has as many at least: head, hands and feet."""
TIED = 0.15
"""Points are joined whose distance deviates by less than this share of how both move."""
BENT = 0.2
"""Some distance deviates by more than this share of itself, or nothing bends."""


def have_bones(positions: ArrayLike) -> bool:
    """Return whether each point is joined to another one, and not all to all.

    Parameters
    ----------
    positions : array_like of shape (frames, points, 3)
        In any unit.

    Returns
    -------
    bool

    Examples
    --------
    >>> turns = np.linspace(0, 20, 400)
    >>> walk = np.column_stack([turns, 0 * turns, 0 * turns])
    >>> swing = 0.4 * np.column_stack([np.sin(turns), np.cos(turns), 0 * turns])
    >>> points = [walk, walk + [0, 1, 0], walk + [0, 1.5, 0], walk + swing, walk - swing]
    >>> have_bones(np.stack(points, axis=1))
    True
    >>> have_bones(np.random.default_rng(0).standard_normal((400, 5, 3)))
    False
    """
    array = np.asarray(positions, np.float64)
    # Every n-th frame: distances vary alike in fewer frames.
    array = array[:: max(1, len(array) // 2000)]
    if array.shape[1] < POINTS:
        return False
    # (points,): variance of the place, summed over the three axes.
    moved = array.var(axis=0).sum(axis=1)
    bent = False
    for point in range(array.shape[1]):
        distances = np.linalg.norm(array - array[:, point, None], axis=2)
        deviation = distances.std(axis=0)
        # If two points moved independently, their distance would deviate by about this much.
        both = np.sqrt(moved + moved[point])
        tied = deviation < TIED * both
        tied[point] = False
        if not tied.any():
            return False
        # In a rigid body no distance varies, and a body bends.
        bent = bent or bool((deviation > BENT * distances.mean(axis=0)).any())
    return bent
