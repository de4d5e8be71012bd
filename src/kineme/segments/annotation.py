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

from kineme._util.checks import is_whole_number
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

    def __post_init__(self) -> None:
        """Convert numbers and texts of numpy, which JSON cannot hold; refuse other types."""
        names = {
            as_cluster(cluster): as_text(name, "the name of a cluster")
            for cluster, name in self.cluster_names.items()
        }
        comments = tuple(
            (level, int(frame), as_text(text, "a comment")) for level, frame, text in self.comments
        )
        object.__setattr__(self, "cluster_names", names)
        object.__setattr__(self, "comments", comments)

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


def as_cluster(number: Any) -> int:
    """Return the number of a cluster as an `int`; raise ParameterError for other values."""
    if not is_whole_number(number, -1):
        raise ParameterError(f"a cluster must be a whole number from -1, not {number!r:.60}")
    return int(number)


def as_text(value: object, what: str) -> str:
    """Return a text as a `str`, not a numpy.str_; raise ParameterError for other types."""
    if not isinstance(value, str):
        raise ParameterError(f"{what} must be a text, not {value!r:.60}")
    return str(value)


NO_ANNOTATION = Annotation()
"""Annotation of a table that nobody has edited."""
