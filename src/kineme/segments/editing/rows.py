"""Rows of one level, in time order, and what an edit makes of them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from kineme.errors import ParameterError
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import COLUMNS, Level, Segment, kind_of

Rows = list[Segment]


def lanes(segmentation: Segmentation, level: Level) -> tuple[Rows, Rows, Rows]:
    """The rows of a level, and those of activities and of primitives."""
    names: tuple[Level, ...] = (level, "activity", "primitive")
    found = {name: list(segmentation.level(name)) for name in dict.fromkeys(names)}
    return found[level], found["activity"], found["primitive"]


def starting(segmentation: Segmentation, level: Level, frame: int) -> Segment:
    """The segment of a level that starts at ``frame``; ParameterError where none does."""
    rows = segmentation.level(level)
    at = int(np.searchsorted(rows.start_frame, frame))
    if at == len(rows) or rows.start_frame[at] != frame:
        raise ParameterError(f"no segment of level {level!r} starts at frame {frame}")
    return rows[at]


def moved(rows: Rows, frame: int, to: int) -> Rows:
    """The border at ``frame`` stands at ``to``."""
    return [
        replace(row, stop_frame=to, confidence=math.nan)
        if row.stop_frame == frame
        else replace(row, start_frame=to, confidence=math.nan, border_confidence=math.nan)
        if row.start_frame == frame
        else row
        for row in rows
    ]


def cut(rows: Rows, frame: int) -> Rows:
    """The row that ``frame`` lies in, if any, as two."""
    parts: Rows = []
    for row in rows:
        if row.start_frame < frame < row.stop_frame:
            parts.append(replace(row, stop_frame=frame, confidence=math.nan))
            row = replace(  # noqa: PLW2901
                row, start_frame=frame, confidence=math.nan, border_confidence=math.nan
            )
        parts.append(row)
    return parts


def joined(rows: Rows, first: int, last: int, like: int) -> Rows:
    """Rows ``first`` to ``last`` as one that is like one of them."""
    if first == last:
        return rows
    one = replace(
        rows[like],
        start_frame=rows[first].start_frame,
        stop_frame=rows[last].stop_frame,
        confidence=math.nan,
        border_confidence=rows[first].border_confidence,
    )
    return [*rows[:first], one, *rows[last + 1 :]]


def adopted(row: Segment, before: Segment, after: Segment) -> Segment:
    """A primitive that lay in one activity and lies in another."""
    same = (row.kind == "transition") == (before.kind == "transition")
    kind = kind_of(row.level, transition=after.kind == "transition")
    new = replace(
        row,
        kind=kind if same else row.kind,
        cluster=after.cluster if row.cluster == before.cluster >= 0 else row.cluster,
        label=after.label if row.label == before.label != "" else row.label,
    )
    unchanged = (new.kind, new.cluster) == (row.kind, row.cluster)
    return new if unchanged else replace(new, confidence=math.nan)


def as_transition(row: Segment) -> Segment:
    """The row as a transition, which is in no cluster."""
    return replace(row, kind="transition", cluster=-1, confidence=math.nan)


def as_movement(row: Segment) -> Segment:
    """The row as what its level says: an activity, or a primitive."""
    return replace(row, kind=row.level, confidence=math.nan)


def handed_over(primitives: Rows, before: Rows, after: Rows, move: tuple[int, int, int]) -> Rows:
    """The primitives once the border of activities (number, from, to) has moved."""
    number, frame, to = move
    low, high = min(frame, to), max(frame, to)
    borders = cuts(primitives)
    if to not in borders:
        passed = [border for border in borders if low <= border <= high]
        primitives = moved(primitives, min(passed, key=lambda border: abs(border - to)), to)
    gave, took = (number - 1, number) if to < frame else (number, number - 1)
    inside = [i for i, row in enumerate(primitives) if low <= row.start_frame < high]
    inside = [i for i in inside if primitives[i].stop_frame <= high]
    for i in inside:
        primitives[i] = adopted(primitives[i], before[gave], after[took])
    if inside and after[took].kind == "transition":
        host = inside[-1] + 1 if to < frame else inside[0] - 1
        primitives = joined(primitives, min(host, inside[0]), max(host, inside[-1]), host)
    return primitives


def cuts(rows: Rows) -> list[int]:
    """Where one row stops and the next starts."""
    return [row.start_frame for row in rows[1:]]


def after_border(rows: Rows, level: Level, frame: int) -> int:
    """The number of the segment after the border; ParameterError where there is none."""
    if frame not in cuts(rows):
        nearest = min(cuts(rows), key=lambda border: abs(border - frame), default=None)
        hint = "there is none" if nearest is None else f"the nearest is at {nearest}"
        raise ParameterError(f"no border of level {level!r} is at frame {frame}; {hint}")
    return next(i for i, row in enumerate(rows) if row.start_frame == frame)


def length(row: Segment) -> int:
    """Frames."""
    return row.stop_frame - row.start_frame


def with_rows(
    segmentation: Segmentation, activities: Iterable[Segment], primitives: Iterable[Segment]
) -> Segmentation:
    """The same recording with these rows; seconds and parents follow from their frames."""
    rows = [*activities, *primitives]
    return with_columns(
        segmentation, {name: [getattr(row, name) for row in rows] for name in COLUMNS}
    )


def with_columns(segmentation: Segmentation, columns: Mapping[str, ArrayLike]) -> Segmentation:
    """The same recording with these columns; seconds and parents follow from frames."""
    return Segmentation.from_columns(
        {name: values for name, values in columns.items() if name != "activity"},
        n_frames=segmentation.n_frames,
        fps=segmentation.fps,
        provenance=segmentation.provenance,
        timings=segmentation.timings,
        annotation=segmentation.annotation,
    )


def renumbered(segmentation: Segmentation, numbers: Mapping[int, int]) -> Segmentation:
    """The same segments, whose clusters have these numbers; those without one are in none."""
    table = segmentation.table
    clusters = np.array([numbers.get(c, -1) for c in table.cluster.tolist()], np.int64)
    actions = clusters[table.level == "activity"][table.activity]
    changed = table.with_columns(cluster=clusters, action=actions)
    return replace(segmentation, table=changed, hierarchy=None)
