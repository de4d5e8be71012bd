"""Segmentation: the segments of a recording, where they came from, what they cost.

The columns of its table are described in `kineme.segments.table`.

Every segmentation is checked when it is made: levels tile the recording, primitives lie in
activities, provenance is plain JSON.
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
from kineme.recordings.clock import Clock
from kineme.segments.annotation import NO_ANNOTATION, Annotation
from kineme.segments.hierarchy import DEFAULT_DETAIL, Hierarchy, check_detail
from kineme.segments.table import (
    COLUMNS,
    START_TIME,
    Level,
    Segment,
    SegmentTable,
    segment_table,
)

if TYPE_CHECKING:
    import pandas as pd

FASTEST, LONGEST = 1e9, 1e11
"""Frames per second and seconds, below which every label format can tell them."""


class Input(TypedDict, total=False):
    """File that a recording was read from."""

    path: str | None
    format: str | None
    sha256: str | None


class LabelFile(TypedDict, total=False):
    """File that labels were read from, and repetitions of each activity where it has some."""

    path: str | None
    format: str | None
    counts: list[int | None]


class Provenance(TypedDict, total=False):
    """What is read again of a provenance, as the package writes it; people may add to it."""

    input: Input | None
    labels: LabelFile
    preset: str | None
    parameters: dict[str, Any]
    notes: list[str]
    gaps: list[tuple[int, int]]


def check_recording(n_frames: int, fps: float) -> None:
    """ParameterError where no recording has this length or rate."""
    if not (is_number(n_frames) and n_frames >= 1):
        raise ParameterError(f"a recording has at least 1 frame, not {n_frames!r:.60}")
    if not (is_number(fps) and 0 < fps < FASTEST):
        raise ParameterError(f"the frame rate must be a positive number, not {fps!r:.60}")
    if not n_frames / fps < LONGEST:
        raise ParameterError(f"no recording lasts {n_frames / fps:.3g} s, as this would")


def check_tiles(rows: SegmentTable, level: Level, n_frames: int) -> None:
    """ParameterError where the segments of a level do not follow each other from start to end."""
    if not len(rows) and level == "primitive":
        return
    if not len(rows) or rows.start_frame[0] != 0 or rows.stop_frame[-1] != n_frames:
        raise ParameterError(f"the {level} level must cover frames 0 to {n_frames}")
    # The first of these, if any.
    for row in np.flatnonzero(rows.stop_frame[:-1] != rows.start_frame[1:])[:1].tolist():
        raise ParameterError(
            f"one {level} stops at frame {rows.stop_frame[row]}, the next starts at "
            f"{rows.start_frame[row + 1]}: segments of a level must touch and not overlap"
        )
    if (rows.stop_frame <= rows.start_frame).any():
        empty = rows[int(np.argmax(rows.stop_frame <= rows.start_frame))]
        raise ParameterError(f"the {level} at frame {empty.start_frame} has no frames")


def check_parents(activities: SegmentTable, primitives: SegmentTable) -> None:
    """ParameterError where a primitive does not lie in the activity that it names."""
    if (activities.activity != np.arange(len(activities))).any():
        raise ParameterError("column 'activity' of the activity level must count 0, 1, 2, ...")
    # The activity of each primitive: the last that begins at or before it.
    enclosing = np.searchsorted(activities.start_frame, primitives.start_frame, "right") - 1
    outside = primitives.stop_frame > activities.stop_frame[enclosing]
    if outside.any():
        row = primitives[int(np.argmax(outside))]
        raise ParameterError(
            f"the primitive of frames {row.start_frame} to {row.stop_frame} crosses the border "
            f"of an activity at {activities.stop_frame[enclosing[np.argmax(outside)]]}"
        )
    wrong = primitives.activity != enclosing
    if wrong.any():
        row = primitives[int(np.argmax(wrong))]
        raise ParameterError(
            f"the primitive at frame {row.start_frame} names activity {row.activity}, "
            f"but lies in activity {enclosing[np.argmax(wrong)]}"
        )


def copy_as_json(value: Mapping[str, Any], name: str) -> dict[str, Any]:
    """A copy made of what JSON has: dicts, lists, texts, finite numbers, booleans, None."""
    try:
        copy: dict[str, Any] = json.loads(json.dumps(dict(value), allow_nan=False))
    except (TypeError, ValueError, RecursionError) as error:
        raise ParameterError(f"{name} cannot be written as JSON: {error}") from error
    if fault := find_fault(copy):  # which nobody could read again
        raise ParameterError(f"{name} {fault}")
    return copy


def as_provenance(value: Mapping[str, Any]) -> dict[str, Any]:
    """Return a copy of plain JSON; an input that is a text is the path of one.

    ParameterError where something that the package writes there is of another shape.
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

    Usually made by `kineme.segment`, `from_columns` or `kineme.read_segments`.

    Parameters
    ----------
    table : SegmentTable
        The segments of both levels.
    n_frames : int
        Length of the recording, frames of the source file.
    fps : float
        Frames per second of the source file.
    provenance : mapping
        What JSON can hold: ``kineme`` (version), ``preset``, ``parameters``,
        ``input`` (``path``, ``format``, ``sha256``), ``notes`` (sentences on what was
        inferred), and where the recording has them its ``clock`` and the ``rows`` of the source
        at its borders. A producer may add more.
    timings : mapping of str to float
        Seconds spent per stage; two results that differ in these alone are equal.
    hierarchy : Hierarchy, optional
        The tables at other details, and this one among them; what `level` gives by number.
        None where there is one detail, and where the table is not one of them (any more).
    annotation : Annotation
        What people did to the table.

    Raises
    ------
    ParameterError
        A level does not tile the recording, a row contradicts another, or the
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
        check_type(self.annotation, Annotation, "Segmentation", "Annotation() is one of nothing")
        check_recording(self.n_frames, self.fps)
        activities, primitives = self.activities, self.primitives
        check_tiles(activities, "activity", self.n_frames)
        check_tiles(primitives, "primitive", self.n_frames)
        check_parents(activities, primitives)
        object.__setattr__(self, "provenance", as_provenance(self.provenance))
        object.__setattr__(self, "timings", copy_as_json(self.timings, "timings"))
        if self.hierarchy is not None:
            looked_at = self.hierarchy.table
            if looked_at is not self.table and looked_at != self.table:
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
        """Return a segmentation from columns in any row order.

        ``level``, ``kind``, ``start_frame`` and ``stop_frame`` are needed.
        ``cluster`` is -1, ``label`` empty, ``confidence`` and ``border_confidence``
        nan where not given; ``activity`` then follows from the frames.
        ``start_s``, ``stop_s`` and ``action`` are always computed, whatever
        is given.

        Parameters
        ----------
        columns : mapping of str to array_like
            By name, one value for each segment.
        n_frames : int
            Length of the recording.
        fps : float
            Frames per second.
        provenance, timings : mapping, optional
            As in `Segmentation`.
        annotation : Annotation
            What people did to the table.

        Returns
        -------
        Segmentation

        Raises
        ------
        ParameterError
            A column is missing or holds what it cannot, or as for `Segmentation`.
        """
        check_recording(n_frames, fps)
        check_type(columns, Mapping, "from_columns", "give arrays by the names of columns")
        table = segment_table(columns, float(fps))
        provenance = {} if provenance is None else provenance
        timings = {} if timings is None else timings
        return cls(table, int(n_frames), float(fps), provenance, timings, annotation=annotation)

    @property
    def activities(self) -> SegmentTable:
        """Return the activity level: activities and the transitions between them."""
        return self.level("activity")

    @property
    def primitives(self) -> SegmentTable:
        """Return the primitive level: single repetitions, and transitions whole."""
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
            one detail is a border at any finer one.

        Returns
        -------
        Segmentation
            The finest result that is no finer than `detail`, with the same hierarchy, so that
            coarser and finer results stay available. Without a hierarchy: this result.

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
        """Return the frames where one segment of a level ends and the next starts."""
        return self.level(level).start_frame[1:]

    def repetitions(self) -> dict[int, int]:
        """Return how many primitives each cluster has; those in no cluster are not counted."""
        clusters = self.primitives.cluster
        return dict(sorted(Counter(clusters[clusters >= 0].tolist()).items()))

    def per_frame(self, column: str = "cluster", *, level: Level = "primitive") -> NDArray[Any]:
        """Return a column of the table spread over the frames.

        Parameters
        ----------
        column : str
        level : {"activity", "primitive"}

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
        """Return how many of each there are, for people; primitives without transitions."""
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
        """That of the recording, where its seconds are not those of frames counted from 0."""
        content = self.provenance.get("clock")
        return None if content is None else Clock.from_json(content)

    def start_times(self) -> list[str]:
        """Return what the clock shows when each segment of the table starts; empty without a clock.

        Returns
        -------
        list of str
            Seconds, or dates of ISO 8601 where the clock counts since 1970.
        """
        clock = self.clock
        return [] if clock is None else [clock.format_time(row.start_s) for row in self]

    def rows(self) -> dict[str, NDArray[np.int64]]:
        """Return ``start_row`` and ``stop_row`` of each segment, in the source in order of time.

        Returns
        -------
        dict of str to (segments,) array
            Empty where frames are the rows of the source.
        """
        known = self.provenance.get("rows")
        if known is None:
            return {}
        # Borders that a person moved lie between those that are known.
        ends = {"start_row": self.table.start_frame, "stop_row": self.table.stop_frame}
        places = {n: np.interp(end, known["frames"], known["rows"]) for n, end in ends.items()}
        return {name: np.rint(rows).astype(np.int64) for name, rows in places.items()}

    def more_columns(self) -> dict[str, Sequence[Any]]:
        """Return columns that files and data frames have where the recording's times need them."""
        times = self.start_times()
        clock: dict[str, Sequence[Any]] = {START_TIME: times} if times else {}
        return clock | {name: rows.tolist() for name, rows in self.rows().items()}

    def to_dataframe(self) -> pd.DataFrame:
        """Return the table of both levels, as `SegmentTable.to_dataframe` gives it.

        Returns
        -------
        pandas.DataFrame
            With a column ``start_time`` where the recording has a clock, see `start_times`, and
            ``start_row`` and ``stop_row`` where its frames are not the rows of the source.

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
        from kineme.segments.html import make_page

        return make_page(
            repr(self).strip("<>"), [self.activities, self.primitives], self.activities
        )
