"""What people vouch for: segments that they made, and segments that they checked.

Both are marks in the `kineme.segments.annotation`.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any, Literal

from kineme.segments.annotation import Span
from kineme.segments.editing.rows import starting
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment

Mark = Literal["by_hand", "checked"]


def span_of(row: Segment) -> Span:
    """Level, first frame and one past the last frame."""
    return row.level, row.start_frame, row.stop_frame


def marked(segmentation: Segmentation, mark: Mark) -> set[Span]:
    """The segments that carry a mark.

    Parameters
    ----------
    segmentation : Segmentation
    mark : {"by_hand", "checked"}

    Returns
    -------
    set of (level, start_frame, stop_frame)
    """
    spans = {*getattr(segmentation.annotation, mark)}
    return {span_of(row) for row in segmentation if span_of(row) in spans} if spans else set()


def with_marks(segmentation: Segmentation, mark: Mark, spans: Iterable[Span]) -> Segmentation:
    """The same segments, of which these and no others carry a mark.

    Parameters
    ----------
    segmentation : Segmentation
    mark : {"by_hand", "checked"}
    spans : iterable of (level, start_frame, stop_frame)

    Returns
    -------
    Segmentation
    """
    marks: dict[str, Any] = {mark: tuple(sorted(set(spans)))}
    return replace(segmentation, annotation=replace(segmentation.annotation, **marks))


def check(
    segmentation: Segmentation, level: Level, frames: Iterable[int], checked: bool
) -> Segmentation:
    """The segments that start at ``frames`` are checked, or not any more.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frames : iterable of int
        Where the segments start.
    checked : bool

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        No segment starts at one of them.
    """
    chosen = {span_of(starting(segmentation, level, frame)) for frame in frames}
    before = marked(segmentation, "checked")
    return with_marks(segmentation, "checked", before | chosen if checked else before - chosen)


def noted(before: Segmentation, after: Segmentation) -> Segmentation:
    """The segmentation after an edit, with what the edit made marked as made by hand.

    Parameters
    ----------
    before, after : Segmentation
        The edit changed frames, kinds or clusters of some segments.

    Returns
    -------
    Segmentation
    """
    earlier = {(span_of(row), row.kind, row.cluster) for row in before}
    made = {span_of(row) for row in after if (span_of(row), row.kind, row.cluster) not in earlier}
    return with_marks(after, "by_hand", made | marked(after, "by_hand"))
