"""What the ``kineme`` method finds, stage by stage, and the segments that come of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme.methods.base import Columns
from kineme.methods.confidence import Confidence
from kineme.methods.doubts import doubts
from kineme.methods.evidence import Evidence
from kineme.methods.recurrence.recurrence import Recurrence
from kineme.methods.segments import columns_of

if TYPE_CHECKING:
    from kineme.graph import NeighborGraph
    from kineme.methods.recurrence.constants import RecurrenceConstants

Frames = NDArray[np.int64]

# For pictures: neighbours per frame at most.
PICTURED = 256
# Activities that a note lists at most.
LISTED = 5


@dataclass(frozen=True, eq=False)
class RecurrenceFound:
    """What the stages found.

    Attributes
    ----------
    features : (frames, dims) array
        Scaled so that distances are body sizes.
    recurrence : Recurrence
        How similar the samples are.
    preset : RecurrenceConstants
    borders : (segments + 1,) array
        Of activities and transitions, from 0 to n.
    labels : (segments,) array
        Action of each, -1 for transitions.
    primitives : (primitives + 1,) array
        Borders of the primitives, from 0 to n, those of activities included.
    clusters : (primitives,) array
        Cluster of each, -1 where it is neither repetition nor occurrence.
    not_periodic : array of int
        Actions whose primitives are occurrences.
    evidence : Evidence
        By which it is told how sure all that is.
    confidence : Confidence
        How probable it is that each thing found is right.
    narrow : Recurrence
        How similar the samples are for short actions.
    timings : dict of str to float
        Seconds per stage.
    """

    features: NDArray[np.float64]
    recurrence: Recurrence
    preset: RecurrenceConstants
    borders: Frames
    labels: Frames
    primitives: Frames
    clusters: Frames
    not_periodic: Frames
    evidence: Evidence
    confidence: Confidence
    narrow: Recurrence
    timings: dict[str, float] = field(default_factory=dict)

    def columns(self) -> Columns:
        """Activities, primitives, and how probable it is that each is right."""
        parents = self.evidence.parents
        sure = self.confidence
        return columns_of(
            self.borders,
            self.primitives,
            is_activity=self.labels >= 0,
            is_primitive=self.clusters >= 0,
            clusters=(self.labels, self.clusters),
            scores=(sure.links, np.where(self.clusters >= 0, sure.counts[parents], np.nan)),
            border_confidence=(sure.borders, sure.cuts),
        )

    def levels(self, columns: Columns) -> Mapping[float, Columns]:
        """The table at coarser and finer details; see `kineme.methods.recurrence.levels`."""
        from kineme.methods.recurrence.levels import levels_of

        return levels_of(
            columns,
            borders=self.borders,
            labels=self.labels,
            narrow=self.narrow,
            preset=self.preset,
        )

    @cached_property
    def graph(self) -> NeighborGraph:
        """Neighbours of every frame, for pictures; the method itself does not need them."""
        from kineme.graph import neighbor_graph

        return neighbor_graph(
            self.features,
            radius=2 * self.preset.max_scale,
            k=PICTURED,
            max_lag=max(1, self.preset.frames(self.preset.window)),
        )

    def doubts(self, columns: Columns, fps: float) -> list[str]:
        """A sentence for each cluster, count or border that is not sure, at most five.

        And one for the activities that are not periodic.
        """
        found = doubts(columns, fps, self.preset)
        of_activities = columns["level"] == "activity"
        loose = of_activities & np.isin(columns["cluster"], self.not_periodic)
        if loose.any():
            starts, stops = columns["start_frame"][loose], columns["stop_frame"][loose]
            listed = [
                f"{start / fps:.2f} to {stop / fps:.2f} s"
                for start, stop in zip(starts, stops, strict=True)
            ]
            more = f" and {len(listed) - LISTED} more" if len(listed) > LISTED else ""
            primitives = columns["start_frame"][~of_activities & (columns["cluster"] >= 0)]
            at = np.searchsorted(starts, primitives, side="right") - 1
            recurs = ((at >= 0) & (primitives < stops[at])).any()
            told = (
                "their primitives are what recurs anywhere" if recurs else "nothing in them recurs"
            )
            found.append(f"not periodic: {', '.join(listed[:LISTED])}{more}; {told}")
        return found
