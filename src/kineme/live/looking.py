"""Looks at the recent past: segments with the cluster numbers of the stream.

The recent past is segmented as a recording of its own, by the method that files are segmented by.
Clusters of one look are those of the look before with which they share most seconds. A cluster
that shares none is compared with examples of older clusters: these are put before the recent past
and both are segmented together.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field, replace

import numpy as np

from kineme._util.arrays import Floats, Ints, Masks
from kineme.errors import KinemeWarning
from kineme.live.finals import Finals, Look, Row
from kineme.methods.kineme.constants import KinemeConstants
from kineme.methods.segmenter import SegmentOptions, segment_with_options
from kineme.recordings import Motion, Signals, Skeleton
from kineme.recordings.arrays import find_spans
from kineme.segments.hierarchy import DEFAULT_DETAIL
from kineme.segments.segmentation import Segmentation
from kineme.transfer.clusters import keep_numbers, list_spans

EXAMPLE_S = 8.0
"""Seconds of an activity that stand for its cluster."""
MOST_EXAMPLES = 12
"""Clusters that are recognised after they have left the recent past: the latest ones."""
LEAST_S = 1.0
"""Seconds that must be recorded before anything is looked at."""


@dataclass(frozen=True)
class Layout:
    """What the values of a frame are: channels by their names, or x, y, z of each joint."""

    fps: float
    channels: tuple[str, ...] = ()
    skeleton: Skeleton | None = None

    @property
    def n_values(self) -> int:
        """Return how many numbers a frame has."""
        return len(self.channels) if self.skeleton is None else 3 * self.skeleton.n_joints

    def make_recording(self, values: Floats, missing: Masks) -> Motion | Signals:
        """Return frames as a recording with gaps."""
        gaps = tuple((start, stop) for start, stop in find_spans(missing).tolist())
        if self.skeleton is None:
            return Signals(values, self.fps, self.channels, gaps)
        positions = values.reshape(len(values), -1, 3)
        return Motion(self.skeleton, positions, self.fps, gaps=gaps)


def choose_options(options: SegmentOptions, *, signals: bool) -> SegmentOptions:
    """Return options for looks at the recent past.

    Of the method's views the first is taken: a choice that may change from one look to the next
    would make other clusters of the same rows, and takes most of the time.
    """
    preset = options.resolved(signals=signals)
    if isinstance(preset, KinemeConstants):
        preset = preset.select_view(0)
    return replace(options, preset=preset, constants={})


@dataclass
class RecentPast:
    """Last frames of a stream, and what is remembered of those before.

    Attributes
    ----------
    layout : Layout
    options : SegmentOptions
        How the recent past is segmented; see `choose_options`.
    start : int
        Its first frame.
    values, missing : (frames, values) and (frames,) arrays
    examples : dict of int to (frames, values) array
        Of clusters, the one that was seen last at the end.
    known : (spans, 3) array
        First frame, frame after the last and cluster of what the last look found.
    """

    layout: Layout
    options: SegmentOptions
    start: int = 0
    values: Floats = field(default_factory=lambda: np.empty((0, 0)))
    missing: Masks = field(default_factory=lambda: np.empty(0, np.bool_))
    examples: dict[int, Floats] = field(default_factory=dict)
    known: Ints = field(default_factory=lambda: np.empty((0, 3), np.int64))
    _blocks: list[tuple[Floats, Masks]] = field(default_factory=list)

    def append(self, values: Floats, missing: Masks) -> None:
        """Add frames to the end."""
        self._blocks.append((values, missing))

    def collect(self) -> None:
        """Bring the frames that were added into one array."""
        if self._blocks:
            values, missing = zip(*self._blocks, strict=True)
            before = [self.values] if len(self.values) else []
            self.values = np.concatenate([*before, *values])
            self.missing = np.concatenate([self.missing, *missing])
            self._blocks = []

    def drop_before(self, frame: int) -> None:
        """Forget what lies before a frame."""
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
        following = max(finals.highest, *old[:, 2].tolist(), -1) + 1
        starts, stops, clusters = list_spans(columns, table.cluster)
        new = starts * fps + self.start, stops * fps + self.start, clusters
        given = keep_numbers(
            {0: (old[:, 0].astype(float), old[:, 1].astype(float), old[:, 2])},
            {0: new},
            following=following,
        )
        unseen = [local for local, number in given.items() if number > finals.highest]
        if unseen and self.examples:
            given |= self._recognise(found, unseen, set(given.values()))
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
        activities, primitives = (
            [Row(*row) for row in rows[chosen].tolist()] for chosen in (coarse, ~coarse)
        )
        return Look(activities, primitives)

    def keep_example(self, row: Row) -> None:
        """Remember the middle of an activity for its cluster."""
        self.collect()
        half = round(EXAMPLE_S * self.layout.fps / 2)
        middle = (row.start + row.stop) // 2
        first = max(row.start, middle - half, self.start) - self.start
        last = min(row.stop, middle + half) - self.start
        values = self.values[first : max(last, first)][~self.missing[first : max(last, first)]]
        before = self.examples.pop(row.cluster, values)
        # the latest one, unless it is much shorter
        kept = values if len(values) >= len(before) / 2 else before
        if len(kept):
            self.examples[row.cluster] = kept.copy()
        while len(self.examples) > MOST_EXAMPLES:
            del self.examples[next(iter(self.examples))]

    def _segment(self, values: Floats, missing: Masks) -> Segmentation:
        recording = self.layout.make_recording(values, missing)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", KinemeWarning)
            return segment_with_options(recording, self.options, details=(DEFAULT_DETAIL,))[0]

    def _known_spans(self, finals: Finals) -> Ints:
        """Spans of clusters in the recent past: final ones, and beyond those of the last look."""
        final = [row for row in finals.last_activities(self.start) if row.cluster >= 0]
        coming = self.known[self.known[:, 1] > finals.frontier].copy()
        coming[:, 0] = np.maximum(coming[:, 0], finals.frontier)
        return np.concatenate([np.array(final, np.int64).reshape(-1, 3), coming])

    def _recognise(self, found: Segmentation, unseen: list[int], taken: set[int]) -> dict[int, int]:
        """Return the numbers of clusters that are segmented together with an older example."""
        examples = {k: rows for k, rows in self.examples.items() if k not in taken}
        if not examples:
            return {}
        parts, missing, spans, first = [], [], {}, 0
        for number, rows in examples.items():
            spans[number] = slice(first, first + len(rows))
            # a frame that is missing keeps two examples apart
            parts += [rows, rows[-1:]]
            missing += [np.zeros(len(rows), np.bool_), np.ones(1, np.bool_)]
            first += len(rows) + 1
        together = self._segment(
            np.concatenate([*parts, self.values]), np.concatenate([*missing, self.missing])
        ).per_frame(level="activity")
        here = found.per_frame(level="activity")
        owners = {_mode(together[span]): number for number, span in spans.items()}
        recognised: dict[int, int] = {}
        for local in unseen:
            owner = owners.pop(_mode(together[first:][here == local]), None)
            if owner is not None:
                recognised[local] = owner
        return recognised


def _mode(clusters: Ints) -> int:
    """Return the cluster of most frames; -2 if there is none."""
    active = clusters[clusters >= 0]
    return int(np.bincount(active).argmax()) if len(active) else -2
