"""Carry corrections over to a new segmentation of the same recording.

Segments made by hand or checked (`kineme.segments.editing.annotating`) replace the new segments in
their place. Clusters are matched by shared frames: an old cluster matches the new one that has more
than half of its frames, unless this one has more frames of another old cluster. Matched clusters
keep their numbers, and thus their colours; other new clusters get unused numbers. The name of a
cluster goes to the matching cluster. The name of a single segment goes to the segment that shares
more than half of both their frames. Names without a match are listed.
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
from kineme.segments.editing.borders import (
    Rows,
    change_parent,
    count_frames,
    cut,
    join_rows,
    list_cuts,
    renumber_clusters,
    replace_rows,
)
from kineme.segments.editing.clusters import (
    cluster_names,
    has_own_name,
    name_cluster,
    set_cluster_names,
)
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment, SegmentTable


@dataclass(frozen=True)
class CarryResult:
    """Result of carrying corrections over: the new segmentation with the corrections."""

    segmentation: Segmentation
    corrections: int  # number of segments made by hand or checked; all of them are carried over
    names: int  # number of names of clusters and of single segments
    lost: list[str]  # one sentence for each name without a match


def carry_corrections(before: Segmentation, found: Segmentation) -> CarryResult:
    """Carry the corrections and names of a segmentation over to a new one.

    Parameters
    ----------
    before : Segmentation
        The corrected segmentation.
    found : Segmentation
        A new segmentation of the same recording.

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
    # Rows with any mark.
    fixed = [row for row in before if get_span(row) in set().union(*flags.values())]
    if not len(found.primitives):
        fixed = [row for row in fixed if row.level == "activity"]
    singles = {get_span(row) for row in before.table[has_own_name(before)]}
    # Names of clusters are carried over separately, so rows keep only their own names.
    placed = [row if get_span(row) in singles else replace(row, label="") for row in fixed]
    now = _impose_segments(_renumber(before, found), placed)
    # Imposing segments made new rows, so set the marks again.
    for mark, spans in flags.items():
        now = set_marked(now, mark, spans)
    now = set_comments(now, comments(before))
    annotation = replace(now.annotation, excluded=before.annotation.excluded)
    if fixed:
        annotation = replace(annotation, corrections=before.annotation.corrections)
    now = replace(now, annotation=annotation)
    return _carry_names(now, before, len(fixed))


def count_names(segmentation: Segmentation) -> int:
    """Return the number of names of clusters and of single segments."""
    return len(cluster_names(segmentation)) + int(has_own_name(segmentation).sum())


def _renumber(before: Segmentation, found: Segmentation) -> Segmentation:
    """Renumber the clusters of the new segments: matching ones get the old numbers."""
    match = _match_clusters(before, found)
    # Numbers of old clusters are never used for other ones.
    used = set(before.table.cluster.tolist())
    free = (number for number in count() if number not in used)
    number = {}
    for cluster in sorted(set(found.table.cluster.tolist()) - {-1}):
        number[cluster] = match[cluster] if cluster in match else next(free)
    return renumber_clusters(found, number)


def _match_clusters(before: Segmentation, found: Segmentation) -> dict[int, int]:
    """Return the number of the matching old cluster for each new cluster with a match."""
    shared: dict[int, Counter[int]] = {}
    for level in get_args(Level):
        # (2, frames): old and new cluster of each frame.
        pairs = np.stack([_spread_clusters(before, level), _spread_clusters(found, level)])
        # Distinct columns are pairs of clusters; counts are their shared frames.
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
        # `setdefault`: the old cluster with the largest overlap gets the new one.
        match.setdefault(new, cluster)
    return match


def _spread_clusters(segmentation: Segmentation, level: Level) -> NDArray[np.int64]:
    """Return the cluster of each frame; -1 if the level is empty."""
    clusters = segmentation.per_frame("cluster", level=level)
    return clusters if len(clusters) else np.full(segmentation.n_frames, -1)


def _carry_names(now: Segmentation, before: Segmentation, corrections: int) -> CarryResult:
    """Carry names over to the new table, and list the names without a match.

    ``corrections`` is the number of those carried over before.
    """
    lost, new_names = [], dict[int, str]()
    present = set(now.table.cluster.tolist())
    names, singles = cluster_names(before), before.table[has_own_name(before)]
    if not names and not len(singles):
        return CarryResult(now, corrections, names=0, lost=[])
    for cluster, name in names.items():
        if cluster in present:
            new_names[cluster] = name
            now = name_cluster(now, cluster, name)
        else:
            lost.append(f"the name “{name}” of cluster {cluster}: no cluster matches it")
    labels: dict[Span, str] = {}
    for row in singles:
        match = _find_matching_segment(now, row)
        if match is None:
            where = f"the {row.level} at {row.start_s:.2f} s"
            lost.append(f"the name “{row.label}” of {where}: no segment matches it")
        else:
            labels[get_span(match)] = row.label
    rows = [replace(row, label=labels.get(get_span(row), row.label)) for row in now]
    # Store empty names for clusters without one, so that none is inferred from labels.
    now = set_cluster_names(replace_rows(now, rows), dict.fromkeys(present, "") | new_names)
    return CarryResult(now, corrections, len(names) + len(singles), lost)


def _find_matching_segment(segmentation: Segmentation, row: Segment) -> Segment | None:
    """Return the segment that shares more than half of its frames and of a row's frames."""
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
    """Insert fixed segments into the segmentation."""
    by_level = {level: [row for row in fixed if row.level == level] for level in get_args(Level)}
    # Activities first: their borders must not cut fixed primitives.
    activities = _move_borders_out_of_primitives(list(found.activities), by_level["primitive"])
    activities = _insert_fixed(activities, by_level["activity"])
    if not len(found.primitives):
        return replace_rows(found, activities)
    primitives = _cut_at_borders(activities, list(found.primitives))
    for row in by_level["activity"]:
        primitives = _give_activity_to_primitives(primitives, row, found)
    primitives = _cut_at_borders(activities, _insert_fixed(primitives, by_level["primitive"]))
    return replace_rows(found, [*activities, *primitives])


def _cut_at_borders(activities: Rows, primitives: Rows) -> Rows:
    """Cut the primitives at the borders of activities."""
    for border in list_cuts(activities):
        primitives = cut(primitives, border)
    return primitives


def _move_borders_out_of_primitives(activities: Rows, primitives: Rows) -> Rows:
    """Move borders of activities inside fixed primitives to their nearer end."""
    starts = [row.start_frame for row in primitives]

    def move(border: int) -> int:
        # The last primitive that starts at or before the border.
        index = bisect_right(starts, border) - 1
        if index < 0 or border >= primitives[index].stop_frame:
            return border
        start, stop = _list_edges(primitives[index])
        # At a tie to the start.
        return start if border - start <= stop - border else stop

    rows = [_change_span(row, move(row.start_frame), move(row.stop_frame)) for row in activities]
    # Drop rows that are now empty.
    return [row for row in rows if row.start_frame < row.stop_frame]


def _insert_fixed(rows: Rows, fixed: Rows) -> Rows:
    """Replace rows by fixed ones; merge a remainder of less than half of a row with the next."""
    # Fixed rows must not be changed by later ones.
    edges = {_list_edges(one) for one in fixed}
    for one in fixed:
        # Rows before and after the fixed one; rows inside are dropped.
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
    """Shorten a row to a span; if few frames are left, merge it with the row beside it."""
    row, rows = rows[at], list(rows)
    rows[at] = _change_span(row, *span)
    is_small = 2 * count_frames(rows[at]) < count_frames(row) and len(rows) > 1
    if is_small and _list_edges(rows[beside]) not in edges:
        # Convert negative indices.
        i, j, k = (k % len(rows) for k in (min(at, beside), max(at, beside), beside))
        return join_rows(rows, min(i, j), max(i, j), k)
    return rows


def _give_activity_to_primitives(primitives: Rows, activity: Segment, found: Segmentation) -> Rows:
    """Move the primitives that overlap a fixed activity into it: kind, cluster and label follow.

    If the activity is a transition, one transition replaces them. ``found`` is the new
    segmentation, in which the former activity of each primitive is looked up.
    """
    inside = [i for i, row in enumerate(primitives) if _measure_overlap(row, activity)]
    if activity.kind == "transition":
        transition = replace(activity, level="primitive", label="")
        return [*primitives[: inside[0]], transition, *primitives[inside[-1] + 1 :]]
    primitives = list(primitives)
    for i in inside:
        old_parent = _find_middle_row(found.activities, primitives[i])
        primitives[i] = change_parent(primitives[i], old_parent, activity)
    return primitives


def _find_middle_row(rows: SegmentTable, row: Segment) -> Segment:
    """Return the row of a level that contains the middle frame of another row."""
    # - 1: the last frame is one before the stop.
    middle = (row.start_frame + row.stop_frame - 1) // 2
    return rows[int(np.searchsorted(rows.start_frame, middle, side="right")) - 1]


def _measure_overlap(row: Segment, other: Segment) -> int:
    """Return the number of frames that both rows share."""
    shared = min(row.stop_frame, other.stop_frame) - max(row.start_frame, other.start_frame)
    return max(shared, 0)


def _list_edges(row: Segment) -> tuple[int, int]:
    return row.start_frame, row.stop_frame


def _change_span(row: Segment, start: int, stop: int) -> Segment:
    """Change the frames of a row; drop the confidence of its border if that moves."""
    confidence = row.border_confidence if start == row.start_frame else math.nan
    return replace(row, start_frame=start, stop_frame=stop, border_confidence=confidence)
