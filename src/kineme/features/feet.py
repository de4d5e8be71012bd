"""Find frames in which a point of a foot is low and slow, so that the foot stands."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats

GROUND_PERCENTILE = 5.0
"""Percentile of the heights of a point that counts as its lowest height."""


def measure_speed(path: Floats, fps: float) -> Floats:
    """Return the speed of a point in metres per second; 0 for a single frame.

    Parameters
    ----------
    path : (frames, dims) array
    fps : float
        Frames per second.
    """
    if len(path) < 2:
        return np.zeros(len(path))
    return np.asarray(np.linalg.norm(np.gradient(path, axis=0), axis=1) * fps)


def find_low_and_slow(
    path: Floats, fps: float, *, height: float, speed: float
) -> NDArray[np.bool_]:
    """Return the frames in which a point stands.

    Parameters
    ----------
    path : (frames, 3) array
        Metres, y up.
    fps : float
        Frames per second.
    height : float
        Metres above its lowest height, below which it is low.
    speed : float
        Metres per second, below which it is slow.
    """
    # A low percentile is robust to tracking errors, unlike the minimum.
    low = path[:, 1] < np.percentile(path[:, 1], GROUND_PERCENTILE) + height
    return np.asarray(low & (measure_speed(path, fps) < speed))
