"""Repetitions begin at rest, where somebody rests between them.

Which pose tells repetitions best is one that is passed fast, in the midst of them.
People see events begin and end where movement is slowest (Zacks, Kumar, Abrams and
Mehta 2009), and a clip that begins there can be used.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Frames = NDArray[np.int64]

RESTING = 0.25
"""Share of the mean speed below which somebody rests."""
NEAR = 0.15
"""Share of a repetition within which each rest is looked for."""


def at_rest(cuts: Frames, path: Floats, averaged: int) -> Frames:
    """The cuts, all moved by the same phase to where movement is slowest.

    They stay where nobody rests, and where the first or the last repetition would be less than
    half of one.

    Parameters
    ----------
    cuts : (cuts,) array of int
        Frames at which the second, third, ... repetition begins, ascending.
    path : (frames + 1,) array
        Length of the path up to each frame, and to the end.
    averaged : int
        Frames before and after one, over which its speed is the mean.

    Examples
    --------
    >>> path = np.append(0, np.cumsum(np.tile([1.0, 1, 1, 1, 0, 0, 0, 1], 3)))
    >>> at_rest(np.array([8, 16]), path, 1).tolist()
    [5, 13]
    """
    if not len(cuts):
        return cuts
    n = len(path) - 1
    usual = float(np.median(np.diff(cuts, prepend=0, append=n)))
    half = usual / 2
    shifts = np.arange(-int(half), int(half) + 1)
    shifts = shifts[(cuts[0] + shifts >= half) & (cuts[-1] + shifts <= n - half)]
    if not len(shifts):
        return cuts
    speeds = _speeds(path, averaged)
    slowness = speeds[cuts[:, None] + shifts].mean(axis=0)
    if slowness.min() > RESTING * path[-1] / n:
        return cuts
    rests = cuts + shifts[slowness.argmin()]
    reach = int(NEAR * usual)
    near = np.arange(-reach, reach + 1)
    around = np.clip(rests[:, None] + near, 1, n - 1)
    slowest = np.take_along_axis(around, speeds[around].argmin(axis=1)[:, None], axis=1)[:, 0]
    return slowest if (np.diff(slowest) > 0).all() else rests


def _speeds(path: Floats, averaged: int) -> Floats:
    """Of each frame, averaged over so many before and after."""
    frames = np.arange(len(path) - 1)
    first = np.maximum(frames - averaged, 0)
    last = np.minimum(frames + averaged + 1, len(path) - 1)
    speeds: Floats = (path[last] - path[first]) / (last - first)
    return speeds
