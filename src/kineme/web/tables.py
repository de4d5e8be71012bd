"""Segment tables as messages, and the rows that an edit changed.

The table of an hour has thousands of rows, and most edits change a few. ``editing/changes.ts`` of
the pages applies the changes.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from kineme.labels.json_table import SCHEMA
from kineme.segments.annotation import Annotation
from kineme.segments.editing import cluster_names
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, SegmentTable
from kineme.web.messages import Segment, Segments, TableChange

Integers = NDArray[np.int64]
Marks = dict[int, dict[str, Any]]
"""Optional fields of `kineme.web.messages.Segment` by row number; most rows have none."""


def make_segments_message(segmentation: Segmentation) -> Segments:
    """Return a segment table as a message."""
    table, annotation = segmentation.table, segmentation.annotation
    return Segments(
        schema=SCHEMA,
        n_frames=segmentation.n_frames,
        fps=segmentation.fps,
        provenance=dict(segmentation.provenance),
        timings=dict(segmentation.timings),
        segments=make_rows(table, find_marks(table, annotation)),
        cluster_names=_name_clusters(segmentation),
    )


def find_marks(table: SegmentTable, annotation: Annotation) -> Marks:
    """Return the annotations of a table's rows: checked, excluded, comment.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> from kineme.segments import editing
    >>> found = editing.check(kineme.read_segments(bundled_truth()), "activity", [380], True)
    >>> find_marks(found.table, found.annotation)
    {2: {'checked': True}}
    """
    marks: Marks = defaultdict(dict)
    columns = (table.level.tolist(), table.start_frame.tolist(), table.stop_frame.tolist())
    rows = {span: row for row, span in enumerate(zip(*columns, strict=True))}
    for span in annotation.checked:
        if span in rows:
            marks[rows[span]]["checked"] = True
    rows_of_level = {level: np.flatnonzero(table.level == level) for level in get_args(Level)}
    marked: list[tuple[Level, int, str, Any]] = [
        *(("primitive", frame, "excluded", True) for frame in annotation.excluded),
        *((level, frame, "comment", text) for level, frame, text in sorted(annotation.comments)),
    ]
    for level, frame, name, value in marked:
        # The segments of a level have no gaps: the last one that starts by then holds the frame.
        before = np.searchsorted(table.start_frame[rows_of_level[level]], frame, side="right")
        row = int(rows_of_level[level][before - 1]) if before else -1
        if row < 0 or frame >= columns[2][row]:
            continue
        mark = marks[row]
        mark[name] = f"{mark[name]}\n{value}" if name == "comment" and name in mark else value
    return dict(marks)


def make_rows(table: SegmentTable, marks: Marks, numbers: Sequence[int] = ()) -> list[Segment]:
    """Return the rows of a table with these marks, or only the rows with these ``numbers``."""
    chosen = table[np.asarray(numbers, int)] if len(numbers) else table
    cells = zip(*(column.tolist() for column in chosen.columns().values()), strict=True)
    row_numbers = numbers if len(numbers) else range(len(table))
    return [Segment(*row, **marks.get(i, {})) for i, row in zip(row_numbers, cells, strict=True)]


def make_table_change(
    before: Segmentation, now: Segmentation, *, revision: int
) -> TableChange | None:
    """Return the rows in which a table differs from ``before``, which has this revision.

    None if the length or the provenance differs, so that the whole table must be sent.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> from kineme.segments import editing
    >>> table = kineme.read_segments(bundled_truth(), fps=60)
    >>> moved = editing.move_border(table, "activity", 326, 330)
    >>> change = make_table_change(table, moved, revision=4)
    >>> change.removed, [row.stop_frame for row in change.rows]
    ([('activity', 326), ('primitive', 326)], [330, 380, 330, 380])
    """
    same_source = all(
        getattr(before, name) == getattr(now, name)
        for name in ("n_frames", "fps", "provenance", "timings")
    )
    if not same_source:
        return None
    marks = find_marks(now.table, now.annotation)
    changed = _find_changed_rows(before, now, marks)
    rows = make_rows(now.table, marks, changed) if changed else []
    gone = ~np.isin(_make_row_keys(before), _make_row_keys(now))
    levels, starts = before.table.level[gone].tolist(), before.table.start_frame[gone].tolist()
    return TableChange(
        of=revision,
        removed=list(zip(levels, starts, strict=True)),
        rows=rows,
        cluster_names=_name_clusters(now),
    )


def _find_changed_rows(before: Segmentation, now: Segmentation, marks: Marks) -> list[int]:
    """Return the numbers of the rows that are new or different."""
    _, old, new = np.intersect1d(
        _make_row_keys(before), _make_row_keys(now), assume_unique=True, return_indices=True
    )
    same = np.ones(len(old), bool)
    for name, column in before.table.columns().items():
        if name == "activity":  # pages renumber activities after a split themselves
            continue
        left, right = column[old], getattr(now.table, name)[new]
        # Equal, or both nan.
        same &= (left == right) | ((left != left) & (right != right))  # noqa: PLR0124
    earlier, pairs = find_marks(before.table, before.annotation), zip(old, new, strict=True)
    same &= [earlier.get(old_row) == marks.get(new_row) for old_row, new_row in pairs]
    changed: list[int] = np.setdiff1d(np.arange(len(now)), new[same], assume_unique=True).tolist()
    return changed


def _make_row_keys(segmentation: Segmentation) -> Integers:
    """Return a unique number for each row, from its level and first frame."""
    table = segmentation.table
    keys: Integers = table.start_frame + segmentation.n_frames * (table.level == "primitive")
    return keys


def _name_clusters(segmentation: Segmentation) -> dict[str, str]:
    return {str(cluster): name for cluster, name in cluster_names(segmentation).items()}
