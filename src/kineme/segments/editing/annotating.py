"""Edit the annotation of a segmentation: marks, comments and exclusions.

Marks are on segments that people made or checked. A comment belongs to the segment that contains
its frame, and so does an exclusion from means; see `kineme.segments.annotation`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any, Literal

from numpy.typing import NDArray

from kineme.segments.annotation import Comment, Span, as_text
from kineme.segments.editing.borders import find_segment_at
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment

Mark = Literal["by_hand", "checked"]


def check(
    segmentation: Segmentation, level: Level, frames: Iterable[int], checked: bool
) -> Segmentation:
    """Mark the segments that start at ``frames`` as checked, or remove the mark.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frames : iterable of int
        Starts of the segments.
    checked : bool

    Raises
    ------
    ParameterError
        No segment starts at one of them.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> check(found, "activity", [380], checked=True).annotation.checked
    (('activity', 380, 928),)
    """
    chosen = {get_span(find_segment_at(segmentation, level, frame)) for frame in frames}
    before = find_marked(segmentation, "checked")
    return set_marked(segmentation, "checked", before | chosen if checked else before - chosen)


def comment(segmentation: Segmentation, level: Level, frame: int, text: str) -> Segmentation:
    """Set the comment of the segment that starts at ``frame``.

    Parameters
    ----------
    segmentation : Segmentation
    level : {"activity", "primitive"}
    frame : int
        Start of the segment.
    text : str
        Empty to remove the comment.

    Raises
    ------
    ParameterError
        No segment starts there.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> comments(comment(found, "primitive", 61, "limps"))
    [('primitive', 93, 'limps')]
    """
    row = find_segment_at(segmentation, level, frame)
    kept = [each for each in comments(segmentation) if not _is_comment_on(each, row)]
    if text := as_text(text, "a comment"):
        kept.append(_make_comment(row, text))
    return set_comments(segmentation, kept)


def exclude(segmentation: Segmentation, frames: Iterable[int], excluded: bool) -> Segmentation:
    """Exclude the primitives that start at ``frames`` from means, or include them again.

    Parameters
    ----------
    segmentation : Segmentation
    frames : iterable of int
        Starts of the primitives.
    excluded : bool

    Raises
    ------
    ParameterError
        No primitive starts at one of them.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth(), fps=60)
    >>> stumbled = exclude(found, [126], excluded=True)
    >>> stumbled.annotation.excluded
    (160,)
    >>> walk = kineme.cycles(kineme.read(kineme.bundled_recording()), stumbled)
    >>> walk.columns["excluded"][:3].tolist()
    ['', '', 'by hand']
    """
    rows = [find_segment_at(segmentation, "primitive", frame) for frame in frames]
    # Remove all exclusions inside these primitives, then set the new ones.
    others = {
        frame
        for frame in segmentation.annotation.excluded
        if not any(row.start_frame <= frame < row.stop_frame for row in rows)
    }
    chosen = {_find_middle(row) for row in rows} if excluded else set()
    entry = tuple(sorted(others | chosen))
    return replace(segmentation, annotation=replace(segmentation.annotation, excluded=entry))


def comments(segmentation: Segmentation) -> list[Comment]:
    """Return level, frame and text of each comment, in time order.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> comments(kineme.read_segments(bundled_truth()))
    []
    """
    return sorted(segmentation.annotation.comments, key=lambda each: (each[1], each[0]))


def get_span(row: Segment) -> Span:
    """Return level, first frame and one past the last frame of a segment."""
    return row.level, row.start_frame, row.stop_frame


def find_marked(segmentation: Segmentation, mark: Mark) -> set[Span]:
    """Return the spans of segments with this mark; marks without such a segment are ignored."""
    spans: set[Span] = {*getattr(segmentation.annotation, mark)}
    table = segmentation.table
    return spans.intersection(_list_cells(table.level, table.start_frame, table.stop_frame))


def set_marked(segmentation: Segmentation, mark: Mark, spans: Iterable[Span]) -> Segmentation:
    """Set this mark on exactly these spans."""
    entry: dict[str, Any] = {mark: tuple(sorted(set(spans)))}
    return replace(segmentation, annotation=replace(segmentation.annotation, **entry))


def mark_edited(before: Segmentation, after: Segmentation) -> Segmentation:
    """Mark the segments that an edit made or changed as made by hand."""
    earlier, now = (
        {*_list_cells(rows.level, rows.start_frame, rows.stop_frame, rows.kind, rows.cluster)}
        for rows in (before.table, after.table)
    )
    # Spans of rows that are new or changed.
    edited = {(level, start, stop) for level, start, stop, *_ in now - earlier}
    return set_marked(after, "by_hand", edited | find_marked(after, "by_hand"))


def assign_comments(segmentation: Segmentation) -> list[str]:
    """Return the comments on each row as one text, or an empty text."""
    entries = comments(segmentation)
    return [
        "; ".join(each[2] for each in entries if _is_comment_on(each, row)) for row in segmentation
    ]


def set_comments_by_row(segmentation: Segmentation, texts: Sequence[str]) -> Segmentation:
    """Set the comments by one text for each row; unchanged texts keep the frames of comments."""
    if list(texts) == assign_comments(segmentation):
        return segmentation
    entries = [
        _make_comment(row, text) for row, text in zip(segmentation, texts, strict=True) if text
    ]
    return set_comments(segmentation, entries)


def set_comments(segmentation: Segmentation, entries: list[Comment]) -> Segmentation:
    """Replace all comments."""
    annotation = replace(segmentation.annotation, comments=tuple(entries))
    return replace(segmentation, annotation=annotation)


def _list_cells(*columns: NDArray[Any]) -> Iterator[tuple[Any, ...]]:
    """Yield the cells of each row in these columns."""
    return zip(*(column.tolist() for column in columns), strict=True)


def _make_comment(row: Segment, text: str) -> Comment:
    """Return a comment on a segment, at its middle frame."""
    return row.level, _find_middle(row), text


def _find_middle(row: Segment) -> int:
    # The middle stays inside if borders of the segment move a little.
    return (row.start_frame + row.stop_frame) // 2


def _is_comment_on(entry: Comment, row: Segment) -> bool:
    """Return whether a comment is on a segment."""
    level, frame, _ = entry
    return level == row.level and row.start_frame <= frame < row.stop_frame
