"""Feature bundling: repetitions of a movement drawn together into one strand.

Seen as a curve in the space of the features, somebody who repeats a movement draws strands side by
side: each repetition differs a little. Bundling moves every frame towards the middle of similar
frames, but only at right angles to its own direction of movement. So curves of the same movement
close up, and their timing stays as it is. Afterwards a smaller radius tells repetitions from other
movements.

1. Principal components: the fewest that hold 98 % of the variance.
2. Each frame's direction: a five-point derivative, smoothed by a binomial filter.
3. Each frame moves, within the hyperplane orthogonal to its direction, to where
   the mean distance to its nearest neighbours is least (their geometric median).

Source: Krueger et al. 2017, section III. There frames climb the density of
their neighbours, a Gaussian kernel of Scott's bandwidth. In the authors'
program the bandwidth is inverted: the kernel vanishes, and what is left to
minimise, step by step and to its own precision, is the mean distance. It is
convex, needs no bandwidth and no unit, and is minimised here outright.
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

FEWEST_COMPONENTS = 3
DERIVATIVE = np.array([1, -8, 0, 8, -1]) / 12
# Coefficients of (1/2 + 1/2)**10, which sum to 1.
BINOMIAL = np.array([comb(10, k) for k in range(11)]) / 2**10


def bundle(features: ArrayLike, *, neighbors: int = 32, variance: float = 0.98) -> Floats:
    """Return the features (frames, dims) with every frame moved towards similar ones.

    What the principal components leave out is lost: the result lies in their
    space. Turning, moving or scaling the features does the same to the result.

    Parameters
    ----------
    features : array_like of shape (frames, dims)
        Stacked features in the order of time, finite, in any unit.
    neighbors : int
        Frames that each frame moves towards: its nearest, without itself. At
        least as many are taken as there are components.
    variance : float
        Share of the variance that the components hold at least.

    Raises
    ------
    ParameterError
        Features are not frames × dims or not finite, or a parameter is out of
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
    # The kernel needs rows that are contiguous in memory.
    reduced = np.ascontiguousarray((points - center) @ axes)
    # At least as many neighbours as dimensions.
    nearest = _find_nearest_others(reduced, max(neighbors, axes.shape[1]))
    directions = _compute_directions(reduced)
    moved = np.empty_like(reduced)

    def move(part: slice) -> None:
        _kernels.move_to_medians(reduced, directions, nearest, part.start, part.stop, moved)

    map_threads(move, make_even_slices(len(reduced)))
    # Back to the original axes; what was left out of the components stays 0.
    return cast(Floats, moved @ axes.T + center)


def _find_principal_axes(centered: Floats, variance: float) -> Floats:
    """(dims, components): the fewest orthonormal axes that hold this share of the variance."""
    spread, axes = np.linalg.eigh(centered.T @ centered)
    # Eigenvalues ascend, so both are reversed; rounding can make the smallest ones negative.
    spread, axes = np.maximum(spread[::-1], 0), axes[:, ::-1]
    totals = np.cumsum(spread)
    # The first place at which the share is reached, plus one for a count.
    enough = int(np.searchsorted(totals, variance * totals[-1])) + 1
    return axes[:, : max(enough, FEWEST_COMPONENTS)]


def _find_nearest_others(points: Floats, count: int) -> NDArray[np.int64]:
    """(frames, count): each frame's nearest without itself; fewer where there are not as many."""
    n = len(points)
    count = min(count, n - 1)
    # A list of ranks keeps the second axis, even for a single neighbour; rank 1 is usually itself.
    _, found = cKDTree(points).query(points, np.arange(1, count + 2), workers=count_threads())
    others = found != np.arange(n)[:, None]
    others[others.all(axis=1), -1] = False  # among its equals a frame may not find itself
    return cast(NDArray[np.int64], found[others].reshape(n, count))


def _compute_directions(points: Floats) -> Floats:
    """Unit vectors along the curve of the points; zero where it stands still."""
    # Steps at both ends; the sum makes them 0 where there is only one point.
    first, last = np.diff(points[:2], axis=0).sum(axis=0), np.diff(points[-2:], axis=0).sum(axis=0)
    beyond = np.array([[1.0], [2.0]])
    # Two points more at each end, on straight lines, for the derivative of five points.
    longer = np.concatenate([points[0] - beyond[::-1] * first, points, points[-1] + beyond * last])
    # Convolution reverses its weights, so they are reversed before.
    slopes = convolve1d(longer, DERIVATIVE[::-1], axis=0)[2:-2]
    # Sum of the weights that lie inside, so that ends are not drawn to 0.
    inside = convolve1d(np.ones(len(points)), BINOMIAL, mode="constant")
    smooth = convolve1d(slopes, BINOMIAL, axis=0, mode="constant") / inside[:, None]
    lengths = np.linalg.norm(smooth, axis=1, keepdims=True)
    # A direction of length 0 stays 0.
    return np.ascontiguousarray(smooth / np.where(lengths > 0, lengths, 1))
