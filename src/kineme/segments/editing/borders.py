"""Where segments of a level meet: borders moved, made and taken away."""

from __future__ import annotations

from kineme.errors import ParameterError
from kineme.segments.editing.rows import (
    Part,
    Rows,
    change_parent,
    count_frames,
    cut,
    find_row_after,
    hand_over,
    join_rows,
    list_cuts,
    move_border_rows,
)
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level


def move_border(segmentation: Segmentation, level: Level, frame: int, to: int) -> Segmentation:
    """Move the border at ``frame`` to ``to``, between those before and after it.

    Of the primitive borders that an activity's border passes, the last one
    moves with it; primitives between the others go to the activity that grew.
    A transition stays one primitive.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frame : int
        Where the border is.
    to : int
        Where it goes.

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
    # The borders before and after the one that moves are its limits.
    low, high = table[after - 1].start_frame, table[after].stop_frame
    if not low < to < high:
        raise ParameterError(
            f"the {level} border at frame {frame} can move to {low + 1} to {high - 1}, not {to}"
        )
    if to == frame:
        return segmentation
    # The activities at both sides of the border, with their primitives.
    part = Part.of(segmentation, frame - 1, frame + 1)
    activities, primitives = part.activities, part.primitives
    if level == "primitive":
        # A border of activities is one of primitives, too, and both move together.
        if frame in list_cuts(activities):
            activities = move_border_rows(activities, frame, to)
        return part.replaced(activities, move_border_rows(primitives, frame, to))
    wider = move_border_rows(activities, frame, to)
    if primitives:
        primitives = hand_over(primitives, activities, wider, (1, frame, to))
    return part.replaced(wider, primitives)


def split(segmentation: Segmentation, level: Level, frame: int) -> Segmentation:
    """Return a new border at ``frame``; both parts are called what the whole was.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frame : int
        The first of the second part.

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        There is a border already, or no segment of that level.

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
    # Primitives are cut as well, since a border of activities is one of primitives.
    return part.replaced(activities, cut(part.primitives, frame))


def merge(segmentation: Segmentation, level: Level, start: int, stop: int) -> Segmentation:
    """Return the segments of ``[start, stop)`` as one of the kind, cluster and label of the first.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    start, stop : int
        Where the first of the segments starts and the last stops, frames.

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        The span does not begin and end at borders, holds fewer than two segments, or
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
    first = _number(part.of_level(level), start)
    return _merge_rows(part, level, first, first + len(chosen) - 1, like=first)


def delete_border(segmentation: Segmentation, level: Level, frame: int) -> Segmentation:
    """Return the two segments that meet at ``frame`` as one: the longer takes the other.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frame : int
        Where the border is.

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        There is no such border, or it is one of activities, too.

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
    rows = part.of_level(level)
    after = _number(rows, frame)
    longer = after if count_frames(rows[after]) > count_frames(rows[after - 1]) else after - 1
    return _merge_rows(part, level, after - 1, after, like=longer)


def _number(rows: Rows, frame: int) -> int:
    """Return the number of the row that starts there."""
    return next(i for i, row in enumerate(rows) if row.start_frame == frame)


def _merge_rows(part: Part, level: Level, first: int, last: int, *, like: int) -> Segmentation:
    activities, primitives = part.activities, [*part.primitives]
    if level == "primitive":
        if primitives[first].activity != primitives[last].activity:
            border = activities[primitives[first].activity].stop_frame
            raise ParameterError(
                f"the border at frame {border} is one of activities: delete it on that level"
            )
        return part.replaced(activities, join_rows(primitives, first, last, like))
    merged = join_rows(activities, first, last, like)
    # Primitives of all joined activities become those of the union.
    inside = [i for i, row in enumerate(primitives) if first <= row.activity <= last]
    for i in inside:
        primitives[i] = change_parent(
            primitives[i], activities[primitives[i].activity], merged[first]
        )
    # A transition is one primitive.
    if inside and merged[first].kind == "transition":
        primitives = join_rows(primitives, inside[0], inside[-1], inside[0])
    return part.replaced(merged, primitives)
