"""Segment table: the package's common tongue.

`Segment` declares its columns, a field each: type, meaning, unit, and what holds where nothing is
known. Rows and arrays, the checks, CSV, JSON, Parquet and data frames, the JSON Schema, the table
in the docs and the messages of the pages are made from that; a column more is a field more there.

Rows are ordered by level, then by time. The activity level tiles the recording, and so does the
primitive level where there is one: the first segment starts at 0, each starts where the one before
it stops, the last stops at ``n_frames``. Frames are the truth; seconds are always derived from
them.
"""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Container, Iterator, Mapping
from dataclasses import MISSING, dataclass, fields, replace
from types import MappingProxyType
from typing import (
    TYPE_CHECKING,
    Annotated,
    Any,
    Literal,
    Self,
    TypeVar,
    get_args,
    get_type_hints,
    overload,
)

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.checks import format_count, require_extra
from kineme.errors import ParameterError

if TYPE_CHECKING:
    import pandas as pd

Level = Literal["activity", "primitive"]
Kind = Literal["activity", "primitive", "transition"]
Values = TypeVar("Values")


@dataclass(frozen=True)
class Column:
    """One column of a table: what files, pages and docs need to know of it.

    Attributes
    ----------
    meaning : str
        In a sentence.
    type : type
        Of its cells; a float is nan where nothing is known.
    unit : str
        Of its numbers, where they have one.
    least : int, optional
        The smallest of its numbers.
    optional : bool
        True if a file may lack it.
    derived : bool
        Whether it follows from other columns.
    allowed : tuple of str
        The texts that it may hold; any where there are none.
    default : str or float, optional
        What holds where nothing is known; None: it is always needed.
    """

    meaning: str
    type: type[str | int | float] = str
    unit: str = ""
    least: int | None = None
    optional: bool = False
    derived: bool = False
    allowed: tuple[str, ...] = ()
    default: str | float | None = None


@dataclass(frozen=True, slots=True)
class Segment:
    """One row of the table: a span ``[start_frame, stop_frame)`` and what it is.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> walk = found.activities[0]
    >>> walk.kind, walk.label, walk.start_frame, walk.stop_frame, round(walk.duration_s, 2)
    ('activity', 'walk', 0, 326, 5.43)
    """

    level: Annotated[Level, Column("which rows of the table: `activity` or `primitive`")]
    kind: Annotated[Kind, Column("`activity` or `primitive`, as its level, or `transition`")]
    start_frame: Annotated[
        int, Column("first frame, from 0, at the rate of the source file", unit="frames", least=0)
    ]
    stop_frame: Annotated[int, Column("one past the last frame", unit="frames", least=1)]
    start_s: Annotated[float, Column("`start_frame / fps`", unit="s", least=0, derived=True)]
    stop_s: Annotated[float, Column("`stop_frame / fps`", unit="s", least=0, derived=True)]
    cluster: Annotated[
        int, Column("equal numbers are equal movements; -1: in no cluster", least=-1)
    ] = -1
    activity: Annotated[
        int,
        Column(
            "the segment of the activity level that it lies in (or is), from 0",
            least=0,
            derived=True,
        ),
    ] = 0
    label: Annotated[str, Column("a name given by a person or a knowledge base, or empty")] = ""
    confidence: Annotated[
        float,
        Column("how probable it is that what its kind claims is right; none where nobody says"),
    ] = math.nan
    action: Annotated[
        int,
        Column(
            "`cluster` of the activity that it lies in (or is)",
            least=-1,
            optional=True,
            derived=True,
        ),
    ] = -1
    border_confidence: Annotated[
        float,
        Column("how probable it is that its start is right; none where nobody says", optional=True),
    ] = math.nan

    @property
    def duration_s(self) -> float:
        """Seconds from start to stop."""
        return self.stop_s - self.start_s


def _list_columns() -> Iterator[tuple[str, Column]]:
    """Name and column of each field of a segment."""
    hints = get_type_hints(Segment, include_extras=True)
    for field in fields(Segment):
        kind, column = get_args(hints[field.name])
        texts = get_args(kind)
        yield (
            field.name,
            replace(
                column,
                type=str if texts else kind,
                allowed=texts,
                default=None if field.default is MISSING else field.default,
            ),
        )


COLUMNS: Mapping[str, Column] = MappingProxyType(dict(_list_columns()))
"""Columns by name, in the documented order."""
START_TIME = "start_time"
"""One more column of files and data frames, where the recording has a clock: what it shows."""
COMMENT = "comment"
"""One more column of files: what people said about a segment, in tables that have comments."""


NEEDED = [name for name, column in COLUMNS.items() if not column.optional]
"""Columns that every segment table in a file has."""


def find_lacking(names: Container[str]) -> list[str]:
    """Return the columns of `NEEDED` that are not among these names."""
    return [name for name in NEEDED if name not in names]


def choose_kind(level: Level, *, transition: bool) -> Kind:
    """Return the kind of a segment of a level that is a transition, or none."""
    return "transition" if transition else level


def _make_columns_class(table: type[Values]) -> type[Values]:
    """Return the class as a dataclass of one array for each column."""
    table.__annotations__ = dict.fromkeys(COLUMNS, NDArray[Any])
    return dataclass(frozen=True, eq=False, repr=False)(table)


@_make_columns_class
class SegmentTable:
    """Segments as columns: one numpy array for each field of a `Segment`, all of the same length.

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

    if TYPE_CHECKING:

        def __init__(self, **columns: NDArray[Any]) -> None: ...
        def __getattr__(self, name: str) -> NDArray[Any]: ...

    @property
    def duration_s(self) -> NDArray[np.float64]:
        """Seconds from start to stop of each segment."""
        seconds: NDArray[np.float64] = self.stop_s - self.start_s
        return seconds

    def columns(self) -> dict[str, NDArray[Any]]:
        """Return the columns by name, in the documented order."""
        return {name: getattr(self, name) for name in COLUMNS}

    def with_columns(self, **columns: NDArray[Any]) -> Self:
        """Return the same segments with other values in some columns, which are not checked."""
        return type(self)(**{**self.columns(), **columns})

    def to_dataframe(self) -> pd.DataFrame:
        """One row per segment: the columns in the documented order, and ``duration_s``.

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
        with require_extra("pandas", "tables"):
            import pandas as pd
        frame = pd.DataFrame(self.columns())
        frame.insert([*COLUMNS].index("stop_s") + 1, "duration_s", self.duration_s)
        return frame

    def select(self, rows: slice | ArrayLike) -> Self:
        """Return the rows that a mask, a slice or an index array picks, as ``table[rows]``.

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
        picked = rows if isinstance(rows, slice) else _check_selection(rows, len(self))
        try:
            columns = {name: column[picked] for name, column in self.columns().items()}
        except (TypeError, ValueError):  # a slice that is none of whole numbers
            raise ParameterError(f"{rows!r} picks no rows: give whole numbers") from None
        return type(self)(**columns)

    def __len__(self) -> int:
        return len(self.level)

    def __iter__(self) -> Iterator[Segment]:
        return map(Segment, *(column.tolist() for column in self.columns().values()))

    @overload
    def __getitem__(self, rows: int) -> Segment: ...
    @overload
    def __getitem__(self, rows: slice | ArrayLike) -> Self: ...
    def __getitem__(self, rows: Any) -> Segment | Self:
        """Return the segment in a row.

        Or the table of those that a slice, mask or index array picks.

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
            np.array_equal(first, second, equal_nan=first.dtype.kind == "f")
            for first, second in zip(self.columns().values(), other.columns().values(), strict=True)
        )

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        n = len(self)
        of = f"{format_count(n, 'segment')}"
        span = f", {self.start_s.min():.2f} to {self.stop_s.max():.2f} s" if n else ""
        return f"<SegmentTable of {of}{span}>"

    def _repr_html_(self) -> str:
        from kineme.segments.html import make_page

        levels = [self[self.level == level] for level in get_args(Level)]
        return make_page(repr(self).strip("<>"), levels, self)


def make_segment_table(columns: Mapping[str, ArrayLike], fps: float) -> SegmentTable:
    """Return a table from columns in any row order; see `Segmentation.from_columns`."""
    needed = {name: column for name, column in COLUMNS.items() if not column.derived}
    for name, column in needed.items():
        if column.default is None and name not in columns:
            raise ParameterError(f"a segment table needs the column {name!r}")
    n = np.size(columns["level"])
    arrays = {
        name: _check_column(columns.get(name, np.full(n, column.default)), name)
        for name, column in needed.items()
    }
    if "activity" in columns:
        arrays["activity"] = _check_column(columns["activity"], "activity")
    for name, array in arrays.items():
        if array.shape != (n,):
            raise ParameterError(f"column {name!r} has shape {array.shape}, 'level' has ({n},)")
    arrays = _compute_derived(arrays, fps) | arrays
    arrays["kind"] = choose_kinds(arrays["level"], arrays["kind"])
    order = np.lexsort((arrays["stop_frame"], arrays["start_frame"], arrays["level"]))
    return SegmentTable(**{name: arrays[name][order] for name in COLUMNS})


def choose_kinds(levels: NDArray[np.str_], kinds: NDArray[np.str_]) -> NDArray[np.str_]:
    """Return the kinds of segments by their levels: a transition stays one, the rest follow."""
    if ((levels == "activity") & (kinds == "primitive")).any():
        raise ParameterError(
            "a segment of level 'activity' is an activity or a transition, not a primitive"
        )
    return np.where(kinds == "transition", kinds, levels)


def _compute_derived(arrays: Mapping[str, NDArray[Any]], fps: float) -> dict[str, NDArray[Any]]:
    """Return the columns that follow from others."""
    start = arrays["start_frame"]
    activities = np.flatnonzero(arrays["level"] == "activity")
    activities = activities[np.argsort(start[activities], kind="stable")]
    enclosing = np.searchsorted(start[activities], start, side="right") - 1
    clusters = np.append(arrays["cluster"][activities], -1)  # the last: that of none
    return {
        "start_s": start / fps,
        "stop_s": arrays["stop_frame"] / fps,
        "activity": enclosing,
        "action": clusters[enclosing],
    }


def _check_column(values: ArrayLike, name: str) -> NDArray[Any]:
    """Return the values of a column as an array of its type.

    ParameterError where it cannot hold them.
    """
    column = COLUMNS[name]
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise ParameterError(f"column {name!r} must hold one value per row") from error
    if column.type is str:
        return _convert_texts(array, name, column.allowed)
    if column.type is int:
        return _convert_integers(array, name)
    if array.dtype.kind not in "iuf" or np.isinf(array).any():
        raise ParameterError(f"column {name!r} must be finite, or nan where nothing is known")
    return array.astype(np.float64)


def _convert_integers(array: NDArray[Any], name: str) -> NDArray[np.int64]:
    if array.size and array.dtype.kind not in "iu":
        raise ParameterError(f"column {name!r} must hold whole numbers, not {array.dtype}")
    if array.size and int(array.max()) > np.iinfo(np.int64).max:
        raise ParameterError(f"column {name!r} holds {array.max()}, which is too large")
    return array.astype(np.int64)


def _convert_texts(array: NDArray[Any], name: str, allowed: tuple[str, ...]) -> NDArray[np.str_]:
    values = array.ravel().tolist()
    other = next((value for value in values if not isinstance(value, str)), "")
    if other != "":
        raise ParameterError(f"column {name!r} must hold texts, not {other!r:.60}")
    for text in set(values):
        if allowed and text not in allowed:
            raise ParameterError(f"{name} must be {' or '.join(allowed)}, not {text!r}")
        if any(unicodedata.category(letter) in ("Cc", "Cs", "Zl", "Zp") for letter in text):
            raise ParameterError(f"{name} {text!r} must be one line of plain text")
    return array.astype(np.str_)


def _check_selection(rows: ArrayLike, n: int) -> NDArray[Any]:
    """Return a mask or row numbers of a table of n rows, checked."""
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
