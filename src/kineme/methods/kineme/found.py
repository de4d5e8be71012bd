"""Results of all stages of the method, and the segment table made from them."""

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

MAX_LISTED = 5
"""Largest number of activities listed in a note."""
FINE_PER_SEGMENT = 8
"""Largest number of fine segments per segment of the default level, for levels of detail."""
MAX_FINE = 1000
"""Largest number of fine segments in total, unless the default level has more."""


@dataclass(frozen=True, eq=False)
class KinemeFound:
    """Results of the stages.

    Attributes
    ----------
    features : (samples, dims) array
        The chosen view, at ``preset.rate``.
    preset : KinemeConstants
    unit : float
        The median distance of two samples.
    segments : Segments
        Both levels, in frames at the working rate.
    evidence : Evidence
        Statistics for the confidence of the segments.
    fine : (segments + 1,) array
        Borders of the finest segments, in frames at the working rate.
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
        """Return the borders of activities, in frames at the working rate, from 0 to the end."""
        return self.segments.borders

    @property
    def primitives(self) -> Frames:
        """Return the borders of repetitions, events and activities."""
        return self.segments.primitives

    def columns(self) -> Columns:
        """Return the segment table: activities, primitives, and their confidence."""
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
        """Return the probability that each result is right."""
        return compute_confidence(self.evidence, self.preset)

    def levels(
        self, columns: Columns, details: tuple[float, ...] | None = None
    ) -> Mapping[float, Columns]:
        """Return the table at coarser and finer details: the tree, pruned at scaled costs.

        Details that equal the next coarser one are left out.
        """
        segments, frames = self._make_fine_segments()
        clusters = assign_clusters(
            segments,
            details or DETAILS,
            border_price=self.preset.samples(self.preset.segment_cost),
            cluster_price=self.preset.cluster_price(len(self.features)),
        )
        return make_tables(columns, frames, clusters, longest=0.0)

    def _make_fine_segments(self) -> tuple[FineSegments, Frames]:
        """Return fine segments of the tree, cut at the default borders, and borders in frames."""
        n, per_sample = len(self.features), self.preset.working_fps / self.preset.rate
        coarse = convert_to_samples(self.borders, self.preset, n)
        nearest = np.rint(self.fine[:-1] / per_sample).astype(np.int64)
        fine = np.unique(np.append(np.minimum(nearest, n - 1), n))
        levels = tree.list_levels(fine, tree.sum_between_segments(self.features, fine, self.unit))
        # Level k - 1 of the tree has k segments.
        count = min(len(levels), FINE_PER_SEGMENT * len(coarse), max(MAX_FINE, len(coarse)))
        borders = np.unique(np.concatenate([coarse, fine[levels[count - 1]]]))
        frames = np.rint(borders * per_sample).astype(np.int64)
        # Default borders are known to the frame.
        frames[np.searchsorted(borders, coarse)] = self.borders
        # Cluster at detail 1 of the default segment that contains each fine one.
        parents = self.segments.labels[np.searchsorted(coarse, borders[:-1], side="right") - 1]
        sums = tree.sum_between_segments(self.features, borders, self.unit) / 2
        return FineSegments(borders, np.arange(len(parents)), parents, sums), frames

    def doubts(self, columns: Columns, fps: float) -> list[str]:
        """Return one sentence for each doubtful result, and one for activities without period."""
        sentences = list_doubts(columns, fps)
        is_activity = columns["level"] == "activity"
        not_periodic = is_activity & np.isin(columns["cluster"], self.segments.not_periodic)
        if not_periodic.any():
            starts, stops = (columns[f"{end}_frame"][not_periodic] for end in ("start", "stop"))
            spans = [
                f"{start / fps:.2f} to {stop / fps:.2f} s"
                for start, stop in zip(starts, stops, strict=True)
            ]
            more = f" and {len(spans) - MAX_LISTED} more" if len(spans) > MAX_LISTED else ""
            primitives = columns["start_frame"][~is_activity & (columns["cluster"] >= 0)]
            # The last of these activities that begins at or before each primitive; -1 for none.
            before = np.searchsorted(starts, primitives, side="right") - 1
            recurs = ((before >= 0) & (primitives < stops[before])).any()
            note = (
                "their primitives are movements that repeat elsewhere"
                if recurs
                else "nothing in them repeats"
            )
            sentences.append(f"not periodic: {', '.join(spans[:MAX_LISTED])}{more}; {note}")
        return sentences
