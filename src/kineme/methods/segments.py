"""Build the columns of a segment table from borders; number clusters by appearance."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats, Ints
from kineme.methods.base import Columns


def make_columns(
    activities: Ints,
    primitives: Ints,
    *,
    is_activity: NDArray[np.bool_],
    is_primitive: NDArray[np.bool_] | None = None,
    clusters: tuple[Ints, Ints],
    confidence: tuple[Floats, Floats],
    border_confidence: tuple[Floats, Floats] | None = None,
) -> Columns:
    """Return the columns of both levels.

    Parameters
    ----------
    activities, primitives : (segments + 1,) array
        Borders of each level, from 0 to the end. Borders of activities are also borders of
        primitives.
    is_activity : (activities,) array of bool
        False for transitions.
    is_primitive : (primitives,) array of bool, optional
        False for transitions; by default all in activities are primitives.
    clusters, confidence : pair of arrays
        For activities, and for primitives.
    border_confidence : pair of arrays, optional
        Probability that the start of each is right, for activities and for primitives.

    Returns
    -------
    dict of str to array
        ``level``, ``kind``, ``start_frame``, ``stop_frame``, ``cluster``, ``confidence``, and
        ``border_confidence`` if given.
    """
    parents = np.searchsorted(activities, primitives[:-1], side="right") - 1
    primitive = is_activity[parents] if is_primitive is None else is_primitive
    columns = {
        "level": np.repeat(["activity", "primitive"], [len(activities) - 1, len(parents)]),
        "kind": np.where(np.append(is_activity, primitive), "activity", "transition"),
        "start_frame": np.concatenate([activities[:-1], primitives[:-1]]),
        "stop_frame": np.concatenate([activities[1:], primitives[1:]]),
        "cluster": np.concatenate(clusters),
        "confidence": np.concatenate(confidence),
    }
    if border_confidence is not None:
        columns["border_confidence"] = np.concatenate(border_confidence)
    return columns


def number_by_appearance(labels: NDArray[np.integer]) -> Ints:
    """Renumber labels from 0 in order of appearance; -1 stays.

    Examples
    --------
    >>> import numpy as np
    >>> number_by_appearance(np.array([7, 7, -1, 2, 7]))
    array([ 0,  0, -1,  1,  0])
    """
    in_cluster = labels >= 0
    _, first, inverse = np.unique(labels[in_cluster], return_index=True, return_inverse=True)
    numbered = np.full(len(labels), -1, np.int64)
    # `argsort` twice gives ranks: the rank of a label's first position is its new number.
    numbered[in_cluster] = np.argsort(np.argsort(first))[inverse]
    return numbered
