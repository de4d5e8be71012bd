"""What the method finds, stage by stage, and the segment table made from it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme.methods.base import Columns
from kineme.methods.doubts import list_doubts
from kineme.methods.kineme import tree
from kineme.methods.kineme.borders import convert_to_samples
from kineme.methods.kineme.confidence import Confidence, Evidence, compute_confidence
from kineme.methods.kineme.primitives import Segments
from kineme.methods.levels import DETAILS, FineSegments, assign_clusters, make_tables
from kineme.methods.segments import make_columns

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Frames = NDArray[np.int64]

LISTED = 5
"""Activities that a note lists at most."""
EACH = 8
"""Fine segments of levels of detail for each segment of the default level, at most."""
MOST = 1000
"""Fine segments of a long recording, at most, if the default level has not more."""


@dataclass(frozen=True, eq=False)
class KinemeFound:
    """What the stages found.

    Attributes
    ----------
    features : (samples, dims) array
        The view, ``preset.rate`` times a second.
    preset : KinemeConstants
    unit : float
        The median distance of two samples.
    segments : Segments
        Both levels, in frames of the working rate.
    evidence : Evidence
        Statistics for the confidence of all these.
    fine : (segments + 1,) array
        Borders of the finest segments, frames of the working rate.
    timings : dict of str to float
        Seconds per stage.
    """

    features: NDArray[np.float32]
    preset: KinemeConstants
    unit: float
    segments: Segments
    evidence: Evidence
    fine: Frames
    timings: dict[str, float] = field(default_factory=dict)

    @property
    def borders(self) -> Frames:
        """Of activities, frames of the working rate, from 0 to the end."""
        return self.segments.borders

    @property
    def primitives(self) -> Frames:
        """Borders of repetitions and events, those of activities included."""
        return self.segments.primitives

    def columns(self) -> Columns:
        """Activities, primitives, and their confidence."""
        segments, probabilities = self.segments, self.confidence
        counts = np.where(segments.clusters >= 0, probabilities.counts[segments.parents], np.nan)
        return make_columns(
            self.borders,
            self.primitives,
            is_activity=segments.labels >= 0,
            is_primitive=segments.clusters >= 0,
            clusters=(segments.labels, segments.clusters),
            confidence=(probabilities.links, counts),
            border_confidence=(probabilities.borders, probabilities.cuts),
        )

    @cached_property
    def confidence(self) -> Confidence:
        """How probable it is that each thing found is right."""
        return compute_confidence(self.evidence, self.preset)

    def levels(
        self, columns: Columns, details: tuple[float, ...] | None = None
    ) -> Mapping[float, Columns]:
        """Return the table at coarser and finer details: the tree, pruned at scaled costs.

        Details that are equal to their coarser neighbour are left out.
        """
        segments, frames = self._fine_segments()
        at = assign_clusters(
            segments,
            details or DETAILS,
            border_price=self.preset.samples(self.preset.segment_cost),
            cluster_price=self.preset.cluster_price(len(self.features)),
        )
        return make_tables(columns, frames, at, longest=0.0)

    def _fine_segments(self) -> tuple[FineSegments, Frames]:
        """Segments of a fine level of the tree, cut at the default borders; and these in frames."""
        n, per_sample = len(self.features), self.preset.working_fps / self.preset.rate
        coarse = convert_to_samples(self.borders, self.preset, n)
        nearest = np.rint(self.fine[:-1] / per_sample).astype(np.int64)
        fine = np.unique(np.append(np.minimum(nearest, n - 1), n))
        found = tree.list_levels(fine, tree.sum_between_segments(self.features, fine, self.unit))
        most = min(len(found), EACH * len(coarse), max(MOST, len(coarse)))
        borders = np.unique(np.concatenate([coarse, fine[found[most - 1]]]))
        frames = np.rint(borders * per_sample).astype(np.int64)
        frames[np.searchsorted(borders, coarse)] = self.borders
        parents = self.segments.labels[np.searchsorted(coarse, borders[:-1], side="right") - 1]
        sums = tree.sum_between_segments(self.features, borders, self.unit) / 2
        return FineSegments(borders, np.arange(len(parents)), parents, sums), frames

    def doubts(self, columns: Columns, fps: float) -> list[str]:
        """Return a sentence for each cluster, count or border of low confidence, at most five.

        One more lists the activities that are not periodic.
        """
        found = list_doubts(columns, fps)
        is_activity = columns["level"] == "activity"
        not_periodic = is_activity & np.isin(columns["cluster"], self.segments.not_periodic)
        if not_periodic.any():
            starts, stops = (
                columns["start_frame"][not_periodic],
                columns["stop_frame"][not_periodic],
            )
            listed = [
                f"{start / fps:.2f} to {stop / fps:.2f} s"
                for start, stop in zip(starts, stops, strict=True)
            ]
            more = f" and {len(listed) - LISTED} more" if len(listed) > LISTED else ""
            primitives = columns["start_frame"][~is_activity & (columns["cluster"] >= 0)]
            at = np.searchsorted(starts, primitives, side="right") - 1
            recurs = ((at >= 0) & (primitives < stops[at])).any()
            note = (
                "their primitives are what recurs anywhere" if recurs else "nothing in them recurs"
            )
            found.append(f"not periodic: {', '.join(listed[:LISTED])}{more}; {note}")
        return found
