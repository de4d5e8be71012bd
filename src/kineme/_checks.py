"""What public functions check of the arrays they are given."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme.errors import ParameterError

MOST_FRAMES_MORE = 1000
"""Frames at a new rate for one of the old, at most; beyond that the old one is wrong."""


def check_rates(old: float, new: float) -> None:
    """ParameterError where the frames at a new rate would be beyond all measure."""
    if new > MOST_FRAMES_MORE * old:
        raise ParameterError(
            f"frames {1 / old:g} s apart are too far for {new:g} a second: is the frame rate right?"
        )


def as_features(values: ArrayLike, name: str = "features") -> NDArray[np.float64]:
    """The values as float64 (frames, dims) without gaps in memory.

    Raises
    ------
    ParameterError : another shape, no frames or no dims, or values that are not finite
    """
    array = np.ascontiguousarray(values, np.float64)
    if array.ndim != 2 or 0 in array.shape:
        raise ParameterError(
            f"{name} must be frames x dims with at least one of each, not of shape {array.shape}"
        )
    if not np.isfinite(array).all():
        frame = int(np.argmin(np.isfinite(array).all(axis=1)))
        raise ParameterError(f"{name} hold a value that is not finite, first in frame {frame}")
    return array
