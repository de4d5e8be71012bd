"""Levels of detail of the ``kineme`` method: actions joined, activities divided."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme.methods import levels
from kineme.methods.base import Columns
from kineme.methods.recurrence import _action_kernels as kernels
from kineme.methods.recurrence.change_points import change_points

if TYPE_CHECKING:
    from kineme.methods.recurrence.constants import RecurrenceConstants
    from kineme.methods.recurrence.recurrence import Recurrence

Samples = NDArray[np.int64]

MOST = 1000
"""Pieces of a long recording, at most, if it has not more segments."""


def levels_of(
    columns: Columns,
    *,
    borders: Samples,
    labels: Samples,
    narrow: Recurrence,
    preset: RecurrenceConstants,
) -> Mapping[float, Columns]:
    """The table at each detail but 1, those left out that are like their coarser neighbour.

    Parameters
    ----------
    columns : dict of str to array
        The table at detail 1.
    borders, labels, narrow, preset
        As in `RecurrenceFound`.

    Returns
    -------
    mapping of float to columns
    """
    pieces, frames = _pieces(borders, labels, narrow, preset)
    cost = preset.border_cost * preset.working_fps / preset.step
    at = levels.clusters_at(pieces, levels.DETAILS, border_price=cost, cluster_price=cost)
    return levels.tables_at(columns, frames, at, preset.frames(preset.min_action))


def _pieces(
    default: Samples, actions: Samples, narrow: Recurrence, preset: RecurrenceConstants
) -> tuple[levels.Pieces, Samples]:
    """Activities cut where finer change points are, and transitions; with their frames."""
    short = preset.narrowed
    n, step = len(narrow), narrow.step
    least = preset.frames(preset.min_segment)
    frames = default
    for finest in sorted(levels.FINER, reverse=True):
        cuts = change_points(
            narrow,
            penalty=short.border_cost * short.working_fps / step / finest,
            min_length=max(1, short.samples(short.min_segment)),
        )
        finer = _divided(default, actions >= 0, cuts * step, least)
        if len(finer) <= MOST:
            frames = finer
            break
    parents = actions[np.searchsorted(default, frames[:-1], side="right") - 1]
    labels = np.where(parents >= 0, np.cumsum(parents >= 0) - 1, -1)
    borders = np.minimum(np.rint(frames / step).astype(np.int64), n)
    borders[-1] = n
    k = int(labels.max(initial=-1)) + 1
    sums, counts = np.zeros((k, k)), np.zeros((k, k))
    kernels.sum_similarities(narrow.similarity, np.repeat(labels, np.diff(borders)), sums, counts)
    lengths = np.bincount(labels[labels >= 0], np.diff(borders)[labels >= 0], k)
    pairs = np.outer(lengths, lengths)
    differences = pairs * (1 - sums / np.maximum(counts, 1))
    return levels.Pieces(borders, labels, parents[labels >= 0], differences), frames


def _divided(
    borders: Samples, is_activity: NDArray[np.bool_], cuts: Samples, least: int
) -> Samples:
    """The borders with those cuts that lie in activities, so far at least from their ends."""
    at = np.searchsorted(borders, cuts, side="right") - 1
    inside = (at >= 0) & (at < len(is_activity))
    cuts, at = cuts[inside], at[inside]
    far = (cuts - borders[at] >= least) & (borders[at + 1] - cuts >= least)
    return np.unique(np.concatenate([borders, cuts[far & is_activity[at]]]))
