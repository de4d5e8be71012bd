"""The ``kineme`` method: what each stage finds, in frames of the working rate.

Nothing here knows what a skeleton is: any array of frames × dims will do.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import compress
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._checks import as_features
from kineme._threads import map_threads
from kineme.methods.confidence import probability
from kineme.methods.recurrence import change_points
from kineme.methods.recurrence.actions import Actions, refine
from kineme.methods.recurrence.ends import fitted_ends
from kineme.methods.recurrence.evidence import counted, evidence
from kineme.methods.recurrence.found import RecurrenceFound
from kineme.methods.recurrence.occurrences import occurrences
from kineme.methods.recurrence.parts import clusters_of_repetitions
from kineme.methods.recurrence.placing import Segments, of_actions, placed
from kineme.methods.recurrence.recurrence import (
    Recurrence,
    narrower,
    phase_windows,
    recurrence,
)
from kineme.methods.recurrence.repetitions import Repetitions, repetitions
from kineme.methods.recurrence.transitions import activity_ends
from kineme.methods.samples import unstacked
from kineme.methods.stages import Progress, stopwatch

if TYPE_CHECKING:
    from kineme.methods.recurrence.constants import RecurrenceConstants

Frames = NDArray[np.int64]

# Scales of signals before their unit is known.
_TINY, _HUGE = 1e-9, 1e9


def analyze_actions(
    features: ArrayLike, preset: RecurrenceConstants, *, progress: Progress | None = None
) -> RecurrenceFound:
    """Recurrence, actions and repetitions of a sequence of features.

    Parameters
    ----------
    features : (frames, dims) array
        Stacked poses at the working rate, scaled so that distances are body
        sizes: divided by the size of the body and by the root of the number
        of stacked poses.
    preset : RecurrenceConstants
    progress : callable, optional
        Called with the name of each stage before it runs.

    Returns
    -------
    RecurrenceFound

    Raises
    ------
    ParameterError
        Features of another shape, empty, or not finite.
    """
    rows = as_features(features)
    timings: dict[str, float] = {}
    stage = stopwatch(timings, progress)
    with stage("recurrence"):
        recurring = _recurrence(rows, preset, preset.min_scale, preset.max_scale)
        narrow = _narrower(recurring, preset)
    with stage("actions"):
        found = find_actions(recurring, narrow, preset)
        borders, labels, own = _activities(found, narrow, preset, len(rows))
    with stage("repetitions"):
        limits = found.borders * recurring.step
        repeating = _count(recurring, borders, labels, limits, preset)
        segments = _repeated(recurring, borders, labels, own, repeating, preset)
    with stage("occurrences"):
        segments = _with_occurrences(recurring, segments, preset)
    borders, labels, primitives = segments.borders, segments.labels, segments.primitives
    with stage("confidence"):
        repeats = segments.repeats
        shown = evidence(recurring, preset, borders, labels, segments.own, primitives, repeats)
    return RecurrenceFound(
        rows,
        recurring,
        preset,
        borders,
        labels,
        primitives,
        segments.clusters,
        segments.not_periodic,
        shown,
        narrow,
        timings,
    )


def find_actions(wide: Recurrence, narrow: Recurrence, preset: RecurrenceConstants) -> Actions:
    """Segments of one action each, in samples.

    Parameters
    ----------
    wide, narrow : Recurrence
        Of the same samples, with the phases of the preset and with those for short actions.
    preset : RecurrenceConstants
    """
    borders = change_points.divided(
        _segments(wide, preset),
        _segments(narrow, preset.narrowed()),
        narrow,
        softness=preset.merge_softness,
        least=preset.min_repetition,
        elsewhere=preset.distinct_share,
        min_length=max(1, preset.samples(preset.min_segment)),
    )
    labels = change_points.link(
        borders,
        wide,
        _poses(wide.features, preset.offsets) if preset.any_pace else wide.features,
        narrow=narrow.phase,
        gap_share=preset.link_gap,
        similarity=preset.link_similarity,
        softness=preset.link_softness,
        samples=preset.link_samples,
        least=preset.least_self_similarity,
        max_lag=None if preset.max_lag is None else preset.samples(preset.max_lag),
    )
    repeats = change_points.repeating(
        borders, labels, wide, softness=preset.merge_softness, least=preset.min_repetition
    )
    return refine(
        borders,
        np.where(repeats, labels, -1),
        narrow,
        switch_cost=preset.switch_cost * preset.working_fps / preset.step,
        no_action_cost=preset.no_action_cost,
        least_similarity=preset.least_similarity,
        least_own=preset.least_self_similarity,
        min_length=max(1, preset.samples(preset.min_action)),
        rounds=preset.rounds,
    )


def _segments(recurring: Recurrence, preset: RecurrenceConstants) -> Frames:
    """Borders between the samples that are similar, but for those between parts of one."""
    borders = change_points.change_points(
        recurring,
        penalty=preset.border_cost * preset.working_fps / preset.step,
        min_length=max(1, preset.samples(preset.min_segment)),
    )
    return change_points.merge_neighbors(
        borders,
        recurring,
        gap=preset.samples(preset.merge_gap),
        softness=preset.merge_softness,
        least=preset.merge_share,
    )


def recurrence_unit(features: NDArray[np.float64], preset: RecurrenceConstants) -> float:
    """The length in which the median sample of signals recurs at ``preset.recurs_at``.

    1 where nothing is long enough to recur.
    """
    scales = _recurrence(features, preset.replace(max_lag=None), _TINY, _HUGE).scales
    known = scales[scales < _HUGE / 2]
    if not len(known):
        return 1.0
    return max(float(np.median(known)), preset.exact_below) / preset.recurs_at


def _recurrence(
    features: NDArray[np.float64], preset: RecurrenceConstants, low: float, high: float
) -> Recurrence:
    reach = preset.window if preset.max_lag is None else min(preset.window, preset.max_lag)
    return recurrence(
        features,
        step=preset.step,
        width=max(1, preset.samples(reach)),
        phases=phase_windows(preset.samples(preset.phase), preset.phase_shares),
        rank=preset.samples(preset.recurrence_time),
        low=low,
        high=high,
        softness=preset.softness,
    )


def _narrower(wide: Recurrence, preset: RecurrenceConstants) -> Recurrence:
    """The recurrence by which short actions are told apart."""
    short = preset.narrowed()
    return narrower(
        wide,
        phases=phase_windows(short.samples(short.phase), short.phase_shares),
        rank=short.samples(short.recurrence_time),
        low=short.min_scale,
        high=short.max_scale,
    )


def _poses(features: NDArray[np.float32], offsets: tuple[float, ...]) -> NDArray[np.float32]:
    """The poses without their neighbours in time; all, if they were not stacked at the offsets."""
    bare = unstacked(features, offsets)
    if bare is None:
        return features
    poses: NDArray[np.float32] = bare * len(offsets) ** 0.5
    return poses


def _activities(
    found: Actions, recurring: Recurrence, preset: RecurrenceConstants, n: int
) -> tuple[Frames, Frames, NDArray[np.float64]]:
    """Borders, labels and confidence of activities and the transitions between them, in frames."""
    ends, begins = activity_ends(
        found,
        recurring,
        factor=preset.transition_factor,
        spread=preset.transition_spread,
        usual=preset.usual_quantile,
        longest=preset.samples(preset.max_transition),
        largest_share=preset.max_transition_share,
    )
    borders = np.column_stack([np.append(0, begins), np.append(ends, n)]).ravel()[:-1]
    labels = np.column_stack([found.labels, np.full_like(found.labels, -1)]).ravel()[:-1]
    confidence = np.repeat(found.confidence, 2)[:-1]
    filled = np.diff(borders, append=n) > 0
    borders, labels, confidence = borders[filled], labels[filled], confidence[filled]
    first = np.concatenate([[True], labels[1:] != labels[:-1]])
    confidence = np.where(labels < 0, np.nan, confidence)
    return np.append(borders[first], n), labels[first], confidence[first]


def _repeated(
    recurring: Recurrence,
    borders: Frames,
    labels: Frames,
    own: NDArray[np.float64],
    repeating: Sequence[Repetitions],
    preset: RecurrenceConstants,
) -> Segments:
    """Activities and their repetitions, with fitted ends."""
    n, known = len(recurring.features), labels >= 0
    ends = fitted_ends(
        recurring.features,
        borders[:-1][known],
        borders[1:][known],
        labels[known],
        [each.cuts for each in compress(repeating, known)],
        preset,
    )
    borders, activity = _tiled(n, ends.starts, ends.stops)
    primitives, repeated = _tiled(
        n, ends.firsts, ends.lasts, [borders, *(each.cuts for each in repeating)]
    )
    labels, own = np.append(labels[known], -1), np.append(own[known], np.nan)
    clusters = clusters_of_repetitions(
        _poses(recurring.features, preset.offsets), primitives, labels[repeated], repeated, preset
    )
    none = np.empty(0, np.int64)
    return Segments(borders, labels[activity], own[activity], primitives, clusters, none)


def _with_occurrences(
    recurring: Recurrence, segments: Segments, preset: RecurrenceConstants
) -> Segments:
    """Occurrences for primitives in transitions, and in actions whose counts are not probable.

    An action gives its repetitions up where occurrences explain more of it than these are
    probable. Transitions that are no more than the ends of two activities are left alone.
    """
    borders, labels = segments.borders, segments.labels
    parents, repeats, lengths = segments.parents, segments.repeats, np.diff(borders)
    counts, _ = counted(
        recurring.features, segments.primitives, parents, repeats, segments.own, preset
    )
    several = np.bincount(parents[repeats], minlength=len(labels)) > 1
    sure = of_actions(probability(counts, preset.count_weights), lengths * several, labels)
    ends = (labels < 0) & (lengths <= 2 * preset.frames(preset.max_transition))
    weak = (sure < preset.unsure_count) & ~ends
    looked_at = np.repeat(weak, lengths)
    found = occurrences(_poses(recurring.features, preset.offsets), looked_at, preset)
    explained = of_actions(found.explained(borders), lengths, labels)
    free = weak & ((labels < 0) | (explained > sure))
    return placed(segments, found.within(borders, free), free)


def _tiled(
    n: int, starts: Frames, stops: Frames, cuts: Sequence[Frames] = ()
) -> tuple[Frames, Frames]:
    """Borders from 0 to n with these spans and cuts among them, and the span of each segment.

    What lies in no span is in span -1.
    """
    borders: Frames = np.unique(np.concatenate([[0, n], starts, stops, *cuts]))
    spans = np.searchsorted(starts, borders[:-1], side="right") - 1
    inside = (spans >= 0) & (borders[:-1] < np.append(stops, 0)[spans])
    return borders, np.where(inside, spans, -1)


def _count(
    recurring: Recurrence,
    borders: Frames,
    labels: Frames,
    limits: Frames,
    preset: RecurrenceConstants,
) -> list[Repetitions]:
    """Repetitions of each activity; none in transitions.

    An activity's first and last repetition reach into its transitions, so it
    is counted from half-way to the limit of its action; cuts lie within it.
    """
    limits = np.append(limits[:-1], len(recurring.features))

    def count(segment: int) -> Repetitions:
        start, stop = int(borders[segment]), int(borders[segment + 1])
        if labels[segment] < 0:
            return Repetitions(np.empty(0, np.int64))
        action = int(np.searchsorted(limits, (start + stop) // 2, side="right")) - 1
        first = (start + min(start, int(limits[action]))) // 2
        last = (stop + max(stop, int(limits[action + 1]))) // 2
        found = repetitions(recurring.features, first, last, preset)
        inside = (start < found.cuts) & (found.cuts < stop)
        return replace(found, cuts=found.cuts[inside])

    return map_threads(count, range(len(labels)))
