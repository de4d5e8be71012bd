"""Types of arrays, and values between frames."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = np.ndarray[Any, np.dtype[Any]]
Floats = NDArray[np.float64]
Float32s = NDArray[np.float32]
Ints = NDArray[np.int64]
Masks = NDArray[np.bool_]


def interpolate_frames(values: ArrayLike, at: ArrayLike) -> Floats:
    """Values (frames, ...) at fractional frames; beyond the last frame the line is carried on.

    Examples
    --------
    >>> interpolate_frames([0.0, 10.0, 30.0], [0.5, 1.5]).tolist()
    [5.0, 20.0]
    """
    rows, places = np.asarray(values, np.float64), np.asarray(at, np.float64)
    # The last frame but one at most, so that a place beyond the end has a line to follow.
    before = np.minimum(places.astype(np.intp), max(0, len(rows) - 2))
    after = np.minimum(before + 1, len(rows) - 1)
    # New axes, so that the share applies to all further axes of the values.
    share = (places - before)[(..., *[None] * (rows.ndim - 1))]
    mixed: Floats = (1 - share) * rows[before] + share * rows[after]
    return mixed


def bridge_line(track: Floats, hidden: NDArray[np.bool_]) -> None:
    """Fill the hidden frames of one coordinate, in place, from the frames around them.

    Before the first and after the last frame that is not hidden its value is kept.
    """
    present = np.flatnonzero(~hidden)
    track[hidden] = np.interp(np.flatnonzero(hidden), present, track[present])
