"""The segment table: the package's common tongue.

It has one row per segment and the columns described in `kineme.segments.row`. Rows are ordered by
level, then by time. The activity level tiles the recording, and so does the
primitive level where there is one: the first segment starts at 0, each starts
where the one before it stops, the last stops at ``n_frames``. Frames are the
truth; seconds are always derived from them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, get_args, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._counts import counted
from kineme.errors import MissingDependencyError, ParameterError
from kineme.segments.row import COLUMNS, COMMENT, DESCRIBED, Column, Kind, Level, Segment, lacking

if TYPE_CHECKING:
    import pandas as pd

__all__ = [
    "COLUMNS",
    "COMMENT",
    "DESCRIBED",
    "Column",
    "Kind",
    "Level",
    "Segment",
    "SegmentTable",
    "lacking",
]


@dataclass(frozen=True, eq=False, repr=False)
class SegmentTable:
    """Segments as columns: one numpy array each, all of the same length.

    Usually taken from a `Segmentation`. A slice, a mask or row numbers pick rows,
    as in numpy; one number gives a `Segment`.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> table = kineme.read_segments(bundled_truth(), fps=60).table
    >>> table[0].kind, table[table.duration_s > 5.0]
    ('activity', <SegmentTable of 5 segments, 0.00 to 48.30 s>)
    """

    level: NDArray[np.str_]
    kind: NDArray[np.str_]
    start_frame: NDArray[np.int64]
    stop_frame: NDArray[np.int64]
    start_s: NDArray[np.float64]
    stop_s: NDArray[np.float64]
    cluster: NDArray[np.int64]
    activity: NDArray[np.int64]
    label: NDArray[np.str_]
    score: NDArray[np.float64]
    action: NDArray[np.int64]
    border_confidence: NDArray[np.float64]

    @property
    def duration_s(self) -> NDArray[np.float64]:
        """Seconds from start to stop of each segment."""
        return self.stop_s - self.start_s

    def columns(self) -> dict[str, NDArray[Any]]:
        """The columns by name, in the documented order."""
        return {name: getattr(self, name) for name in COLUMNS}

    def to_dataframe(self) -> pd.DataFrame:
        """One row per segment: the columns in the documented order, and ``duration_s``.

        Returns
        -------
        pandas.DataFrame

        Raises
        ------
        MissingDependencyError
            pandas is not installed.

        Examples
        --------
        >>> import kineme
        >>> from kineme.datasets import bundled_truth
        >>> segments = kineme.read_segments(bundled_truth(), fps=60)
        >>> frame = segments.activities.to_dataframe()
        >>> float(frame.groupby("label").duration_s.sum().round(2)["walk"])
        9.78
        """
        try:
            import pandas as pd
        except ImportError as error:
            raise MissingDependencyError("pandas", "tables") from error
        frame = pd.DataFrame(self.columns())
        frame.insert(COLUMNS.index("stop_s") + 1, "duration_s", self.duration_s)
        return frame

    def select(self, rows: slice | ArrayLike) -> SegmentTable:
        """The rows that a mask, a slice or an index array picks, as ``table[rows]``.

        Parameters
        ----------
        rows : slice or array_like
            Row numbers or a mask, as in numpy.

        Returns
        -------
        SegmentTable

        Raises
        ------
        IndexError
            There is no such row.
        ParameterError
            It picks no rows.
        """
        picked = rows if isinstance(rows, slice) else _picked(rows, len(self))
        try:
            columns = {name: column[picked] for name, column in self.columns().items()}
        except (TypeError, ValueError):  # a slice that is none of whole numbers
            raise ParameterError(f"{rows!r} picks no rows: give whole numbers") from None
        return SegmentTable(**columns)

    def __len__(self) -> int:
        return len(self.level)

    def __iter__(self) -> Iterator[Segment]:
        return map(Segment, *(column.tolist() for column in self.columns().values()))

    @overload
    def __getitem__(self, rows: int) -> Segment: ...
    @overload
    def __getitem__(self, rows: slice | ArrayLike) -> SegmentTable: ...
    def __getitem__(self, rows: Any) -> Segment | SegmentTable:
        """The segment in a row; or the table of those that a slice, mask or index array picks.

        Raises
        ------
        IndexError
            There is no such row.
        ParameterError
            Neither a row nor what picks rows.
        """
        if not isinstance(rows, int | np.integer) or isinstance(rows, bool):
            return self.select(rows)
        if not -len(self) <= rows < len(self):
            raise IndexError(f"row {rows} of a table of {len(self)}")
        return Segment(*(column[rows].item() for column in self.columns().values()))

    def __eq__(self, other: object) -> bool:
        """Equal in every cell, where nan equals nan."""
        if not isinstance(other, SegmentTable):
            return NotImplemented
        return all(
            np.array_equal(mine, theirs, equal_nan=mine.dtype.kind == "f")
            for mine, theirs in zip(self.columns().values(), other.columns().values(), strict=True)
        )

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        n = len(self)
        of = f"{counted(n, 'segment')}"
        span = f", {self.start_s.min():.2f} to {self.stop_s.max():.2f} s" if n else ""
        return f"<SegmentTable of {of}{span}>"

    def _repr_html_(self) -> str:
        from kineme.segments.notebook import page

        levels = [self[self.level == level] for level in get_args(Level)]
        return page(repr(self).strip("<>"), levels, self)


def _picked(rows: ArrayLike, n: int) -> NDArray[Any]:
    """A mask or row numbers of a table of n rows, checked."""
    try:
        picked = np.asarray(rows)
    except ValueError:
        picked = np.empty(())  # of lists of several lengths
    if picked.shape == (0,):
        return picked.astype(np.int64)
    if picked.ndim != 1 or picked.dtype.kind not in "biu":
        raise ParameterError(
            f"rows are picked by a slice, a mask or row numbers, not by {rows!r:.60}"
        )
    if picked.dtype.kind == "b" and len(picked) != n:
        raise ParameterError(f"a mask of {len(picked)} does not fit a table of {n} rows")
    if picked.dtype.kind != "b" and not (-n <= picked.min() and picked.max() < n):
        raise IndexError(f"row {picked[(picked < -n) | (picked >= n)][0]} of a table of {n}")
    return picked
