"""Segment table: the common data structure of the package.

The fields of `Segment` declare its columns: type, meaning, unit and default. Rows and arrays,
validation, CSV, JSON, Parquet, data frames, the JSON Schema, the table in the docs and the messages
of the pages follow from this declaration, so a new column needs only a new field.

Rows are ordered by level, then by time. Each level tiles the recording (the primitive level may be
empty): the first segment starts at 0, each starts where the previous one stops, and the last stops
at ``n_frames``. Seconds are always derived from frames.
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
    """Declaration of a column, for files, pages and docs."""

    meaning: str
    type: type[str | int | float] = str  # unknown floats are nan
    unit: str = ""
    least: int | None = None  # smallest allowed number
    optional: bool = False  # a file may lack it
    derived: bool = False  # it follows from other columns
    allowed: tuple[str, ...] = ()  # empty if any text is allowed
    default: str | float | None = None  # value if unknown; None if the column is required


@dataclass(frozen=True, slots=True)
class Segment:
    """One row of the table: a span ``[start_frame, stop_frame)`` with its properties.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> walk = found.activities[0]
    >>> walk.kind, walk.label, walk.start_frame, walk.stop_frame, round(walk.duration_s, 2)
    ('activity', 'walk', 0, 326, 5.43)
    """

    level: Annotated[
        Level, Column("which of the two levels the row is in: `activity` or `primitive`")
    ]
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
            "the segment of the activity level that contains it (or is it), from 0",
            least=0,
            derived=True,
        ),
    ] = 0
    label: Annotated[str, Column("a name given by a person or a knowledge base, or empty")] = ""
    confidence: Annotated[
        float,
        Column("probability that its cluster is right; none if unknown"),
    ] = math.nan
    action: Annotated[
        int,
        Column(
            "`cluster` of the activity that contains it (or is it)",
            least=-1,
            optional=True,
            derived=True,
        ),
    ] = -1
    border_confidence: Annotated[
        float,
        Column("probability that its start is right; none if unknown", optional=True),
    ] = math.nan

    @property
    def duration_s(self) -> float:
        """Return the duration in seconds."""
        return self.stop_s - self.start_s


def _list_columns() -> Iterator[tuple[str, Column]]:
    """Yield name and column of each field of a segment."""
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
"""Additional column of files and data frames: clock time, if the recording has a clock."""
COMMENT = "comment"
"""Additional column of files: comments on segments, if there are any."""


NEEDED = [name for name, column in COLUMNS.items() if not column.optional]
"""Columns that every segment table in a file has."""


def find_lacking(names: Container[str]) -> list[str]:
    """Return the columns of `NEEDED` that are not among these names."""
    return [name for name in NEEDED if name not in names]


def choose_kind(level: Level, *, transition: bool) -> Kind:
    """Return the kind of a segment by its level: "transition", or the level itself."""
    return "transition" if transition else level


def _make_columns_class(table: type[Values]) -> type[Values]:
    """Turn the class into a dataclass with one array for each column."""
    table.__annotations__ = dict.fromkeys(COLUMNS, NDArray[Any])
    return dataclass(frozen=True, eq=False, repr=False)(table)


@_make_columns_class
class SegmentTable:
    """Segments as columns: one numpy array for each field of a `Segment`, all of the same length.

    It is usually taken from a `Segmentation`. A slice, a mask or row numbers select
    rows, as in numpy; one number returns a `Segment`.

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
        """Return the duration of each segment in seconds."""
        seconds: NDArray[np.float64] = self.stop_s - self.start_s
        return seconds

    def columns(self) -> dict[str, NDArray[Any]]:
        """Return the columns by name, in the documented order."""
        return {name: getattr(self, name) for name in COLUMNS}

    def with_columns(self, **columns: NDArray[Any]) -> Self:
        """Replace some columns, without validation."""
        return type(self)(**{**self.columns(), **columns})

    def to_dataframe(self) -> pd.DataFrame:
        """Return a data frame: the columns in the documented order, and ``duration_s``.

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
        """Return the rows that a mask, a slice or an index array selects, as ``table[rows]``.

        Parameters
        ----------
        rows : slice or array_like
            Row numbers or a mask, as in numpy.

        Raises
        ------
        IndexError
            There is no such row.
        ParameterError
            The argument is not a valid selection.
        """
        picked = rows if isinstance(rows, slice) else _check_selection(rows, len(self))
        try:
            columns = {name: column[picked] for name, column in self.columns().items()}
        except (TypeError, ValueError):  # a slice of other values than whole numbers
            raise ParameterError(f"{rows!r} selects no rows: give whole numbers") from None
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
        """Return the segment in a row, or several rows; see `select`."""
        if not isinstance(rows, int | np.integer) or isinstance(rows, bool):
            return self.select(rows)
        if not -len(self) <= rows < len(self):
            raise IndexError(f"row {rows} of a table of {len(self)}")
        return Segment(*(column[rows].item() for column in self.columns().values()))

    def __eq__(self, other: object) -> bool:
        """Return whether all cells are equal; nan equals nan."""
        if not isinstance(other, SegmentTable):
            return NotImplemented
        return all(
            np.array_equal(first, second, equal_nan=first.dtype.kind == "f")
            for first, second in zip(self.columns().values(), other.columns().values(), strict=True)
        )

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        n = len(self)
        count = f"{format_count(n, 'segment')}"
        span = f", {self.start_s.min():.2f} to {self.stop_s.max():.2f} s" if n else ""
        return f"<SegmentTable of {count}{span}>"

    def _repr_html_(self) -> str:
        from kineme.segments.display import make_page

        levels = [self[self.level == level] for level in get_args(Level)]
        return make_page(repr(self).strip("<>"), levels, self)


def make_segment_table(columns: Mapping[str, ArrayLike], fps: float) -> SegmentTable:
    """Create a table from columns in any row order; see `Segmentation.from_columns`."""
    # Derived columns are computed below.
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
    order = sort_rows(arrays)
    return SegmentTable(**{name: arrays[name][order] for name in COLUMNS})


def sort_rows(columns: Mapping[str, ArrayLike]) -> NDArray[np.intp]:
    """Return the rows of a segment table in its order: by level, start and stop."""
    # `lexsort` sorts by the last key first.
    names = "stop_frame", "start_frame", "level"
    return np.lexsort([np.asarray(columns[name]) for name in names])


def choose_kinds(levels: NDArray[np.str_], kinds: NDArray[np.str_]) -> NDArray[np.str_]:
    """Return the kinds of segments: transitions stay transitions, others get their level."""
    if ((levels == "activity") & (kinds == "primitive")).any():
        raise ParameterError(
            "a segment of level 'activity' is an activity or a transition, not a primitive"
        )
    return np.where(kinds == "transition", kinds, levels)


def _compute_derived(arrays: Mapping[str, NDArray[Any]], fps: float) -> dict[str, NDArray[Any]]:
    """Compute the columns that follow from others."""
    start = arrays["start_frame"]
    activities = np.flatnonzero(arrays["level"] == "activity")
    activities = activities[np.argsort(start[activities], kind="stable")]
    # Activity of each row: the last one that begins at or before it.
    enclosing = np.searchsorted(start[activities], start, side="right") - 1
    clusters = np.append(arrays["cluster"][activities], -1)  # appended for index -1
    return {
        "start_s": start / fps,
        "stop_s": arrays["stop_frame"] / fps,
        "activity": enclosing,
        "action": clusters[enclosing],
    }


def _check_column(values: ArrayLike, name: str) -> NDArray[Any]:
    """Convert the values of a column to an array of its type; raise ParameterError if invalid."""
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
    """Return a column of texts; raise ParameterError for other values."""
    values = array.ravel().tolist()
    invalid = next((value for value in values if not isinstance(value, str)), "")
    if invalid != "":
        raise ParameterError(f"column {name!r} must hold texts, not {invalid!r:.60}")
    for text in set(values):
        if allowed and text not in allowed:
            raise ParameterError(f"{name} must be {' or '.join(allowed)}, not {text!r}")
        # Control characters, surrogates, line and paragraph separators.
        if any(unicodedata.category(letter) in ("Cc", "Cs", "Zl", "Zp") for letter in text):
            raise ParameterError(f"{name} {text!r} must be one line of plain text")
    return array.astype(np.str_)


def _check_selection(rows: ArrayLike, n: int) -> NDArray[Any]:
    """Return a valid mask or valid row numbers of a table of n rows."""
    try:
        picked = np.asarray(rows)
    except ValueError:
        picked = np.empty(())  # nested lists of different lengths
    if picked.shape == (0,):
        return picked.astype(np.int64)
    if picked.ndim != 1 or picked.dtype.kind not in "biu":
        raise ParameterError(
            f"rows are selected by a slice, a mask or row numbers, not by {rows!r:.60}"
        )
    if picked.dtype.kind == "b" and len(picked) != n:
        raise ParameterError(f"a mask of {len(picked)} does not match a table of {n} rows")
    if picked.dtype.kind != "b" and not (-n <= picked.min() and picked.max() < n):
        raise IndexError(f"row {picked[(picked < -n) | (picked >= n)][0]} of a table of {n}")
    return picked
