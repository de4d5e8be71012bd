"""What segments and clusters are called.

A cluster has a name, which its segments are called by; a segment may have a name of its
own, which stays whatever the cluster is called. The label of a segment is the one that
counts for it. Names of clusters are in the `kineme.segments.annotation`; where they are not,
a cluster is called what more than half of its segments are.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from kineme.errors import ParameterError
from kineme.segments.editing.rows import replace_columns, starting
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment


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
    row, names = starting(segmentation, level, frame), names_by_cluster(segmentation)
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
    if not members_of(segmentation, cluster):
        raise ParameterError(f"no segment is in cluster {cluster}")
    names = names_by_cluster(segmentation)
    called = [
        (row.level, row)
        for row in members_of(segmentation, cluster)
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
    return {cluster: name for cluster, name in names_by_cluster(segmentation).items() if name}


def set_cluster_names(segmentation: Segmentation, names: Mapping[int, str]) -> Segmentation:
    """Give the clusters these names and no others; labels stay as they are.

    The name of a cluster is empty if it has none, whatever its segments are called.
    """
    present = set(segmentation.table.cluster.tolist())
    kept = {cluster: names[cluster] for cluster in sorted(names) if cluster in present}
    annotation = replace(segmentation.annotation, cluster_names=kept)
    return replace(segmentation, annotation=annotation)


def names_by_cluster(segmentation: Segmentation) -> dict[int, str]:
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


def members_of(segmentation: Segmentation, cluster: int) -> list[Segment]:
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
