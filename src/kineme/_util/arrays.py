"""Array types, interpolation and unit vectors."""

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
    """Interpolate values (frames, ...) linearly at fractional frames; extrapolate at the end.

    Examples
    --------
    >>> interpolate_frames([0.0, 10.0, 30.0], [0.5, 1.5]).tolist()
    [5.0, 20.0]
    """
    rows, places = np.asarray(values, np.float64), np.asarray(at, np.float64)
    # At most the last frame but one, so that positions beyond the end are extrapolated.
    before = np.minimum(places.astype(np.intp), max(0, len(rows) - 2))
    after = np.minimum(before + 1, len(rows) - 1)
    # Add axes to broadcast over the remaining axes of the values.
    share = (places - before)[(..., *[None] * (rows.ndim - 1))]
    mixed: Floats = (1 - share) * rows[before] + share * rows[after]
    return mixed


def normalize_vectors(vectors: Floats) -> Floats:
    """Return unit vectors along the last axis; vectors of length 0 stay 0.

    Examples
    --------
    >>> normalize_vectors(np.array([[0.0, 2.0], [0.0, 0.0]])).tolist()
    [[0.0, 1.0], [0.0, 0.0]]
    """
    # The floor avoids a division by 0.
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12))


def bridge_line(track: Floats, hidden: NDArray[np.bool_]) -> None:
    """Interpolate the hidden frames of one coordinate in place.

    The first and last visible values are repeated at the ends.
    """
    present = np.flatnonzero(~hidden)
    track[hidden] = np.interp(np.flatnonzero(hidden), present, track[present])
