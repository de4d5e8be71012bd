"""Segments put into a segmentation as they are; those around them give way."""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import replace
from typing import get_args

import numpy as np

from kineme.segments.editing.rows import Rows, adopted, cut, cuts, joined, length, with_rows
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment, SegmentTable


def imposed(found: Segmentation, fixed: Rows) -> Segmentation:
    """The segmentation with these segments in it as they are."""
    by_level = {level: [row for row in fixed if row.level == level] for level in get_args(Level)}
    activities = _sparing(list(found.activities), by_level["primitive"])
    activities = _with_fixed(activities, by_level["activity"])
    if not len(found.primitives):
        return with_rows(found, activities, [])
    primitives = _cut_at(activities, list(found.primitives))
    for row in by_level["activity"]:
        primitives = _inside(primitives, row, found)
    primitives = _cut_at(activities, _with_fixed(primitives, by_level["primitive"]))
    return with_rows(found, activities, primitives)


def _cut_at(activities: Rows, primitives: Rows) -> Rows:
    """The primitives, none of which crosses a border of activities."""
    for border in cuts(activities):
        primitives = cut(primitives, border)
    return primitives


def _sparing(activities: Rows, primitives: Rows) -> Rows:
    """The activities, whose borders inside primitives that stay go to the nearer end of those."""
    starts = [row.start_frame for row in primitives]

    def moved(border: int) -> int:
        at = bisect_right(starts, border) - 1
        if at < 0 or border >= primitives[at].stop_frame:
            return border
        start, stop = _edges(primitives[at])
        return start if border - start <= stop - border else stop

    rows = [_spanning(row, moved(row.start_frame), moved(row.stop_frame)) for row in activities]
    return [row for row in rows if row.start_frame < row.stop_frame]


def _with_fixed(rows: Rows, fixed: Rows) -> Rows:
    """The rows with others in their place; what is left of less than half of a row is joined on."""
    edges = {_edges(one) for one in fixed}
    for one in fixed:
        start, stop = _edges(one)
        before = [row for row in rows if row.start_frame < start]
        after = [row for row in rows if row.stop_frame > stop]
        if before and before[-1].stop_frame > start:
            before = _shortened(before, -1, -2, (before[-1].start_frame, start), edges)
        if after and after[0].start_frame < stop:
            after = _shortened(after, 0, 1, (stop, after[0].stop_frame), edges)
        rows = [*before, one, *after]
    return rows


def _shortened(
    rows: Rows, at: int, beside: int, span: tuple[int, int], edges: set[tuple[int, int]]
) -> Rows:
    """A row with the frames that it keeps; they go to the row beside it if they are few."""
    row, rows = rows[at], list(rows)
    rows[at] = _spanning(row, *span)
    few = 2 * length(rows[at]) < length(row) and len(rows) > 1
    if few and _edges(rows[beside]) not in edges:
        i, j, k = (k % len(rows) for k in (min(at, beside), max(at, beside), beside))
        return joined(rows, min(i, j), max(i, j), k)
    return rows


def _inside(primitives: Rows, activity: Segment, found: Segmentation) -> Rows:
    """The primitives of an activity that stays, called what it is where they were what it was."""
    inside = [i for i, row in enumerate(primitives) if overlap(row, activity)]
    was = in_the_middle(found.activities, activity)
    if activity.kind == "transition" and was.kind != "transition":
        one = replace(activity, level="primitive", label="")
        return [*primitives[: inside[0]], one, *primitives[inside[-1] + 1 :]]
    for i in inside:
        primitives[i] = adopted(primitives[i], was, activity)
    return primitives


def in_the_middle(rows: SegmentTable, row: Segment) -> Segment:
    """The one of the rows of a level that holds the middle frame of another."""
    middle = (row.start_frame + row.stop_frame - 1) // 2
    return rows[int(np.searchsorted(rows.start_frame, middle, side="right")) - 1]


def overlap(row: Segment, other: Segment) -> int:
    """Frames that both have."""
    shared = min(row.stop_frame, other.stop_frame) - max(row.start_frame, other.start_frame)
    return max(shared, 0)


def _edges(row: Segment) -> tuple[int, int]:
    return row.start_frame, row.stop_frame


def _spanning(row: Segment, start: int, stop: int) -> Segment:
    """The row with other frames; where it starts anew its border has no confidence."""
    confidence = row.border_confidence if start == row.start_frame else math.nan
    return replace(row, start_frame=start, stop_frame=stop, border_confidence=confidence)
