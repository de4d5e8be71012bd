"""Run the stages of the method: from features to segments, repetitions and events.

Features are an array of frames x dims, of bodies or of sensors.

1. *views*: compute posture and energy of movement a few times a second, in one or more scales.
2. *segments*: build a tree of segments in each view and choose the level with the shortest
   description. A segment is described by the similarity of its samples, or by a movement that it
   repeats. Of several views, choose the one that agrees most with all. Long recordings are
   segmented in independent parts.
3. *borders*: refine borders to the frame, and insert transitions that fit neither side.
4. *repetitions*: count the repetitions of each segment, and find the first and the last one.
5. *events*: find spans that recur occasionally.
6. *confidence*: compute the probability that results are right. No other stage reads it.

`KinemeFound` holds the results, and makes tables of them at several levels of detail.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from itertools import pairwise
from math import ceil
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from threadpoolctl import ThreadpoolController

from kineme._util.checks import as_features
from kineme._util.parallel import map_threads
from kineme.features.channels import choose_frames
from kineme.methods.base import Columns, Progress, time_stages
from kineme.methods.kineme import tree
from kineme.methods.kineme.borders import convert_to_samples, move_fine_borders, refine_borders
from kineme.methods.kineme.confidence import (
    OF_BODIES,
    OF_SIGNALS,
    Answers,
    Confidence,
    Evidence,
    compute_confidence,
)
from kineme.methods.kineme.primitives import (
    Segments,
    divide_into_repetitions,
    find_events,
    merge_similar_clusters,
)
from kineme.methods.kineme.tree import (
    Level,
    choose_part_ends,
    compute_median_distance,
    find_fine_level,
    find_level,
    link_parts,
)
from kineme.methods.kineme.views import Views, choose_view, compute_views
from kineme.methods.segments import (
    DETAILS,
    FineSegments,
    assign_clusters,
    find_segments,
    list_doubts,
    make_columns,
    make_tables,
)

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Rows = NDArray[np.float32]
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
    confidence : Confidence
        Probability that each result is right.
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
    confidence: Confidence
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
        return make_columns(
            segments.borders,
            segments.primitives,
            is_activity=segments.labels >= 0,
            is_primitive=segments.clusters >= 0,
            clusters=(segments.labels, segments.clusters),
            confidence=(probabilities.clusters, np.full(len(segments.clusters), np.nan)),
            border_confidence=(probabilities.borders, probabilities.cuts),
        )

    def levels(
        self, columns: Columns, details: tuple[float, ...] | None = None
    ) -> Mapping[float, Columns]:
        """Return the table at coarser and finer details: the tree, pruned at scaled costs.

        Details that equal the next coarser one are left out.
        """
        preset, n = self.preset, len(self.features)
        per_sample = preset.working_fps / preset.rate
        coarse = convert_to_samples(self.segments.borders, preset, n)
        nearest = np.rint(self.fine[:-1] / per_sample).astype(np.int64)
        fine = np.unique(np.append(np.minimum(nearest, n - 1), n))
        levels = tree.list_levels(fine, tree.sum_between_segments(self.features, fine, self.unit))
        # Level k - 1 of the tree has k segments.
        count = min(len(levels), FINE_PER_SEGMENT * len(coarse), max(MAX_FINE, len(coarse)))
        borders = np.unique(np.concatenate([coarse, fine[levels[count - 1]]]))
        frames = np.rint(borders * per_sample).astype(np.int64)
        # Default borders are known to the frame.
        frames[np.searchsorted(borders, coarse)] = self.segments.borders
        # Cluster at detail 1 of the default segment that contains each fine one.
        parents = self.segments.labels[find_segments(coarse, borders[:-1])]
        sums = tree.sum_between_segments(self.features, borders, self.unit) / 2
        clusters = assign_clusters(
            FineSegments(borders, parents, sums),
            details or DETAILS,
            border_price=preset.samples(preset.segment_cost),
            cluster_price=preset.cluster_price(n),
        )
        return make_tables(columns, frames, clusters)

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
            before = find_segments(starts, primitives)
            recurs = ((before >= 0) & (primitives < stops[before])).any()
            note = (
                "their primitives are movements that repeat elsewhere"
                if recurs
                else "nothing in them repeats"
            )
            sentences.append(f"not periodic: {', '.join(spans[:MAX_LISTED])}{more}; {note}")
        return sentences


class Part(NamedTuple):
    """Result for a part of a recording."""

    scale: int
    """Number of the chosen view."""
    view: Rows
    """Chosen view, (samples, dims)."""
    level: Level
    answers: Answers
    """Clusters that all views find."""


def analyze(
    features: ArrayLike,
    preset: KinemeConstants,
    *,
    joints: bool = False,
    progress: Progress | None = None,
) -> KinemeFound:
    """Find the segments, clusters, repetitions and events of features (frames, dims).

    Features are at the working rate; for a body in body sizes. ``joints`` tells whether they are
    computed from positions of joints. ``progress`` is called with the name of each stage before it
    runs. Raise ParameterError if the features have another shape, are empty, or not finite.
    """
    # Parts run in parallel, and sums must not depend on the number of threads.
    with _get_thread_limiter().limit(limits=1):
        rows = as_features(features)
        timings: dict[str, float] = {}
        stage = time_stages(timings, progress)
        n = len(rows)
        # Centred before the conversion to float32, so that an offset costs no precision.
        poses = np.ascontiguousarray(rows - rows.mean(axis=0), np.float32)
        min_frames = 2 * ceil(preset.working_fps / preset.rate)  # so that each part has a sample
        side = preset.frames(2 * preset.averaging)
        ends = choose_part_ends(poses, max(min_frames, preset.frames(preset.part)), side)
        spans = [slice(*span) for span in pairwise(ends)]
        with stage("views"):
            views = [compute_views(rows[span], preset, joints=joints) for span in spans]
        with stage("segments"):
            parts = map_threads(
                lambda each: _segment_part(each[0], poses[each[1]], each[1], preset),
                zip(views, spans, strict=True),
            )
            view = parts[0].view
            if len(parts) > 1:
                # All parts are compared in the view that most of them chose.
                scale = int(np.bincount([part.scale for part in parts]).argmax())
                view = compute_views(rows, preset.select_view(scale), joints=joints).views[0]
            unit = compute_median_distance(view, preset.comparison_width)
            sample_frames = choose_frames(n, preset.working_fps, preset.rate)
            # Price of a cluster in one part, as parts were segmented on their own.
            price = preset.cluster_price(len(parts[0].view))
            level = link_parts(
                view, sample_frames, [part.level for part in parts], unit=unit, price=price
            )
        with stage("borders"):
            starts, stops = refine_borders(rows, level.borders, preset)
            fine = move_fine_borders(level.fine, level.borders, np.append(starts, n))
        with stage("repetitions"):
            segments = divide_into_repetitions(poses, starts, stops, level.labels, preset)
            if preset.min_similarity < 1:
                segments = merge_similar_clusters(poses, segments, preset)
        if preset.event_scale:
            with stage("events"):
                segments = find_events(poses, segments, preset)
        with stage("confidence"):
            evidence = Evidence(poses, view, segments, [part.answers for part in parts], preset)
            calibration = OF_BODIES if preset.unit == "body sizes" else OF_SIGNALS
            confidence = compute_confidence(evidence, calibration)
        return KinemeFound(view, preset, unit, segments, evidence, confidence, fine, timings)


@cache
def _get_thread_limiter() -> ThreadpoolController:
    """Return a limiter for the threads of matrix products; cached, as it takes 7 ms to create."""
    return ThreadpoolController()


def _segment_part(views: Views, poses: Rows, span: slice, preset: KinemeConstants) -> Part:
    """Segment a part on its own. Its view is chosen without regard to repetitions."""
    fine_levels = [find_fine_level(view, preset) for view in (*views.views, *views.halves)]
    levels = [find_level(fine, preset) for fine in fine_levels]
    # Cluster of each sample, for each view.
    clusters = [np.repeat(level.labels, np.diff(level.borders)) for level in levels]
    count = len(views.views)
    scale = choose_view(clusters[:count], clusters[count:], margin=preset.view_margin)
    level = find_level(fine_levels[scale], preset, poses).to_frames(span, preset)
    view = views.views[scale]
    frames = span.start + choose_frames(span.stop - span.start, preset.working_fps, preset.rate)
    return Part(scale, view, level, Answers(frames, clusters))
