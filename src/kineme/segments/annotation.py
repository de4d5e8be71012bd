"""What people did to a segment table, beside it: marks, comments, names, how much was corrected.

A mark is on a span of a level and holds as long as a segment has exactly these frames: one that
was moved or joined since is not the one that was marked. A comment is at a frame of a level, and
so on the segment that holds this frame, whatever becomes of its borders: no edit and no new
segmentation loses one. So it is with repetitions that are left out of means.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Self

import msgspec

from kineme._util.json import convert_json
from kineme.errors import ParameterError
from kineme.segments.table import Level

Span = tuple[Level, int, int]
"""Level, first frame, and one past the last frame."""
Comment = tuple[Level, int, str]
"""Level, frame and text."""


@dataclass(frozen=True, slots=True)  # slots: msgspec then sets what a file leaves out
class Annotation:
    """What people did to a segment table.

    Attributes
    ----------
    checked : tuple of (level, start_frame, stop_frame)
        Segments that somebody looked at and found right, which no new segmentation changes.
    by_hand : tuple of (level, start_frame, stop_frame)
        Segments that somebody made, which no new segmentation changes.
    comments : tuple of (level, frame, text)
        What people said about segments.
    cluster_names : dict of str
        By cluster; empty for one that has none, whatever its segments are called. A cluster that
        is not there is called what more than half of its segments are.
    corrections : int
        How often the table was corrected.
    excluded : tuple of int
        Frames: the primitives that hold them count in no mean of `kineme.cycles`.

    Examples
    --------
    >>> Annotation(checked=(("activity", 0, 326),), corrections=2).to_json()
    {'checked': (('activity', 0, 326),), 'corrections': 2}
    """

    checked: tuple[Span, ...] = ()
    by_hand: tuple[Span, ...] = ()
    comments: tuple[Comment, ...] = ()
    cluster_names: dict[int, str] = field(default_factory=dict)
    corrections: int = 0
    excluded: tuple[int, ...] = ()

    @classmethod
    def from_json(cls, content: object) -> Self:
        """Return the annotation that a file holds.

        Raises
        ------
        ParameterError
            It is of another shape.
        """
        try:
            return convert_json(content, cls)
        except ValueError as error:
            raise ParameterError(f"the annotation is not as kineme writes it: {error}") from error

    def to_json(self) -> dict[str, Any]:
        """Return what a file holds of it: the parts that there are, empty where there is none."""
        parts: dict[str, Any] = msgspec.to_builtins(self, str_keys=True)
        return {name: part for name, part in parts.items() if part}

    def excludes(self, start_frame: int, stop_frame: int) -> bool:
        """Return whether a primitive of these frames counts in no mean."""
        return any(start_frame <= frame < stop_frame for frame in self.excluded)


NO_ANNOTATION = Annotation()
"""Of a table that nobody did anything to."""
