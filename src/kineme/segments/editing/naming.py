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

from kineme.errors import ParameterError
from kineme.segments.editing.rows import starting, with_rows
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment


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
    named = changed(segmentation, [(level, row)], label=label)
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
    return with_cluster_names(changed(segmentation, called, label=label), names | {cluster: label})


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
    >>> cluster_names(kineme.read_segments(bundled_truth(), fps=60))[0]
    'walk'
    """
    return {cluster: name for cluster, name in names_by_cluster(segmentation).items() if name}


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
    present = set(segmentation.table.cluster.tolist())
    kept = {cluster: names[cluster] for cluster in sorted(names) if cluster in present}
    annotation = replace(segmentation.annotation, cluster_names=kept)
    return replace(segmentation, annotation=annotation)


def names_by_cluster(segmentation: Segmentation) -> dict[int, str]:
    """The names of clusters by number; empty for those that are said to have none."""
    entries = segmentation.annotation.cluster_names
    labels: dict[int, Counter[str]] = {}
    for cluster, label in zip(
        segmentation.table.cluster.tolist(), segmentation.table.label.tolist(), strict=True
    ):
        if cluster >= 0:
            labels.setdefault(cluster, Counter())[label] += 1
    names = {}
    for cluster in sorted(labels):
        (label, count), *_ = labels[cluster].most_common(1)
        if cluster in entries:
            names[cluster] = entries[cluster]
        elif 2 * count > labels[cluster].total() and label:
            names[cluster] = label
    return names


def members_of(segmentation: Segmentation, cluster: int) -> list[Segment]:
    """The segments of a cluster, of both levels."""
    return [row for row in segmentation if row.cluster == cluster >= 0]


def changed(
    segmentation: Segmentation, members: Sequence[tuple[Level, Segment]], **columns: object
) -> Segmentation:
    """The members with other values in these columns."""
    chosen = {(level, row.start_frame) for level, row in members}
    rows = [
        replace(row, **columns) if (row.level, row.start_frame) in chosen else row  # type: ignore[arg-type]
        for row in segmentation
    ]
    return with_rows(segmentation, rows, [])
