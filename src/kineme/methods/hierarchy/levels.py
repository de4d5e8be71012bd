"""Levels of detail of the method for sensors: its tree, pruned at scaled costs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from kineme.methods import levels
from kineme.methods.base import Columns
from kineme.methods.hierarchy import tree

if TYPE_CHECKING:
    from kineme.methods.hierarchy.found import HierarchyFound

EACH = 8
"""Pieces for each segment of the default level, at most."""
MOST = 1000
"""Pieces of a long recording, at most, if it has not more segments."""


def levels_of(found: HierarchyFound, columns: Columns) -> Mapping[float, Columns]:
    """The table at each detail but 1.

    Parameters
    ----------
    found : HierarchyFound
    columns : dict of str to array
        The table at detail 1.

    Returns
    -------
    mapping of float to columns
    """
    preset = found.preset
    pieces, frames = _pieces(found)
    at = levels.clusters_at(
        pieces,
        levels.DETAILS,
        border_price=preset.samples(preset.segment_cost),
        cluster_price=preset.samples(preset.cluster_cost),
    )
    return {
        detail: levels.at_detail(columns, frames, at[detail], 0.0 if detail < 1 else None)
        for detail in levels.DETAILS
    }


def _pieces(found: HierarchyFound) -> tuple[levels.Pieces, levels.Ints]:
    """Segments of a fine level of the tree, cut at the default borders; and these in frames."""
    n = len(found.features)
    per_sample = found.preset.working_fps / found.preset.rate
    own = np.rint(found.borders / per_sample).astype(np.int64)
    own[-1] = n
    fine = found.fine
    tree_levels = tree.levels(fine, tree.between_segments(found.features, fine, found.unit))
    most = min(len(tree_levels), EACH * len(found.borders), max(MOST, len(found.borders)))
    borders = np.unique(np.concatenate([own, fine[tree_levels[most - 1]]]))
    frames = np.rint(borders * per_sample).astype(np.int64)
    default = np.searchsorted(borders, own)
    frames[default] = found.borders
    parents = found.labels[np.searchsorted(own, borders[:-1], side="right") - 1]
    sums = tree.between_segments(found.features, borders, found.unit) / 2
    return levels.Pieces(borders, np.arange(len(parents)), parents, sums), frames
