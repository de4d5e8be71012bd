"""Feature bundling: reduce the differences between repetitions of a movement.

In the space of the features, repetitions of a movement are curves side by side. Bundling moves
every frame towards similar frames, but only orthogonally to its own direction of movement. So the
curves approach each other, and their timing stays the same. Afterwards a smaller radius separates
repetitions from other movements.

1. Project to the fewest principal components with 98 % of the variance.
2. Compute the direction of each frame: a five-point derivative, smoothed by a binomial filter.
3. Move each frame, within the hyperplane orthogonal to its direction, to the geometric median of
   its nearest neighbours, which has the least mean distance to them.

Source: Krueger et al. 2017, section III. There frames climb the density of their neighbours,
estimated with a Gaussian kernel of Scott's bandwidth. In the authors' program the bandwidth is
inverted, so the kernel vanishes and the mean distance is minimised in effect. This is convex and
needs no bandwidth and no unit. This module minimises it directly.
"""

from __future__ import annotations

from math import comb
from typing import cast

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import convolve1d
from scipy.spatial import cKDTree

from kineme._util.arrays import Floats
from kineme._util.checks import as_features, is_number
from kineme._util.parallel import count_threads, make_even_slices, map_threads
from kineme.errors import ParameterError
from kineme.features import _kernels

MIN_COMPONENTS = 3
"""Smallest number of principal components."""
DERIVATIVE = np.array([1, -8, 0, 8, -1]) / 12
"""Weights of the five-point derivative."""
BINOMIAL = np.array([comb(10, k) for k in range(11)]) / 2**10
"""Weights of the smoothing filter: coefficients of (1/2 + 1/2)**10, which sum to 1."""


def bundle(features: ArrayLike, *, neighbors: int = 32, variance: float = 0.98) -> Floats:
    """Move every frame of features (frames, dims) towards similar frames.

    The result lies in the space of the principal components; the rest is lost.
    The function commutes with rotation, translation and scaling of the features.

    Parameters
    ----------
    features : array_like of shape (frames, dims)
        Stacked features in order of time, finite, in any unit.
    neighbors : int
        Number of nearest frames that each frame moves towards; at least the number
        of components.
    variance : float
        Smallest share of the variance that the components explain.

    Raises
    ------
    ParameterError
        The features are not frames × dims or not finite, or a parameter is out of
        range.

    References
    ----------
    Krueger et al. 2017, section III; constants as in the authors' program.

    Examples
    --------
    >>> import numpy as np
    >>> import kineme
    >>> angle = np.arange(200) / 8
    >>> noise = np.random.default_rng(0).normal(scale=0.1, size=(200, 2))
    >>> circle = np.stack([np.cos(angle), np.sin(angle)], axis=1) + noise
    >>> bundled = kineme.bundle(circle, neighbors=8)
    >>> bool(np.hypot(*bundled.T).std() < np.hypot(*circle.T).std())
    True
    """
    points = as_features(features, "features to bundle")
    if not (is_number(neighbors) and neighbors >= 1 and is_number(variance) and 0 < variance <= 1):
        raise ParameterError(
            f"neighbors must be at least 1 and variance a share above 0, "
            f"not {neighbors} and {variance}"
        )
    center = points.mean(axis=0)
    axes = _find_principal_axes(points - center, variance)
    # The kernel needs a contiguous array.
    reduced = np.ascontiguousarray((points - center) @ axes)
    # At least as many neighbours as dimensions.
    nearest = _find_nearest_others(reduced, max(neighbors, axes.shape[1]))
    directions = _compute_directions(reduced)
    moved = np.empty_like(reduced)

    def move(part: slice) -> None:
        """Write the moved frames of a part to ``moved``."""
        _kernels.move_to_medians(reduced, directions, nearest, part.start, part.stop, moved)

    map_threads(move, make_even_slices(len(reduced)))
    # Back to the original axes.
    return cast(Floats, moved @ axes.T + center)


def _find_principal_axes(centered: Floats, variance: float) -> Floats:
    """Return the fewest orthonormal axes (dims, components) with this share of the variance."""
    spread, axes = np.linalg.eigh(centered.T @ centered)
    # Reverse the ascending eigenvalues; rounding can make the smallest ones negative.
    spread, axes = np.maximum(spread[::-1], 0), axes[:, ::-1]
    totals = np.cumsum(spread)
    # The index at which the share is reached, plus one, is the count.
    enough = int(np.searchsorted(totals, variance * totals[-1])) + 1
    return axes[:, : max(enough, MIN_COMPONENTS)]


def _find_nearest_others(points: Floats, count: int) -> NDArray[np.int64]:
    """Return the nearest other frames of each frame, (frames, count), or all if there are fewer."""
    n = len(points)
    count = min(count, n - 1)
    # A list of ranks keeps the second axis for a single neighbour; rank 1 is usually itself.
    _, found = cKDTree(points).query(points, np.arange(1, count + 2), workers=count_threads())
    others = found != np.arange(n)[:, None]
    # Among equal points a frame may not find itself: drop the farthest instead.
    others[others.all(axis=1), -1] = False
    return cast(NDArray[np.int64], found[others].reshape(n, count))


def _compute_directions(points: Floats) -> Floats:
    """Return unit vectors along the curve of the points; zero where it does not move."""
    # Steps at both ends; the sum is 0 if there is only one point.
    first, last = np.diff(points[:2], axis=0).sum(axis=0), np.diff(points[-2:], axis=0).sum(axis=0)
    beyond = np.array([[1.0], [2.0]])
    # Extend both ends by two points on straight lines, for the five-point derivative.
    longer = np.concatenate([points[0] - beyond[::-1] * first, points, points[-1] + beyond * last])
    # Convolution reverses the weights, so reverse them first.
    slopes = convolve1d(longer, DERIVATIVE[::-1], axis=0)[2:-2]
    # Normalise by the weights inside, so that ends are not biased towards 0.
    inside = convolve1d(np.ones(len(points)), BINOMIAL, mode="constant")
    smooth = convolve1d(slopes, BINOMIAL, axis=0, mode="constant") / inside[:, None]
    lengths = np.linalg.norm(smooth, axis=1, keepdims=True)
    return np.ascontiguousarray(smooth / np.where(lengths > 0, lengths, 1))
