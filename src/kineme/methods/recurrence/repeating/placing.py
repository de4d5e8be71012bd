"""Occurrences in their place: among the activities, transitions and repetitions found before.

Periodic activities keep their repetitions. Elsewhere the primitives are the
occurrences and, between them, transitions. An occurrence is never cut: a border
between activities that falls into one moves to its nearer end.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from kineme.methods.recurrence.repeating.occurrences import Occurrences
from kineme.methods.segments import by_first_appearance

Frames = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Segments:
    """Both levels of a recording, each from frame 0 to its end.

    Attributes
    ----------
    borders : (activities + 1,) array
        Of activities and the transitions between them.
    labels, own : (activities,) array
        Action of each, and how much more similar it is to that than to others; -1 and nan for
        transitions.
    primitives : (primitives + 1,) array
        Borders of the primitives, those of activities among them.
    clusters : (primitives,) array
        Cluster of each, -1 for what is part of none: actions, then parts of them, then what
        occurs.
    not_periodic : array of int
        Actions whose primitives are occurrences.
    """

    borders: Frames
    labels: Frames
    own: NDArray[np.float64]
    primitives: Frames
    clusters: Frames
    not_periodic: Frames

    @cached_property
    def parents(self) -> Frames:
        """The activity or transition that each primitive lies in."""
        return _place(self.borders, self.primitives[:-1])

    @cached_property
    def repeats(self) -> NDArray[np.bool_]:
        """Which primitives are repetitions."""
        actions = self.labels[self.parents]
        found: NDArray[np.bool_] = (self.clusters >= 0) & (actions >= 0)
        return found & ~np.isin(actions, self.not_periodic)

    @cached_property
    def counts(self) -> Frames:
        """Repetitions of each activity."""
        return np.bincount(self.parents[self.repeats], minlength=len(self.labels))


def of_actions(
    shares: NDArray[np.float64], weights: NDArray[np.integer], labels: Frames
) -> NDArray[np.float64]:
    """For each segment the weighted mean share of its action; 0 of transitions."""
    known = labels >= 0
    of_known = labels[known]
    total = np.bincount(of_known, weights[known])
    means = np.zeros(len(labels))
    sums = np.bincount(of_known, (shares * weights)[known])
    means[known] = (sums / np.maximum(total, 1))[of_known]
    return means


def interrupted(segments: Segments, standing: NDArray[np.bool_], least: float) -> NDArray[np.bool_]:
    """The activities of which half of the repetitions or more hold so many frames of standing."""
    own = segments.repeats
    before = np.append(0, np.cumsum(standing))
    held = np.diff(before[segments.primitives])[own] >= least
    number = np.bincount(segments.parents[own], held, minlength=len(segments.labels))
    return (number > 0) & (2 * number >= segments.counts)


def placed(segments: Segments, found: Occurrences, free: NDArray[np.bool_]) -> Segments:
    """The segments with occurrences for primitives where no activity is periodic.

    Parameters
    ----------
    segments : Segments
    found : Occurrences
        Of the free segments; their clusters go on after those of the activities.
    free : (activities,) array of bool
        Transitions, and activities of actions that are not periodic.

    Returns
    -------
    Segments
    """
    borders, old = _filled(_out_of(found, segments.borders), segments.labels)
    free = free[old]
    cuts = segments.primitives[:-1]
    cuts = cuts[~free[_place(borders, cuts)]]
    primitives = np.unique(np.concatenate([borders, cuts, found.starts, found.stops]))
    begin = primitives[:-1]
    labels = by_first_appearance(segments.labels[old])
    numbers = np.full(segments.labels.max(initial=-1) + 2, -1)
    numbers[segments.labels[old] + 1] = labels
    actions = int(labels.max(initial=-1)) + 1
    clusters = segments.clusters[_place(segments.primitives, begin)]
    clusters[free[_place(borders, begin)]] = -1
    parts = by_first_appearance(np.where(clusters < len(numbers) - 1, -1, clusters))
    clusters = np.where(parts < 0, numbers[np.where(parts < 0, clusters, -1) + 1], actions + parts)
    if len(found):
        which = np.maximum(_place(found.starts, begin), 0)
        inside = (found.starts[which] <= begin) & (begin < found.stops[which])
        first = actions + int(parts.max(initial=-1)) + 1
        clusters[inside] = first + found.clusters[which[inside]]
    loose = np.unique(labels[free & (labels >= 0)])
    return Segments(borders, labels, segments.own[old], primitives, clusters, loose)


def whole_activities(
    found: Occurrences, segments: Segments, free: NDArray[np.bool_], share: float
) -> Occurrences:
    """The occurrences, those alone in an activity of one repetition as long as it.

    Such an activity begins and ends where another movement does, if half of the set or more
    lie so in its action. Parameters are those of `placed`; ``share`` of the activity at least
    must be the occurrence.
    """
    borders = segments.borders
    place = _place(borders, (found.starts + found.stops) // 2)
    starts, stops = borders[place], borders[place + 1]
    inside = np.minimum(found.stops, stops) - np.maximum(found.starts, starts)
    single = free & (segments.labels >= 0) & (segments.counts == 1)
    alone = single & (np.bincount(place, minlength=len(free)) == 1)
    whole = alone[place] & (inside >= share * (stops - starts))
    together = found.clusters * (segments.labels.max(initial=-1) + 2) + segments.labels[place] + 1
    number = np.bincount(together, whole)[together]  # of its set and action
    whole &= 2 * number >= np.bincount(found.clusters)[found.clusters]
    starts = np.where(whole, np.minimum(starts, found.starts), found.starts)
    stops = np.where(whole, np.maximum(stops, found.stops), found.stops)
    starts[1:] = np.maximum(starts[1:], found.stops[:-1])
    stops[:-1] = np.minimum(stops[:-1], starts[1:])
    return replace(found, starts=starts, stops=stops)


def without_still(segments: Segments, time: NDArray[np.float64], least: float) -> Segments:
    """The segments without primitives in actions that neither repeat nor move.

    Parameters
    ----------
    segments : Segments
    time : (frames + 1,) array
        Seconds of movement up to each frame, and to the end.
    least : float
        Seconds of movement that a single repetition takes at least.
    """
    actions, own = segments.labels[segments.parents], segments.repeats
    lasting = np.diff(time[segments.primitives]) >= least
    several = segments.counts[segments.parents] > 1
    still = np.setdiff1d(actions[own], actions[own & (lasting | several)])
    return given_up(segments, still)


def without_few(segments: Segments, time: NDArray[np.float64], few: int, least: float) -> Segments:
    """The segments without single repetitions too few to recur, where primitives are what recurs.

    These are one that no other is like, and at most ``few`` that move for less than ``least``
    seconds in the mean.
    """
    if not len(segments.not_periodic):
        return segments
    of_activities, own = segments.parents, segments.repeats
    actions = segments.labels[of_activities][own]
    numbers = np.bincount(actions)
    moved = np.bincount(actions, np.diff(time[segments.primitives])[own])
    several = np.bincount(actions, segments.counts[of_activities][own] > 1) > 0
    hardly = (numbers <= few) & ~several & (moved < least * numbers)
    return given_up(segments, np.flatnonzero((numbers == 1) | hardly))


def given_up(segments: Segments, actions: Frames) -> Segments:
    """The segments without the repetitions of some actions."""
    if not len(actions):
        return segments
    own = segments.repeats & np.isin(segments.labels[segments.parents], actions)
    return replace(
        segments,
        clusters=np.where(own, -1, segments.clusters),
        not_periodic=np.union1d(segments.not_periodic, actions),
    )


def _place(borders: Frames, frames: Frames) -> Frames:
    """In which segment each frame lies."""
    places: Frames = np.searchsorted(borders, frames, side="right") - 1
    return places


def _filled(borders: Frames, labels: Frames) -> tuple[Frames, Frames]:
    """Borders of the segments that have frames, and which they are; equal neighbours are one."""
    kept = np.flatnonzero(np.diff(borders) > 0)
    kept = kept[np.append(True, labels[kept[1:]] != labels[kept[:-1]])]
    return np.append(borders[kept], borders[-1]), kept


def _out_of(found: Occurrences, borders: Frames) -> Frames:
    """The borders, those within an occurrence moved to its nearer end."""
    if not len(found):
        return borders
    which = np.maximum(_place(found.starts, borders), 0)
    starts, stops = found.starts[which], found.stops[which]
    inside = (starts < borders) & (borders < stops)
    nearer = np.where(borders - starts <= stops - borders, starts, stops)
    return np.where(inside, nearer, borders)
