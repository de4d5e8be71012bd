"""What the method for sensors finds, stage by stage."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme.methods.base import Columns
from kineme.methods.confidence import Confidence, confidence
from kineme.methods.doubts import doubts
from kineme.methods.evidence import Evidence
from kineme.methods.hierarchy.constants import HierarchyConstants
from kineme.methods.segments import columns_of

if TYPE_CHECKING:
    from kineme.graph import NeighborGraph

Frames = NDArray[np.int64]

# For pictures: neighbours per sample at most.
PICTURED = 256


@dataclass(frozen=True, eq=False)
class HierarchyFound:
    """What the stages found.

    Attributes
    ----------
    features : (samples, dims) array
        Statistics of the channels, ``preset.rate`` times a second.
    preset : HierarchyConstants
    unit : float
        The median distance of two samples.
    borders : (segments + 1,) array
        Frames of the working rate, from 0 to n.
    labels : (segments,) array
        Cluster of each.
    primitives : (primitives + 1,) array
        Borders of the repetitions, those of segments included.
    evidence : Evidence
        By which it is told how sure all that is.
    fine : (pieces + 1,) array
        Borders of the finest segments, samples of `features`.
    timings : dict of str to float
        Seconds per stage.
    """

    features: NDArray[np.float32]
    preset: HierarchyConstants
    unit: float
    borders: Frames
    labels: Frames
    primitives: Frames
    evidence: Evidence
    fine: Frames
    timings: dict[str, float] = field(default_factory=dict)

    def columns(self) -> Columns:
        """Activities, repetitions, and how probable it is that each is right."""
        parents = self.evidence.parents
        sure = self.confidence
        return columns_of(
            self.borders,
            self.primitives,
            is_activity=np.full(len(self.labels), True),
            clusters=(self.labels, self.labels[parents]),
            scores=(sure.links, sure.counts[parents]),
            border_confidence=(sure.borders, sure.cuts),
        )

    @cached_property
    def confidence(self) -> Confidence:
        """How probable it is that each thing found is right."""
        return confidence(self.evidence, self.preset)

    def levels(self, columns: Columns) -> Mapping[float, Columns]:
        """The table at coarser and finer details; see `kineme.methods.hierarchy.levels`."""
        from kineme.methods.hierarchy.levels import levels_of

        return levels_of(
            columns,
            borders=self.borders,
            labels=self.labels,
            fine=self.fine,
            features=self.features,
            unit=self.unit,
            preset=self.preset,
        )

    @cached_property
    def graph(self) -> NeighborGraph:
        """Neighbours of every sample, for pictures: within half the median distance."""
        from kineme.graph import neighbor_graph

        return neighbor_graph(self.features, radius=0.5 * self.unit, k=PICTURED)

    def doubts(self, columns: Columns, fps: float) -> list[str]:
        """A sentence for each cluster, count or border that is not sure, at most five."""
        return doubts(columns, fps, self.preset)
