"""What the method for sensors finds, stage by stage."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme.methods.base import Columns
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
    confidence : (segments,) array
        How much nearer its samples are to their own cluster than to any other, 0 to 1.
    primitives : (primitives + 1,) array
        Borders of the repetitions, those of segments included.
    agreement : (primitives,) array
        How certain their number is, 0 to 1.
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
    confidence: NDArray[np.float64]
    primitives: Frames
    agreement: NDArray[np.float64]
    fine: Frames
    timings: dict[str, float] = field(default_factory=dict)

    def columns(self) -> Columns:
        """Activities with their confidence, repetitions with the certainty of their count."""
        parents = np.searchsorted(self.borders, self.primitives[:-1], side="right") - 1
        return columns_of(
            self.borders,
            self.primitives,
            is_activity=np.full(len(self.labels), True),
            clusters=(self.labels, self.labels[parents]),
            scores=(self.confidence, self.agreement),
        )

    def levels(self, columns: Columns) -> Mapping[float, Columns]:
        """The table at coarser and finer details; see `kineme.methods.hierarchy.levels`."""
        from kineme.methods.hierarchy.levels import levels_of

        return levels_of(self, columns)

    @cached_property
    def graph(self) -> NeighborGraph:
        """Neighbours of every sample, for pictures: within half the median distance."""
        from kineme.graph import neighbor_graph

        return neighbor_graph(self.features, radius=0.5 * self.unit, k=PICTURED)

    def doubts(self, columns: Columns, fps: float) -> list[str]:
        """A sentence for each activity whose count is not sure."""
        activity = (columns["level"] == "activity") & (columns["kind"] == "activity")
        sentences = []
        for row in np.flatnonzero(activity):
            start, stop = columns["start_frame"][row], columns["stop_frame"][row]
            inside = (columns["level"] == "primitive") & (columns["start_frame"] == start)
            agreement = columns["score"][inside][0]
            if agreement < self.preset.unsure_count:
                sentences.append(
                    f"look at the repetitions at {start / fps:.2f} to {stop / fps:.2f} s: "
                    f"another number of them fits nearly as well (score {agreement:.2f})"
                )
        return sentences
