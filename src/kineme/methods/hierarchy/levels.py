"""Levels of detail of the method for sensors: its tree, pruned at scaled costs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme.methods import levels
from kineme.methods.base import Columns
from kineme.methods.hierarchy import tree

if TYPE_CHECKING:
    from kineme.methods.hierarchy.constants import HierarchyConstants

EACH = 8
"""Pieces for each segment of the default level, at most."""
MOST = 1000
"""Pieces of a long recording, at most, if it has not more segments."""


def levels_of(
    columns: Columns,
    *,
    borders: levels.Ints,
    labels: levels.Ints,
    fine: levels.Ints,
    features: NDArray[np.float32],
    unit: float,
    preset: HierarchyConstants,
) -> Mapping[float, Columns]:
    """The table at each detail but 1, those left out that are like their coarser neighbour.

    Parameters
    ----------
    columns : dict of str to array
        The table at detail 1.
    borders, labels, fine, features, unit, preset
        As in `HierarchyFound`.

    Returns
    -------
    mapping of float to columns
    """
    per_sample = preset.working_fps / preset.rate
    pieces, frames = _pieces(borders, labels, fine, features, unit, per_sample)
    at = levels.clusters_at(
        pieces,
        levels.DETAILS,
        border_price=preset.samples(preset.segment_cost),
        cluster_price=preset.cluster_price(len(features)),
    )
    return levels.tables_at(columns, frames, at, longest=0.0)


def _pieces(
    default: levels.Ints,
    labels: levels.Ints,
    fine: levels.Ints,
    features: NDArray[np.float32],
    unit: float,
    per_sample: float,
) -> tuple[levels.Pieces, levels.Ints]:
    """Segments of a fine level of the tree, cut at the default borders; and these in frames."""
    own = np.rint(default / per_sample).astype(np.int64)
    own[-1] = len(features)
    tree_levels = tree.levels(fine, tree.between_segments(features, fine, unit))
    most = min(len(tree_levels), EACH * len(default), max(MOST, len(default)))
    borders = np.unique(np.concatenate([own, fine[tree_levels[most - 1]]]))
    frames = np.rint(borders * per_sample).astype(np.int64)
    frames[np.searchsorted(borders, own)] = default
    parents = labels[np.searchsorted(own, borders[:-1], side="right") - 1]
    sums = tree.between_segments(features, borders, unit) / 2
    return levels.Pieces(borders, np.arange(len(parents)), parents, sums), frames
