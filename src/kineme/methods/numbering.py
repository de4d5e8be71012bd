"""Numbers for groups: the first to appear is 0, the next new one 1, and so on."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def by_first_appearance(labels: NDArray[np.integer]) -> NDArray[np.int64]:
    """The same labels counted from 0 in order of appearance; -1 stays."""
    known = labels >= 0
    _, first, inverse = np.unique(labels[known], return_index=True, return_inverse=True)
    numbered = np.full(len(labels), -1, np.int64)
    numbered[known] = np.argsort(np.argsort(first))[inverse]
    return numbered
