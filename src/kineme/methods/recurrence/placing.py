"""Occurrences in their place: among the activities, transitions and repetitions found before.

Periodic activities keep their repetitions. Elsewhere the primitives are the
occurrences and, between them, transitions. An occurrence is never cut: a border
between activities that falls into one moves to its nearer end.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kineme.methods.recurrence.occurrences import Occurrences
from kineme.methods.segments import by_first_appearance

Frames = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Segments:
    """Both levels of a recording, each from frame 0 to its end.

    Attributes
    ----------
    borders : (activities + 1,) array
        Of activities and the transitions between them.
    labels, confidence : (activities,) array
        Action of each and how sure it is; -1 and nan for transitions.
    primitives : (primitives + 1,) array
        Borders of the primitives, those of activities among them.
    clusters, agreement : (primitives,) array
        Cluster of each and how sure it is; -1 and nan for what is part of none.
    not_periodic : array of int
        Actions that do not repeat themselves back to back.
    """

    borders: Frames
    labels: Frames
    confidence: NDArray[np.float64]
    primitives: Frames
    clusters: Frames
    agreement: NDArray[np.float64]
    not_periodic: Frames


def of_actions(shares: NDArray[np.float64], borders: Frames, labels: Frames) -> NDArray[np.float64]:
    """For each segment the mean share over the time of its action; 0 in transitions."""
    lengths = np.diff(borders)
    known = labels >= 0
    times = np.bincount(labels[known], lengths[known])
    sums = np.bincount(labels[known], (shares * lengths)[known])
    means = np.zeros(len(labels))
    means[known] = (sums / np.maximum(times, 1))[labels[known]]
    return means


def placed(segments: Segments, found: Occurrences, free: NDArray[np.bool_]) -> Segments:
    """The segments with occurrences for primitives where no activity is periodic.

    Parameters
    ----------
    segments : Segments
    found : Occurrences
        Of the free segments; their clusters go on after those of the activities.
    free : (activities,) array of bool
        Transitions, and activities that are not periodic.

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
    parents = _place(borders, begin)
    before = _place(segments.primitives, begin)
    labels = by_first_appearance(segments.labels[old])
    numbers = np.full(segments.labels.max() + 2, -1)
    numbers[segments.labels[old] + 1] = labels
    clusters, agreement = numbers[segments.clusters[before] + 1], segments.agreement[before]
    clusters[free[parents]], agreement[free[parents]] = -1, np.nan
    if len(found):
        which = np.maximum(_place(found.starts, begin), 0)
        inside = (found.starts[which] <= begin) & (begin < found.stops[which])
        clusters[inside] = labels.max() + 1 + found.clusters[which[inside]]
        agreement[inside] = found.similarity[which[inside]]
    return Segments(
        borders,
        labels,
        segments.confidence[old],
        primitives,
        clusters,
        agreement,
        np.unique(numbers[segments.not_periodic + 1]),
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
