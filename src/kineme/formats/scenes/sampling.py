"""Values between keys."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats


def find_keys(times: Floats, at: Floats, slack: float) -> tuple[NDArray[np.intp], Floats]:
    """Return the key before each frame, and the share of the interval to the next that has passed.

    Before the first key and after the last one the shares are 0 and 1; by the slack a key may
    miss the frame that it was made for.
    """
    # The slack lets a key count that comes just after its frame.
    found = np.searchsorted(times, at + slack, "right") - 1
    # The last interval serves times beyond the last key, too.
    index = np.clip(found, 0, len(times) - 2)
    passed = at - times[index]
    share = passed / np.diff(times)[index]
    # At a key, up to the slack, the value is exactly that of the key.
    share[np.abs(passed) <= slack] = 0.0
    share[np.abs(at - times[index + 1]) <= slack] = 1.0
    return index, np.clip(share, 0.0, 1.0)
