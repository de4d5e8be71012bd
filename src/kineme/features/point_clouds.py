"""Compare poses as moving point clouds (Kovar, Gleicher and Pighin 2002, section 3.1).

The joints in a window around a frame form one cloud. The second of two clouds is
turned about the vertical and shifted on the floor to fit the first; heights do not
change. The distance is the root mean square over the points, in metres.

The fit has a closed form. Centre both clouds on the floor and write their floor
coordinates as complex numbers c = x + iz. The best turn has the angle of Σ c c̄', and
the residual is Σ|c|² + Σ|c'|² - 2 |Σ c c̄'|. A turn by ``angle`` about y, which is up,
multiplies x + iz by exp(-i angle).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats

Complex = NDArray[np.complex128]

PAIRS_AT_ONCE = 2048
"""Number of pairs of frames that are fitted at a time, to limit memory."""


def compute_cloud_distances(points: Floats, rows: slice, columns: slice, *, half: int) -> Floats:
    """Return the distances of clouds around frames of ``rows`` and of ``columns``, in metres.

    Points (frames, joints, 3) are in metres, y up. A window has ``half`` frames on each side; the
    first and last frame are repeated.
    """
    floor_a, height_a, _ = _make_clouds(points, np.arange(rows.start, rows.stop), half)
    floor_b, height_b, _ = _make_clouds(points, np.arange(columns.start, columns.stop), half)
    # Σ(a - b)² = |a|² + |b|² - 2 ab: matrix products give all pairs at once.
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
    """Return the distance of each pair of frames, and how to lay the second onto the first.

    Points and windows are those of `compute_cloud_distances`; ``first`` and ``second`` hold the
    frames of the pairs.

    Returns
    -------
    distances : ndarray of shape (pairs,)
        Metres.
    angles : ndarray of shape (pairs,)
        Turn about the vertical through the origin, radians.
    shifts : ndarray of shape (pairs, 2)
        Shift along x and z after the turn, metres.
    """
    # At least one block, even if empty, for `concatenate`.
    blocks = range(0, max(len(first), 1), PAIRS_AT_ONCE)
    parts = [
        _fit_block(points, first[i : i + PAIRS_AT_ONCE], second[i : i + PAIRS_AT_ONCE], half)
        for i in blocks
    ]
    distances, angles, shifts = (np.concatenate(part) for part in zip(*parts, strict=True))
    return distances, angles, shifts


def _fit_block(
    points: Floats, first: NDArray[np.int64], second: NDArray[np.int64], half: int
) -> tuple[Floats, Floats, Floats]:
    """Return distance, turn and shift that best align pairs of clouds; see `fit_clouds`."""
    floor_a, height_a, center_a = _make_clouds(points, first, half)
    floor_b, height_b, center_b = _make_clouds(points, second, half)
    shared = (floor_a * floor_b.conj()).sum(axis=1)
    # The turn of the second cloud, as a complex number of length 1.
    turn = np.exp(1j * np.angle(shared))
    squares = np.abs(floor_a - turn[:, None] * floor_b) ** 2 + (height_a - height_b) ** 2
    # The turn about the origin also moves the centre of the second cloud.
    shift = center_a - turn * center_b
    return (
        np.sqrt(squares.mean(axis=1)),
        # A turn about y multiplies x + iz by exp(-i angle), hence the minus.
        -np.angle(turn),
        np.stack([shift.real, shift.imag], axis=1),
    )


def _make_clouds(
    points: Floats, centers: NDArray[np.int64], half: int
) -> tuple[Complex, Floats, Complex]:
    """Return centred floor coordinates, heights, and the centre, with one row per cloud."""
    frames = centers[:, None] + np.arange(-half, half + 1)
    # (clouds, points of the window, 3).
    size = frames.shape[1] * points.shape[1]  # not -1, as there may be no frames
    cloud = points[np.clip(frames, 0, len(points) - 1)].reshape(len(frames), size, 3)
    floor = cloud[..., 0] + 1j * cloud[..., 2]
    center = floor.mean(axis=1)
    return floor - center[:, None], cloud[..., 1], center
