"""Convert labels to a truth: activities, and the repetitions in them.

People label repetitions either as adjacent segments with the same name, or on the level
``primitive``. Both give the same truth (`add_repetitions`): adjacent segments with equal labels are
one activity, and each of them is a repetition. A column ``count`` gives only their number.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from kineme.evaluation.truth import TRANSITION, Labelling, Truth
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import COLUMNS, Segment, SegmentTable, choose_kind

Count = int | None


def add_repetitions(labels: Segmentation) -> Segmentation:
    """Convert labels to both levels: activities, and their repetitions as primitives.

    Neighbours with the same name become one activity. Without primitives or a count, they are its
    repetitions. In a file of primitives only, each is a repetition, and a pause that is not longer
    than its neighbours does not end the activity. The provenance holds the counts in
    ``["labels"]["counts"]``: one for each activity, None if unknown.

    Examples
    --------
    >>> columns = {"level": ["activity"] * 3, "kind": ["activity"] * 3, "start_frame": [0, 30, 60],
    ...     "stop_frame": [30, 60, 90], "label": ["squat", "squat", "walk"]}
    >>> labels = add_repetitions(Segmentation.from_columns(columns, n_frames=90, fps=30))
    >>> labels.cuts().tolist(), labels.provenance["labels"]["counts"]
    ([60], [2, None])
    """
    rows = list(labels.activities)
    origin = labels.provenance.get("labels", {})
    known_counts = _count_repetitions(labels)
    single = origin.get("level") == "primitive"
    groups = _group_rows(rows, pauses=single)
    inner = list(labels.primitives) or _make_repetitions(rows, groups, known_counts, single=single)
    # A sum is known only if the count of each row is known.
    known = [[known_counts[i] for i in group if not _is_transition(rows[i])] for group in groups]
    counts: list[Count] = [
        sum(count or 0 for count in some) if some and None not in some else None for some in known
    ]
    starts = [rows[group[0]].start_frame for group in groups]
    found = [row.start_frame for row in inner if not _is_transition(row)]
    # Number of repetitions that start in each group.
    numbers = np.bincount(np.searchsorted(starts, found, "right") - 1, minlength=len(groups))
    for i, group in enumerate(groups):
        # Counts given by people are kept.
        if all(known_counts[row] is None for row in group) and numbers[i]:
            counts[i] = int(numbers[i])
    joined = [replace(rows[g[0]], stop_frame=rows[g[-1]].stop_frame) for g in groups]
    names = [name for name in COLUMNS if name != "activity"]
    return Segmentation.from_columns(
        {name: [getattr(row, name) for row in (*joined, *inner)] for name in names},
        n_frames=labels.n_frames,
        fps=labels.fps,
        provenance={**labels.provenance, "labels": {**origin, "counts": counts}},
    )


def make_truth(truth: Segmentation, *, n_frames: int, fps: float) -> Truth:
    """Convert the activities of a segmentation to a truth at a frame rate.

    Transitions become uncertain borders. Names of activities are their labels, or else their
    clusters. Counts are taken from the provenance, and repetitions are the primitives, see
    `add_repetitions`.
    """
    rows = truth.activities
    clusters = make_labelling(rows, fps=truth.fps)
    names = [
        TRANSITION if _is_transition(row) else _name_class(row.label) or name
        for row, name in zip(rows, clusters.labels, strict=True)
    ]
    # Numbers instead of labels identify the rows that remain at the new rate.
    numbered = replace(clusters, labels=tuple(map(str, range(len(names)))))
    numbered = numbered.at(frames=n_frames, fps=fps)
    kept = [int(label) for label in numbered.labels]  # others are shorter than a frame
    labels = replace(numbered, labels=tuple(names[i] for i in kept))
    counts = _count_repetitions(truth)
    actions = Truth.from_labelling(labels, counts=[counts[i] for i in kept])
    if not len(truth.primitives):
        return actions
    repetitions = make_labelling(truth.primitives, fps=truth.fps).at(frames=n_frames, fps=fps)
    return replace(actions, repetitions=repetitions)


def make_labelling(rows: SegmentTable, *, fps: float) -> Labelling:
    """Convert the clusters of one level of a segmentation to a labelling.

    Transitions are `TRANSITION`. Segments without a cluster have their label as name, or else a
    unique name.

    Parameters
    ----------
    rows : SegmentTable
        Segments of one level.
    fps : float
        Frames per second.

    Returns
    -------
    Labelling

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> make_labelling(found.activities, fps=found.fps).labels[:4]
    ('0', 'transition', '1', 'transition')
    """
    labels = [
        TRANSITION
        if row.kind == "transition"
        else f"{row.cluster}"
        if row.cluster >= 0
        else _name_class(row.label) or f"~{i}"
        for i, row in enumerate(rows)
    ]
    return Labelling(np.append(rows.start_frame, rows.stop_frame[-1]), tuple(labels), fps)


def _count_repetitions(labels: Segmentation) -> Sequence[Count]:
    """Return the known number of repetitions of each row of the activity level, or None."""
    counts: Sequence[Count] = labels.provenance.get("labels", {}).get("counts", ())
    rows = len(labels.activities)
    return (
        counts if len(counts) == rows else [None] * rows
    )  # the table was edited, or has no counts


def _name_class(label: str) -> str:
    """Return a label as the name of a class, distinct from `TRANSITION`."""
    return f"{label} (activity)" if label == TRANSITION else label


def _is_transition(row: Segment) -> bool:
    return row.kind == "transition"


def _get_activity_name(row: Segment) -> str:
    """Return the name of an activity: label or cluster; empty for transitions or if unknown."""
    if _is_transition(row):
        return ""
    return row.label or (f"cluster {row.cluster}" if row.cluster >= 0 else "")


def _group_rows(rows: Sequence[Segment], *, pauses: bool) -> list[list[int]]:
    """Group the indices of rows that form one activity, or one transition."""
    groups: list[list[int]] = []
    for i, row in enumerate(rows):
        name = _get_activity_name(row)
        if name and groups and name == _get_activity_name(rows[groups[-1][-1]]):
            groups[-1].append(i)
        elif pauses and name and len(groups) > 1 and _is_pause(*rows[i - 2 : i + 1]):
            # Merge the pause and this row with the group before the pause.
            groups[-2:] = [[*groups[-2], i - 1, i]]
        else:
            groups.append([i])
    return groups


def _is_pause(before: Segment, between: Segment, after: Segment) -> bool:
    shorter = min(before.duration_s, after.duration_s)
    equal = _is_transition(between) and _get_activity_name(before) == _get_activity_name(after)
    return equal and between.duration_s <= shorter


def _make_repetitions(
    rows: Sequence[Segment],
    groups: Sequence[Sequence[int]],
    given: Sequence[Count],
    *,
    single: bool,
) -> list[Segment]:
    """Return primitives for groups of rows that are repetitions; empty if there are none."""
    inner: list[Segment] = []
    for group in groups:
        first, last = rows[group[0]], rows[group[-1]]
        cut = not _is_transition(first) and all(given[i] is None for i in group)
        if cut and (single or len(group) > 1):
            for row in (rows[i] for i in group):
                kind = choose_kind("primitive", transition=_is_transition(row))
                inner.append(replace(row, level="primitive", kind=kind))
        else:
            # Primitives must tile the recording, so fill unknown parts with a transition.
            inner.append(
                Segment("primitive", "transition", first.start_frame, last.stop_frame, 0.0, 0.0)
            )
    return inner if any(row.kind == "primitive" for row in inner) else []
