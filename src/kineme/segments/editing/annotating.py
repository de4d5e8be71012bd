"""What people vouch for and say: entries of the `kineme.segments.annotation`.

People vouch for segments that they made and for segments that they checked. A comment is on the
segment that holds its frame; so is what they leave out of means.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any, Literal

from numpy.typing import NDArray

from kineme.segments.annotation import Comment, Span
from kineme.segments.editing.rows import find_starting
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment

Mark = Literal["by_hand", "checked"]


def check(
    segmentation: Segmentation, level: Level, frames: Iterable[int], checked: bool
) -> Segmentation:
    """Return the segments that start at ``frames`` are checked, or not any more.

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

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> check(found, "activity", [380], checked=True).annotation.checked
    (('activity', 380, 928),)
    """
    chosen = {get_span(find_starting(segmentation, level, frame)) for frame in frames}
    before = find_marked(segmentation, "checked")
    return set_marked(segmentation, "checked", before | chosen if checked else before - chosen)


def comment(segmentation: Segmentation, level: Level, frame: int, text: str) -> Segmentation:
    """Return the segment that starts at ``frame`` has this comment in place of any it had.

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

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> found = kineme.read_segments(bundled_truth())
    >>> comments(comment(found, "primitive", 61, "limps"))
    [('primitive', 93, 'limps')]
    """
    row = find_starting(segmentation, level, frame)
    kept = [each for each in comments(segmentation) if not _is_of(each, row)]
    if text:
        kept.append(_make_comment(row, text))
    return set_comments(segmentation, kept)


def exclude(segmentation: Segmentation, frames: Iterable[int], excluded: bool) -> Segmentation:
    """Return the primitives that start at ``frames`` count in no mean, or do so again.

    Parameters
    ----------
    segmentation : Segmentation
    frames : iterable of int
        Where the primitives start.
    excluded : bool

    Returns
    -------
    Segmentation

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
    rows = [find_starting(segmentation, "primitive", frame) for frame in frames]
    # An exclusion is a frame, so it holds for whatever segment covers that frame.
    others = {
        frame
        for frame in segmentation.annotation.excluded
        if not any(row.start_frame <= frame < row.stop_frame for row in rows)
    }
    chosen = {_find_middle(row) for row in rows} if excluded else set()
    entry = tuple(sorted(others | chosen))
    return replace(segmentation, annotation=replace(segmentation.annotation, excluded=entry))


def comments(segmentation: Segmentation) -> list[Comment]:
    """Level, frame and text of each, in time order.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_truth
    >>> comments(kineme.read_segments(bundled_truth()))
    []
    """
    return sorted(segmentation.annotation.comments, key=lambda each: (each[1], each[0]))


def get_span(row: Segment) -> Span:
    """Level, first frame and one past the last frame."""
    return row.level, row.start_frame, row.stop_frame


def find_marked(segmentation: Segmentation, mark: Mark) -> set[Span]:
    """Return the segments that people vouch for in this sense."""
    spans: set[Span] = {*getattr(segmentation.annotation, mark)}
    table = segmentation.table
    return spans.intersection(_list_cells(table.level, table.start_frame, table.stop_frame))


def set_marked(segmentation: Segmentation, mark: Mark, spans: Iterable[Span]) -> Segmentation:
    """Return the same segments, of which people vouch for these and no others in this sense."""
    entry: dict[str, Any] = {mark: tuple(sorted(set(spans)))}
    return replace(segmentation, annotation=replace(segmentation.annotation, **entry))


def mark_edited(before: Segmentation, after: Segmentation) -> Segmentation:
    """Return the segmentation after an edit, with what the edit made marked as made by hand."""
    earlier, now = (
        {*_list_cells(rows.level, rows.start_frame, rows.stop_frame, rows.kind, rows.cluster)}
        for rows in (before.table, after.table)
    )
    # Rows that are new or changed; their spans are what people made.
    made = {(level, start, stop) for level, start, stop, *_ in now - earlier}
    return set_marked(after, "by_hand", made | find_marked(after, "by_hand"))


def assign_comments(segmentation: Segmentation) -> list[str]:
    """Return the comments on each row, in their order; empty where there is none."""
    entries = comments(segmentation)
    return ["; ".join(each[2] for each in entries if _is_of(each, row)) for row in segmentation]


def from_rows(segmentation: Segmentation, texts: Sequence[str]) -> Segmentation:
    """Return the same segments with these comments, one for each row.

    As they are where they say that.
    """
    if list(texts) == assign_comments(segmentation):
        return segmentation
    entries = [
        _make_comment(row, text) for row, text in zip(segmentation, texts, strict=True) if text
    ]
    return set_comments(segmentation, entries)


def set_comments(segmentation: Segmentation, entries: list[Comment]) -> Segmentation:
    """Return the same segments with these comments and no others."""
    annotation = replace(segmentation.annotation, comments=tuple(entries))
    return replace(segmentation, annotation=annotation)


def _list_cells(*columns: NDArray[Any]) -> Iterator[tuple[Any, ...]]:
    """Yield the cells of each row in these columns; tables have many rows."""
    return zip(*(column.tolist() for column in columns), strict=True)


def _make_comment(row: Segment, text: str) -> Comment:
    """Return a comment on a segment, at its middle frame."""
    return row.level, _find_middle(row), text


def _find_middle(row: Segment) -> int:
    # The middle stays inside when borders of the segment move a little.
    return (row.start_frame + row.stop_frame) // 2


def _is_of(entry: Comment, row: Segment) -> bool:
    """Return whether a comment is on a segment."""
    level, frame, _ = entry
    return level == row.level and row.start_frame <= frame < row.stop_frame
