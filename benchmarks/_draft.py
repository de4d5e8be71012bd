"""A draft of one method for bodies and sensors: a movement that repeats is told by one repetition.

The frame is the method for sensors: views, a tree of segments, the level and the clusters of the
shortest description. New is a second form of what a segment costs. Beside "samples that stay alike"
there is "a movement that repeats": of a segment that divides into even repetitions which the mean
of all others explains, whatever their size, most of its distances are not told again.

    told = 1 - max((window / period)^2, few / repetitions), less where repetitions are uneven

is the share that is saved. Means over a second see a fast movement as one thing anyway, so
only what lasts longer saves something; a few repetitions may be alike by chance. Grouping does not
see it: what is saved is taken off the cost of a level, so the tree decides where segments end.

Presets ``draft`` (bodies: one view) and ``draft_sensors`` (the nine views of sensors) are known to
`kineme.segment` once `register_draft` was called; ``benchmarks/sources.py`` does it.
Not a part of the package: ``benchmarks/notes/one_method.md`` says what it gives and what is open.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, NamedTuple
from unittest.mock import patch

import numpy as np
from numpy.typing import ArrayLike, NDArray

from _draft_kernels import explained, spread
from kineme._checks import as_features
from kineme.methods.hierarchy import analysis, tree
from kineme.methods.hierarchy._kernels import cheapest_grouping
from kineme.methods.hierarchy.found import HierarchyFound
from kineme.methods.hierarchy.level import Segments, _preference, joined
from kineme.methods.hierarchy.parts import part_ends
from kineme.methods.hierarchy.preset import SENSORS, HierarchyPreset
from kineme.methods.presets import PRESETS, register
from kineme.methods.recurrence.repeating._candidate_kernels import repetitions_between
from kineme.methods.recurrence.repeating.repetitions import Movement, _candidate, _dips, movement
from kineme.methods.samples import unstacked
from kineme.methods.segments import by_first_appearance

Floats = NDArray[np.float64]
Frames = NDArray[np.int64]

ALIKE = 0.5
"""Share of a repetition that the mean of the others explains at least."""
FEW = 3.0
"""Repetitions that may be alike by chance."""
PERIOD_S = 1.5
"""What repeats within this is one thing to samples already."""
LONGEST_S = 8.0
"""Longest repetition: what lasts longer is a course of activities."""
UNEVEN = 0.6
"""Standard deviation of the logarithms of durations from which on nothing is even."""
SPAN_S = (1.0, 90.0)
"""Shortest and longest segment that is asked whether it repeats; longer ones are so in parts."""
PLACES = 16
"""Along a repetition, at which the mean of the others is known."""


class Repeated(NamedTuple):
    """A division of a span into repetitions: its seconds, and the share that is saved."""

    start_s: float
    stop_s: float
    told: float


@dataclass
class Repeating:
    """Whether spans of a recording repeat; what was asked once is known.

    Attributes
    ----------
    rows : (frames, dims) array
        Poses or channels at the rate at which repetitions are counted.
    fps : float
    preset : HierarchyConstants
        With the constants of counting, for that rate.
    """

    rows: NDArray[np.float32]
    fps: float
    preset: HierarchyPreset
    known: dict[tuple[float, float], list[Repeated]] = field(default_factory=dict)

    def divisions(self, start_s: float, stop_s: float) -> list[Repeated]:
        """The divisions of a span by which something is told."""
        key = (start_s, stop_s)
        if key not in self.known:
            self.known[key] = list(self._divisions(start_s, stop_s))
        return self.known[key]

    def _divisions(self, start_s: float, stop_s: float) -> Iterator[Repeated]:
        if not SPAN_S[0] <= stop_s - start_s <= SPAN_S[1]:
            return
        rows = self.rows[round(start_s * self.fps) : round(stop_s * self.fps)]
        if len(rows) < PLACES:
            return
        along = movement(rows, self.preset.frames(self.preset.repetition_smoothing))
        for visits in _visits(rows, along, self.preset):
            durations = np.diff(visits) / self.fps
            if len(durations) < 2 or durations.max() > LONGEST_S:
                continue
            places = repetitions_between(along.poses, along.path, visits, PLACES)
            if explained(along.poses, along.path, visits, places) < ALIKE:
                continue
            found = _candidate(along, visits, self.preset, self.preset.centering)
            period, count = float(durations.mean()), len(durations) + found.before + found.after
            even = 1 - (float(np.log(durations).std()) / UNEVEN) ** 2
            told = max(even, 0.0) * (1 - max(min(PERIOD_S / period, 1) ** 2, min(FEW / count, 1)))
            if told > 0:
                first = start_s + visits[0] / self.fps - min(found.before, 1.0) * period
                last = start_s + visits[-1] / self.fps + min(found.after, 1.0) * period
                yield Repeated(max(first, start_s), min(last, stop_s), told)

    def saved(self, view: NDArray[np.float32], unit: float, start: int, stop: int) -> float:
        """Samples at the median distance that repetitions save a segment of the view."""
        rate = self.preset.rate
        return max(
            (
                each.told
                * spread(view, round(each.start_s * rate), round(each.stop_s * rate))
                / unit
                for each in self.divisions(start / rate, stop / rate)
            ),
            default=0.0,
        )


def _visits(
    rows: NDArray[np.float32], along: Movement, preset: HierarchyPreset
) -> Iterator[Frames]:
    """Frames at which a pose is visited, once per repetition; see `repeating.repetitions`."""
    references = np.unique(np.linspace(0, len(rows) - 1, min(preset.voters, len(rows))).astype(int))
    depths, centers = _dips(rows, references, preset)
    falls = depths - np.pad(depths[:, 1:], ((0, 0), (0, 1)))
    votes = np.diff(along.path)[references] @ falls
    votes[0] = 0
    for column in np.argsort(-votes, kind="stable")[: preset.counts_tried]:
        clear = np.argsort(-falls[:, column], kind="stable")[: preset.poses_tried]
        if votes[column] > 0:
            yield from np.sort(centers[clear[falls[clear, column] > 0], : column + 1], axis=1)


def segments_of(
    view: NDArray[np.float32], preset: HierarchyPreset, repeating: Repeating
) -> Segments:
    """The segments of a view at the level of the shortest description."""
    unit = tree.median_distance(view)
    width, cost = max(1, round(preset.samples(preset.max_fine))), preset.samples(preset.fine_cost)
    fine = tree.fine_borders(view, unit, width=width, cost=cost)
    sums = tree.between_segments(view, fine, unit)
    levels = tree.levels(fine, sums.copy())
    tried = {*range(min(len(levels), tree.EACH_LEVEL))}
    tried |= {int(i) for i in np.geomspace(1, len(levels), tree.LEVELS).astype(int) - 1}
    saved: dict[tuple[int, int], float] = {}
    best, cheapest = tree.Level(fine[[0, -1]], np.zeros(1, np.int64)), np.inf
    for level in (levels[i] for i in sorted(tried)):
        lengths = np.diff(fine[level]).astype(np.float64)
        inner = np.add.reduceat(np.add.reduceat(sums, level[:-1], 0), level[:-1], 1)
        alone = np.diag(inner) / (2 * lengths)
        told = 0.0
        for span, most in zip(pairwise(fine[level].tolist()), alone, strict=True):
            if span not in saved:
                saved[span] = repeating.saved(view, unit, *span)
            told += min(saved[span], most)
        labels = np.empty(len(lengths), np.int64)
        cost = cheapest_grouping(
            inner, lengths, preset.max_clusters, preset.samples(preset.segment_cost),
            preset.cluster_price(len(view)), preset.spread_share, labels,
        ) - told  # fmt: skip
        if cost < cheapest:
            cheapest, best = cost, tree.Level(fine[level], by_first_appearance(labels))
    shortest = round(preset.samples(preset.min_action))
    borders, labels = joined(best.borders, best.labels, shortest=shortest)
    return Segments(fine, borders, labels, _preference(fine, sums, best, borders))


@dataclass(frozen=True, kw_only=True)
class DraftPreset(HierarchyPreset):
    """The method for sensors with segments that may repeat."""

    def analyze(self, features: ArrayLike, **told: Any) -> HierarchyFound:
        rows = as_features(features)
        bare = unstacked(rows, self.offsets)
        channels = rows if bare is None else bare
        step = max(1, round(self.working_fps / self.counting_fps))
        counted = np.ascontiguousarray(channels[::step], np.float32)
        fps = self.working_fps / step
        counting = self.replace(working_fps=fps, centering=1.0)
        asked: dict[tuple[int, int], Repeating] = {}

        def in_parts(view: NDArray[np.float32], _: HierarchyPreset) -> list[Segments]:
            ends = part_ends(len(view), max(1, round(self.samples(self.part))))
            found = []
            for span in pairwise(ends):
                first, last = (round(end / self.rate * fps) for end in span)
                own = asked.setdefault(span, Repeating(counted[first:last], fps, counting))
                found.append(segments_of(view[slice(*span)], self, own))
            return found

        with patch.object(analysis, "_in_parts", in_parts):
            return super().analyze(features, **told)


def register_draft() -> None:
    """Make the presets ``draft``, for bodies, and ``draft_sensors`` known."""
    if "draft" in PRESETS:
        return
    values = {**SENSORS.parameters(), "help": "A draft of one method.", "unit": "any"}
    register(DraftPreset(**{**values, "name": "draft_sensors"}))
    one_view = {"shared": (1e4,), "weights": (0.5,), "restless_over": (0.0,), "centering": 1.0}
    counting = {"end_distance": 0.5, "end_scatter": 2.0}
    register(DraftPreset(**{**values, **one_view, **counting, "name": "draft"}))
