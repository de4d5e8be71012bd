"""Edit clusters, kinds and names of segments.

The name of a cluster is the label of its segments, except of segments with a name of their
own, which do not change with the cluster. Names of clusters are stored in the
`kineme.segments.annotation`. If they are missing there, the name of a cluster is the label of
more than half of its segments.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, get_args

from kineme.errors import ParameterError
from kineme.segments.editing.borders import (
    Rows,
    find_segment_at,
    join_rows,
    renumber_clusters,
    replace_columns,
    replace_rows,
)
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Kind, Level, Segment, choose_kind


def name_segment(segmentation: Segmentation, level: Level, frame: int, label: str) -> Segmentation:
    """Give the segment that starts at ``frame`` a name of its own.

    An empty name removes it: then the segment has the name of its cluster.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frame : int
        Start of the segment.
    label : str

    Raises
    ------
    ParameterError
        No segment starts there, or the label is not one line of text.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> name_segment(found, "primitive", 61, "limp").primitives[:3].label.tolist()
    ['walk', 'limp', 'walk']
    """
    row, names = find_segment_at(segmentation, level, frame), collect_names(segmentation)
    label = label or names.get(row.cluster, "")
    named = change_columns(segmentation, [(level, row)], label=label)
    # Store an empty name for a cluster without one, or this label might be taken for its name.
    return named if row.cluster < 0 else set_cluster_names(named, {row.cluster: ""} | names)


def name_cluster(segmentation: Segmentation, cluster: int, label: str) -> Segmentation:
    """Name a cluster, and label its segments of both levels, except those with their own name.

    Parameters
    ----------
    segmentation : Segmentation
    cluster : int
    label : str
        Empty to remove the name.

    Raises
    ------
    ParameterError
        No segment is in this cluster, or the label is not one line of text.

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
    members = [
        (row.level, row)
        for row in find_members(segmentation, cluster)
        if row.label in ("", names.get(cluster, ""))
    ]
    return set_cluster_names(
        change_columns(segmentation, members, label=label), names | {cluster: label}
    )


def cluster_names(segmentation: Segmentation) -> dict[int, str]:
    """Return the names of clusters, without empty ones.

    Returns
    -------
    dict of str
        Name by cluster.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> cluster_names(kineme.read_segments(bundled_truth(), fps=60))[0]
    'walk'
    """
    return {cluster: name for cluster, name in collect_names(segmentation).items() if name}


def set_cluster_names(segmentation: Segmentation, names: Mapping[int, str]) -> Segmentation:
    """Replace all names of clusters; labels of segments do not change.

    The name of a cluster without a name is empty.
    """
    present = set(segmentation.table.cluster.tolist())
    kept = {cluster: names[cluster] for cluster in sorted(names) if cluster in present}
    annotation = replace(segmentation.annotation, cluster_names=kept)
    return replace(segmentation, annotation=annotation)


def collect_names(segmentation: Segmentation) -> dict[int, str]:
    """Return the names of clusters, including stored empty names."""
    clusters, labels = segmentation.table.cluster.tolist(), segmentation.table.label.tolist()
    sizes = Counter(clusters)
    # How often each label occurs in each cluster.
    counts = Counter(zip(clusters, labels, strict=True)).items()
    # Stored names take precedence over labels of most segments.
    names = {
        cluster: label for (cluster, label), count in counts if label and 2 * count > sizes[cluster]
    } | segmentation.annotation.cluster_names
    return {cluster: names[cluster] for cluster in sorted(sizes) if 0 <= cluster in names}


def find_members(segmentation: Segmentation, cluster: int) -> list[Segment]:
    """Return the segments of a cluster, of both levels."""
    table = segmentation.table
    return [*table.select(table.cluster == cluster)] if cluster >= 0 else []


def change_columns(
    segmentation: Segmentation, members: Sequence[tuple[Level, Segment]], **columns: object
) -> Segmentation:
    """Set columns of the members to new values."""
    chosen = {(level, row.start_frame) for level, row in members}
    table = segmentation.table
    keys = zip(table.level.tolist(), table.start_frame.tolist(), strict=True)
    rows = [i for i, key in enumerate(keys) if key in chosen]
    values: dict[str, Any] = table.columns()
    for name, value in columns.items():
        # Lists, as a fixed-width array would truncate texts.
        values[name] = values[name].tolist()
        for row in rows:
            values[name][row] = value
    return replace_columns(segmentation, values)


def set_cluster(segmentation: Segmentation, level: Level, frame: int, cluster: int) -> Segmentation:
    """Move the segment that starts at ``frame`` to a cluster, or to none (-1).

    A transition becomes an activity or primitive. Primitives of an activity that were in
    its cluster move with it. Labels that are the old cluster's name change to the new one's.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frame : int
        Start of the segment.
    cluster : int

    Raises
    ------
    ParameterError
        No segment starts there, or the cluster neither exists nor is the next new number.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> again = set_cluster(found, "activity", 2494, 3)
    >>> again.activities[-1].label, again.repetitions()[3]
    ('jump', 8)
    """
    # Numbers must have no gaps: the only new number allowed is the next one.
    new_cluster = int(segmentation.table.cluster.max(initial=-1)) + 1
    if not -1 <= cluster <= new_cluster:
        raise ParameterError(f"there is no cluster {cluster}; the next new one is {new_cluster}")
    chosen = find_segment_at(segmentation, level, frame)
    members = [(level, chosen)]
    if level == "activity":
        inside = segmentation.primitives.select(segmentation.primitives.activity == chosen.activity)
        members += [("primitive", row) for row in inside if row.cluster == chosen.cluster]
    moved = _move_members(segmentation, members, cluster)
    transition = cluster < 0 and chosen.kind == "transition"
    keys = {(row.level, row.start_frame) for _, row in members}
    return replace_rows(moved, _change_kinds(moved, keys, transition=transition), [])


def merge_clusters(segmentation: Segmentation, cluster: int, into: int) -> Segmentation:
    """Move all segments of a cluster to another one, and label them with its name.

    Parameters
    ----------
    segmentation : Segmentation
    cluster : int
        Cluster to remove.
    into : int

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
        raise ParameterError(
            f"cluster {cluster} cannot be merged with itself: name another cluster"
        )
    members = [(row.level, row) for row in find_members(segmentation, cluster)]
    return _move_members(segmentation, members, into)


def split_cluster(segmentation: Segmentation, cluster: int, frames: Iterable[int]) -> Segmentation:
    """Move the primitives of a cluster that start at ``frames`` to a new cluster.

    An activity is moved if all of its primitives of this cluster are.

    Parameters
    ----------
    segmentation : Segmentation
    cluster : int
    frames : iterable of int
        Starts of the primitives, or of activities in a table without primitives.

    Raises
    ------
    ParameterError
        None of the segments of the cluster is selected, or all are.

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
            f"{len(leavers)} of {len(members)} segments of cluster {cluster} are selected: "
            "select some of them, not all"
        )
    # An activity moves only if all of its primitives of the cluster move.
    staying = {row.activity for row in members if row.start_frame not in chosen}
    leaving = {row.activity for row in leavers} - staying
    moved: list[tuple[Level, Segment]] = [(row.level, row) for row in leavers]
    if level == "primitive":
        numbered = enumerate(segmentation.activities)
        moved += [
            ("activity", row) for i, row in numbered if i in leaving and row.cluster == cluster
        ]
    new_cluster = int(segmentation.table.cluster.max(initial=-1)) + 1
    return _move_members(segmentation, moved, new_cluster)


def order_clusters(segmentation: Segmentation, order: Sequence[int]) -> Segmentation:
    """Renumber the clusters from 0 in this order; names move with them.

    Parameters
    ----------
    segmentation : Segmentation
    order : sequence of int
        All clusters, each once.

    Raises
    ------
    ParameterError
        `order` does not list each cluster of the table once.

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
    """Make the segment that starts at ``frame`` a transition, or an activity or primitive.

    Primitives of an activity change with it. A transition has no cluster and only one primitive.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frame : int
        Start of the segment.
    kind : {"activity", "primitive", "transition"}
        "activity" and "primitive" both mean the kind of its level.

    Raises
    ------
    ParameterError
        No segment starts there, or the kind does not exist.

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
    chosen = find_segment_at(segmentation, level, frame)
    if (kind == "transition") == (chosen.kind == "transition"):
        return segmentation
    activities, primitives = list(segmentation.activities), list(segmentation.primitives)
    keys: set[tuple[Level, int]] = {(level, frame)}
    if level == "activity":
        inside = [i for i, row in enumerate(primitives) if row.activity == chosen.activity]
        if inside and kind == "transition":
            # Merge its primitives to one transition.
            primitives = join_rows(primitives, inside[0], inside[-1], inside[0])
            inside = inside[:1]
        keys |= {("primitive", primitives[i].start_frame) for i in inside}
    rows = _change_kinds([*activities, *primitives], keys, transition=kind == "transition")
    return replace_rows(segmentation, rows, [])


def _change_kinds(
    rows: Iterable[Segment], keys: set[tuple[Level, int]], *, transition: bool
) -> Rows:
    """Make the rows with these levels and starts transitions without a cluster, or movements."""
    changed: Rows = []
    for row in rows:
        if (row.level, row.start_frame) in keys:
            kind = choose_kind(row.level, transition=transition)
            cluster = -1 if transition else row.cluster
            row = replace(row, kind=kind, cluster=cluster, confidence=math.nan)  # noqa: PLW2901
        changed.append(row)
    return changed


def _move_members(
    segmentation: Segmentation,
    members: Sequence[tuple[Level, Segment]],
    cluster: int,
) -> Segmentation:
    """Move members to another cluster, and label them with its name, except own names."""
    names = collect_names(segmentation)
    moved = segmentation
    # First the members with the name of their cluster, then those with their own name.
    for inherits in (True, False):
        group = [
            (level, row)
            for level, row in members
            if (row.label in ("", names.get(row.cluster, ""))) == inherits
        ]
        label = {"label": names.get(cluster, "")} if inherits else {}
        if group:
            moved = change_columns(moved, group, cluster=cluster, confidence=math.nan, **label)
    # Store an empty name for a nameless cluster, or labels of members might be taken for its name.
    return set_cluster_names(moved, ({cluster: ""} if cluster >= 0 else {}) | names)
