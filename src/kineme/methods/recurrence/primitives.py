"""Primitives of the ``kineme`` method: repetitions of the activities, occurrences elsewhere.

All in frames of the features.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import compress
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme._threads import map_threads
from kineme.methods.recurrence.recurrence import Recurrence
from kineme.methods.recurrence.repeating.ends import fitted_ends
from kineme.methods.recurrence.repeating.occurrences import movement_time, occurrences, standing
from kineme.methods.recurrence.repeating.parts import clusters_of_repetitions
from kineme.methods.recurrence.repeating.placing import (
    Segments,
    given_up,
    interrupted,
    of_actions,
    placed,
    whole_activities,
    without_few,
    without_still,
)
from kineme.methods.recurrence.repeating.repetitions import Repetitions, repetitions
from kineme.methods.samples import single_poses

if TYPE_CHECKING:
    from kineme.methods.recurrence.constants import RecurrenceConstants

Floats = NDArray[np.float64]
Frames = NDArray[np.int64]


def count_repetitions(
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


def with_repetitions(
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
        single_poses(recurring.features, preset.offsets),
        primitives,
        labels[repeated],
        repeated,
        preset,
    )
    none = np.empty(0, np.int64)
    return Segments(borders, labels[activity], own[activity], primitives, clusters, none)


def with_occurrences(
    recurring: Recurrence, segments: Segments, counts: Floats, preset: RecurrenceConstants
) -> Segments:
    """Occurrences for primitives in transitions, and in actions whose counts are not probable.

    An activity with a single repetition has no count that could be, nor has one in half of
    whose repetitions somebody stands for long. An action gives its
    repetitions up where occurrences explain more of it than these are probable. Transitions
    that are no more than the ends of two activities are left alone. An action of single
    repetitions in which hardly anything moves has no primitives, nor has, where an action was
    given up, one of few single repetitions that move little, nor any where there are many
    activities of which none has a probable count or recurs.

    Parameters
    ----------
    recurring : Recurrence
    segments : Segments
        With repetitions for primitives.
    counts : (segments,) array
        How probable the count of each is.
    preset : RecurrenceConstants
    """
    poses = single_poses(recurring.features, preset.offsets)
    time = movement_time(poses, preset)
    segments = _occurring(poses, time, segments, counts, preset)
    seconds, least = time / preset.working_fps, preset.pair_factor * preset.min_recurrence
    segments = without_few(segments, seconds, preset.few_activities, least)
    return without_still(segments, seconds, preset.min_event)


def _occurring(
    poses: NDArray[np.float32],
    time: Floats,
    segments: Segments,
    counts: Floats,
    preset: RecurrenceConstants,
) -> Segments:
    """Occurrences for primitives where counts are not probable; see `with_occurrences`."""
    borders, labels = segments.borders, segments.labels
    lengths = np.diff(borders)
    ends = (labels < 0) & (lengths <= 2 * preset.frames(preset.max_transition))
    long = preset.frames(preset.max_stand) / 2
    back_to_back = (segments.counts > 1) & ~interrupted(segments, standing(time, preset), long)
    sure = of_actions(counts * back_to_back, np.ones_like(labels), labels)
    weak = (sure < preset.min_periodic) & ~ends
    if not weak.any():
        return segments
    # Where an activity is in question, what recurs is told by the whole recording.
    looked_at = np.repeat(weak | (weak & (labels >= 0)).any(), lengths)
    found = occurrences(poses, looked_at, preset)
    explained = of_actions(found.within(borders, weak).explained(borders), lengths, labels)
    free = weak & ((labels < 0) | (explained > sure))
    found = found.within(borders, free)
    if len(found):
        found = whole_activities(found, segments, free, preset.whole_share)
        return placed(segments, found, free)
    known = labels >= 0
    by_chance = known.sum() > preset.few_activities and weak[known].all()
    return given_up(segments, labels[known]) if by_chance else segments


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
