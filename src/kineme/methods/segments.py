"""From borders to columns of a segment table, whoever found them; clusters counted anew."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme.methods.base import Columns

Ints = NDArray[np.int64]
Floats = NDArray[np.float64]


def columns_of(
    activities: Ints,
    primitives: Ints,
    *,
    is_activity: NDArray[np.bool_],
    clusters: tuple[Ints, Ints],
    scores: tuple[Floats, Floats],
) -> Columns:
    """Columns of both levels.

    Parameters
    ----------
    activities, primitives : (segments + 1,) array
        Borders of each level, from 0 to the end; those of activities are among those of
        primitives.
    is_activity : (activities,) array of bool
        Whether it is an activity, or else a transition; its primitives are the same.
    clusters, scores : pair of arrays
        Of the activities, and of the primitives.

    Returns
    -------
    dict of str to array
        ``level``, ``kind``, ``start_frame``, ``stop_frame``, ``cluster``, ``score``.
    """
    parents = np.searchsorted(activities, primitives[:-1], side="right") - 1
    kinds = np.where(is_activity, "activity", "transition")
    return {
        "level": np.repeat(["activity", "primitive"], [len(activities) - 1, len(parents)]),
        "kind": np.concatenate([kinds, kinds[parents]]),
        "start_frame": np.concatenate([activities[:-1], primitives[:-1]]),
        "stop_frame": np.concatenate([activities[1:], primitives[1:]]),
        "cluster": np.concatenate(clusters),
        "score": np.concatenate(scores),
    }


def by_first_appearance(labels: NDArray[np.integer]) -> Ints:
    """The same labels counted from 0 in order of appearance; -1 stays.

    Examples
    --------
    >>> import numpy as np
    >>> by_first_appearance(np.array([7, 7, -1, 2, 7]))
    array([ 0,  0, -1,  1,  0])
    """
    known = labels >= 0
    _, first, inverse = np.unique(labels[known], return_index=True, return_inverse=True)
    numbered = np.full(len(labels), -1, np.int64)
    numbered[known] = np.argsort(np.argsort(first))[inverse]
    return numbered
