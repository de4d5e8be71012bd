"""Segmentation: the segments of a recording, where they came from, what they cost.

The columns of its table are described in :mod:`kineme.segments.table`.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._checks import check_type, is_number, is_one_of
from kineme.errors import MissingDependencyError, ParameterError
from kineme.segments.table import COLUMNS, Level, Segment, SegmentTable, segment_table

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, repr=False)
class Segmentation:
    """The segments of one recording.

    Usually made by :func:`kineme.segment`, :meth:`from_columns` or
    :func:`kineme.read_segments`.

    Parameters
    ----------
    table : the segments of both levels, as :func:`segment_table` makes it
    n_frames : length of the recording, frames of the source file
    fps : frames per second of the source file
    provenance : what JSON can hold: ``kineme`` (version), ``preset``,
        ``parameters``, ``input`` (``path``, ``format``, ``sha256``), ``notes``
        (sentences on what was inferred); a producer may add more
    timings : seconds spent per stage

    Raises
    ------
    ParameterError : a level does not tile the recording, a row contradicts
        another, or the provenance cannot be written as JSON
    """

    table: SegmentTable
    n_frames: int
    fps: float
    provenance: Mapping[str, Any] = field(default_factory=dict)
    timings: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_type(
            self.table, SegmentTable, "Segmentation", "Segmentation.from_columns takes columns"
        )
        _check_recording(self.n_frames, self.fps)
        for level in get_args(Level):
            _check_tiles(self.level(level), level, self.n_frames)
        _check_parents(self.activities, self.primitives)
        object.__setattr__(self, "provenance", _plain(self.provenance, "provenance"))
        object.__setattr__(self, "timings", _plain(self.timings, "timings"))

    @classmethod
    def from_columns(
        cls,
        columns: Mapping[str, ArrayLike],
        *,
        n_frames: int,
        fps: float,
        provenance: Mapping[str, Any] | None = None,
        timings: Mapping[str, float] | None = None,
    ) -> Segmentation:
        """A segmentation from columns in any row order.

        ``level``, ``kind``, ``start_frame`` and ``stop_frame`` are needed.
        ``cluster`` is -1, ``label`` empty and ``score`` nan where not given;
        ``activity`` then follows from the frames. ``start_s`` and ``stop_s``
        are always computed, whatever is given.
        """
        _check_recording(n_frames, fps)
        check_type(columns, Mapping, "from_columns", "give arrays by the names of columns")
        table = segment_table(columns, float(fps))
        said = {} if provenance is None else provenance
        spent = {} if timings is None else timings
        return cls(table, int(n_frames), float(fps), said, spent)

    def level(self, level: Level) -> SegmentTable:
        """The segments of one level, in time order."""
        if not is_one_of(level, get_args(Level)):
            raise ParameterError(f"level must be 'activity' or 'primitive', not {level!r}")
        return self.table.select(self.table.level == level)

    @property
    def activities(self) -> SegmentTable:
        """The activity level: activities and the transitions between them."""
        return self.level("activity")

    @property
    def primitives(self) -> SegmentTable:
        """The primitive level: single repetitions, and transitions whole."""
        return self.level("primitive")

    def cuts(self, level: Level = "activity") -> NDArray[np.int64]:
        """The frames where one segment of a level ends and the next starts."""
        return self.level(level).start_frame[1:]

    def repetitions(self) -> dict[int, int]:
        """How many primitives each cluster has; those in no cluster are not counted."""
        clusters = self.primitives.cluster
        return dict(sorted(Counter(clusters[clusters >= 0].tolist()).items()))

    def per_frame(self, column: str = "cluster", *, level: Level = "primitive") -> NDArray[Any]:
        """A column of the table spread over the frames: one value per frame."""
        if not is_one_of(column, COLUMNS):
            raise ParameterError(f"no column {column!r}; there are {', '.join(COLUMNS)}")
        rows = self.level(level)
        values: NDArray[Any] = getattr(rows, column)
        return np.repeat(values, rows.stop_frame - rows.start_frame)

    def describe(self) -> str:
        """How many of each there are, for people; primitives without transitions."""
        kinds = self.activities.kind.tolist()
        counts = {
            "activity": kinds.count("activity"),
            "transition": kinds.count("transition"),
            "primitive": self.primitives.kind.tolist().count("activity"),
            "cluster": len(self.repetitions()),
        }
        many = {"activity": "activities"}
        return ", ".join(
            f"{n} {name if n == 1 else many.get(name, name + 's')}" for name, n in counts.items()
        )

    def to_pandas(self) -> pd.DataFrame:
        """The table as a DataFrame, one row per segment.

        Raises
        ------
        MissingDependencyError : pandas is not installed
        """
        try:
            import pandas as pd
        except ImportError as error:
            raise MissingDependencyError("pandas", "tables") from error
        return pd.DataFrame(self.table.columns())

    def __len__(self) -> int:
        return len(self.table)

    def __iter__(self) -> Iterator[Segment]:
        return iter(self.table)

    def __repr__(self) -> str:
        seconds = self.n_frames / self.fps
        return f"<Segmentation of {self.n_frames} frames ({seconds:.1f} s): {self.describe()}>"


def _check_recording(n_frames: int, fps: float) -> None:
    if not (is_number(n_frames) and n_frames >= 1):
        raise ParameterError(f"a recording has at least 1 frame, not {n_frames!r:.60}")
    if not (is_number(fps) and fps > 0):
        raise ParameterError(f"the frame rate must be a positive number, not {fps!r:.60}")


def _check_tiles(rows: SegmentTable, level: Level, n_frames: int) -> None:
    if not len(rows) and level == "primitive":
        return
    if not len(rows) or rows.start_frame[0] != 0 or rows.stop_frame[-1] != n_frames:
        raise ParameterError(f"the {level} level must cover frames 0 to {n_frames}")
    for before, after in zip(rows.stop_frame[:-1], rows.start_frame[1:], strict=True):
        if before != after:
            raise ParameterError(
                f"one {level} stops at frame {before}, the next starts at {after}: "
                "segments of a level must touch and not overlap"
            )
    if (rows.stop_frame <= rows.start_frame).any():
        empty = rows[int(np.argmax(rows.stop_frame <= rows.start_frame))]
        raise ParameterError(f"the {level} at frame {empty.start_frame} has no frames")


def _check_parents(activities: SegmentTable, primitives: SegmentTable) -> None:
    if (activities.activity != np.arange(len(activities))).any():
        raise ParameterError("column 'activity' of the activity level must count 0, 1, 2, ...")
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


def _plain(value: Mapping[str, Any], name: str) -> dict[str, Any]:
    """A copy made of what JSON has: dicts, lists, texts, finite numbers, booleans, None."""
    try:
        copy: dict[str, Any] = json.loads(json.dumps(dict(value), allow_nan=False))
    except (TypeError, ValueError) as error:
        raise ParameterError(f"{name} cannot be written as JSON: {error}") from error
    return copy
