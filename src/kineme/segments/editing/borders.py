"""Move, insert and remove borders, and operate on rows of one level in time order.

An edit of a border changes only the activities around it (`Part`). The rest of the table, which may
have thousands of rows, is not touched.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from kineme.errors import ParameterError
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import COLUMNS, Level, Segment, choose_kind

Rows = list[Segment]


def move_border(segmentation: Segmentation, level: Level, frame: int, to: int) -> Segmentation:
    """Move the border at ``frame`` to ``to``, between the borders before and after it.

    If a border of activities passes borders of primitives, the last of these moves
    with it, and primitives between the others go to the activity that grew. A
    transition stays one primitive.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frame : int
        Frame of the border.
    to : int
        New frame of the border.

    Raises
    ------
    ParameterError
        There is no such border, or ``to`` is not between its neighbours.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> moved = move_border(found, "activity", 326, 330)
    >>> moved.cuts()[0].item(), moved.cuts("primitive")[4].item()
    (330, 330)
    """
    after = find_row_after(segmentation, level, frame)
    table = segmentation.level(level)
    # The neighbouring borders are the limits.
    low, high = table[after - 1].start_frame, table[after].stop_frame
    if not low < to < high:
        raise ParameterError(
            f"the {level} border at frame {frame} can move to {low + 1} to {high - 1}, not {to}"
        )
    if to == frame:
        return segmentation
    # Activities on both sides of the border, with their primitives.
    part = Part.of(segmentation, frame - 1, frame + 1)
    activities, primitives = part.activities, part.primitives
    if level == "primitive":
        # A border of activities moves together with that of primitives.
        if frame in list_cuts(activities):
            activities = move_border_rows(activities, frame, to)
        return part.insert(activities, move_border_rows(primitives, frame, to))
    moved = move_border_rows(activities, frame, to)
    if primitives:
        primitives = _reassign_primitives(primitives, activities, moved, frame, to)
    return part.insert(moved, primitives)


def split(segmentation: Segmentation, level: Level, frame: int) -> Segmentation:
    """Insert a border at ``frame``; both parts keep the properties of the segment.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frame : int
        First frame of the second part.

    Raises
    ------
    ParameterError
        There is already a border, or no segment of this level.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> split(found, "activity", 200).activities[:2].label.tolist()
    ['walk', 'walk']
    """
    table = segmentation.level(level)
    if not ((table.start_frame < frame) & (frame < table.stop_frame)).any():
        where = f"frame {frame} is not inside a segment of level {level!r}"
        raise ParameterError(f"{where}: choose a frame between two borders")
    part = Part.of(segmentation, frame, frame + 1)
    activities = cut(part.activities, frame) if level == "activity" else part.activities
    # A border of activities is also a border of primitives.
    return part.insert(activities, cut(part.primitives, frame))


def merge(segmentation: Segmentation, level: Level, start: int, stop: int) -> Segmentation:
    """Merge the segments of ``[start, stop)``; the kind, cluster and label are those of the first.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    start, stop : int
        First frame of the first segment, and end of the last one.

    Raises
    ------
    ParameterError
        The span does not begin and end at borders, has fewer than two segments, or has
        primitives of several activities.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> len(found.primitives), len(merge(found, "primitive", 0, 126).primitives)
    (38, 37)
    """
    table = segmentation.level(level)
    chosen = table.select((start <= table.start_frame) & (table.start_frame < stop))
    at_borders = (
        len(chosen) > 1 and chosen[0].start_frame == start and chosen[-1].stop_frame == stop
    )
    if not at_borders:
        raise ParameterError(
            f"frames {start} to {stop} are not two or more whole segments of level {level!r}"
        )
    part = Part.of(segmentation, start, stop)
    first = _find_row_index(part.get_rows(level), start)
    return _merge_rows(part, level, first, first + len(chosen) - 1, like=first)


def delete_border(segmentation: Segmentation, level: Level, frame: int) -> Segmentation:
    """Merge the two segments that meet at ``frame``, with the properties of the longer one.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frame : int
        Frame of the border.

    Raises
    ------
    ParameterError
        There is no such border, or it is also a border of activities.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> delete_border(found, "activity", 326).activities[0].stop_frame
    380
    """
    find_row_after(segmentation, level, frame)
    part = Part.of(segmentation, frame - 1, frame + 1)
    rows = part.get_rows(level)
    after = _find_row_index(rows, frame)
    longer = after if count_frames(rows[after]) > count_frames(rows[after - 1]) else after - 1
    return _merge_rows(part, level, after - 1, after, like=longer)


@dataclass(frozen=True)
class Part:
    """Activities that contain some frames, and their primitives.

    ``activity`` of these rows counts from the first of the activities. ``spans`` are the positions
    of both in the table.
    """

    segmentation: Segmentation
    activities: Rows
    primitives: Rows
    spans: tuple[slice, slice]

    @classmethod
    def of(cls, segmentation: Segmentation, start: int, stop: int) -> Part:
        """Return the part of the activities that overlap ``[start, stop)``."""
        table = segmentation.table
        # Activities come before primitives in the table.
        n = len(segmentation.activities)
        # The activity that contains the first frame, up to the last that begins before `stop`.
        first = int(np.searchsorted(table.start_frame[:n], start, "right")) - 1
        last = int(np.searchsorted(table.start_frame[:n], stop, "left"))
        # Primitives of these activities; their parents are sorted.
        low, high = (n + np.searchsorted(table.activity[n:], [first, last])).tolist()
        spans = slice(first, last), slice(low, high)
        activities, primitives = (
            [replace(row, activity=row.activity - first) for row in table[span]] for span in spans
        )
        return cls(segmentation, activities, primitives, spans)

    def get_rows(self, level: Level) -> Rows:
        """Return the rows of a level."""
        return self.activities if level == "activity" else self.primitives

    def insert(self, activities: Rows, primitives: Rows) -> Segmentation:
        """Return the whole segmentation with these rows in place of the part."""
        # Slices of both levels, in the order of the table.
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


def _merge_rows(part: Part, level: Level, first: int, last: int, *, like: int) -> Segmentation:
    """Merge rows ``first`` to ``last`` of a level into one with the properties of row ``like``."""
    activities, primitives = part.activities, [*part.primitives]
    if level == "primitive":
        if primitives[first].activity != primitives[last].activity:
            border = activities[primitives[first].activity].stop_frame
            raise ParameterError(
                f"the border at frame {border} is one of activities: delete it on that level"
            )
        return part.insert(activities, join_rows(primitives, first, last, like))
    merged = join_rows(activities, first, last, like)
    # Primitives of all merged activities belong to the merged one.
    inside = [i for i, row in enumerate(primitives) if first <= row.activity <= last]
    for i in inside:
        primitives[i] = change_parent(
            primitives[i], activities[primitives[i].activity], merged[first]
        )
    # A transition has only one primitive.
    if inside and merged[first].kind == "transition":
        primitives = join_rows(primitives, inside[0], inside[-1], inside[0])
    return part.insert(merged, primitives)


def _find_row_index(rows: Rows, frame: int) -> int:
    """Return the index of the row that starts at a frame."""
    return next(i for i, row in enumerate(rows) if row.start_frame == frame)


def find_segment_at(segmentation: Segmentation, level: Level, frame: int) -> Segment:
    """Return the segment of a level that starts at ``frame``, or raise ParameterError."""
    rows = segmentation.level(level)
    index = int(np.searchsorted(rows.start_frame, frame))
    if index == len(rows) or rows.start_frame[index] != frame:
        raise ParameterError(f"no segment of level {level!r} starts at frame {frame}")
    return rows[index]


def find_row_after(segmentation: Segmentation, level: Level, frame: int) -> int:
    """Return the index of the segment after the border, or raise ParameterError."""
    borders: list[int] = segmentation.cuts(level).tolist()
    if frame not in borders:
        nearest = min(borders, key=lambda border: abs(border - frame), default=None)
        hint = "there is none" if nearest is None else f"the nearest is at {nearest}"
        raise ParameterError(f"no border of level {level!r} is at frame {frame}; {hint}")
    return borders.index(frame) + 1


def move_border_rows(rows: Rows, frame: int, to: int) -> Rows:
    """Move the border at ``frame`` to ``to``."""
    return [
        # A changed span drops the confidence, a changed start also that of the border.
        replace(row, stop_frame=to, confidence=math.nan)
        if row.stop_frame == frame
        else replace(row, start_frame=to, confidence=math.nan, border_confidence=math.nan)
        if row.start_frame == frame
        else row
        for row in rows
    ]


def cut(rows: Rows, frame: int) -> Rows:
    """Split the row that contains ``frame``, if any, in two."""
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
    """Merge rows ``first`` to ``last`` to one, with the properties of row ``like``."""
    if first == last:
        return rows
    merged = replace(
        rows[like],
        start_frame=rows[first].start_frame,
        stop_frame=rows[last].stop_frame,
        confidence=math.nan,
        # The start is still that of the first row.
        border_confidence=rows[first].border_confidence,
    )
    return [*rows[:first], merged, *rows[last + 1 :]]


def _reassign_primitives(primitives: Rows, before: Rows, after: Rows, frame: int, to: int) -> Rows:
    """Update the primitives of two activities after the border between them has moved."""
    low, high = min(frame, to), max(frame, to)
    borders = list_cuts(primitives)
    # A border of activities must be one of primitives: move the nearest one that was passed.
    if to not in borders:
        crossed = [border for border in borders if low <= border <= high]
        primitives = move_border_rows(
            primitives, min(crossed, key=lambda border: abs(border - to)), to
        )
    # Indices of the activity that lost frames, and of the one that got them.
    gave, took = (0, 1) if to < frame else (1, 0)
    # Primitives that lie completely in the moved span.
    inside = [i for i, row in enumerate(primitives) if low <= row.start_frame < high]
    inside = [i for i in inside if primitives[i].stop_frame <= high]
    for i in inside:
        primitives[i] = change_parent(primitives[i], before[gave], after[took])
    # A transition has only one primitive: merge it with those that it got.
    if inside and after[took].kind == "transition":
        host = inside[-1] + 1 if to < frame else inside[0] - 1
        primitives = join_rows(primitives, min(host, inside[0]), max(host, inside[-1]), host)
    return primitives


def change_parent(row: Segment, before: Segment, after: Segment) -> Segment:
    """Move a primitive from one activity to another; see the package docstring for the rules."""
    # Kind, cluster and label follow the activity only if they were those of the old one.
    has_its_kind = (row.kind == "transition") == (before.kind == "transition")
    has_its_cluster = row.cluster >= 0 and row.cluster == before.cluster
    has_its_label = row.label != "" and row.label == before.label
    kind = choose_kind(row.level, transition=after.kind == "transition")
    new = replace(
        row,
        kind=kind if has_its_kind else row.kind,
        cluster=after.cluster if has_its_cluster else row.cluster,
        label=after.label if has_its_label else row.label,
    )
    # The confidence is that of kind and cluster.
    unchanged = (new.kind, new.cluster) == (row.kind, row.cluster)
    return new if unchanged else replace(new, confidence=math.nan)


def list_cuts(rows: Rows) -> list[int]:
    """Return the frames at which one row stops and the next starts."""
    return [row.start_frame for row in rows[1:]]


def count_frames(row: Segment) -> int:
    """Return the number of frames of a row."""
    return row.stop_frame - row.start_frame


def replace_rows(segmentation: Segmentation, rows: Sequence[Segment]) -> Segmentation:
    """Replace all rows; seconds and parents are computed from their frames."""
    return replace_columns(
        segmentation, {name: [getattr(row, name) for row in rows] for name in COLUMNS}
    )


def replace_columns(segmentation: Segmentation, columns: Mapping[str, ArrayLike]) -> Segmentation:
    """Replace all columns; seconds and parents are computed from frames."""
    return Segmentation.from_columns(
        {name: values for name, values in columns.items() if name != "activity"},
        n_frames=segmentation.n_frames,
        fps=segmentation.fps,
        provenance=segmentation.provenance,
        timings=segmentation.timings,
        annotation=segmentation.annotation,
    )


def renumber_clusters(segmentation: Segmentation, numbers: Mapping[int, int]) -> Segmentation:
    """Renumber clusters; segments of clusters without a new number are in none (-1)."""
    table = segmentation.table
    clusters = np.array([numbers.get(c, -1) for c in table.cluster.tolist()], np.int64)
    # Each row's `action` is the cluster of its activity.
    actions = clusters[table.level == "activity"][table.activity]
    changed = table.with_columns(cluster=clusters, action=actions)
    return replace(segmentation, table=changed, hierarchy=None)
