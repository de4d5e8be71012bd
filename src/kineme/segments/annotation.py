"""Annotation of a segment table by people: marks, comments, cluster names, number of corrections.

A mark belongs to a span of a level. It is valid only while a segment has exactly these frames, so
it ends if the segment is moved or merged. A comment belongs to a frame of a level, and thus to the
segment that contains this frame. So no edit and no new segmentation loses a comment. Repetitions
that are excluded from means are stored in the same way.
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


@dataclass(frozen=True, slots=True)  # slots: msgspec then sets defaults for missing fields
class Annotation:
    """Annotation of a segment table by people.

    Attributes
    ----------
    checked : tuple of (level, start_frame, stop_frame)
        Segments that somebody confirmed; a new segmentation does not change them.
    by_hand : tuple of (level, start_frame, stop_frame)
        Segments that somebody made; a new segmentation does not change them.
    comments : tuple of (level, frame, text)
        Comments on segments.
    cluster_names : dict of str
        Names by cluster; empty for a cluster without a name. A cluster that is missing here has
        the label of more than half of its segments as name.
    corrections : int
        Number of corrections of the table.
    excluded : tuple of int
        Frames: `kineme.cycles` leaves the primitives that contain them out of means.

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
        """Return the annotation from the JSON of a file.

        Raises
        ------
        ParameterError
            The content has another structure.
        """
        try:
            return convert_json(content, cls)
        except ValueError as error:
            raise ParameterError(f"the annotation is not as kineme writes it: {error}") from error

    def to_json(self) -> dict[str, Any]:
        """Return the JSON for a file, without empty parts."""
        parts: dict[str, Any] = msgspec.to_builtins(self, str_keys=True)
        return {name: part for name, part in parts.items() if part}

    def excludes(self, start_frame: int, stop_frame: int) -> bool:
        """Return whether a primitive of these frames is left out of means."""
        return any(start_frame <= frame < stop_frame for frame in self.excluded)


NO_ANNOTATION = Annotation()
"""Annotation of a table that nobody has edited."""
