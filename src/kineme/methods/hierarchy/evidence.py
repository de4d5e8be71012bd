"""Statistics of what the method for sensors found, by which it is told how sure it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme.methods.evidence import border_statistics, link_statistics
from kineme.methods.hierarchy.tree import between_segments

if TYPE_CHECKING:
    from kineme.methods.hierarchy.constants import HierarchyConstants

Floats = NDArray[np.float64]
Frames = NDArray[np.int64]

NEAR = 2.0
"""Seconds on either side of a border that are compared with both segments."""


def evidence(
    features: NDArray[np.float32],
    unit: float,
    borders: Frames,
    labels: Frames,
    own: Floats,
    preset: HierarchyConstants,
) -> tuple[Floats, Floats]:
    """Statistics of the clusters of activities and of their borders, (segments, 3) each.

    Parameters
    ----------
    features : (samples, dims) array
    unit : float
        The median distance of two samples.
    borders, labels : array of int
        Samples, ends included, and clusters.
    own : (segments,) array
        How much nearer the samples of each are to their own cluster than to others.
    preset : HierarchyConstants
    """

    def similar(rows: Frames, columns: Frames) -> float:
        apart = features[rows][:, None] - features[columns]
        distances = np.sqrt(np.square(apart).sum(axis=2, dtype=np.float64))
        known = np.exp(-distances / unit)[np.not_equal.outer(rows, columns)]
        return float(known.mean()) if known.size else 0.0

    lengths = np.diff(borders)
    alike = np.exp(-between_segments(features, borders, unit) / np.outer(lengths, lengths))
    near = max(1, round(NEAR * preset.rate))
    return link_statistics(labels, alike, own), border_statistics(
        borders, labels, alike, similar, near
    )
