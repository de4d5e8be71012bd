"""Labels for a recording in which nothing repeats itself, by a search for every known primitive.

A recording that is too short has no activities, so there is nothing to name. Its features are
searched for each labelled primitive (see `kineme.transfer.subsequences.search`); of matches that
overlap, the nearest stays. Matches of one label that follow each other are the primitives of one
activity.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme.segments.editing.rows import replace_rows
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment, kind_of
from kineme.transfer.knowledge import FPS, KnowledgeBase
from kineme.transfer.subsequences import search

Row = tuple[int, int, str]

_FOLLOWS_S = 0.3  # matches of one label this near to each other are of one activity


class Found(NamedTuple):
    """Where, in samples, a labelled primitive was found, and its distance."""

    start: int
    stop: int
    label: str
    distance: float


def found_by_search(
    features: NDArray[np.floating], knowledge: KnowledgeBase, threshold: float
) -> list[Found]:
    """Matches of labelled primitives that do not overlap, in time order."""
    borders = np.concatenate([[0], np.cumsum(knowledge.lengths)])
    matches: list[Found] = []
    for label, start, stop in zip(knowledge.labels, borders[:-1], borders[1:], strict=True):
        found = search(knowledge.features[start:stop], features, threshold=threshold)
        spans = zip(*(column.tolist() for column in found), strict=True)
        matches += [Found(a, b, str(label), distance) for a, b, distance in spans]
    occupied = np.zeros(len(features), np.bool_)
    kept = []
    for match in sorted(matches, key=lambda match: match.distance):
        if not occupied[match.start : match.stop].any():
            occupied[match.start : match.stop] = True
            kept.append(match)
    return sorted(kept)


def segmented_as_found(segmentation: Segmentation, found: list[Found]) -> Segmentation:
    """The recording cut into what was found: labelled activities and primitives."""
    frames_per_sample = segmentation.fps / FPS
    primitives: list[Row] = []
    for match in found:
        start = round(match.start * frames_per_sample)
        stop = min(round(match.stop * frames_per_sample), segmentation.n_frames)
        if primitives and primitives[-1][2] == match.label:
            last = primitives[-1]
            if start - last[1] <= _FOLLOWS_S * segmentation.fps:
                primitives[-1] = (last[0], start, last[2])
        primitives.append((start, stop, match.label))
    activities: list[Row] = []
    for start, stop, label in primitives:
        follows = bool(activities) and activities[-1][1:] == (start, label)
        activities.append((activities.pop()[0] if follows else start, stop, label))
    names = {label: number for number, label in enumerate(sorted({row[2] for row in activities}))}
    levels: tuple[tuple[Level, list[Row]], ...]
    levels = ("activity", activities), ("primitive", primitives)
    rows = [
        Segment(
            level,
            kind_of(level, transition=not label),
            start,
            stop,
            start / segmentation.fps,
            stop / segmentation.fps,
            cluster=names.get(label, -1),
            label=label,
        )
        for level, spans in levels
        for start, stop, label in _fill_between(spans, segmentation.n_frames)
    ]
    return replace_rows(segmentation, rows, [])


def _fill_between(rows: list[Row], n_frames: int) -> list[Row]:
    """Return the rows, and what lies between them without a label."""
    tiled: list[Row] = []
    at = 0
    for start, stop, label in [*rows, (n_frames, n_frames, "")]:
        if start > at:
            tiled.append((at, start, ""))
        if stop > start:
            tiled.append((start, stop, label))
        at = stop
    return tiled
