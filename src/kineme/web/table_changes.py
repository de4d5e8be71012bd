"""What an edit makes other in a segment table, told in place of the whole.

The table of an hour has thousands of rows, of which an edit changes a few. Rows of both tables
that have the same span are the same row; of those, cells are told that have another value, and of
the others the rows themselves. What follows from other columns is not told: seconds, the activity
of a row, the names of clusters, the numbers of marked rows. ``editing/changes.ts`` of the pages
makes the table of it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme.segments.annotation import Span
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import COLUMNS, SegmentTable
from kineme.web.messages import Cells, SpansChange, TableChange

SPAN = ("level", "start_frame", "stop_frame")
COMPARED = [name for name, column in COLUMNS.items() if not column.derived and name not in SPAN]
Integers = NDArray[np.int64]


def table_change(
    before: Segmentation,
    now: Segmentation,
    ids: tuple[Sequence[str], Sequence[str]],
    *,
    revision: int,
) -> TableChange | None:
    """What is other in a table than before, at ``revision``; None where most of it is, or its head.

    ``ids`` are the identities of the rows of both.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> from kineme.segments import editing
    >>> table = kineme.read_segments(bundled_truth(), fps=60)
    >>> moved = editing.move_border(table, "activity", 326, 330)
    >>> ids = [str(number) for number in range(len(table))]
    >>> change = table_change(table, moved, (ids, ids), revision=4)
    >>> change.removed, [row.stop_frame for row in change.added]
    ([0, 1, 17, 18], [330, 380, 330, 380])
    """
    if _head(before) != _head(now):
        return None
    old, new = _rows_in_common(before, now)
    removed, at = _others(old, len(before)), _others(new, len(now))
    if len(at) > len(new):
        return None
    others = [row for was, row in zip(old.tolist(), new.tolist(), strict=True)
              if ids[0][was] != ids[1][row]]  # fmt: skip
    names = now.annotation.cluster_names
    comments, excluded = now.annotation.comments, now.annotation.excluded
    return TableChange(
        of=revision,
        removed=removed,
        at=at,
        added=[now.table[row] for row in at],
        cells=_cells(before.table.select(old), now.table.select(new), new),
        ids=[(row, ids[1][row]) for row in sorted([*at, *others])],
        checked=_spans(before.annotation.checked, now.annotation.checked),
        by_hand=_spans(before.annotation.by_hand, now.annotation.by_hand),
        comments=None if comments == before.annotation.comments else list(comments),
        cluster_names=None if names == before.annotation.cluster_names else dict(names),
        corrections=now.annotation.corrections,
        excluded=None if excluded == before.annotation.excluded else list(excluded),
    )


def _head(table: Segmentation) -> tuple[Any, ...]:
    """All but the rows and what people did to them."""
    return table.n_frames, table.fps, table.provenance, table.timings


def _rows_in_common(before: Segmentation, now: Segmentation) -> tuple[Integers, Integers]:
    """The numbers of the rows with the same span, in both tables."""

    def places(table: SegmentTable) -> Integers:
        found: Integers = table.start_frame + before.n_frames * (table.level == "primitive")
        return found

    _, old, new = np.intersect1d(
        places(before.table), places(now.table), assume_unique=True, return_indices=True
    )
    same = before.table.stop_frame[old] == now.table.stop_frame[new]
    return old[same], new[same]


def _others(rows: Integers, n: int) -> list[int]:
    """The numbers below n that are not among these."""
    others: list[int] = np.setdiff1d(np.arange(n), rows, assume_unique=True).tolist()
    return others


def _cells(before: SegmentTable, now: SegmentTable, numbers: Integers) -> list[Cells]:
    """Cells of the same rows that have another value; the rows have these numbers."""
    found: list[Cells] = []
    for name in COMPARED:
        old, new = getattr(before, name), getattr(now, name)
        same = old == new
        if new.dtype.kind == "f":
            same |= np.isnan(old) & np.isnan(new)
        values: dict[Any, list[int]] = {}
        for number, value in zip(numbers[~same].tolist(), new[~same].tolist(), strict=True):
            key = None if value != value else value  # noqa: PLR0124 (nan)
            values.setdefault(key, []).append(number)
        found += [Cells(column=name, value=value, rows=rows) for value, rows in values.items()]
    return found


def _spans(before: Iterable[Span], now: Iterable[Span]) -> SpansChange:
    old, new = {*before}, {*now}
    return SpansChange(added=sorted(new - old), removed=sorted(old - new))
