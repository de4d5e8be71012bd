"""Segment the recent past of a stream, with the cluster numbers of the stream.

The recent past is segmented like a file. A cluster takes the number of the cluster of the last look
with which it shares most seconds. A cluster that shares none is compared with examples of older
clusters, by the energy distance of their samples, and takes the number of the nearest one, which
may change until an activity of the cluster is final.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field, replace
from typing import cast

import numpy as np

from kineme._util.arrays import Float32s, Floats, Ints, Masks
from kineme.errors import KinemeWarning
from kineme.live.events import AGREEING_S, Finals, Look, Row
from kineme.methods.kineme.constants import KinemeConstants
from kineme.methods.kineme.tree import (
    MAX_PER_CLUSTER,
    compute_energy_distances,
    compute_mean_distances,
    compute_median_distance,
    spread_samples,
)
from kineme.methods.kineme.views import compute_first_view
from kineme.methods.prepare import prepare_motion, prepare_signals
from kineme.methods.segmenter import SegmentOptions, segment_with_options
from kineme.recordings import Motion, Signals, Skeleton
from kineme.recordings.arrays import find_spans
from kineme.segments.hierarchy import DEFAULT_DETAIL
from kineme.segments.segmentation import Segmentation
from kineme.transfer.clusters import keep_numbers, list_spans

EXAMPLE_S = 8.0
"""Seconds of an activity that are kept as the example of its cluster."""
MOST_EXAMPLES = 40
"""Number of examples that are kept: those of the latest clusters."""
SAME_MOVEMENT = 0.3
"""Distance of a new cluster and an example up to which they are one movement, in units of the
typical distance of samples that are near in time."""
EDGE_S = 1.0
"""Seconds at the ends of activities and examples that are not compared."""
LEAST_S = 1.0
"""Seconds that must be recorded before the recent past is segmented."""


@dataclass(frozen=True)
class Layout:
    """Meaning of the values of a frame: named channels, or x, y, z of each joint."""

    fps: float
    channels: tuple[str, ...] = ()
    skeleton: Skeleton | None = None

    @property
    def n_values(self) -> int:
        """Return the number of values in a frame."""
        return len(self.value_names)

    @property
    def value_names(self) -> tuple[str, ...]:
        """Return the names of the values in a frame."""
        joints = self.skeleton.names if self.skeleton else ()
        return self.channels or tuple(f"{joint}_{axis}" for joint in joints for axis in "xyz")

    def make_recording(self, values: Floats, missing: Masks) -> Motion | Signals:
        """Return frames as a recording with gaps."""
        gaps = tuple((start, stop) for start, stop in find_spans(missing).tolist())
        if self.skeleton is None:
            return Signals(values, self.fps, self.channels, gaps)
        positions = values.reshape(len(values), -1, 3)
        return Motion(self.skeleton, positions, self.fps, gaps=gaps)


def choose_options(options: SegmentOptions, *, signals: bool) -> SegmentOptions:
    """Return the options for segmenting the recent past.

    Only the first view of the method is used. Choosing among views takes most of the time, and the
    choice could change from one look to the next, and with it the clusters of the same rows.
    """
    preset = options.resolved(signals=signals)
    if isinstance(preset, KinemeConstants):
        preset = preset.select_view(0)
    return replace(options, preset=preset, constants={})


@dataclass
class RecentPast:
    """Hold the last frames of a stream, and examples of earlier clusters."""

    layout: Layout
    options: SegmentOptions  # how the recent past is segmented; see `choose_options`
    start: int = 0  # first frame of the recent past
    # Of shape (frames, values), and which frames are missing.
    values: Floats = field(default_factory=lambda: np.empty((0, 0)))
    missing: Masks = field(default_factory=lambda: np.empty(0, np.bool_))
    # Example (frames, values) of each cluster, in the order in which clusters were seen last.
    examples: dict[int, Floats] = field(default_factory=dict)
    # (spans, 3): first frame, frame after the last, and cluster of the segments of the last look.
    known: Ints = field(default_factory=lambda: np.empty((0, 3), np.int64))
    _blocks: list[tuple[Floats, Masks]] = field(default_factory=list)

    def append(self, values: Floats, missing: Masks) -> None:
        """Add frames to the end."""
        self._blocks.append((values, missing))

    def collect(self) -> None:
        """Concatenate the frames that were added.

        Blocks are small and frequent, and each concatenation copies all frames, so it is done only
        when the frames are needed.
        """
        if self._blocks:
            values, missing = zip(*self._blocks, strict=True)
            # Before the first frame the number of columns is unknown: (0, 0) cannot be joined.
            before = [self.values] if len(self.values) else []
            self.values = np.concatenate([*before, *values])
            self.missing = np.concatenate([self.missing, *missing])
            self._blocks = []

    def drop_before(self, frame: int) -> None:
        """Drop the frames before a given one."""
        self.collect()
        dropped = min(max(0, frame - self.start), len(self.values))
        self.values, self.missing = self.values[dropped:], self.missing[dropped:]
        self.start = max(self.start, frame)

    def look(self, finals: Finals) -> Look:
        """Segment the recent past; return its rows with the cluster numbers of the stream."""
        self.collect()
        fps, stop = self.layout.fps, self.start + len(self.values)
        if (~self.missing).sum() < LEAST_S * fps:
            nothing = [Row(self.start, stop, -1)]
            return Look(nothing, nothing)
        found = self._segment(self.values, self.missing)
        table = found.table
        columns = table.columns()
        old = self._known_spans(finals)
        next_number = max(finals.highest, *old[:, 2].tolist(), -1) + 1
        starts, stops, clusters = list_spans(columns, table.cluster)
        new = starts * fps + self.start, stops * fps + self.start, clusters
        given = keep_numbers(
            {0: (old[:, 0].astype(float), old[:, 1].astype(float), old[:, 2])},
            {0: new},
            next_number=next_number,
        )
        # Numbers without a final activity in the recent past may change as more is seen of them.
        final = {row.cluster for row in finals.last_activities(self.start)}
        provisional = [local for local, number in given.items() if number not in final]
        if provisional and self.examples:
            matched = self._recognise(found, provisional, final.intersection(given.values()))
            for local in provisional:
                if local not in matched and given[local] in matched.values():
                    highest = max(finals.highest, *given.values(), *matched.values())
                    matched[local] = highest + 1
            given |= matched
        numbers = range(int(table.cluster.max()) + 1)
        named = np.array([given.get(local, -1) for local in numbers], np.int64)
        rows = np.column_stack(
            [
                table.start_frame + self.start,
                table.stop_frame + self.start,
                np.where(table.kind == "transition", -1, np.append(named, -1)[table.cluster]),
            ]
        )
        self.known = np.column_stack([*new[:2], named[clusters]]).round().astype(np.int64)
        coarse = table.level == "activity"
        # The open activity and its repetitions keep their number, which is final.
        begun = finals.start + AGREEING_S * fps
        current = rows[coarse & (rows[:, 0] <= begun) & (rows[:, 1] > begun) & (rows[:, 2] >= 0)]
        for first, last, number in current if finals.cluster >= 0 else ():
            same = (rows[:, 0] >= first) & (rows[:, 1] <= last) & (rows[:, 2] == number)
            rows[same, 2] = finals.cluster
        activities, primitives = (
            [Row(*row) for row in rows[chosen].tolist()] for chosen in (coarse, ~coarse)
        )
        return Look(activities, primitives)

    def keep_example(self, row: Row) -> None:
        """Keep the middle of an activity as the example of its cluster."""
        self.collect()
        half = round(EXAMPLE_S * self.layout.fps / 2)
        middle = (row.start + row.stop) // 2
        first = max(row.start, middle - half, self.start) - self.start
        last = min(row.stop, middle + half) - self.start
        values = self.values[first : max(last, first)][~self.missing[first : max(last, first)]]
        before = self.examples.pop(row.cluster, values)
        # The latest example, unless it is much shorter than the one before.
        kept = values if len(values) >= len(before) / 2 else before
        if len(kept):
            self.examples[row.cluster] = kept.copy()
        while len(self.examples) > MOST_EXAMPLES:
            del self.examples[next(iter(self.examples))]

    def _segment(self, values: Floats, missing: Masks) -> Segmentation:
        recording = self.layout.make_recording(values, missing)
        with warnings.catch_warnings(action="ignore", category=KinemeWarning):
            return segment_with_options(recording, self.options, details=(DEFAULT_DETAIL,))[0]

    def _known_spans(self, finals: Finals) -> Ints:
        """Return final spans of clusters in the recent past, followed by those of the last look."""
        final = [row for row in finals.last_activities(self.start) if row.cluster >= 0]
        coming = self.known[self.known[:, 1] > finals.frontier]
        return np.concatenate([np.array(final, np.int64).reshape(-1, 3), coming])

    def _recognise(
        self, found: Segmentation, clusters: list[int], taken: set[int]
    ) -> dict[int, int]:
        """Return the numbers of clusters that are near an example of an older cluster."""
        older = {number: rows for number, rows in self.examples.items() if number not in taken}
        if not older:
            return {}
        view, frames, unit, edge = self._compute_view(
            np.concatenate([*older.values(), self.values])
        )
        # Number the examples, then the clusters of the recent past.
        here = found.per_frame(level="activity")
        own = np.where(self.missing | (here < 0), -1, here + len(older))
        group = np.repeat(np.arange(len(older)), [len(rows) for rows in older.values()])
        group = np.concatenate([group, own])[frames]
        # A sample near a change averages over both sides.
        changes = np.flatnonzero(np.diff(group)) + 0.5
        is_inside = (np.abs(np.arange(len(group))[:, None] - changes) > edge).all(axis=1)

        def list_samples(number: int) -> Ints:
            samples = np.flatnonzero((group == number) & is_inside)
            samples = samples if len(samples) else np.flatnonzero(group == number)
            return samples[spread_samples(0, len(samples), MAX_PER_CLUSTER)]

        examples = {number: list_samples(i) for i, number in enumerate(older)}
        compared = {local: list_samples(local + len(older)) for local in clusters}
        return _match_nearest(view, unit, examples, compared)

    def _compute_view(self, values: Floats) -> tuple[Float32s, Ints, float, float]:
        """Return the view of frames (samples, dims), and the frame of each sample.

        Also return the typical distance of samples near in time, and the samples in `EDGE_S`.
        """
        is_signals = self.layout.skeleton is None
        preset = self.options.resolved(signals=is_signals)
        if not isinstance(preset, KinemeConstants):  # other methods have no views
            preset = cast(KinemeConstants, SegmentOptions().resolved(signals=is_signals))
        fps = preset.rate_of(values, self.layout.fps)
        preset = preset.at_most(fps)
        layout = replace(self.layout, fps=fps)
        recording = layout.make_recording(values, np.zeros(len(values), np.bool_))
        with warnings.catch_warnings(action="ignore", category=KinemeWarning):
            if isinstance(recording, Signals):
                prepared = prepare_signals(recording, preset, emg=self.options.emg)
            else:
                prepared = prepare_motion(recording, preset, self.options.effectors)
        rows = np.concatenate(prepared.features)
        view, at = compute_first_view(rows, preset, joints=prepared.joints)
        frames = (at * (fps / preset.working_fps)).astype(np.int64)
        unit = compute_median_distance(view, preset.comparison_width)
        return view, np.minimum(frames, len(values) - 1), unit, preset.samples(EDGE_S)


def _match_nearest(
    view: Float32s, unit: float, examples: dict[int, Ints], clusters: dict[int, Ints]
) -> dict[int, int]:
    """Return the number of the nearest example for each cluster that is near enough to one.

    Examples by number, and clusters, are samples of the view. The nearest pairs are matched first,
    so that each number is given once.
    """
    numbers = [number for number, samples in examples.items() if len(samples)]
    local = [cluster for cluster, samples in clusters.items() if len(samples)]
    if not (numbers and local):
        return {}
    groups = [*(clusters[k] for k in local), *(examples[k] for k in numbers)]
    means = compute_mean_distances(view, groups) / unit
    distances = compute_energy_distances(means)[: len(local), len(local) :]
    matched: dict[int, int] = {}
    while distances.min() <= SAME_MOVEMENT:
        row, column = np.unravel_index(distances.argmin(), distances.shape)
        matched[local[row]] = numbers[column]
        # Neither is matched again.
        distances[row], distances[:, column] = np.inf, np.inf
    return matched
