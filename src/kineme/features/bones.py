"""Whether points are those of a body, by its bones: for channels without a skeleton.

However a body moves, each of its points keeps its distance from some other one, as a wrist from its
elbow, while both go elsewhere. Others come nearer and part, which the points of a box do not. What
sensors measure does neither.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

POINTS = 5
"""A body has as many at least: head, hands and feet."""
TIED = 0.15
"""Points are joined whose distance deviates by less than this share of how both move."""
BENT = 0.2
"""Some distance deviates by more than this share of itself, or nothing bends."""
_FRAMES = 2000  # enough to tell how distances vary


def have_bones(positions: ArrayLike) -> bool:
    """Return whether each point is joined to another one, and not all to all.

    Parameters
    ----------
    positions : array_like of shape (frames, points, 3)
        In any unit.

    Returns
    -------
    bool

    Examples
    --------
    >>> turns = np.linspace(0, 20, 400)
    >>> walk = np.column_stack([turns, 0 * turns, 0 * turns])
    >>> swing = 0.4 * np.column_stack([np.sin(turns), np.cos(turns), 0 * turns])
    >>> points = [walk, walk + [0, 1, 0], walk + [0, 1.5, 0], walk + swing, walk - swing]
    >>> have_bones(np.stack(points, axis=1))
    True
    >>> have_bones(np.random.default_rng(0).standard_normal((400, 5, 3)))
    False
    """
    array = np.asarray(positions, np.float64)
    # Every n-th frame: distances vary alike in fewer frames.
    array = array[:: max(1, len(array) // _FRAMES)]
    if array.shape[1] < POINTS:
        return False
    # (points,): variance of the place, summed over the three axes.
    moved = array.var(axis=0).sum(axis=1)
    bent = False
    for point in range(array.shape[1]):
        distances = np.linalg.norm(array - array[:, point, None], axis=2)
        deviation = distances.std(axis=0)
        # If two points moved independently, their distance would deviate by about this much.
        both = np.sqrt(moved + moved[point])
        tied = deviation < TIED * both
        tied[point] = False
        if not tied.any():
            return False
        # In a rigid body no distance varies, and a body bends.
        bent = bent or bool((deviation > BENT * distances.mean(axis=0)).any())
    return bent
