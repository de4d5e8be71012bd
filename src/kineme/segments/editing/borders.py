"""Edit borders: move, split, merge and delete."""

from __future__ import annotations

from kineme.errors import ParameterError
from kineme.segments.editing.rows import (
    Part,
    Rows,
    change_parent,
    count_frames,
    cut,
    find_row_after,
    join_rows,
    list_cuts,
    move_border_rows,
    reassign_primitives,
)
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level


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

    Returns
    -------
    Segmentation

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
        primitives = reassign_primitives(primitives, activities, moved, (1, frame, to))
    return part.insert(moved, primitives)


def split(segmentation: Segmentation, level: Level, frame: int) -> Segmentation:
    """Insert a border at ``frame``; both parts keep the properties of the segment.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frame : int
        First frame of the second part.

    Returns
    -------
    Segmentation

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

    Returns
    -------
    Segmentation

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

    Returns
    -------
    Segmentation

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


def _find_row_index(rows: Rows, frame: int) -> int:
    """Return the index of the row that starts at a frame."""
    return next(i for i, row in enumerate(rows) if row.start_frame == frame)


def _merge_rows(part: Part, level: Level, first: int, last: int, *, like: int) -> Segmentation:
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
