"""What segments are: their labels, clusters and kinds.

A cluster has a name, which its segments are called by; a segment may have a name of its
own, which stays whatever the cluster is called. The label of a segment is the one that
counts for it. Names of clusters are in the provenance (``cluster_names``); in a table that
does not say, a cluster is called what more than half of its segments are.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, get_args

from kineme.errors import ParameterError
from kineme.segments.editing.rows import as_activity, as_transition, joined, with_rows
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Kind, Level, Segment


def name_segment(segmentation: Segmentation, level: Level, frame: int, label: str) -> Segmentation:
    """The segment that starts at ``frame`` has a name of its own, which stays.

    An empty one takes it away: then it is called by the name of its cluster, if that has one.

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
    row, names = _starting(segmentation, level, frame), _names(segmentation)
    label = label or names.get(row.cluster, "")
    named = _changed(segmentation, [(level, row)], label=label)
    return named if row.cluster < 0 else with_cluster_names(named, {row.cluster: ""} | names)


def name_cluster(segmentation: Segmentation, cluster: int, label: str) -> Segmentation:
    """A cluster has this name, and so have its segments of both levels but those with their own.

    Parameters
    ----------
    segmentation : Segmentation
    cluster : int
    label : str
        Empty: the cluster has no name any more.

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        No segment is in that cluster, or the label is more than a line of text.
    """
    if not _members(segmentation, cluster):
        raise ParameterError(f"no segment is in cluster {cluster}")
    names = _names(segmentation)
    called = [
        (row.level, row)
        for row in _members(segmentation, cluster)
        if row.label in ("", names.get(cluster, ""))
    ]
    return with_cluster_names(_changed(segmentation, called, label=label), names | {cluster: label})


def cluster_names(segmentation: Segmentation) -> dict[int, str]:
    """The names of the clusters that have one.

    Parameters
    ----------
    segmentation : Segmentation

    Returns
    -------
    dict of str
        By cluster.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> cluster_names(kineme.read_segments(bundled_truth(), fps=60))
    {}
    """
    return {cluster: name for cluster, name in _names(segmentation).items() if name}


def merge_clusters(segmentation: Segmentation, cluster: int, into: int) -> Segmentation:
    """The segments of one cluster are in another, and called by its name where it has one.

    Parameters
    ----------
    segmentation : Segmentation
    cluster : int
        Which is gone then.
    into : int

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        One of them has no segments, or they are the same.
    """
    for each in (cluster, into):
        if not _members(segmentation, each):
            raise ParameterError(f"no segment is in cluster {each}")
    if cluster == into:
        raise ParameterError(f"cluster {cluster} cannot be merged with itself: name another")
    members = [(row.level, row) for row in _members(segmentation, cluster)]
    return _moved_to(segmentation, members, into, score=math.nan)


def with_cluster_names(segmentation: Segmentation, names: Mapping[int, str]) -> Segmentation:
    """The same segments, whose clusters have these names and no others; labels stay as they are.

    Parameters
    ----------
    segmentation : Segmentation
    names : mapping of str
        By cluster; empty for one that has none, whatever its segments are called.

    Returns
    -------
    Segmentation
    """
    there = set(segmentation.table.cluster.tolist())
    kept = {str(cluster): names[cluster] for cluster in sorted(names) if cluster in there}
    provenance = {**segmentation.provenance, "cluster_names": kept}
    if not kept:
        del provenance["cluster_names"]
    return replace(segmentation, provenance=provenance)


def set_cluster(segmentation: Segmentation, level: Level, frame: int, cluster: int) -> Segmentation:
    """The segment that starts at ``frame`` is in a cluster, and so no transition; -1: in none.

    The primitives of an activity that were in its cluster go with it. Who was called by
    the old cluster's name is called by the new one's.

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
    return _moved_to(segmentation, members, cluster, kind=kind, score=math.nan)


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


def _names(segmentation: Segmentation) -> dict[int, str]:
    """The same, and empty for clusters that are said to have none."""
    said: Any = segmentation.provenance.get("cluster_names")
    known: Mapping[str, Any] = said if isinstance(said, dict) else {}
    labels: dict[int, Counter[str]] = {}
    for cluster, label in zip(
        segmentation.table.cluster.tolist(), segmentation.table.label.tolist(), strict=True
    ):
        if cluster >= 0:
            labels.setdefault(cluster, Counter())[label] += 1
    names = {}
    for cluster in sorted(labels):
        (label, count), *_ = labels[cluster].most_common(1)
        if str(cluster) in known:
            names[cluster] = str(known[str(cluster)])
        elif 2 * count > labels[cluster].total() and label:
            names[cluster] = label
    return names


def _members(segmentation: Segmentation, cluster: int) -> list[Segment]:
    return [row for row in segmentation if row.cluster == cluster >= 0]


def _moved_to(
    segmentation: Segmentation,
    members: Sequence[tuple[Level, Segment]],
    cluster: int,
    **columns: object,
) -> Segmentation:
    """The members in another cluster, called by its name unless they have their own."""
    names = _names(segmentation)
    moved = segmentation
    for inherits in (True, False):
        some = [
            (level, row)
            for level, row in members
            if (row.label in ("", names.get(row.cluster, ""))) == inherits
        ]
        label = {"label": names.get(cluster, "")} if inherits else {}
        if some:
            moved = _changed(moved, some, cluster=cluster, **columns, **label)
    return with_cluster_names(moved, ({cluster: ""} if cluster >= 0 else {}) | names)


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
