"""Corrections by hand: each edit gives a new segmentation, in which every level still tiles.

A border is a frame where one segment of a level stops and the next starts. The
borders of activities are borders of primitives, too, where there are any, and
stay so: what is done to an activity is done to the primitives at its ends. A
primitive that comes to lie in another activity keeps its own cluster and label
where they differ from those of the activity it was in; what it had in common
with that one it has in common with the new one.

A person's word has no score: segments whose span, kind or cluster was changed
lose theirs.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import get_args

from kineme.errors import ParameterError
from kineme.segments.edited_rows import (
    adopted,
    after_border,
    as_activity,
    as_transition,
    cut,
    cuts,
    handed_over,
    joined,
    length,
    moved,
)
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import COLUMNS, Kind, Level, Segment


def move_border(segmentation: Segmentation, level: Level, frame: int, to: int) -> Segmentation:
    """The border at ``frame`` stands at ``to``, between those before and after it.

    Of the primitive borders that an activity's border passes, the last one
    moves with it; primitives between the others go to the activity that grew.
    A transition stays one primitive.

    Raises
    ------
    ParameterError : there is no such border, or ``to`` is not between its neighbours
    """
    rows = list(segmentation.level(level))
    after = after_border(rows, level, frame)
    low, high = rows[after - 1].start_frame, rows[after].stop_frame
    if not low < to < high:
        raise ParameterError(
            f"the {level} border at frame {frame} can move to {low + 1} to {high - 1}, not {to}"
        )
    if to == frame:
        return segmentation
    activities, primitives = list(segmentation.activities), list(segmentation.primitives)
    if level == "primitive":
        if frame in cuts(activities):
            activities = moved(activities, frame, to)
        return _with(segmentation, activities, moved(primitives, frame, to))
    wider = moved(activities, frame, to)
    if primitives:
        primitives = handed_over(primitives, activities, wider, (after, frame, to))
    return _with(segmentation, wider, primitives)


def split(segmentation: Segmentation, level: Level, frame: int) -> Segmentation:
    """A new border at ``frame``; both parts are called what the whole was.

    Raises
    ------
    ParameterError : there is a border already, or no segment of that level
    """
    rows = list(segmentation.level(level))
    if not any(row.start_frame < frame < row.stop_frame for row in rows):
        where = f"frame {frame} is not inside a segment of level {level!r}"
        raise ParameterError(f"{where}: choose a frame between two borders")
    activities, primitives = list(segmentation.activities), list(segmentation.primitives)
    if level == "activity":
        activities = cut(activities, frame)
    return _with(segmentation, activities, cut(primitives, frame))


def merge(segmentation: Segmentation, level: Level, start: int, stop: int) -> Segmentation:
    """The segments of ``[start, stop)`` as one of the kind, cluster and label of the first.

    Raises
    ------
    ParameterError : the span does not begin and end at borders or holds fewer than two
        segments, or primitives of several activities
    """
    rows = list(segmentation.level(level))
    chosen = [i for i, row in enumerate(rows) if start <= row.start_frame < stop]
    whole = (
        len(chosen) > 1
        and rows[chosen[0]].start_frame == start
        and rows[chosen[-1]].stop_frame == stop
    )
    if not whole:
        raise ParameterError(
            f"frames {start} to {stop} are not two or more whole segments of level {level!r}"
        )
    return _merged(segmentation, level, chosen[0], chosen[-1], like=chosen[0])


def delete_border(segmentation: Segmentation, level: Level, frame: int) -> Segmentation:
    """The two segments that meet at ``frame`` as one: the longer takes the other.

    Raises
    ------
    ParameterError : there is no such border, or it is one of activities, too
    """
    rows = list(segmentation.level(level))
    after = after_border(rows, level, frame)
    longer = after if length(rows[after]) > length(rows[after - 1]) else after - 1
    return _merged(segmentation, level, after - 1, after, like=longer)


def name_segment(segmentation: Segmentation, level: Level, frame: int, label: str) -> Segmentation:
    """The segment that starts at ``frame`` has this label; an empty one takes it away.

    Raises
    ------
    ParameterError : no segment starts there, or the label is more than a line of text
    """
    return _changed(segmentation, [(level, _starting(segmentation, level, frame))], label=label)


def name_cluster(segmentation: Segmentation, cluster: int, label: str) -> Segmentation:
    """All segments of a cluster, of both levels, have this label.

    Raises
    ------
    ParameterError : no segment is in that cluster, or the label is more than a line of text
    """
    members = [(row.level, row) for row in segmentation if row.cluster == cluster >= 0]
    if not members:
        raise ParameterError(f"no segment is in cluster {cluster}")
    return _changed(segmentation, members, label=label)


def set_cluster(segmentation: Segmentation, level: Level, frame: int, cluster: int) -> Segmentation:
    """The segment that starts at ``frame`` is in a cluster, and so no transition; -1: in none.

    The primitives of an activity that were in its cluster go with it.

    Raises
    ------
    ParameterError : no segment starts there, or the cluster is neither there nor the next new one
    """
    following = int(segmentation.table.cluster.max(initial=-1)) + 1
    if not -1 <= cluster <= following:
        raise ParameterError(f"there is no cluster {cluster}; the next new one is {following}")
    chosen = _starting(segmentation, level, frame)
    kind: Kind = "activity" if cluster >= 0 else chosen.kind
    members = [(level, chosen)]
    if level == "activity":
        inside = segmentation.primitives.select(segmentation.primitives.activity == chosen.activity)
        members += [("primitive", row) for row in inside if row.cluster == chosen.cluster]
    return _changed(segmentation, members, cluster=cluster, kind=kind, score=math.nan)


def set_kind(segmentation: Segmentation, level: Level, frame: int, kind: Kind) -> Segmentation:
    """The segment that starts at ``frame`` is an activity, or a transition and in no cluster.

    An activity's primitives become what it becomes; a transition is one primitive.

    Raises
    ------
    ParameterError : no segment starts there, or no such kind
    """
    if kind not in get_args(Kind):
        raise ParameterError(f"kind must be {' or '.join(get_args(Kind))}, not {kind!r}")
    chosen = _starting(segmentation, level, frame)
    if kind == chosen.kind:
        return segmentation
    become = as_transition if kind == "transition" else as_activity
    activities, primitives = list(segmentation.activities), list(segmentation.primitives)
    if level == "primitive":
        primitives = [become(row) if row.start_frame == frame else row for row in primitives]
        return _with(segmentation, activities, primitives)
    inside = [i for i, row in enumerate(primitives) if row.activity == chosen.activity]
    if inside and kind == "transition":
        primitives = joined(primitives, inside[0], inside[-1], inside[0])
        inside = inside[:1]
    for i in inside:
        primitives[i] = become(primitives[i])
    activities = [become(row) if row.start_frame == frame else row for row in activities]
    return _with(segmentation, activities, primitives)


def _merged(
    segmentation: Segmentation, level: Level, first: int, last: int, *, like: int
) -> Segmentation:
    activities, primitives = list(segmentation.activities), list(segmentation.primitives)
    if level == "primitive":
        if primitives[first].activity != primitives[last].activity:
            border = activities[primitives[first].activity].stop_frame
            raise ParameterError(
                f"the border at frame {border} is one of activities: delete it on that level"
            )
        return _with(segmentation, activities, joined(primitives, first, last, like))
    merged = joined(activities, first, last, like)
    inside = [i for i, row in enumerate(primitives) if first <= row.activity <= last]
    for i in inside:
        primitives[i] = adopted(primitives[i], activities[primitives[i].activity], merged[first])
    if inside and merged[first].kind == "transition":
        primitives = joined(primitives, inside[0], inside[-1], inside[0])
    return _with(segmentation, merged, primitives)


def _changed(
    segmentation: Segmentation, members: Sequence[tuple[Level, Segment]], **columns: object
) -> Segmentation:
    """The members with other values in these columns."""
    chosen = {(level, row.start_frame) for level, row in members}
    rows = [
        replace(row, **columns) if (row.level, row.start_frame) in chosen else row  # type: ignore[arg-type]
        for row in segmentation
    ]
    return _with(segmentation, rows, [])


def _with(
    segmentation: Segmentation, activities: Iterable[Segment], primitives: Iterable[Segment]
) -> Segmentation:
    """The same recording with these rows; seconds and parents follow from their frames."""
    rows = [*activities, *primitives]
    columns = {name: [getattr(row, name) for row in rows] for name in COLUMNS if name != "activity"}
    return Segmentation.from_columns(
        columns,
        n_frames=segmentation.n_frames,
        fps=segmentation.fps,
        provenance=segmentation.provenance,
        timings=segmentation.timings,
    )


def _starting(segmentation: Segmentation, level: Level, frame: int) -> Segment:
    for row in segmentation.level(level):
        if row.start_frame == frame:
            return row
    raise ParameterError(f"no segment of level {level!r} starts at frame {frame}")
