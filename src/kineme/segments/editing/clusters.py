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
from typing import get_args

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Masks
from kineme.errors import ParameterError
from kineme.segments.annotation import as_cluster, as_text
from kineme.segments.editing.borders import (
    find_segment_at,
    merge,
    renumber_clusters,
    replace_columns,
)
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Kind, Level, Segment


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
    label = as_text(label, "the name of a segment") or names.get(row.cluster, "")
    named = _change_rows(segmentation, _mark_row(segmentation, row), label=label)
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
    members = _mark_members(segmentation, cluster) & ~has_own_name(segmentation)
    named = _change_rows(segmentation, members, label=str(label))
    return set_cluster_names(named, collect_names(segmentation) | {cluster: label})


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


def has_own_name(segmentation: Segmentation) -> Masks:
    """Return which rows have a label that is not the name of their cluster."""
    table, names = segmentation.table, collect_names(segmentation)
    inherited = np.array([names.get(cluster, "") for cluster in table.cluster.tolist()])
    own: Masks = (table.label != "") & (table.label != inherited)
    return own


def _mark_row(segmentation: Segmentation, row: Segment) -> Masks:
    table = segmentation.table
    found: Masks = (table.level == row.level) & (table.start_frame == row.start_frame)
    return found


def _mark_members(segmentation: Segmentation, cluster: int) -> Masks:
    """Return which rows are in a cluster; raise ParameterError if none is."""
    members: Masks = segmentation.table.cluster == as_cluster(cluster)
    if cluster < 0 or not members.any():
        raise ParameterError(f"no segment is in cluster {cluster}")
    return members


def _change_rows(segmentation: Segmentation, rows: Masks, **columns: ArrayLike) -> Segmentation:
    """Set columns of some rows to new values."""
    table = segmentation.table
    changed = {
        name: np.where(rows, values, getattr(table, name)) for name, values in columns.items()
    }
    return replace_columns(segmentation, table.columns() | changed)


def _choose_new_cluster(segmentation: Segmentation) -> int:
    """Return the next number, as numbers must have no gaps."""
    return int(segmentation.table.cluster.max()) + 1


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
    new_cluster = _choose_new_cluster(segmentation)
    if as_cluster(cluster) > new_cluster:
        raise ParameterError(f"there is no cluster {cluster}; the next new one is {new_cluster}")
    chosen, table = find_segment_at(segmentation, level, frame), segmentation.table
    members = _mark_row(segmentation, chosen)
    if level == "activity":
        members |= (table.activity == chosen.activity) & (table.cluster == chosen.cluster)
    kind = chosen.kind if cluster < 0 else "activity"
    return _move_members(segmentation, members, cluster, kind=kind)


def merge_clusters(segmentation: Segmentation, cluster: int, into: int) -> Segmentation:
    """Move all segments of a cluster to another one, and label them with its name.

    If only the cluster that is removed has a name, the other one gets it.

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
    members, _ = (_mark_members(segmentation, each) for each in (cluster, into))
    if cluster == into:
        raise ParameterError(
            f"cluster {cluster} cannot be merged with itself: name another cluster"
        )
    names, moved = cluster_names(segmentation), _move_members(segmentation, members, into)
    return moved if into in names else name_cluster(moved, into, names.get(cluster, ""))


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
    table = segmentation.table
    in_cluster = _mark_members(segmentation, cluster)
    has_primitives = (in_cluster & (table.level == "primitive")).any()
    members = in_cluster & (table.level == ("primitive" if has_primitives else "activity"))
    leaving = members & np.isin(table.start_frame, [*frames])
    if not 0 < leaving.sum() < members.sum():
        raise ParameterError(
            f"{leaving.sum()} of {members.sum()} segments of cluster {cluster} are selected: "
            "select some of them, not all"
        )
    # An activity moves only if all of its primitives of the cluster move.
    emptied = np.setdiff1d(table.activity[leaving], table.activity[members & ~leaving])
    leaving |= in_cluster & (table.level == "activity") & np.isin(table.activity, emptied)
    return _move_members(segmentation, leaving, _choose_new_cluster(segmentation))


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
    chosen, is_transition = find_segment_at(segmentation, level, frame), kind == "transition"
    if is_transition == (chosen.kind == "transition"):
        return segmentation
    inside = segmentation.primitives.activity == chosen.activity
    if level == "activity" and is_transition and inside.sum() > 1:
        segmentation = merge(segmentation, "primitive", chosen.start_frame, chosen.stop_frame)
    rows = _mark_row(segmentation, chosen)
    if level == "activity":
        rows |= segmentation.table.activity == chosen.activity
    if is_transition:
        return _change_rows(segmentation, rows, kind=kind, cluster=-1, confidence=math.nan)
    return _change_rows(segmentation, rows, kind="activity", confidence=math.nan)


def _move_members(
    segmentation: Segmentation, members: Masks, cluster: int, **columns: ArrayLike
) -> Segmentation:
    """Move members to another cluster, and label them with its name, except own names."""
    names = collect_names(segmentation)
    labels = np.where(has_own_name(segmentation), segmentation.table.label, names.get(cluster, ""))
    columns |= {"cluster": cluster, "confidence": math.nan, "label": labels}
    moved = _change_rows(segmentation, members, **columns)
    # Store an empty name for a nameless cluster, or labels of members might be taken for its name.
    return set_cluster_names(moved, ({cluster: ""} if cluster >= 0 else {}) | names)
