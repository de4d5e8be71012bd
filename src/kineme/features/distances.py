"""Features of poses without a known body: distances between points.

If ankles, head and wrists cannot all be found, for example for markers of two legs or of a
wheelchair, a pose is described by the distances between its points. They do not depend on position,
heading or the vertical axis.

Of many points, some that are far apart are chosen. Each distance is divided by the root of its
deviation. This is a compromise between metres, in which the largest movement dominates, and
standard deviations, in which noise counts as much as movement. The result is reduced to fifteen
principal axes and scaled to vary as much as the fifteen numbers of a pose, so that the same
constants apply.

`have_bones` decides whether points without a skeleton belong to a body. In a body, each point
keeps its distance from some other point (a wrist from its elbow) while both move, and other
distances change. In a rigid box no distance changes. Values of sensors have no constant distances.
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
"""Variation of a pose (root of the summed variances of its fifteen numbers) and body size, in
metres: means of subject 86 of the CMU database."""

MAX_POINTS = 16
"""Largest number of points whose distances are features."""
MAX_CANDIDATES = 1000
"""Largest number of points that are considered: the number of distances is its square."""
_FRAMES = 200
"""Number of frames from which points are chosen."""
_SAME = 0.01
"""Distance below which two points are the same, as a share of the largest distance."""
_CONSTANT = 0.001
"""Deviation below which a distance is constant, as a share of the largest distance."""
_STILL = 0.01
"""Movement below which a point is still, as a share of the largest movement."""
_APART = 0.5
"""Deviation of the distance of two points, as a share of a point's movement, below which they
are fixed to each other."""
MIN_BODY_POINTS = 5
"""Smallest number of points of a body: head, hands and feet."""
MAX_BONE_DEVIATION = 0.15
"""Deviation of the distance of two points of one bone, as a share of their movement."""
MIN_BENDING = 0.2
"""Deviation of some distance in a body that bends, as a share of the distance."""


def compute_distance_features(positions: ArrayLike) -> tuple[Floats, Indices]:
    """Compute features (frames, at most 15) from distances of points; return them and the points.

    They are scaled to vary by `VARIATION` metres, and are zero if no distance varies.

    Parameters
    ----------
    positions : array_like of shape (frames, points, 3)
        Metres, at least two points.

    Raises
    ------
    MotionError
        There is only one point.

    Notes
    -----
    Rows must be in time order, as outliers of one frame are removed. Features are centred.
    Translation, rotation and scaling of all points do not change their distances; the
    orientation of the axes is arbitrary.

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
        raise MotionError(
            "a single point has no distances to others: segment its coordinates as signals"
        )
    points = choose_spread_points(array)
    features = _filter_median(_compute_distances(array[:, points]))
    # Before centring: the largest mean distance measures the overall size.
    largest = float(features.mean(axis=0).max(initial=0))
    features -= features.mean(axis=0)
    deviation = features.std(axis=0)
    varies = deviation > _CONSTANT * largest
    if not varies.any():
        return np.zeros((len(array), 1)), points
    features, deviation = features[:, varies], deviation[varies]
    # Divide by the root of each deviation; then the summed variance is `VARIATION` squared.
    features *= VARIATION / np.sqrt(deviation * deviation.sum())
    if features.shape[1] > AXES:
        axes = np.linalg.eigh(features.T @ features)[1]
        # Eigenvalues ascend: the last axes hold most of the variance.
        features = features @ axes[:, -AXES:]
    return features, points


def choose_spread_points(positions: Floats, most: int = MAX_POINTS) -> Indices:
    """Choose at most ``most`` points that are far from each other on average, ascending.

    Positions are (frames, points, 3). Fixed points of the laboratory, which do not move while the
    others do, are left out, and so are duplicates.
    """
    n = positions.shape[1]
    # Candidates are evenly spread over all points.
    candidates = np.arange(min(n, MAX_CANDIDATES)) * n // min(n, MAX_CANDIDATES)
    sample = positions[:: max(1, len(positions) // _FRAMES), candidates]
    means, deviations = _measure_pair_distances(sample)
    kept = np.flatnonzero(~_find_lab_points(sample, deviations))
    means, deviations = means[np.ix_(kept, kept)], deviations[np.ix_(kept, kept)]
    # Start with the point whose distances vary most; add the one farthest from those chosen.
    chosen = [int(deviations.sum(axis=1).argmax())]
    # Mean distance of each point to the nearest chosen one.
    nearest = means[chosen[0]]
    while len(chosen) < most and nearest.max() > _SAME * means.max():
        chosen.append(int(nearest.argmax()))
        nearest = np.minimum(nearest, means[chosen[-1]])
    return np.sort(candidates[kept[chosen]])


def _find_lab_points(positions: Floats, deviations: Floats) -> NDArray[np.bool_]:
    """Mark points that never move and are not fixed to a moving point."""
    # Root mean square distance of each point from its mean position.
    movement = np.linalg.norm(positions - positions.mean(axis=0), axis=2)
    movement = np.sqrt((movement**2).mean(axis=0))
    moves = movement > _STILL * movement.max()
    if moves.sum() < 2:
        return np.zeros(len(moves), np.bool_)
    # A point is fixed to a moving one if their distance varies less than that one moves.
    is_fixed = (deviations[:, moves] < _APART * movement[moves]).any(axis=1)
    is_lab_point: NDArray[np.bool_] = ~(moves | is_fixed)
    return is_lab_point


def _measure_pair_distances(positions: Floats) -> tuple[Floats, Floats]:
    """Return mean and standard deviation (points, points) of the distances of points."""
    n = positions.shape[1]
    mean, deviation = np.empty((n, n)), np.empty((n, n))
    # One point at a time, to limit memory.
    for point in range(n):
        distances = np.linalg.norm(positions - positions[:, point, None], axis=2)
        mean[point], deviation[point] = distances.mean(axis=0), distances.std(axis=0)
    return mean, deviation


def _filter_median(values: Floats) -> Floats:
    """Replace each value by the median of itself and its two neighbours in time.

    Otherwise a marker that is confused with another for one frame would dominate the features.
    """
    before, here, after = values[:-2], values[1:-1], values[2:]
    # Median of three by minimum and maximum; the first and the last value stay.
    middle = np.maximum(np.minimum(before, here), np.minimum(np.maximum(before, here), after))
    return np.concatenate([values[:1], middle, values[1:][-1:]])


def _compute_distances(positions: Floats) -> Floats:
    """Return the distances of all pairs of points, (frames, pairs)."""
    pairs = list(combinations(range(positions.shape[1]), 2))
    distances = np.empty((len(positions), len(pairs)))
    for column, (a, b) in enumerate(pairs):
        distances[:, column] = np.linalg.norm(positions[:, a] - positions[:, b], axis=1)
    return distances


def have_bones(positions: ArrayLike) -> bool:
    """Return whether points are those of a body: all are joined by bones, but not rigidly.

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
    # Every n-th frame is enough to measure deviations.
    array = array[:: max(1, len(array) // 2000)]
    if array.shape[1] < MIN_BODY_POINTS:
        return False
    # Variance of each point, summed over the three axes.
    variances = array.var(axis=0).sum(axis=1)
    means, deviations = _measure_pair_distances(array)
    # Approximate deviation of the distance of two points that move independently.
    independent = np.sqrt(np.add.outer(variances, variances))
    is_joined = deviations < MAX_BONE_DEVIATION * independent
    np.fill_diagonal(is_joined, False)
    # A body bends: some distance varies.
    bends = deviations > MIN_BENDING * means
    return bool(is_joined.any(axis=1).all() and bends.any())
