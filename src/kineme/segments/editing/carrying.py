"""A new segmentation of a recording that takes over what people did to the one before.

Segments made by hand or checked (`kineme.segments.editing.annotating`) are in it as they were;
the new ones give way. Clusters are matched by the frames that they share: an old cluster is
the new one that holds more than half of it, unless that has more of another. What matches keeps
its number, and so its colour; other new clusters get numbers that the table so far has not. Names
go where they match: that of a cluster to the matching one, that of a segment to the segment that
it shares more than half of both their frames with. What finds no place is listed.
"""

from __future__ import annotations

import math
from bisect import bisect_right
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
    find_marked,
    get_span,
    set_comments,
    set_marked,
)
from kineme.segments.editing.clusters import cluster_names, name_cluster, set_cluster_names
from kineme.segments.editing.rows import (
    Rows,
    change_parent,
    count_frames,
    cut,
    join_rows,
    list_cuts,
    renumber_clusters,
    replace_rows,
)
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment, SegmentTable


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


def carry_corrections(before: Segmentation, found: Segmentation) -> Carried:
    """Return a new segmentation with the corrections and names of the one before.

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
    >>> "squat" in carry_corrections(found, anew).segmentation.activities.label.tolist()
    True
    """
    flags = {mark: find_marked(before, mark) for mark in get_args(Mark)}
    # Rows that people vouch for in either sense.
    fixed = [row for row in before if get_span(row) in set().union(*flags.values())]
    if not len(found.primitives):
        fixed = [row for row in fixed if row.level == "activity"]
    singles = {get_span(row) for row in _find_singly_named(before)}
    # Names of clusters are carried over separately, so only names of their own stay in the rows.
    placed = [row if get_span(row) in singles else replace(row, label="") for row in fixed]
    now = _impose_segments(_renumber(before, found), placed)
    # Marks are set again, since imposing segments made new rows.
    for mark, spans in flags.items():
        now = set_marked(now, mark, spans)
    now = set_comments(now, comments(before))
    annotation = replace(now.annotation, excluded=before.annotation.excluded)
    if fixed:
        annotation = replace(annotation, corrections=before.annotation.corrections)
    now = replace(now, annotation=annotation)
    return _carry_names(now, before, len(fixed))


def count_names(segmentation: Segmentation) -> int:
    """Return how many names there are: of clusters, and of segments that have their own."""
    return len(cluster_names(segmentation)) + len(_find_singly_named(segmentation))


def _find_singly_named(segmentation: Segmentation) -> Rows:
    names = cluster_names(segmentation)
    # A name of its own is one that the row's cluster does not have.
    return [row for row in segmentation if row.label not in ("", names.get(row.cluster, ""))]


def _renumber(before: Segmentation, found: Segmentation) -> Segmentation:
    """Return the new segments, with the old numbers of the clusters that match."""
    match = _match_clusters(before, found)
    # Numbers of former clusters are never reused for other ones.
    used = set(before.table.cluster.tolist())
    free = (number for number in count() if number not in used)
    number = {}
    for cluster in sorted(set(found.table.cluster.tolist()) - {-1}):
        number[cluster] = match[cluster] if cluster in match else next(free)
    return renumber_clusters(found, number)


def _match_clusters(before: Segmentation, found: Segmentation) -> dict[int, int]:
    """Return the old number of each new cluster that has one."""
    shared: dict[int, Counter[int]] = {}
    for level in get_args(Level):
        # (2, frames): old and new cluster of each frame.
        pairs = np.stack([_spread_clusters(before, level), _spread_clusters(found, level)])
        # Distinct columns: pairs of clusters, and on how many frames they are.
        values, sizes = np.unique(pairs, axis=1, return_counts=True)
        for (old, new), frames in zip(values.T.tolist(), sizes.tolist(), strict=True):
            if old >= 0:
                shared.setdefault(old, Counter())[new] += frames
    most = []
    for cluster, counts in shared.items():
        new, frames = counts.most_common(1)[0]
        # More than half of the old cluster's frames.
        if new >= 0 and 2 * frames > counts.total():
            # Negative, so that sorting puts the largest overlap first.
            most.append((-frames, cluster, new))
    match: dict[int, int] = {}
    for _, cluster, new in sorted(most):
        # The old cluster with the larger overlap keeps the new one.
        match.setdefault(new, cluster)
    return match


def _spread_clusters(segmentation: Segmentation, level: Level) -> NDArray[np.int64]:
    """Return the cluster of each frame; -1 everywhere where there is no such level."""
    rows = segmentation.level(level)
    if not len(rows):
        return np.full(segmentation.n_frames, -1)
    return np.repeat(rows.cluster, rows.stop_frame - rows.start_frame)


def _carry_names(now: Segmentation, before: Segmentation, fixed: int) -> Carried:
    """Return the new table with the names of the old one, and the names that found no place."""
    lost, new_names = [], dict[int, str]()
    present = set(now.table.cluster.tolist())
    names, singles = cluster_names(before), _find_singly_named(before)
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
        twin = _find_twin(now, row)
        if twin is None:
            where = f"the {row.level} at {row.start_s:.2f} s"
            lost.append(f"the name “{row.label}” of {where}: no segment matches it")
        else:
            labels[get_span(twin)] = row.label
    rows = [replace(row, label=labels.get(get_span(row), row.label)) for row in now]
    # Clusters without a name are said to have none, so that none is guessed from labels.
    now = set_cluster_names(replace_rows(now, rows, []), dict.fromkeys(present, "") | new_names)
    return Carried(now, fixed, len(names) + len(singles), lost)


def _find_twin(segmentation: Segmentation, row: Segment) -> Segment | None:
    """Return the segment of that level that shares more than half of both with a row."""
    rows = segmentation.level(row.level)
    if not len(rows):
        return None
    other = _find_middle_row(rows, row)
    return (
        other
        if 2 * _measure_overlap(row, other) > max(count_frames(row), count_frames(other))
        else None
    )


def _impose_segments(found: Segmentation, fixed: Rows) -> Segmentation:
    """Return the segmentation with these segments in it as they are."""
    by_level = {level: [row for row in fixed if row.level == level] for level in get_args(Level)}
    # Activities first: their borders must not cut primitives that stay.
    activities = _spare_primitives(list(found.activities), by_level["primitive"])
    activities = _insert_fixed(activities, by_level["activity"])
    if not len(found.primitives):
        return replace_rows(found, activities, [])
    primitives = _cut_at(activities, list(found.primitives))
    for row in by_level["activity"]:
        primitives = _keep_inside(primitives, row, found)
    primitives = _cut_at(activities, _insert_fixed(primitives, by_level["primitive"]))
    return replace_rows(found, activities, primitives)


def _cut_at(activities: Rows, primitives: Rows) -> Rows:
    """Return the primitives, none of which crosses a border of activities."""
    for border in list_cuts(activities):
        primitives = cut(primitives, border)
    return primitives


def _spare_primitives(activities: Rows, primitives: Rows) -> Rows:
    """Return the activities, their borders moved out of primitives that stay, to the nearer end."""
    starts = [row.start_frame for row in primitives]

    def moved(border: int) -> int:
        # The last primitive that starts at or before the border.
        at = bisect_right(starts, border) - 1
        if at < 0 or border >= primitives[at].stop_frame:
            return border
        start, stop = _list_edges(primitives[at])
        # To the nearer end; at equal distance to the start.
        return start if border - start <= stop - border else stop

    rows = [_change_span(row, moved(row.start_frame), moved(row.stop_frame)) for row in activities]
    # A row whose borders met has vanished.
    return [row for row in rows if row.start_frame < row.stop_frame]


def _insert_fixed(rows: Rows, fixed: Rows) -> Rows:
    """Return the rows with others in their place.

    What is left of less than half of a row is joined on.
    """
    # Rows that were put in already must not be changed by later ones.
    edges = {_list_edges(one) for one in fixed}
    for one in fixed:
        # What lies before and after the new row; rows inside are dropped.
        start, stop = _list_edges(one)
        before = [row for row in rows if row.start_frame < start]
        after = [row for row in rows if row.stop_frame > stop]
        if before and before[-1].stop_frame > start:
            before = _shorten_row(before, -1, -2, (before[-1].start_frame, start), edges)
        if after and after[0].start_frame < stop:
            after = _shorten_row(after, 0, 1, (stop, after[0].stop_frame), edges)
        rows = [*before, one, *after]
    return rows


def _shorten_row(
    rows: Rows, at: int, beside: int, span: tuple[int, int], edges: set[tuple[int, int]]
) -> Rows:
    """Return a row with the frames that it keeps; they go to the row beside it if they are few."""
    row, rows = rows[at], list(rows)
    rows[at] = _change_span(row, *span)
    few = 2 * count_frames(rows[at]) < count_frames(row) and len(rows) > 1
    if few and _list_edges(rows[beside]) not in edges:
        # Indices from the end become indices from the start.
        i, j, k = (k % len(rows) for k in (min(at, beside), max(at, beside), beside))
        return join_rows(rows, min(i, j), max(i, j), k)
    return rows


def _keep_inside(primitives: Rows, activity: Segment, found: Segmentation) -> Rows:
    """Return the primitives of an activity that stays, with its label where they had its old."""
    inside = [i for i, row in enumerate(primitives) if _measure_overlap(row, activity)]
    was = _find_middle_row(found.activities, activity)
    if activity.kind == "transition" and was.kind != "transition":
        one = replace(activity, level="primitive", label="")
        return [*primitives[: inside[0]], one, *primitives[inside[-1] + 1 :]]
    for i in inside:
        primitives[i] = change_parent(primitives[i], was, activity)
    return primitives


def _find_middle_row(rows: SegmentTable, row: Segment) -> Segment:
    """Return the one of the rows of a level that holds the middle frame of another."""
    # The last frame is one before the stop.
    middle = (row.start_frame + row.stop_frame - 1) // 2
    return rows[int(np.searchsorted(rows.start_frame, middle, side="right")) - 1]


def _measure_overlap(row: Segment, other: Segment) -> int:
    """Frames that both have."""
    shared = min(row.stop_frame, other.stop_frame) - max(row.start_frame, other.start_frame)
    return max(shared, 0)


def _list_edges(row: Segment) -> tuple[int, int]:
    return row.start_frame, row.stop_frame


def _change_span(row: Segment, start: int, stop: int) -> Segment:
    """Return the row with other frames; where it starts anew its border has no confidence."""
    confidence = row.border_confidence if start == row.start_frame else math.nan
    return replace(row, start_frame=start, stop_frame=stop, border_confidence=confidence)
