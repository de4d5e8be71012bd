"""Change what segments are and what they are called: clusters, kinds and names.

A cluster has a name, which its segments are called by; a segment may have a name of its
own, which stays whatever the cluster is called. The label of a segment is the one that
counts for it. Names of clusters are in the `kineme.segments.annotation`; where they are not,
a cluster is called what more than half of its segments are.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, get_args

from kineme.errors import ParameterError
from kineme.segments.editing.rows import (
    as_movement,
    as_transition,
    find_starting,
    join_rows,
    renumber_clusters,
    replace_columns,
    replace_rows,
)
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Kind, Level, Segment


def name_segment(segmentation: Segmentation, level: Level, frame: int, label: str) -> Segmentation:
    """Return the segment that starts at ``frame`` has a name of its own, which stays.

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

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> name_segment(found, "primitive", 61, "limp").primitives[:3].label.tolist()
    ['walk', 'limp', 'walk']
    """
    row, names = find_starting(segmentation, level, frame), collect_names(segmentation)
    label = label or names.get(row.cluster, "")
    named = change_columns(segmentation, [(level, row)], label=label)
    # The cluster is said to have no name unless it has: one label must not name it.
    return named if row.cluster < 0 else set_cluster_names(named, {row.cluster: ""} | names)


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

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> name_cluster(found, 0, "stroll").activities[[0, 4]].label.tolist()
    ['stroll', 'stroll']
    """
    if not find_members(segmentation, cluster):
        raise ParameterError(f"no segment is in cluster {cluster}")
    names = collect_names(segmentation)
    called = [
        (row.level, row)
        for row in find_members(segmentation, cluster)
        if row.label in ("", names.get(cluster, ""))
    ]
    return set_cluster_names(
        change_columns(segmentation, called, label=label), names | {cluster: label}
    )


def cluster_names(segmentation: Segmentation) -> dict[int, str]:
    """Return the names of the clusters that have one.

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
    >>> cluster_names(kineme.read_segments(bundled_truth(), fps=60))[0]
    'walk'
    """
    return {cluster: name for cluster, name in collect_names(segmentation).items() if name}


def set_cluster_names(segmentation: Segmentation, names: Mapping[int, str]) -> Segmentation:
    """Give the clusters these names and no others; labels stay as they are.

    The name of a cluster is empty if it has none, whatever its segments are called.
    """
    present = set(segmentation.table.cluster.tolist())
    kept = {cluster: names[cluster] for cluster in sorted(names) if cluster in present}
    annotation = replace(segmentation.annotation, cluster_names=kept)
    return replace(segmentation, annotation=annotation)


def collect_names(segmentation: Segmentation) -> dict[int, str]:
    """Return the names of clusters by number; empty for those that are said to have none."""
    clusters, labels = segmentation.table.cluster.tolist(), segmentation.table.label.tolist()
    sizes = Counter(clusters)
    # How often each label occurs in each cluster.
    called = Counter(zip(clusters, labels, strict=True)).items()
    # Names that people gave count more than those of most segments.
    names = {
        cluster: label for (cluster, label), count in called if label and 2 * count > sizes[cluster]
    } | segmentation.annotation.cluster_names
    return {cluster: names[cluster] for cluster in sorted(sizes) if 0 <= cluster in names}


def find_members(segmentation: Segmentation, cluster: int) -> list[Segment]:
    """Return the segments of a cluster, of both levels."""
    table = segmentation.table
    return [*table.select(table.cluster == cluster)] if cluster >= 0 else []


def change_columns(
    segmentation: Segmentation, members: Sequence[tuple[Level, Segment]], **columns: object
) -> Segmentation:
    """Return the members with other values in these columns."""
    chosen = {(level, row.start_frame) for level, row in members}
    table = segmentation.table
    places = zip(table.level.tolist(), table.start_frame.tolist(), strict=True)
    rows = [i for i, place in enumerate(places) if place in chosen]
    values: dict[str, Any] = table.columns()
    for name, value in columns.items():
        # Lists, since texts in a fixed-width array would be cut.
        values[name] = values[name].tolist()
        for row in rows:
            values[name][row] = value
    return replace_columns(segmentation, values)


def set_cluster(segmentation: Segmentation, level: Level, frame: int, cluster: int) -> Segmentation:
    """Put the segment that starts at ``frame`` into a cluster, as no transition; -1: into none.

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

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> again = set_cluster(found, "activity", 2494, 3)
    >>> again.activities[-1].label, again.repetitions()[3]
    ('jump', 8)
    """
    # Numbers have no holes: only the next new one may be named.
    following = int(segmentation.table.cluster.max(initial=-1)) + 1
    if not -1 <= cluster <= following:
        raise ParameterError(f"there is no cluster {cluster}; the next new one is {following}")
    chosen = find_starting(segmentation, level, frame)
    members = [(level, chosen)]
    if level == "activity":
        inside = segmentation.primitives.select(segmentation.primitives.activity == chosen.activity)
        members += [("primitive", row) for row in inside if row.cluster == chosen.cluster]
    # Members that have their own name keep it, those called by their cluster's do not.
    moved = _move_members(segmentation, members, cluster)
    become = as_transition if cluster < 0 and chosen.kind == "transition" else as_movement
    places = {(row.level, row.start_frame) for _, row in members}
    rows = [become(row) if (row.level, row.start_frame) in places else row for row in moved]
    return replace_rows(moved, rows, [])


def merge_clusters(segmentation: Segmentation, cluster: int, into: int) -> Segmentation:
    """Move the segments of a cluster into another, with its name where it has one.

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

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> merge_clusters(found, 4, 0).repetitions()
    {0: 15, 1: 4, 2: 5, 3: 4, 5: 4}
    """
    for each in (cluster, into):
        if not find_members(segmentation, each):
            raise ParameterError(f"no segment is in cluster {each}")
    if cluster == into:
        raise ParameterError(f"cluster {cluster} cannot be merged with itself: name another")
    members = [(row.level, row) for row in find_members(segmentation, cluster)]
    return _move_members(segmentation, members, into)


def split_cluster(segmentation: Segmentation, cluster: int, frames: Iterable[int]) -> Segmentation:
    """Move the primitives of a cluster that start at ``frames`` into a new cluster.

    So is an activity all of whose primitives of that cluster go.

    Parameters
    ----------
    segmentation : Segmentation
    cluster : int
    frames : iterable of int
        Where the primitives start; activities in a table without primitives.

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        None of these is in the cluster, or all are.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> split_cluster(found, 0, [962, 1027]).repetitions()
    {0: 7, 1: 4, 2: 5, 3: 4, 4: 6, 5: 4, 6: 2}
    """
    chosen, rows = set(frames), find_members(segmentation, cluster)
    level: Level = "primitive" if any(row.level == "primitive" for row in rows) else "activity"
    members = [row for row in rows if row.level == level]
    leavers = [row for row in members if row.start_frame in chosen]
    if not leavers or len(leavers) == len(members):
        raise ParameterError(
            f"{len(leavers)} of {len(members)} segments of cluster {cluster} are chosen: "
            "choose some of them, not all"
        )
    # An activity moves only if none of its primitives of the cluster stays.
    staying = {row.activity for row in members if row.start_frame not in chosen}
    leaving = {row.activity for row in leavers} - staying
    moved: list[tuple[Level, Segment]] = [(row.level, row) for row in leavers]
    if level == "primitive":
        numbered = enumerate(segmentation.activities)
        moved += [
            ("activity", row) for i, row in numbered if i in leaving and row.cluster == cluster
        ]
    following = int(segmentation.table.cluster.max(initial=-1)) + 1
    return _move_members(segmentation, moved, following)


def order_clusters(segmentation: Segmentation, order: Sequence[int]) -> Segmentation:
    """Return the same clusters numbered anew, in this order from 0; names go along.

    Parameters
    ----------
    segmentation : Segmentation
    order : sequence of int
        The clusters, each once.

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        They are not the clusters of the table.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> order_clusters(found, [5, 4, 3, 2, 1, 0]).activities.cluster[-1].item()
    0
    """
    present = sorted(set(segmentation.table.cluster.tolist()) - {-1})
    if sorted(order) != present:
        raise ParameterError(f"name each cluster once: {', '.join(map(str, present))}")
    new = {cluster: number for number, cluster in enumerate(order)}
    names = collect_names(segmentation)
    renamed = {new[cluster]: name for cluster, name in names.items()}
    return set_cluster_names(renumber_clusters(segmentation, new), renamed)


def set_kind(segmentation: Segmentation, level: Level, frame: int, kind: Kind) -> Segmentation:
    """Return the segment that starts at ``frame`` is a transition and in no cluster, or none.

    An activity's primitives become what it becomes; a transition is one primitive.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frame : int
        Where the segment starts.
    kind : {"activity", "primitive", "transition"}
        One of the first two: what its level says.

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        No segment starts there, or no such kind.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> set_kind(found, "activity", 2494, "transition").activities[-1].kind
    'transition'
    """
    if kind not in get_args(Kind):
        raise ParameterError(f"kind must be {' or '.join(get_args(Kind))}, not {kind!r}")
    chosen = find_starting(segmentation, level, frame)
    if (kind == "transition") == (chosen.kind == "transition"):
        return segmentation
    become = as_transition if kind == "transition" else as_movement
    activities, primitives = list(segmentation.activities), list(segmentation.primitives)
    if level == "primitive":
        primitives = [become(row) if row.start_frame == frame else row for row in primitives]
        return replace_rows(segmentation, activities, primitives)
    inside = [i for i, row in enumerate(primitives) if row.activity == chosen.activity]
    if inside and kind == "transition":
        # Its primitives become one, which is a transition.
        primitives = join_rows(primitives, inside[0], inside[-1], inside[0])
        inside = inside[:1]
    for i in inside:
        primitives[i] = become(primitives[i])
    activities = [become(row) if row.start_frame == frame else row for row in activities]
    return replace_rows(segmentation, activities, primitives)


def _move_members(
    segmentation: Segmentation,
    members: Sequence[tuple[Level, Segment]],
    cluster: int,
) -> Segmentation:
    """Return the members in another cluster, called by its name unless they have their own."""
    names = collect_names(segmentation)
    moved = segmentation
    # First those called by the cluster's name, then those with a name of their own.
    for inherits in (True, False):
        some = [
            (level, row)
            for level, row in members
            if (row.label in ("", names.get(row.cluster, ""))) == inherits
        ]
        label = {"label": names.get(cluster, "")} if inherits else {}
        if some:
            moved = change_columns(moved, some, cluster=cluster, confidence=math.nan, **label)
    # A cluster that was nameless is said to be, so that labels of members do not name it.
    return set_cluster_names(moved, ({cluster: ""} if cluster >= 0 else {}) | names)
