"""What the ``kineme`` method finds, stage by stage, and the segments that come of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme.methods.base import Columns
from kineme.methods.recurrence.recurrence import Recurrence
from kineme.methods.segments import columns_of

if TYPE_CHECKING:
    from kineme.graph import NeighborGraph
    from kineme.methods.recurrence.constants import RecurrenceConstants

Frames = NDArray[np.int64]

# For pictures: neighbours per frame at most.
PICTURED = 256


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
    confidence : (segments,) array
        How sure the action of each is, nan for transitions.
    primitives : (primitives + 1,) array
        Borders of the primitives, from 0 to n, those of activities included.
    agreement : (primitives,) array
        How certain the count is, 0 to 1, nan in transitions.
    narrow : Recurrence
        The same for short actions.
    timings : dict of str to float
        Seconds per stage.
    """

    features: NDArray[np.float64]
    recurrence: Recurrence
    preset: RecurrenceConstants
    borders: Frames
    labels: Frames
    confidence: NDArray[np.float64]
    primitives: Frames
    agreement: NDArray[np.float64]
    narrow: Recurrence
    timings: dict[str, float] = field(default_factory=dict)

    def columns(self) -> Columns:
        """Activities with their confidence, primitives with the certainty of their count."""
        parents = np.searchsorted(self.borders, self.primitives[:-1], side="right") - 1
        return columns_of(
            self.borders,
            self.primitives,
            is_activity=self.labels >= 0,
            clusters=(self.labels, self.labels[parents]),
            scores=(self.confidence, self.agreement),
        )

    def levels(self, columns: Columns) -> Mapping[float, Columns]:
        """The table at coarser and finer details; see `kineme.methods.recurrence.levels`."""
        from kineme.methods.recurrence.levels import levels_of

        return levels_of(self, columns)

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
        """A sentence for each activity that is nearly another, or whose count is not sure."""
        activity = (columns["level"] == "activity") & (columns["kind"] == "activity")
        sentences = []
        for row in np.flatnonzero(activity):
            start, stop = columns["start_frame"][row], columns["stop_frame"][row]
            where = f"at {start / fps:.2f} to {stop / fps:.2f} s"
            if columns["score"][row] < self.preset.unsure_action:
                sentences.append(
                    f"look at the activity {where}: it is nearly as similar to another "
                    f"(confidence {columns['score'][row]:.2f})"
                )
            inside = (columns["level"] == "primitive") & (columns["start_frame"] == start)
            agreement = columns["score"][inside][0]
            if agreement < self.preset.unsure_count:
                sentences.append(
                    f"look at the repetitions {where}: another number of them fits nearly as well "
                    f"(score {agreement:.2f})"
                )
        return sentences
