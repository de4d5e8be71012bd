"""What labels say of a recording, as a truth: activities, and the repetitions in them.

People who cut repetitions name them all alike, back to back, or keep them on the level
``primitive``. Both are the same truth (`add_repetitions`): equal labels that touch each other are
one activity, and each of them is a repetition in it. A column ``count`` tells the number alone.
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
    """Return the same labels on both levels: activities, and as primitives the repetitions of each.

    Neighbours of one name are one activity. They are its repetitions where nobody says what is:
    neither primitives nor a count. Of a file of primitives alone each is a repetition, and a pause
    no longer than those beside it does not end the activity. The provenance has the counts,
    ``["labels"]["counts"]``: one for each row of the activity level, None where nobody knows.

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
    given = _count_repetitions(labels)
    single = origin.get("level") == "primitive"
    groups = _group_rows(rows, pauses=single)
    inner = list(labels.primitives) or _make_repetitions(rows, groups, given, single=single)
    # A sum is known only if each row's count is.
    known = [[given[i] for i in group if not _is_transition(rows[i])] for group in groups]
    counts: list[Count] = [
        sum(count or 0 for count in some) if some and None not in some else None for some in known
    ]
    starts = [rows[group[0]].start_frame for group in groups]
    found = [row.start_frame for row in inner if not _is_transition(row)]
    # How many repetitions start in each group.
    numbers = np.bincount(np.searchsorted(starts, found, "right") - 1, minlength=len(groups))
    for i, group in enumerate(groups):
        # A count that people gave is kept.
        if all(given[row] is None for row in group) and numbers[i]:
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
    """Return the activities of a segmentation as a truth at a rate.

    Transitions are uncertain borders.

    Activities are called by their labels, else by their clusters. Counts are those of the
    provenance, and repetitions the primitives, see `add_repetitions`.
    """
    rows = truth.activities
    clusters = make_labelling(rows, fps=truth.fps)
    names = [
        TRANSITION if _is_transition(row) else _name_class(row.label) or name
        for row, name in zip(rows, clusters.labels, strict=True)
    ]
    # Numbered, so that the rows that remain at the new rate can be told.
    numbered = replace(clusters, labels=tuple(map(str, range(len(names)))))
    numbered = numbered.at(frames=n_frames, fps=fps)
    kept = [int(label) for label in numbered.labels]  # the others vanished at this rate
    labels = replace(numbered, labels=tuple(names[i] for i in kept))
    counts = _count_repetitions(truth)
    actions = Truth.from_labelling(labels, counts=[counts[i] for i in kept])
    if not len(truth.primitives):
        return actions
    repetitions = make_labelling(truth.primitives, fps=truth.fps).at(frames=n_frames, fps=fps)
    return replace(actions, repetitions=repetitions)


def make_labelling(rows: SegmentTable, *, fps: float) -> Labelling:
    """Return the clusters of one level of a segmentation, as labels.

    Transitions are `TRANSITION`; what is in no cluster goes by its label, and without one
    gets a name of its own.

    Parameters
    ----------
    rows : SegmentTable
        Of one level.
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
    # A class of its own for a row without cluster and label.
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
    """Repetitions of each row of the activity level."""
    counts: Sequence[Count] = labels.provenance.get("labels", {}).get("counts", ())
    rows = len(labels.activities)
    return counts if len(counts) == rows else [None] * rows  # edited since, or none at all


def _name_class(label: str) -> str:
    """Return a label as the name of a class, also where people call one what belongs to none."""
    return f"{label} (activity)" if label == TRANSITION else label


def _is_transition(row: Segment) -> bool:
    return row.kind == "transition"


def _name(row: Segment) -> str:
    """Return what an activity is called; empty for a transition, and where nobody says."""
    if _is_transition(row):
        return ""
    return row.label or (f"cluster {row.cluster}" if row.cluster >= 0 else "")


def _group_rows(rows: Sequence[Segment], *, pauses: bool) -> list[list[int]]:
    """Numbers of the rows that are one activity, or one transition."""
    groups: list[list[int]] = []
    for i, row in enumerate(rows):
        name = _name(row)
        if name and groups and name == _name(rows[groups[-1][-1]]):
            groups[-1].append(i)
        elif pauses and name and len(groups) > 1 and _is_pause(*rows[i - 2 : i + 1]):
            # The last group but one takes in the pause and this row.
            groups[-2:] = [[*groups[-2], i - 1, i]]
        else:
            groups.append([i])
    return groups


def _is_pause(before: Segment, between: Segment, after: Segment) -> bool:
    shorter = min(before.duration_s, after.duration_s)
    equal = _is_transition(between) and _name(before) == _name(after)
    return equal and between.duration_s <= shorter


def _make_repetitions(
    rows: Sequence[Segment],
    groups: Sequence[Sequence[int]],
    given: Sequence[Count],
    *,
    single: bool,
) -> list[Segment]:
    """Return the level of primitives that rows of the activity level make up, if they do."""
    inner: list[Segment] = []
    for group in groups:
        first, last = rows[group[0]], rows[group[-1]]
        cut = not _is_transition(first) and all(given[i] is None for i in group)
        if cut and (single or len(group) > 1):
            for row in (rows[i] for i in group):
                kind = choose_kind("primitive", transition=_is_transition(row))
                inner.append(replace(row, level="primitive", kind=kind))
        else:  # nobody says
            # Primitives cover the whole recording, so the rest is a transition.
            inner.append(
                Segment("primitive", "transition", first.start_frame, last.stop_frame, 0.0, 0.0)
            )
    return inner if any(row.kind == "primitive" for row in inner) else []
