"""Primitives: the repetitions of segments, and elsewhere what recurs anywhere.

All in frames of the working rate.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme._threads import map_threads
from kineme.methods.kineme import _repeating_kernels as kernels
from kineme.methods.kineme._repetition_kernels import repetitions_between
from kineme.methods.kineme.ends import fitted_ends
from kineme.methods.kineme.events import occurrences
from kineme.methods.kineme.likeness import linked, mean_repetitions
from kineme.methods.kineme.placing import Segments, of_actions, placed, without_still
from kineme.methods.kineme.repetitions import PLACES, Repetitions, movement, repetitions
from kineme.methods.segments import by_first_appearance

if TYPE_CHECKING:
    from kineme.methods.kineme.constants import KinemeConstants

Floats = NDArray[np.float64]
Frames = NDArray[np.int64]
Rows = NDArray[np.float32]


def with_repetitions(
    rows: Rows, starts: Frames, stops: Frames, labels: Frames, own: Floats, preset: KinemeConstants
) -> Segments:
    """Segments and their repetitions, the first and the last of which end where they fit.

    Parameters
    ----------
    rows : (frames, dims) array
        At the working rate.
    starts, stops : (segments,) array
        What lies between two segments is a transition.
    labels : (segments,) array
        Cluster of each.
    own : (segments,) array
        How much nearer each is to its own cluster than to the next.
    preset : KinemeConstants
    """

    def count(span: tuple[int, int]) -> Repetitions:
        return repetitions(rows, *span, preset)

    spans = list(zip(starts.tolist(), stops.tolist(), strict=True))
    cuts = [each.cuts for each in map_threads(count, spans)]
    ends = fitted_ends(rows, starts, stops, labels, cuts, preset)
    borders, segment = _tiled(len(rows), ends.starts, ends.stops)
    primitives, repeated = _tiled(len(rows), ends.firsts, ends.lasts, [borders, *cuts])
    labels, own = np.append(labels, -1), np.append(own, np.nan)
    none = np.empty(0, np.int64)
    return Segments(borders, labels[segment], own[segment], primitives, labels[repeated], none)


def with_clusters(rows: Rows, segments: Segments, preset: KinemeConstants) -> Segments:
    """Segments whose clusters are one movement at any pace; neighbours that are one are joined.

    Parameters
    ----------
    rows : (frames, dims) array
        At the working rate.
    segments : Segments
        With repetitions.
    preset : KinemeConstants
    """
    movements = mean_repetitions(rows, segments, preset)
    labels = linked(segments.labels, movements, preset.same)
    if (labels == segments.labels).all():
        return segments
    known = np.flatnonzero(labels >= 0)
    first = np.flatnonzero(np.diff(labels[known], prepend=-1))
    starts = segments.borders[:-1][known[first]]
    stops = segments.borders[1:][known[np.append(first[1:], len(known)) - 1]]
    own = np.array([part.mean() for part in np.split(segments.own[known], first[1:])])
    return with_repetitions(
        rows, starts, stops, by_first_appearance(labels[known[first]]), own, preset
    )


def explained(rows: Rows, segments: Segments, preset: KinemeConstants) -> Floats:
    """The share of each segment's repetitions that the mean of the others explains; 0 of one."""
    found = np.zeros(len(segments.labels))
    ends = np.searchsorted(segments.parents, np.arange(len(found) + 1))

    def judge(segment: int) -> None:
        inside = np.flatnonzero(segments.repeats[ends[segment] : ends[segment + 1]])
        edges = segments.primitives[ends[segment] + inside[0] : ends[segment] + inside[-1] + 2]
        along = movement(rows[edges[0] : edges[-1]], preset)
        visits = edges - edges[0]
        repeated = repetitions_between(along.poses, along.path, visits, PLACES)
        kernels.center(repeated)
        found[segment] = kernels.explained(along.poses, along.path, visits, repeated)

    map_threads(judge, np.flatnonzero(segments.counts > 1).tolist())
    return found


def with_events(rows: Rows, segments: Segments, preset: KinemeConstants) -> Segments:
    """Occurrences for primitives, where no segment repeats.

    A segment whose repetitions explain each other keeps them. The others give theirs up where
    occurrences explain more. Segments that are one repetition in which nothing moves have no
    primitives.

    Parameters
    ----------
    rows : (frames, dims) array
        At the working rate, in body sizes.
    segments : Segments
    preset : KinemeConstants
    """
    told = explained(rows, segments, preset)
    told = of_actions(told, np.ones_like(segments.labels), segments.labels)
    weak = told < preset.alike
    if weak.any():
        lengths = np.diff(segments.borders)
        looked_at = np.repeat(weak | (weak & (segments.labels >= 0)).any(), lengths)
        found = occurrences(rows, looked_at, preset)
        recurring = found.within(segments.borders, weak).explained(segments.borders)
        recurring = of_actions(recurring, lengths, segments.labels)
        free = weak & ((segments.labels < 0) | (recurring > told))
        found = found.within(segments.borders, free)
        if len(found):
            segments = placed(segments, found, free)
    return without_still(segments, rows, preset.event_scale / 4)


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
