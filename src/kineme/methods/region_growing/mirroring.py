"""Mirrored cuts: where a repetition with left and right exchanged starts.

Mirrored frames have neighbours among the original ones, and these have paths: a step
with the right foot is like the mirrored step with the left. Such paths cut double steps
into left and right ones. Activities and clusters are found without
them.

The symmetry of an activity follows from where its mirrored paths lie:

- ``symmetric``: on the others, left and right do the same at once (squats);
- ``alternating``: between them, left and right take turns (walking);
- ``one-sided``: they pass through less than half of it, the sides differ (punches
  with one arm). Between kicks with long rests the rests count as symmetric, and a
  limp wider than the radius as one-sided.

Source: Krueger et al. 2017, section V; there the type of symmetry decides which
cuts to add. The authors' program adds them cut by cut, and so does this.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme.methods.region_growing.primitives import PrimitiveCuts
from kineme.methods.region_growing.warping import WarpingPaths

HALF = 0.5  # of the frames; more are most of them


def merge_cuts(
    main: NDArray[np.int64], mirrored: NDArray[np.int64], gap: float
) -> NDArray[np.int64]:
    """Return main cuts, and those mirrored ones that are farther than ``gap`` frames from them all.

    Mirrored cuts are not compared with each other.
    """
    # (mirrored, main): no main cut within the gap.
    apart = ~(np.abs(mirrored[:, None] - main) <= gap).any(axis=1)
    return np.union1d(main, mirrored[apart])


def classify_symmetry(
    activity: tuple[int, int], main: PrimitiveCuts, mirrored: PrimitiveCuts, gap: float
) -> str:
    """``symmetric``, ``alternating`` or ``one-sided``: the symmetry of an activity.

    Parameters
    ----------
    activity : (int, int)
        (first, last), both inclusive.
    main, mirrored : PrimitiveCuts
        As `primitive_cuts` finds them among the frames and the mirrored frames of the activity.
    gap : float
        Frames; a mirrored path this far from every main one lies between them.
    """
    # Both ends are included here.
    first, last = activity
    # Paths through less than half of the frames: the mirrored movement is not in the activity.
    if len(np.unique(mirrored.paths.rows)) <= HALF * (last - first + 1):
        return "one-sided"
    between = _measure_distances(mirrored.paths, main.paths) > gap
    return "alternating" if between.mean() > HALF else "symmetric"


def _measure_distances(paths: WarpingPaths, others: WarpingPaths) -> NDArray[np.float64]:
    """For each node of the paths, how many columns the nearest node of the others is away."""
    order = np.lexsort((others.columns, others.rows))
    # Rows are put one after the other on a line, so that one sorted search serves all of them.
    stride = max(paths.columns.max(), others.columns.max(initial=0)) + 1
    # Nodes of one row lie within ``stride`` of each other, those of two rows do not.
    places = np.concatenate(
        [[-np.inf], 2 * stride * others.rows[order] + others.columns[order], [np.inf]]
    )
    nodes = 2.0 * stride * paths.rows + paths.columns
    after = np.searchsorted(places, nodes)
    nearest: NDArray[np.float64] = np.minimum(nodes - places[after - 1], places[after] - nodes)
    return nearest
