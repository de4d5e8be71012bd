"""A new segmentation of a recording that takes over what people did to the one before.

Segments made by hand or checked (`kineme.segments.editing.annotating`) are in it as they were;
the new ones give way. Clusters are matched by the frames that they share: an old cluster is
the new one that holds more than half of it, unless that has more of another. What matches keeps
its number, and so its colour; other new clusters get numbers that the table so far has not. Names
go where they match: that of a cluster to the matching one, that of a segment to the segment that
it shares more than half of both their frames with. What finds no place is listed.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from itertools import count
from typing import get_args

import numpy as np
from numpy.typing import NDArray

from kineme.segments.annotation import Span
from kineme.segments.editing.annotating import (
    Mark,
    comments,
    marked,
    span_of,
    with_comments,
    with_marked,
)
from kineme.segments.editing.imposing import imposed, in_the_middle, overlap
from kineme.segments.editing.naming import cluster_names, name_cluster, with_cluster_names
from kineme.segments.editing.rows import Rows, length, with_rows
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment


@dataclass(frozen=True)
class Carried:
    """What became of a table that another one took the place of.

    Parameters
    ----------
    segmentation : Segmentation
        The new one, with what was taken over.
    corrections : int
        Segments made by hand or checked, all of which are in it.
    names : int
        Of clusters, and of segments that have their own.
    lost : list of str
        Sentences: the names among them that found no place.
    """

    segmentation: Segmentation
    corrections: int
    names: int
    lost: list[str]


def carried(before: Segmentation, found: Segmentation) -> Carried:
    """A new segmentation with the corrections and names of the one before.

    Parameters
    ----------
    before : Segmentation
        The table so far.
    found : Segmentation
        Another one of the same recording.

    Returns
    -------
    Carried

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> anew = kineme.segment(kineme.read(kineme.bundled_recording()))
    >>> "squat" in carried(found, anew).segmentation.activities.label.tolist()
    True
    """
    flags = {mark: marked(before, mark) for mark in get_args(Mark)}
    fixed = [row for row in before if span_of(row) in set().union(*flags.values())]
    if not len(found.primitives):
        fixed = [row for row in fixed if row.level == "activity"]
    singles = {span_of(row) for row in _singly_named(before)}
    placed = [row if span_of(row) in singles else replace(row, label="") for row in fixed]
    now = imposed(_numbered_like(before, found), placed)
    for mark, spans in flags.items():
        now = with_marked(now, mark, spans)
    now = with_comments(now, comments(before))
    if fixed:
        corrections = before.annotation.corrections
        now = replace(now, annotation=replace(now.annotation, corrections=corrections))
    return _named(now, before, len(fixed))


def names_of(segmentation: Segmentation) -> int:
    """How many names there are: of clusters, and of segments that have their own."""
    return len(cluster_names(segmentation)) + len(_singly_named(segmentation))


def _singly_named(segmentation: Segmentation) -> Rows:
    names = cluster_names(segmentation)
    return [row for row in segmentation if row.label not in ("", names.get(row.cluster, ""))]


def _numbered_like(before: Segmentation, found: Segmentation) -> Segmentation:
    """The new segments, with the old numbers of the clusters that match."""
    match = _matching_clusters(before, found)
    used = set(before.table.cluster.tolist())
    free = (number for number in count() if number not in used)
    number = {-1: -1}
    for cluster in sorted(set(found.table.cluster.tolist()) - {-1}):
        number[cluster] = match[cluster] if cluster in match else next(free)
    rows = [replace(row, cluster=number[row.cluster]) for row in found]
    return with_rows(found, rows, [])


def _matching_clusters(before: Segmentation, found: Segmentation) -> dict[int, int]:
    """The old number of each new cluster that has one."""
    shared: dict[int, Counter[int]] = {}
    for level in get_args(Level):
        pairs = np.stack([_by_frame(before, level), _by_frame(found, level)])
        for (old, new), frames in zip(*_counts(pairs), strict=True):
            if old >= 0:
                shared.setdefault(old, Counter())[new] += frames
    most = []
    for cluster, counts in shared.items():
        new, frames = counts.most_common(1)[0]
        if new >= 0 and 2 * frames > counts.total():
            most.append((-frames, cluster, new))
    match: dict[int, int] = {}
    for _, cluster, new in sorted(most):
        match.setdefault(new, cluster)
    return match


def _by_frame(segmentation: Segmentation, level: Level) -> NDArray[np.int64]:
    """The cluster of each frame; -1 everywhere where there is no such level."""
    rows = segmentation.level(level)
    if not len(rows):
        return np.full(segmentation.n_frames, -1)
    return np.repeat(rows.cluster, rows.stop_frame - rows.start_frame)


def _counts(pairs: NDArray[np.int64]) -> tuple[list[list[int]], list[int]]:
    values, counts = np.unique(pairs, axis=1, return_counts=True)
    return values.T.tolist(), counts.tolist()


def _named(now: Segmentation, before: Segmentation, fixed: int) -> Carried:
    """The new table with the names of the old one, and the names that found no place."""
    lost, new_names = [], dict[int, str]()
    present = set(now.table.cluster.tolist())
    names, singles = cluster_names(before), _singly_named(before)
    if not names and not singles:
        return Carried(now, fixed, 0, [])
    for cluster, name in names.items():
        if cluster in present:
            new_names[cluster] = name
        else:
            lost.append(f"the name “{name}” of cluster {cluster}: no cluster matches it")
    for cluster, name in new_names.items():
        now = name_cluster(now, cluster, name)
    labels: dict[Span, str] = {}
    for row in singles:
        twin = _twin(now, row)
        if twin is None:
            where = f"the {row.level} at {row.start_s:.2f} s"
            lost.append(f"the name “{row.label}” of {where}: no segment matches it")
        else:
            labels[span_of(twin)] = row.label
    rows = [replace(row, label=labels.get(span_of(row), row.label)) for row in now]
    now = with_cluster_names(with_rows(now, rows, []), dict.fromkeys(present, "") | new_names)
    return Carried(now, fixed, len(names) + len(singles), lost)


def _twin(segmentation: Segmentation, row: Segment) -> Segment | None:
    """The segment of that level that shares more than half of both with a row."""
    rows = segmentation.level(row.level)
    if not len(rows):
        return None
    other = in_the_middle(rows, row)
    return other if 2 * overlap(row, other) > max(length(row), length(other)) else None
