"""Segments as HTML for notebooks: a timeline, and the first rows of the table."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape

from kineme.segments.timeline import Row, Rows, segment_color, timeline_svg

ROWS = 8
"""Shown of a table."""
COLUMNS = ("kind", "start s", "stop s", "duration s", "cluster", "label", "confidence")


def page(title: str, timelines: Sequence[Rows], rows: Rows) -> str:
    """HTML of a title, timelines below each other, and the first rows of a table."""
    shown = [table for table in timelines if len(table)]
    picture = ""
    if shown:
        start = min(float(table.start_s.min()) for table in shown)
        stop = max(float(table.stop_s.max()) for table in shown)
        picture = timeline_svg(shown, start, stop)
    more = len(rows) - ROWS
    below = f"<p>and {more} more</p>" if more > 0 else ""
    return f"<div><p>{escape(title)}</p>{picture}{_rows(rows)}{below}</div>"


def _rows(table: Rows) -> str:
    head = "".join(f"<th>{name}</th>" for name in COLUMNS)
    body = "".join(f"<tr>{_cells(segment)}</tr>" for segment in table.select(slice(ROWS)))
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _cells(segment: Row) -> str:
    square = f'<span style="color:{segment_color(segment)}">■</span>'
    cells = (
        segment.kind,
        f"{segment.start_s:.2f}",
        f"{segment.stop_s:.2f}",
        f"{segment.duration_s:.2f}",
        f"{square} {segment.cluster}" if segment.cluster >= 0 else "",
        escape(segment.label),
        "" if math.isnan(segment.confidence) else f"{segment.confidence:.2f}",
    )
    return "".join(f"<td>{cell}</td>" for cell in cells)
