"""One row of the segment table: its columns described, and a segment as they make it."""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal, Protocol, Self

import numpy as np
from numpy.typing import NDArray

Level = Literal["activity", "primitive"]
Kind = Literal["activity", "transition"]


@dataclass(frozen=True)
class Column:
    """One column of the table: what files, pages and docs need to know of it.

    Attributes
    ----------
    type : type
        Of its cells; a float is nan where nothing is known.
    meaning : str
        In a sentence.
    since_first : bool
        Whether every file that kineme wrote has it; else it may be missing.
    """

    type: type[str | int | float]
    meaning: str
    since_first: bool = True


DESCRIBED: Mapping[str, Column] = {
    "level": Column(str, "`activity` or `primitive`"),
    "kind": Column(str, "`activity`, or `transition` between two of them"),
    "start_frame": Column(int, "first frame, from 0, at the rate of the source file"),
    "stop_frame": Column(int, "one past the last frame"),
    "start_s": Column(float, "`start_frame / fps`"),
    "stop_s": Column(float, "`stop_frame / fps`"),
    "cluster": Column(int, "equal numbers are equal movements; -1: in no cluster"),
    "activity": Column(int, "the segment of the activity level that it lies in (or is), from 0"),
    "label": Column(str, "a name given by a person or a knowledge base, or empty"),
    "score": Column(float, "how probable it is that the segment is right; none where nobody says"),
    "action": Column(int, "`cluster` of the activity that it lies in (or is)", since_first=False),
    "border_confidence": Column(
        float, "how probable it is that its start is right; none where nobody says",
        since_first=False,
    ),
}  # fmt: skip
COLUMNS = tuple(DESCRIBED)
START_TIME = "start_time"
"""One more column of files and data frames, where the recording has a clock: what it shows."""
COMMENT = "comment"
"""One more column of files: what people said about a segment, in tables that have comments."""


def lacking(names: Container[str]) -> list[str]:
    """The columns that every segment table in a file has, and these names have not."""
    return [name for name, known in DESCRIBED.items() if known.since_first and name not in names]


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
    action: int
    border_confidence: float

    @property
    def duration_s(self) -> float:
        """Seconds from start to stop."""
        return self.stop_s - self.start_s


class Rows(Protocol):
    """Segments below each other: what pictures need of a `SegmentTable`."""

    @property
    def start_s(self) -> NDArray[np.float64]: ...
    @property
    def stop_s(self) -> NDArray[np.float64]: ...
    @property
    def duration_s(self) -> NDArray[np.float64]: ...
    def select(self, rows: Any, /) -> Self: ...
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[Segment]: ...
