"""Values between keys."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme._arrays import Floats
from kineme.formats.units import blocks


def between(times: Floats, at: Floats, slack: float) -> tuple[NDArray[np.intp], Floats]:
    """The key before each frame, and the share of the interval to the next that has passed.

    Parameters
    ----------
    times : ndarray of shape (keys,)
        Ascending, at least two.
    at : ndarray of shape (frames,)
        Before the first key and after the last one the shares are 0 and 1.
    slack : float
        By which a key may miss the frame that it was made for.
    """
    found = np.searchsorted(times, at + slack, "right") - 1
    index = np.clip(found, 0, len(times) - 2)
    passed = at - times[index]
    share = passed / np.diff(times)[index]
    share[np.abs(passed) <= slack] = 0.0
    share[np.abs(at - times[index + 1]) <= slack] = 1.0
    return index, np.clip(share, 0.0, 1.0)


def slerp(start: Floats, stop: Floats, share: Floats) -> Floats:
    """Unit quaternions (frames, 4) between two, along the shorter arc.

    Parameters
    ----------
    start, stop : ndarray of shape (frames, 4)
    share : ndarray of shape (frames,)
    """
    turned = np.empty_like(start)
    for span in blocks(len(start)):
        a, b, t = start[span], stop[span], share[span, None]
        cos = np.einsum("fc,fc->f", a, b)[:, None]
        b, cos = np.where(cos < 0, -b, b), np.minimum(np.abs(cos), 1.0)
        angle = np.arccos(cos)
        sin = np.sin(angle)
        near = sin < 1e-6
        sin = np.where(near, 1.0, sin)
        first = np.where(near, 1 - t, np.sin((1 - t) * angle) / sin)
        second = np.where(near, t, np.sin(t * angle) / sin)
        mixed = first * a + second * b
        turned[span] = mixed / np.linalg.norm(mixed, axis=1, keepdims=True)
    return turned
