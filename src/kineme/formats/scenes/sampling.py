"""Find the keys around given times."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats


def find_keys(times: Floats, frame_times: Floats, slack: float) -> tuple[NDArray[np.intp], Floats]:
    """Return the key before each frame, and the fraction of the interval to the next key.

    Before the first key the fraction is 0, after the last one 1. ``slack`` is the time by which a
    key may miss its frame.
    """
    # The slack includes a key just after its frame.
    previous = np.searchsorted(times, frame_times + slack, "right") - 1
    # Use the last interval for times after the last key.
    index = np.clip(previous, 0, len(times) - 2)
    passed = frame_times - times[index]
    share = passed / np.diff(times)[index]
    # Near a key use exactly its value.
    share[np.abs(passed) <= slack] = 0.0
    share[np.abs(frame_times - times[index + 1]) <= slack] = 1.0
    return index, np.clip(share, 0.0, 1.0)
