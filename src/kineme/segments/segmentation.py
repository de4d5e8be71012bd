"""Segmentation: the segments of a recording, with provenance and timings.

The columns of its table are described in `kineme.segments.table`.

Every segmentation is validated on creation: levels tile the recording, primitives lie in
activities, and provenance is plain JSON.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, TypedDict, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.checks import check_type, format_count, is_number, is_one_of
from kineme._util.json import convert_json, find_fault
from kineme.errors import ParameterError
from kineme.recordings.times import Clock
from kineme.segments.annotation import NO_ANNOTATION, Annotation
from kineme.segments.hierarchy import DEFAULT_DETAIL, Hierarchy, check_detail
from kineme.segments.table import (
    COLUMNS,
    START_TIME,
    Level,
    Segment,
    SegmentTable,
    make_segment_table,
)

if TYPE_CHECKING:
    import pandas as pd

FASTEST, LONGEST = 1e9, 1e11
"""Upper limits of frames per second and of seconds that every label format can store."""


class Input(TypedDict, total=False):
    """File that a recording was read from."""

    path: str | None
    format: str | None
    sha256: str | None


class LabelFile(TypedDict, total=False):
    """File that labels were read from, with repetition counts of activities if it has some."""

    path: str | None
    format: str | None
    counts: list[int | None]


class Provenance(TypedDict, total=False):
    """Parts of a provenance that the package reads again; it may hold more."""

    input: Input | None
    labels: LabelFile
    preset: str | None
    parameters: dict[str, Any]
    notes: list[str]
    gaps: list[tuple[int, int]]


def check_recording(n_frames: int, fps: float) -> None:
    """Raise ParameterError for an impossible length or rate of a recording."""
    if not (is_number(n_frames) and n_frames >= 1):
        raise ParameterError(f"a recording has at least 1 frame, not {n_frames!r:.60}")
    if not (is_number(fps) and 0 < fps < FASTEST):
        raise ParameterError(f"the frame rate must be a positive number, not {fps!r:.60}")
    if not n_frames / fps < LONGEST:
        raise ParameterError(f"a recording cannot last {n_frames / fps:.3g} s")


def check_same_length(segments: Segmentation, n_frames: int) -> None:
    """Raise ParameterError unless segments have as many frames as a recording."""
    if segments.n_frames != n_frames:
        raise ParameterError(
            f"the segments have {segments.n_frames} frames, but the recording has {n_frames}"
        )


def check_tiles(rows: SegmentTable, level: Level, n_frames: int) -> None:
    """Raise ParameterError unless the segments of a level tile the recording."""
    if not len(rows) and level == "primitive":
        return
    if not len(rows) or rows.start_frame[0] != 0 or rows.stop_frame[-1] != n_frames:
        raise ParameterError(f"the {level} level must cover frames 0 to {n_frames}")
    # Report the first mismatch, if any.
    for row in np.flatnonzero(rows.stop_frame[:-1] != rows.start_frame[1:])[:1].tolist():
        raise ParameterError(
            f"one {level} stops at frame {rows.stop_frame[row]}, the next starts at "
            f"{rows.start_frame[row + 1]}: segments of a level must touch and not overlap"
        )
    if (rows.stop_frame <= rows.start_frame).any():
        empty = rows[int(np.argmax(rows.stop_frame <= rows.start_frame))]
        raise ParameterError(f"the {level} at frame {empty.start_frame} has no frames")


def check_parents(activities: SegmentTable, primitives: SegmentTable) -> None:
    """Raise ParameterError unless each primitive lies in the activity that it names."""
    if (activities.activity != np.arange(len(activities))).any():
        raise ParameterError("column 'activity' of the activity level must count 0, 1, 2, ...")
    # Activity of each primitive: the last one that begins at or before it.
    enclosing = np.searchsorted(activities.start_frame, primitives.start_frame, "right") - 1
    stops = activities.stop_frame[enclosing]
    # Report the first fault, if any.
    for i in np.flatnonzero(primitives.stop_frame > stops)[:1].tolist():
        row = primitives[i]
        raise ParameterError(
            f"the primitive of frames {row.start_frame} to {row.stop_frame} crosses the border "
            f"of an activity at {stops[i]}"
        )
    for i in np.flatnonzero(primitives.activity != enclosing)[:1].tolist():
        row = primitives[i]
        raise ParameterError(
            f"the primitive at frame {row.start_frame} names activity {row.activity}, "
            f"but lies in activity {enclosing[i]}"
        )


def copy_as_json(value: Mapping[str, Any], name: str) -> dict[str, Any]:
    """Copy a mapping to plain JSON values; raise ParameterError if that is impossible."""
    try:
        copy: dict[str, Any] = json.loads(json.dumps(dict(value), allow_nan=False))
    except (TypeError, ValueError, RecursionError) as error:
        raise ParameterError(f"{name} cannot be written as JSON: {error}") from error
    if fault := find_fault(copy):  # valid for `json`, but not for other readers
        raise ParameterError(f"{name} {fault}")
    return copy


def as_provenance(value: Mapping[str, Any]) -> dict[str, Any]:
    """Return a copy in plain JSON; an input that is a text becomes a path.

    Raise ParameterError if a known part has another structure than the package writes.
    """
    provenance = copy_as_json(value, "provenance")
    if isinstance(provenance.get("input"), str):
        provenance["input"] = {"path": provenance["input"]}
    try:
        convert_json(provenance, Provenance)
    except ValueError as error:
        raise ParameterError(f"the provenance is not as kineme writes it: {error}") from error
    return provenance


@dataclass(frozen=True, repr=False)
class Segmentation:
    """Segments of one recording.

    It is usually created by `kineme.segment`, `from_columns` or `kineme.read_segments`.

    Parameters
    ----------
    table : SegmentTable
        The segments of both levels.
    n_frames : int
        Length of the recording in frames of the source file.
    fps : float
        Frames per second of the source file.
    provenance : mapping
        Plain JSON: ``kineme`` (version), ``preset``, ``parameters``, ``input`` (``path``,
        ``format``, ``sha256``), ``notes`` (sentences on what was inferred), and, if the
        recording has them, its ``clock`` and the ``rows`` of the source at its borders. It may
        hold more.
    timings : mapping of str to float
        Seconds per stage; ignored when results are compared.
    hierarchy : Hierarchy, optional
        Tables at all details, including this one. None if there is only one detail, or if the
        table has been edited.
    annotation : Annotation
        Annotation of the table by people.

    Raises
    ------
    ParameterError
        A level does not tile the recording, rows contradict each other, or the
        provenance cannot be written as JSON.

    Examples
    --------
    >>> import kineme
    >>> kineme.Segmentation.from_columns(
    ...     {"level": ["activity"], "kind": ["activity"], "start_frame": [0], "stop_frame": [90]},
    ...     n_frames=90,
    ...     fps=30,
    ... )
    <Segmentation of 90 frames (3.0 s): 1 activity, 0 transitions, 0 primitives, 0 clusters>
    """

    table: SegmentTable
    n_frames: int
    fps: float
    provenance: Mapping[str, Any] = field(default_factory=dict)
    timings: Mapping[str, float] = field(default_factory=dict, compare=False)
    hierarchy: Hierarchy | None = None
    annotation: Annotation = NO_ANNOTATION

    def __post_init__(self) -> None:
        check_type(
            self.table, SegmentTable, "Segmentation", "Segmentation.from_columns takes columns"
        )
        check_type(self.annotation, Annotation, "Segmentation", "Annotation() is an empty one")
        check_recording(self.n_frames, self.fps)
        activities, primitives = self.activities, self.primitives
        check_tiles(activities, "activity", self.n_frames)
        check_tiles(primitives, "primitive", self.n_frames)
        check_parents(activities, primitives)
        object.__setattr__(self, "provenance", as_provenance(self.provenance))
        object.__setattr__(self, "timings", copy_as_json(self.timings, "timings"))
        if self.hierarchy is not None:
            selected = self.hierarchy.table
            if selected is not self.table and selected != self.table:
                object.__setattr__(self, "hierarchy", None)

    @classmethod
    def from_columns(
        cls,
        columns: Mapping[str, ArrayLike],
        *,
        n_frames: int,
        fps: float,
        provenance: Mapping[str, Any] | None = None,
        timings: Mapping[str, float] | None = None,
        annotation: Annotation = NO_ANNOTATION,
    ) -> Segmentation:
        """Create a segmentation from columns in any row order.

        ``level``, ``kind``, ``start_frame`` and ``stop_frame`` are required. By default
        ``cluster`` is -1, ``label`` is empty, ``confidence`` and ``border_confidence``
        are nan, and ``activity`` follows from the frames. ``start_s``, ``stop_s`` and
        ``action`` are always computed.

        Parameters
        ----------
        columns : mapping of str to array_like
            Columns by name, with one value for each segment.
        n_frames : int
            Length of the recording.
        fps : float
            Frames per second.
        provenance, timings : mapping, optional
            As in `Segmentation`.
        annotation : Annotation
            Annotation of the table by people.

        Raises
        ------
        ParameterError
            A column is missing or holds invalid values, or as for `Segmentation`.
        """
        check_recording(n_frames, fps)
        check_type(columns, Mapping, "from_columns", "give arrays by the names of columns")
        table = make_segment_table(columns, float(fps))
        provenance = {} if provenance is None else provenance
        timings = {} if timings is None else timings
        return cls(table, int(n_frames), float(fps), provenance, timings, annotation=annotation)

    @property
    def activities(self) -> SegmentTable:
        """Return the activity level: activities and the transitions between them."""
        return self.level("activity")

    @property
    def primitives(self) -> SegmentTable:
        """Return the primitive level: single repetitions, and transitions."""
        return self.level("primitive")

    def level(self, level: Level) -> SegmentTable:
        """Return the segments of one level of the table, in time order.

        Raises ParameterError if `level` is neither ``"activity"`` nor ``"primitive"``.
        """
        if not is_one_of(level, get_args(Level)):
            raise ParameterError(
                f"level must be 'activity' or 'primitive', not {level!r}; "
                "at_detail() gives coarser and finer results"
            )
        return self.table.select(self.table.level == level)

    def at_detail(self, detail: float) -> Segmentation:
        """Return the result with fewer or more segments.

        Parameters
        ----------
        detail : float
            Above 0. 1 is the default result, less is coarser, more is finer. Every border at
            one detail is also a border at all finer ones.

        Returns
        -------
        Segmentation
            The finest result that is not finer than `detail`, with the same hierarchy, so that
            other details stay available. Without a hierarchy, this result.

        Raises
        ------
        ParameterError
            `detail` is not a number above 0.

        Examples
        --------
        >>> import kineme
        >>> segments = kineme.segment(kineme.read(kineme.bundled_recording()))
        >>> {*segments.at_detail(0.5).cuts().tolist()} <= {*segments.cuts().tolist()}
        True
        >>> segments.at_detail(0.5).at_detail(1) == segments
        True
        """
        check_detail(detail)
        if self.hierarchy is None:
            return self
        chosen = self.hierarchy.at(detail)
        provenance = {name: value for name, value in self.provenance.items() if name != "detail"}
        if chosen.detail != DEFAULT_DETAIL:
            provenance["detail"] = chosen.detail
        return replace(self, table=chosen.table, provenance=provenance, hierarchy=chosen)

    def cuts(self, level: Level = "activity") -> NDArray[np.int64]:
        """Return the frames at which one segment of a level ends and the next starts."""
        return self.level(level).start_frame[1:]

    def repetitions(self) -> dict[int, int]:
        """Return the number of primitives of each cluster."""
        clusters = self.primitives.cluster
        return dict(sorted(Counter(clusters[clusters >= 0].tolist()).items()))

    def per_frame(self, column: str = "cluster", *, level: Level = "primitive") -> NDArray[Any]:
        """Return the value of a column for each frame.

        Returns
        -------
        (n_frames,) array

        Raises
        ------
        ParameterError
            There is no such column or level.

        Examples
        --------
        >>> import kineme
        >>> from kineme.datasets import bundled_truth
        >>> segments = kineme.read_segments(bundled_truth(), fps=60)
        >>> segments.per_frame("label", level="activity")[60].item()
        'walk'
        """
        if not is_one_of(column, COLUMNS):
            raise ParameterError(f"no column {column!r}; there are {', '.join(COLUMNS)}")
        rows = self.level(level)
        values: NDArray[Any] = getattr(rows, column)
        return np.repeat(values, rows.stop_frame - rows.start_frame)

    def describe(self) -> str:
        """Describe the numbers of activities, transitions, primitives and clusters."""
        kinds = self.activities.kind.tolist()
        clusters = {*self.activities.cluster.tolist(), *self.primitives.cluster.tolist()}
        counts = {
            "activity": kinds.count("activity"),
            "transition": kinds.count("transition"),
            "primitive": self.primitives.kind.tolist().count("primitive"),
            "cluster": len(clusters - {-1}),
        }
        return ", ".join(format_count(n, name) for name, n in counts.items())

    @property
    def clock(self) -> Clock | None:
        """Return the clock of the recording, if its times do not start at 0."""
        content = self.provenance.get("clock")
        return None if content is None else Clock.from_json(content)

    def start_times(self) -> list[str]:
        """Return the clock time at the start of each segment; empty without a clock.

        Returns
        -------
        list of str
            Seconds, or ISO 8601 dates in UTC if the clock counts since 1970. Dates without a zone
            in the file keep their hour, as if they were UTC.
        """
        clock = self.clock
        return [] if clock is None else [clock.format_time(row.start_s) for row in self]

    def rows(self) -> dict[str, NDArray[np.int64]]:
        """Return ``start_row`` and ``stop_row`` of each segment in the time-ordered source.

        Returns
        -------
        dict of str to (segments,) array
            Empty if frames are the rows of the source.
        """
        known = self.provenance.get("rows")
        if known is None:
            return {}
        # Interpolate for borders that were moved by hand.
        ends = {"start_row": self.table.start_frame, "stop_row": self.table.stop_frame}
        rows = {n: np.interp(end, known["frames"], known["rows"]) for n, end in ends.items()}
        return {name: np.rint(values).astype(np.int64) for name, values in rows.items()}

    def more_columns(self) -> dict[str, Sequence[Any]]:
        """Return additional columns of files and data frames: clock times and source rows."""
        times = self.start_times()
        clock: dict[str, Sequence[Any]] = {START_TIME: times} if times else {}
        return clock | {name: rows.tolist() for name, rows in self.rows().items()}

    def to_dataframe(self) -> pd.DataFrame:
        """Return the table of both levels as a data frame, see `SegmentTable.to_dataframe`.

        Returns
        -------
        pandas.DataFrame
            With ``start_time`` if the recording has a clock, see `start_times`, and with
            ``start_row`` and ``stop_row`` if its frames are not the rows of the source.

        Raises
        ------
        MissingDependencyError
            pandas is not installed.
        """
        frame = self.table.to_dataframe()
        for name, values in self.more_columns().items():
            frame[name] = values
        return frame

    def __len__(self) -> int:
        return len(self.table)

    def __iter__(self) -> Iterator[Segment]:
        return iter(self.table)

    def __repr__(self) -> str:
        seconds = self.n_frames / self.fps
        length = f"{format_count(self.n_frames, 'frame')} ({seconds:.1f} s)"
        return f"<Segmentation of {length}: {self.describe()}>"

    def _repr_html_(self) -> str:
        from kineme.segments.display import make_page

        return make_page(
            repr(self).strip("<>"), [self.activities, self.primitives], self.activities
        )
