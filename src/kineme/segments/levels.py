"""Both levels of segments of a recording, and what can be asked of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, get_args

import numpy as np
from numpy.typing import NDArray

from kineme._checks import is_one_of
from kineme._counts import counted
from kineme.errors import ParameterError
from kineme.segments.table import COLUMNS, Level, Segment, SegmentTable

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


@dataclass(frozen=True, repr=False)
class Levels:
    """The activity and the primitive level of one recording, each from its start to its end.

    Parameters
    ----------
    table : SegmentTable
        The segments of both levels.
    n_frames : int
        Length of the recording, frames of the source file.
    fps : float
        Frames per second of the source file.
    """

    table: SegmentTable
    n_frames: int
    fps: float

    def of_level(self, level: Level) -> SegmentTable:
        """The segments of one level, in time order; ParameterError for any other word."""
        if not is_one_of(level, get_args(Level)):
            raise ParameterError(
                f"level must be 'activity' or 'primitive', or a detail above 0, not {level!r}"
            )
        return self.table.select(self.table.level == level)

    @property
    def activities(self) -> SegmentTable:
        """The activity level: activities and the transitions between them."""
        return self.of_level("activity")

    @property
    def primitives(self) -> SegmentTable:
        """The primitive level: single repetitions, and transitions whole."""
        return self.of_level("primitive")

    def cuts(self, level: Level = "activity") -> NDArray[np.int64]:
        """The frames where one segment of a level ends and the next starts."""
        return self.of_level(level).start_frame[1:]

    def repetitions(self) -> dict[int, int]:
        """How many primitives each cluster has; those in no cluster are not counted."""
        clusters = self.primitives.cluster
        return dict(sorted(Counter(clusters[clusters >= 0].tolist()).items()))

    def per_frame(self, column: str = "cluster", *, level: Level = "primitive") -> NDArray[Any]:
        """A column of the table spread over the frames.

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
        rows = self.of_level(level)
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
        return ", ".join(counted(n, name) for name, n in counts.items())

    def to_dataframe(self) -> pd.DataFrame:
        """The table of both levels, as `SegmentTable.to_dataframe` gives it.

        Returns
        -------
        pandas.DataFrame

        Raises
        ------
        MissingDependencyError
            pandas is not installed.
        """
        return self.table.to_dataframe()

    def plot(self, *, ax: Axes | None = None) -> Axes:
        """Activities, and primitives below them, along the seconds of the recording.

        Parameters
        ----------
        ax : Axes, optional
            Where to draw; Axes of a new figure of pyplot by default.

        Returns
        -------
        Axes

        Examples
        --------
        >>> import kineme
        >>> from kineme.datasets import bundled_truth
        >>> from matplotlib.figure import Figure
        >>> segments = kineme.read_segments(bundled_truth(), fps=60)
        >>> axes = segments.plot(ax=Figure().add_subplot())
        """
        from kineme.segments.timeline import draw_timeline

        rows = {"activities": self.activities, "primitives": self.primitives}
        shown = {name: table for name, table in rows.items() if len(table)}
        return draw_timeline(shown, self.n_frames / self.fps, ax=ax)

    def __len__(self) -> int:
        return len(self.table)

    def __iter__(self) -> Iterator[Segment]:
        return iter(self.table)

    def __repr__(self) -> str:
        seconds = self.n_frames / self.fps
        length = f"{counted(self.n_frames, 'frame')} ({seconds:.1f} s)"
        return f"<Segmentation of {length}: {self.describe()}>"

    def _repr_html_(self) -> str:
        from kineme.segments.notebook import page

        return page(repr(self).strip("<>"), [self.activities, self.primitives], self.activities)
