"""What segments are: their labels, clusters and kinds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import get_args

from kineme.errors import ParameterError
from kineme.segments.editing.rows import as_activity, as_transition, joined, with_rows
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Kind, Level, Segment


def name_segment(segmentation: Segmentation, level: Level, frame: int, label: str) -> Segmentation:
    """The segment that starts at ``frame`` has this label; an empty one takes it away.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frame : int
        Where the segment starts.
    label : str

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        No segment starts there, or the label is more than a line of text.
    """
    return _changed(segmentation, [(level, _starting(segmentation, level, frame))], label=label)


def name_cluster(segmentation: Segmentation, cluster: int, label: str) -> Segmentation:
    """All segments of a cluster, of both levels, have this label.

    Parameters
    ----------
    segmentation : Segmentation
    cluster : int
    label : str

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        No segment is in that cluster, or the label is more than a line of text.
    """
    members = [(row.level, row) for row in segmentation if row.cluster == cluster >= 0]
    if not members:
        raise ParameterError(f"no segment is in cluster {cluster}")
    return _changed(segmentation, members, label=label)


def set_cluster(segmentation: Segmentation, level: Level, frame: int, cluster: int) -> Segmentation:
    """The segment that starts at ``frame`` is in a cluster, and so no transition; -1: in none.

    The primitives of an activity that were in its cluster go with it.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frame : int
        Where the segment starts.
    cluster : int

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        No segment starts there, or the cluster is neither there nor the next new one.
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

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frame : int
        Where the segment starts.
    kind : {"activity", "transition"}

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        No segment starts there, or no such kind.
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
        return with_rows(segmentation, activities, primitives)
    inside = [i for i, row in enumerate(primitives) if row.activity == chosen.activity]
    if inside and kind == "transition":
        primitives = joined(primitives, inside[0], inside[-1], inside[0])
        inside = inside[:1]
    for i in inside:
        primitives[i] = become(primitives[i])
    activities = [become(row) if row.start_frame == frame else row for row in activities]
    return with_rows(segmentation, activities, primitives)


def _changed(
    segmentation: Segmentation, members: Sequence[tuple[Level, Segment]], **columns: object
) -> Segmentation:
    """The members with other values in these columns."""
    chosen = {(level, row.start_frame) for level, row in members}
    rows = [
        replace(row, **columns) if (row.level, row.start_frame) in chosen else row  # type: ignore[arg-type]
        for row in segmentation
    ]
    return with_rows(segmentation, rows, [])


def _starting(segmentation: Segmentation, level: Level, frame: int) -> Segment:
    for row in segmentation.level(level):
        if row.start_frame == frame:
            return row
    raise ParameterError(f"no segment of level {level!r} starts at frame {frame}")
