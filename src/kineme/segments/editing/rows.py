"""Rows of one level, in time order, and what an edit makes of them.

An edit of a border reaches the activities about it and no others (`Part`): the rest of a table, of
thousands of rows, stays as it is.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from kineme.errors import ParameterError
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import COLUMNS, Level, Segment, choose_kind

Rows = list[Segment]


@dataclass(frozen=True)
class Part:
    """Activities that hold some frames, and their primitives.

    ``activity`` of their rows counts from the first of these; ``spans`` are their rows in the
    table.
    """

    segmentation: Segmentation
    activities: Rows
    primitives: Rows
    spans: tuple[slice, slice]

    @classmethod
    def of(cls, segmentation: Segmentation, start: int, stop: int) -> Part:
        """That of the frames ``[start, stop)``."""
        table = segmentation.table
        # Activities come before primitives in the table.
        n = len(segmentation.activities)
        # The activity that holds the first frame, and the end of those that begin before `stop`.
        first = int(np.searchsorted(table.start_frame[:n], start, "right")) - 1
        last = int(np.searchsorted(table.start_frame[:n], stop, "left"))
        # Primitives of these activities: their parents are in order.
        low, high = (n + np.searchsorted(table.activity[n:], [first, last])).tolist()
        spans = slice(first, last), slice(low, high)
        activities, primitives = (
            [replace(row, activity=row.activity - first) for row in table[span]] for span in spans
        )
        return cls(segmentation, activities, primitives, spans)

    def of_level(self, level: Level) -> Rows:
        """Its rows of a level."""
        return self.activities if level == "activity" else self.primitives

    def replaced(self, activities: Rows, primitives: Rows) -> Segmentation:
        """Return the whole, with these rows in the place of its own."""
        # The slices of both levels, in the order of the table.
        (before, first), (last, after) = [(span.start, span.stop) for span in self.spans]
        columns = {}
        for name, column in self.segmentation.table.columns().items():
            upper, lower = (
                # An empty slice keeps the type of the column.
                np.array([getattr(row, name) for row in rows]) if rows else column[:0]
                for rows in (activities, primitives)
            )
            parts = column[:before], upper, column[first:last], lower, column[after:]
            columns[name] = np.concatenate(parts)
        return replace_columns(self.segmentation, columns)


def find_starting(segmentation: Segmentation, level: Level, frame: int) -> Segment:
    """Return the segment of a level that starts at ``frame``; ParameterError where none does."""
    rows = segmentation.level(level)
    at = int(np.searchsorted(rows.start_frame, frame))
    if at == len(rows) or rows.start_frame[at] != frame:
        raise ParameterError(f"no segment of level {level!r} starts at frame {frame}")
    return rows[at]


def move_border_rows(rows: Rows, frame: int, to: int) -> Rows:
    """Move the border at ``frame`` to ``to``."""
    return [
        # The end moved: the span is another one. Where the start moved, so is the border.
        replace(row, stop_frame=to, confidence=math.nan)
        if row.stop_frame == frame
        else replace(row, start_frame=to, confidence=math.nan, border_confidence=math.nan)
        if row.start_frame == frame
        else row
        for row in rows
    ]


def cut(rows: Rows, frame: int) -> Rows:
    """Return the row that ``frame`` lies in, if any, as two."""
    parts: Rows = []
    for row in rows:
        if row.start_frame < frame < row.stop_frame:
            parts.append(replace(row, stop_frame=frame, confidence=math.nan))
            row = replace(  # noqa: PLW2901
                row, start_frame=frame, confidence=math.nan, border_confidence=math.nan
            )
        parts.append(row)
    return parts


def join_rows(rows: Rows, first: int, last: int, like: int) -> Rows:
    """Rows ``first`` to ``last`` as one that is like one of them."""
    if first == last:
        return rows
    one = replace(
        rows[like],
        start_frame=rows[first].start_frame,
        stop_frame=rows[last].stop_frame,
        confidence=math.nan,
        # Only the first border is still one.
        border_confidence=rows[first].border_confidence,
    )
    return [*rows[:first], one, *rows[last + 1 :]]


def change_parent(row: Segment, before: Segment, after: Segment) -> Segment:
    """Return a primitive that lay in one activity and lies in another."""
    # A primitive that was a transition within an activity stays one, and the other way round.
    same = (row.kind == "transition") == (before.kind == "transition")
    kind = choose_kind(row.level, transition=after.kind == "transition")
    new = replace(
        row,
        kind=kind if same else row.kind,
        cluster=after.cluster if row.cluster == before.cluster >= 0 else row.cluster,
        label=after.label if row.label == before.label != "" else row.label,
    )
    # The confidence is of kind and cluster.
    unchanged = (new.kind, new.cluster) == (row.kind, row.cluster)
    return new if unchanged else replace(new, confidence=math.nan)


def as_transition(row: Segment) -> Segment:
    """Return the row as a transition, which is in no cluster."""
    return replace(row, kind="transition", cluster=-1, confidence=math.nan)


def as_movement(row: Segment) -> Segment:
    """Return the row as what its level says: an activity, or a primitive."""
    return replace(row, kind=row.level, confidence=math.nan)


def hand_over(primitives: Rows, before: Rows, after: Rows, move: tuple[int, int, int]) -> Rows:
    """Return the primitives once the border of activities (number, from, to) has moved."""
    number, frame, to = move
    low, high = min(frame, to), max(frame, to)
    borders = list_cuts(primitives)
    # A border of activities must be one of primitives: the nearest one passed moves there.
    if to not in borders:
        passed = [border for border in borders if low <= border <= high]
        primitives = move_border_rows(
            primitives, min(passed, key=lambda border: abs(border - to)), to
        )
    # The activity that lost frames, and the one that got them.
    gave, took = (number - 1, number) if to < frame else (number, number - 1)
    # Primitives that lie wholly in what changed hands.
    inside = [i for i, row in enumerate(primitives) if low <= row.start_frame < high]
    inside = [i for i in inside if primitives[i].stop_frame <= high]
    for i in inside:
        primitives[i] = change_parent(primitives[i], before[gave], after[took])
    # A transition is one primitive: what it took is joined to its own.
    if inside and after[took].kind == "transition":
        host = inside[-1] + 1 if to < frame else inside[0] - 1
        primitives = join_rows(primitives, min(host, inside[0]), max(host, inside[-1]), host)
    return primitives


def list_cuts(rows: Rows) -> list[int]:
    """Where one row stops and the next starts."""
    return [row.start_frame for row in rows[1:]]


def find_row_after(segmentation: Segmentation, level: Level, frame: int) -> int:
    """Return the number of the segment after the border; ParameterError where there is none."""
    borders: list[int] = segmentation.cuts(level).tolist()
    if frame not in borders:
        nearest = min(borders, key=lambda border: abs(border - frame), default=None)
        hint = "there is none" if nearest is None else f"the nearest is at {nearest}"
        raise ParameterError(f"no border of level {level!r} is at frame {frame}; {hint}")
    return borders.index(frame) + 1


def count_frames(row: Segment) -> int:
    """Frames."""
    return row.stop_frame - row.start_frame


def replace_rows(
    segmentation: Segmentation, activities: Iterable[Segment], primitives: Iterable[Segment]
) -> Segmentation:
    """Return the same recording with these rows; seconds and parents follow from their frames."""
    rows = [*activities, *primitives]
    return replace_columns(
        segmentation, {name: [getattr(row, name) for row in rows] for name in COLUMNS}
    )


def replace_columns(segmentation: Segmentation, columns: Mapping[str, ArrayLike]) -> Segmentation:
    """Return the same recording with these columns; seconds and parents follow from frames."""
    return Segmentation.from_columns(
        # Parents follow from the frames.
        {name: values for name, values in columns.items() if name != "activity"},
        n_frames=segmentation.n_frames,
        fps=segmentation.fps,
        provenance=segmentation.provenance,
        timings=segmentation.timings,
        annotation=segmentation.annotation,
    )


def renumber_clusters(segmentation: Segmentation, numbers: Mapping[int, int]) -> Segmentation:
    """Give the clusters these numbers; segments of clusters without one are in none."""
    table = segmentation.table
    clusters = np.array([numbers.get(c, -1) for c in table.cluster.tolist()], np.int64)
    # Each row's `action` is the cluster of its activity.
    actions = clusters[table.level == "activity"][table.activity]
    changed = table.with_columns(cluster=clusters, action=actions)
    return replace(segmentation, table=changed, hierarchy=None)
