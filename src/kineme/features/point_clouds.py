"""Poses as moving point clouds (Kovar, Gleicher and Pighin 2002, section 3.1).

The joints in a window around a frame are one cloud. Two clouds are compared
after the second was turned about the vertical and moved on the floor to fit
the first best; heights stay as they are. Distances are the root mean square
over the points, metres.

In closed form: with both clouds centred on the floor and their floor
coordinates read as complex numbers c = x + iz, the best turn is that of
Σ c c̄', and it leaves Σ|c|² + Σ|c'|² - 2 |Σ c c̄'|. A turn by ``angle`` about
y, which is up, multiplies x + iz by exp(-i angle).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats

Complex = NDArray[np.complex128]

PAIRS_AT_ONCE = 2048


def compute_cloud_distances(points: Floats, rows: slice, columns: slice, *, half: int) -> Floats:
    """``d[i, j]``: clouds around frame i of ``rows`` and frame j of ``columns``, metres.

    Parameters
    ----------
    points : ndarray of shape (frames, joints, 3)
        Metres, y up.
    rows, columns : slice
        Spans of frames.
    half : int
        Frames of the window on either side; the ends are repeated.
    """
    floor_a, height_a, _ = _make_clouds(points, np.arange(rows.start, rows.stop), half)
    floor_b, height_b, _ = _make_clouds(points, np.arange(columns.start, columns.stop), half)
    # Squares of (a - b) summed are |a|² + |b|² - 2 ab: matrix products give all pairs at once.
    squares_a = (np.abs(floor_a) ** 2).sum(1) + (height_a**2).sum(1)
    squares_b = (np.abs(floor_b) ** 2).sum(1) + (height_b**2).sum(1)
    shared = np.abs(floor_a.conj() @ floor_b.T) + height_a @ height_b.T
    squares = squares_a[:, None] + squares_b - 2 * shared
    # Rounding can make squares of equal clouds negative.
    distances: Floats = np.sqrt(np.maximum(squares, 0) / floor_a.shape[1])
    return distances


def fit_clouds(
    points: Floats, first: NDArray[np.int64], second: NDArray[np.int64], *, half: int
) -> tuple[Floats, Floats, Floats]:
    """Return for each pair of frames its distance, and how the second is laid onto the first.

    Parameters
    ----------
    points : ndarray of shape (frames, joints, 3)
        Metres, y up.
    first, second : ndarray of shape (pairs,)
        Frames.
    half : int
        Frames of the window on either side; the ends are repeated.

    Returns
    -------
    distances : ndarray of shape (pairs,)
        Metres.
    angles : ndarray of shape (pairs,)
        Radians about the vertical through the origin, done first.
    shifts : ndarray of shape (pairs, 2)
        Metres along x and z, done after the turn.
    """
    # Of no pairs there is one empty block, so that `concatenate` has something to join.
    blocks = range(0, max(len(first), 1), PAIRS_AT_ONCE)
    parts = [
        _fit(points, first[i : i + PAIRS_AT_ONCE], second[i : i + PAIRS_AT_ONCE], half)
        for i in blocks
    ]
    distances, angles, shifts = (np.concatenate(part) for part in zip(*parts, strict=True))
    return distances, angles, shifts


def _fit(
    points: Floats, first: NDArray[np.int64], second: NDArray[np.int64], half: int
) -> tuple[Floats, Floats, Floats]:
    floor_a, height_a, center_a = _make_clouds(points, first, half)
    floor_b, height_b, center_b = _make_clouds(points, second, half)
    shared = (floor_a * floor_b.conj()).sum(axis=1)
    # The turn that lays the second cloud onto the first, as a complex number of length 1.
    turn = np.exp(1j * np.angle(shared))
    squares = np.abs(floor_a - turn[:, None] * floor_b) ** 2 + (height_a - height_b) ** 2
    # The centres are not at the origin: the turn about the origin moves the second one.
    shift = center_a - turn * center_b
    return (
        np.sqrt(squares.mean(axis=1)),
        # A turn by an angle about y multiplies x + iz by exp(-i angle), hence the minus.
        -np.angle(turn),
        np.stack([shift.real, shift.imag], axis=1),
    )


def _make_clouds(
    points: Floats, centers: NDArray[np.int64], half: int
) -> tuple[Complex, Floats, Complex]:
    """Floor coordinates about their centre, heights, and the centre, one row per cloud."""
    frames = centers[:, None] + np.arange(-half, half + 1)
    # (clouds, joints of the window, 3); frames beyond the ends repeat the outermost one.
    cloud = points[np.clip(frames, 0, len(points) - 1)].reshape(len(frames), -1, 3)
    floor = cloud[..., 0] + 1j * cloud[..., 2]
    center = floor.mean(axis=1)
    return floor - center[:, None], cloud[..., 1], center
