"""Tell which rows of a segment table an edit changed.

The table of an hour has thousands of rows, of which most edits change a few. ``editing/changes.ts``
of the pages makes the new rows from them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme.segments.segmentation import Segmentation
from kineme.segments.table import SegmentTable
from kineme.web.messages import TableChange

Integers = NDArray[np.int64]


def table_change(before: Segmentation, now: Segmentation, *, revision: int) -> TableChange:
    """Return the rows in which a table differs from the one before, which has that revision.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> from kineme.segments import editing
    >>> table = kineme.read_segments(bundled_truth(), fps=60)
    >>> moved = editing.move_border(table, "activity", 326, 330)
    >>> change = table_change(table, moved, revision=4)
    >>> change.removed, [row.stop_frame for row in change.added]
    ([0, 1, 17, 18], [330, 380, 330, 380])
    """
    old, new = _rows_in_common(before, now)
    at = _others(new, len(now))
    added = [now.table[row] for row in at]
    return TableChange(of=revision, removed=_others(old, len(before)), at=at, added=added)


def _rows_in_common(before: Segmentation, now: Segmentation) -> tuple[Integers, Integers]:
    """Return the numbers of the rows that are the same, in both tables."""

    def places(table: SegmentTable) -> Integers:
        # One number for level and first frame, of which no two rows have the same.
        found: Integers = table.start_frame + before.n_frames * (table.level == "primitive")
        return found

    _, old, new = np.intersect1d(
        places(before.table), places(now.table), assume_unique=True, return_indices=True
    )
    same = np.ones(len(old), bool)
    for name, column in before.table.columns().items():
        was, is_now = column[old], getattr(now.table, name)[new]
        same &= (was == is_now) | ((was != was) & (is_now != is_now))  # noqa: PLR0124 (nan)
    return old[same], new[same]


def _others(rows: Integers, n: int) -> list[int]:
    """Return the numbers below n that are not among these."""
    others: list[int] = np.setdiff1d(np.arange(n), rows, assume_unique=True).tolist()
    return others
