"""Which of several values of a constant would be chosen."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def middle_of_best(scores: Sequence[float], within: float) -> int:
    """The place of the middle one of the values that are about as good as the best."""
    near = np.flatnonzero(np.array(scores) >= max(scores) - within)
    return int(near[len(near) // 2])
