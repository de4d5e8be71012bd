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

from kineme.methods.kineme.events import Occurrences
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


def without_still(segments: Segments, rows: NDArray[np.float32], near: float) -> Segments:
    """The segments without primitives in actions that neither repeat nor move.

    Parameters
    ----------
    segments : Segments
    rows : (frames, dims) array
    near : float
        Who gets no farther than this from the mean pose of a repetition does not move.
    """
    actions, own = segments.labels[segments.parents], segments.repeats
    several = segments.counts[segments.parents] > 1
    moves = np.array([_reach(part) > near for part in np.split(rows, segments.primitives[1:-1])])
    still = np.setdiff1d(actions[own], actions[own & (moves | several)])
    return given_up(segments, still)


def _reach(rows: NDArray[np.float32]) -> float:
    """The largest distance of a row from their mean."""
    return float(np.linalg.norm(rows - rows.mean(axis=0), axis=1).max())


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
