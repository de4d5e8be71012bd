"""Find mirrored cuts: starts of repetitions with left and right exchanged.

A step with the right foot is similar to the mirrored step with the left. So warping
paths between mirrored and original frames divide double steps into left and right ones.
Activities and clusters do not use them.

The symmetry of an activity follows from the positions of its mirrored paths:

- ``symmetric``: on the other paths; left and right do the same at once (squats);
- ``alternating``: between the other paths; left and right take turns (walking);
- ``one-sided``: in less than half of the frames; the sides differ (punches with one
  arm). Limitations: long rests between kicks count as symmetric, and a limp larger
  than the radius as one-sided.

Source: Krueger et al. 2017, section V. There the type of symmetry decides which
cuts are added. The authors' program and this module decide for each cut.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme.methods.region_growing.primitives import PrimitiveCuts
from kineme.methods.region_growing.warping import WarpingPaths

HALF = 0.5
"""Share of frames or nodes that counts as a majority."""


def merge_cuts(
    main: NDArray[np.int64], mirrored: NDArray[np.int64], gap: float
) -> NDArray[np.int64]:
    """Add the mirrored cuts that are more than ``gap`` frames from all main cuts.

    Mirrored cuts are not compared with each other.
    """
    is_far = ~(np.abs(mirrored[:, None] - main) <= gap).any(axis=1)
    return np.union1d(main, mirrored[is_far])


def classify_symmetry(
    activity: tuple[int, int], main: PrimitiveCuts, mirrored: PrimitiveCuts, gap: float
) -> str:
    """Return the symmetry of an activity: ``symmetric``, ``alternating`` or ``one-sided``.

    Parameters
    ----------
    activity : (int, int)
        (first, last), both inclusive.
    main, mirrored : PrimitiveCuts
        As returned by `find_primitive_cuts` for the original and the mirrored frames.
    gap : float
        Frames; a mirrored path farther than this from all main ones lies between them.
    """
    first, last = activity
    # Paths in less than half of the frames: the mirrored movement does not occur.
    if len(np.unique(mirrored.paths.rows)) <= HALF * (last - first + 1):
        return "one-sided"
    between = _measure_distances(mirrored.paths, main.paths) > gap
    return "alternating" if between.mean() > HALF else "symmetric"


def _measure_distances(paths: WarpingPaths, others: WarpingPaths) -> NDArray[np.float64]:
    """Return the distance in columns from each node to the nearest node of others in its row."""
    order = np.lexsort((others.columns, others.rows))
    # Map (row, column) to one number, so that a single sorted search handles all rows. Nodes of
    # one row differ by less than ``stride``, nodes of different rows by more.
    stride = max(paths.columns.max(), others.columns.max(initial=0)) + 1
    positions = np.concatenate(
        [[-np.inf], 2 * stride * others.rows[order] + others.columns[order], [np.inf]]
    )
    nodes = 2.0 * stride * paths.rows + paths.columns
    after = np.searchsorted(positions, nodes)
    nearest: NDArray[np.float64] = np.minimum(
        nodes - positions[after - 1], positions[after] - nodes
    )
    return nearest
