"""What people say about segments: comments in the `kineme.segments.annotation`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from kineme.segments.annotation import Comment
from kineme.segments.editing.rows import starting
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment


def comments(segmentation: Segmentation) -> list[Comment]:
    """Level, frame and text of each, in time order."""
    return sorted(segmentation.annotation.comments, key=lambda each: (each[1], each[0]))


def comment(segmentation: Segmentation, level: Level, frame: int, text: str) -> Segmentation:
    """The segment that starts at ``frame`` has this comment in place of any it had.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frame : int
        Where the segment starts.
    text : str
        Empty: it has none any more.

    Returns
    -------
    Segmentation

    Raises
    ------
    ParameterError
        No segment starts there.
    """
    row = starting(segmentation, level, frame)
    kept = [each for each in comments(segmentation) if not _is_of(each, row)]
    if text:
        kept.append(_of(row, text))
    return with_comments(segmentation, kept)


def in_rows(segmentation: Segmentation) -> list[str]:
    """What is said about each row, in their order; empty where nothing is."""
    entries = comments(segmentation)
    return ["; ".join(each[2] for each in entries if _is_of(each, row)) for row in segmentation]


def from_rows(segmentation: Segmentation, texts: Sequence[str]) -> Segmentation:
    """The same segments with these comments, one for each row; as they are where they say that.

    Parameters
    ----------
    segmentation : Segmentation
    texts : sequence of str
        Empty for rows without one.

    Returns
    -------
    Segmentation
    """
    if list(texts) == in_rows(segmentation):
        return segmentation
    entries = [_of(row, text) for row, text in zip(segmentation, texts, strict=True) if text]
    return with_comments(segmentation, entries)


def with_comments(segmentation: Segmentation, entries: list[Comment]) -> Segmentation:
    """The same segments with these comments and no others."""
    annotation = replace(segmentation.annotation, comments=tuple(entries))
    return replace(segmentation, annotation=annotation)


def _of(row: Segment, text: str) -> Comment:
    """A comment on a segment."""
    return row.level, (row.start_frame + row.stop_frame) // 2, text


def _is_of(entry: Comment, row: Segment) -> bool:
    """Whether a comment is on a segment."""
    level, frame, _ = entry
    return level == row.level and row.start_frame <= frame < row.stop_frame
