"""The segment table: the package's common tongue.

It has one row per segment and these columns:

=============  ======  =====================================================
``level``      str     ``activity`` or ``primitive``
``kind``       str     ``activity``, or ``transition`` between two of them
``start_frame``  int   first frame, from 0, at the rate of the source file
``stop_frame``   int   one past the last frame
``start_s``    float   ``start_frame / fps``
``stop_s``     float   ``stop_frame / fps``
``cluster``    int     equal numbers are equal movements; -1: in no cluster
``activity``   int     the activity-level segment it lies in (or is), from 0
``label``      str     a name given by a person or a knowledge base, or empty
``score``      float   how sure the producer was; nan where it does not say
=============  ======  =====================================================

Rows are ordered by level, then by time. The activity level tiles the
recording, and so does the primitive level where there is one: the first
segment starts at 0, each starts where the one before it stops, the last stops
at ``n_frames``. Frames are the truth; seconds are always derived from them.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal, get_args, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme.errors import ParameterError

Level = Literal["activity", "primitive"]
Kind = Literal["activity", "transition"]

COLUMNS = (
    "level",
    "kind",
    "start_frame",
    "stop_frame",
    "start_s",
    "stop_s",
    "cluster",
    "activity",
    "label",
    "score",
)


@dataclass(frozen=True, slots=True)
class Segment:
    """One row of the table: a span ``[start_frame, stop_frame)`` and what it is."""

    level: Level
    kind: Kind
    start_frame: int
    stop_frame: int
    start_s: float
    stop_s: float
    cluster: int
    activity: int
    label: str
    score: float


@dataclass(frozen=True, eq=False)
class SegmentTable:
    """Segments as columns: one numpy array each, all of the same length."""

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

    def columns(self) -> dict[str, NDArray[Any]]:
        """The columns by name, in the documented order."""
        return {name: getattr(self, name) for name in COLUMNS}

    def select(self, rows: slice | ArrayLike) -> SegmentTable:
        """The rows that a mask, a slice or an index array picks, as ``table[rows]``."""
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
        IndexError : there is no such row
        ParameterError : neither a row nor what picks rows
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


def segment_table(columns: Mapping[str, ArrayLike], fps: float) -> SegmentTable:
    """A table from columns in any row order; see :meth:`Segmentation.from_columns`."""
    missing = [c for c in ("level", "kind", "start_frame", "stop_frame") if c not in columns]
    if missing:
        raise ParameterError(f"a segment table needs the column {missing[0]!r}")
    n = np.size(columns["level"])
    level = _texts(columns["level"], "level", get_args(Level))
    start = _integers(columns["start_frame"], "start_frame")
    stop = _integers(columns["stop_frame"], "stop_frame")
    arrays: dict[str, NDArray[Any]] = {
        "level": level,
        "kind": _texts(columns["kind"], "kind", get_args(Kind)),
        "start_frame": start,
        "stop_frame": stop,
        "start_s": start / fps,
        "stop_s": stop / fps,
        "cluster": _integers(columns.get("cluster", np.full(n, -1)), "cluster"),
        "activity": np.zeros(n, np.int64),
        "label": _texts(columns.get("label", np.full(n, "")), "label"),
        "score": _scores(columns.get("score", np.full(n, np.nan))),
    }
    if "activity" in columns:
        arrays["activity"] = _integers(columns["activity"], "activity")
    for name, array in arrays.items():
        if array.shape != (n,):
            raise ParameterError(f"column {name!r} has shape {array.shape}, 'level' has ({n},)")
    if "activity" not in columns:
        parents = np.sort(start[level == "activity"])
        arrays["activity"] = np.searchsorted(parents, start, side="right") - 1
    order = np.lexsort((stop, start, level))
    return SegmentTable(**{name: array[order] for name, array in arrays.items()})


def _picked(rows: ArrayLike, n: int) -> NDArray[Any]:
    """A mask or row numbers of a table of n rows, checked."""
    picked = _array(rows, "rows")
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


def _integers(values: ArrayLike, name: str) -> NDArray[np.int64]:
    array = _array(values, name)
    if array.size and array.dtype.kind not in "iu":
        raise ParameterError(f"column {name!r} must hold whole numbers, not {array.dtype}")
    return array.astype(np.int64)


def _scores(values: ArrayLike) -> NDArray[np.float64]:
    scores = _array(values, "score")
    if scores.dtype.kind not in "iuf" or np.isinf(scores).any():
        raise ParameterError("column 'score' must be finite, or nan where there is no score")
    return scores.astype(np.float64)


def _texts(values: ArrayLike, name: str, allowed: tuple[str, ...] = ()) -> NDArray[np.str_]:
    texts = _array(values, name)
    for text in set(texts.ravel().tolist()):
        if not isinstance(text, str):
            raise ParameterError(f"column {name!r} must hold texts, not {text!r}")
        if allowed and text not in allowed:
            raise ParameterError(f"{name} must be {' or '.join(allowed)}, not {text!r}")
        if any(unicodedata.category(letter) in ("Cc", "Cs", "Zl", "Zp") for letter in text):
            raise ParameterError(f"{name} {text!r} must be one line of plain text")
    return texts.astype(np.str_)


def _array(values: ArrayLike, name: str) -> NDArray[Any]:
    try:
        return np.asarray(values)
    except ValueError as error:
        raise ParameterError(f"column {name!r} must hold one value per row") from error
