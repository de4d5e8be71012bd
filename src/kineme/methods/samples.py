"""Samples of features: those that stand for a segment, and those without their neighbours."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def spread(start: int, stop: int, most: int) -> NDArray[np.int64]:
    """Samples of a segment, evenly spread, so many at most.

    Examples
    --------
    >>> spread(0, 10, 2)
    array([2, 7])
    """
    n = min(stop - start, most)
    return start + (2 * np.arange(n) + 1) * (stop - start) // (2 * n)


def unstacked(features: NDArray[Any], offsets: tuple[float, ...]) -> NDArray[Any] | None:
    """The features without their neighbours in time; None if they were not stacked at the offsets.

    Parameters
    ----------
    features : (samples, dims * offsets) array
    offsets : tuple of float
        Ascending, at which they were stacked.
    """
    dims, rest = divmod(features.shape[1], len(offsets))
    if rest:
        return None
    first = dims * int(np.argmin(np.abs(offsets)))
    return features[:, first : first + dims]


def single_poses(features: NDArray[np.float32], offsets: tuple[float, ...]) -> NDArray[np.float32]:
    """The poses without their neighbours in time; all, if they were not stacked at the offsets."""
    bare = unstacked(features, offsets)
    if bare is None:
        return features
    poses: NDArray[np.float32] = bare * len(offsets) ** 0.5
    return poses
