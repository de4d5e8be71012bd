"""Colours of clusters, and timelines of segment tables in HTML for notebooks.

Each level is a row, each segment a bar in the colour of its cluster. Segments in no
cluster are grey, transitions lighter grey.

A cluster has the same colour in every picture, report and page. The nine colours of the first
clusters can be distinguished with all common forms of colour blindness. Further clusters repeat
them in lighter, then in darker shades.

Source: Paul Tol, Colour Schemes, SRON/EPS/TN/09-002, 2021: the "muted" scheme.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

import numpy as np
from numpy.typing import NDArray

Segment = Any
"""A row of `kineme.segments.table`, which imports this module."""
SegmentTable = Any
PALETTE = (
    "#332288",
    "#DDCC77",
    "#117733",
    "#CC6677",
    "#88CCEE",
    "#882255",
    "#999933",
    "#44AA99",
    "#AA4499",
)
NO_CLUSTER = "#DDDDDD"
TRANSITION = "#F0F0F0"
_MIXES = ((0.0, 0), (0.5, 255), (0.4, 0))
"""Share and value of the grey that is mixed in, for each round through the palette."""
NO_LABELS: Mapping[str, str] = {}
WIDTH, HEIGHT = 720, 16
"""Width and height of a row, pixels."""
FIRST_ROWS = 8
"""Number of rows of a table that a notebook shows."""
HEADER = ("kind", "start s", "stop s", "duration s", "cluster", "label", "confidence")


def make_page(title: str, timelines: Sequence[SegmentTable], rows: SegmentTable) -> str:
    """Return HTML of a title, timelines below each other, and the first rows of a table."""
    shown = [table for table in timelines if len(table)]
    picture = ""
    if shown:
        start = min(float(table.start_s.min()) for table in shown)
        stop = max(float(table.stop_s.max()) for table in shown)
        picture = draw_timeline(shown, start, stop)
    # Long tables are cut.
    more = len(rows) - FIRST_ROWS
    below = f"<p>and {more} more</p>" if more > 0 else ""
    return f"<div><p>{escape(title)}</p>{picture}{_make_rows(rows)}{below}</div>"


def draw_timeline(rows: Sequence[SegmentTable], start_s: float, stop_s: float) -> str:
    """Draw rows of segments as an ``<svg>``, with at most one bar per pixel in each row."""
    height = HEIGHT * len(rows)
    labels = choose_label_colors(segment for table in rows for segment in table)
    bars = [
        f'<rect x="{left}" y="{number * HEIGHT + 1}" width="{right - left}" '
        f'height="{HEIGHT - 2}" fill="{get_segment_color(segment, labels)}">'
        f"<title>{_describe(segment)}</title></rect>"
        for number, table in enumerate(rows)
        for segment, left, right in _find_pixels(table, start_s, stop_s)
    ]
    return (
        f'<svg viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" '
        f'style="max-width:100%" role="img" aria-label="timeline">{"".join(bars)}</svg>'
    )


def _find_pixels(
    table: SegmentTable, start_s: float, stop_s: float
) -> list[tuple[Segment, float, float]]:
    """Return the first segment that starts in each pixel, with the pixels of start and stop."""
    scale = WIDTH / max(stop_s - start_s, 1e-9)
    left = (table.start_s - start_s) * scale
    # `return_index` gives the first segment of each pixel.
    _, first = np.unique(left.astype(np.int64), return_index=True)
    right = (table.stop_s - start_s) * scale
    # Gap between bars, but at most half of a short bar.
    gap: NDArray[np.float64] = np.minimum(0.8, (right - left) / 2)
    return [
        (segment, round(a, 1), round(max(b, a + 0.5), 1))
        for segment, a, b in zip(
            table.select(first), left[first].tolist(), (right - gap)[first].tolist(), strict=True
        )
    ]


def _describe(segment: Segment) -> str:
    """Return the tooltip of a bar."""
    name = segment.label or (f"cluster {segment.cluster}" if segment.cluster >= 0 else segment.kind)
    return escape(f"{name}: {segment.start_s:.2f} to {segment.stop_s:.2f} s")


def _make_rows(table: SegmentTable) -> str:
    head = "".join(f"<th>{name}</th>" for name in HEADER)
    body = "".join(
        f"<tr>{_make_cells(segment)}</tr>" for segment in table.select(slice(FIRST_ROWS))
    )
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _make_cells(segment: Segment) -> str:
    square = f'<span style="color:{get_segment_color(segment)}">■</span>'
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


def get_segment_color(segment: Segment, labels: Mapping[str, str] = NO_LABELS) -> str:
    """Return the colour ``#RRGGBB`` of a segment's bar: that of its cluster, or of its label."""
    if segment.cluster < 0 and segment.label in labels:
        return labels[segment.label]
    if segment.cluster < 0 and segment.kind == "transition":
        return TRANSITION
    return get_cluster_color(segment.cluster)


def choose_label_colors(rows: Iterable[Segment]) -> dict[str, str]:
    """Return the colour ``#RRGGBB`` of each label, the same as in the pages.

    A label has the colour of the cluster in which it lasts longest, or else one derived from its
    text.
    """
    most: dict[str, Counter[int]] = {}
    used = set()
    for row in rows:
        used.add(get_cluster_color(row.cluster))
        if row.label:
            seconds = most.setdefault(row.label, Counter())
            if row.cluster >= 0:
                seconds[row.cluster] += row.stop_s - row.start_s
    colors: dict[str, str] = {}
    for label in sorted(most, key=lambda text: text.encode("utf-16-be", "surrogatepass")):
        clusters = most[label].most_common(1)
        colors[label] = (
            get_cluster_color(clusters[0][0]) if clusters else _choose_free_color(label, used)
        )
        used.add(colors[label])
    return colors


def _choose_free_color(text: str, used: set[str]) -> str:
    """Return a colour derived from a text, or the next unused one."""
    hashed = 2166136261  # FNV-1a hash over UTF-16 code units, as in JavaScript
    units = text.encode("utf-16-le", "surrogatepass")
    for low, high in zip(units[::2], units[1::2], strict=True):
        hashed = ((hashed ^ (low | high << 8)) * 16777619) % 2**32
    number = len(PALETTE) * len(_MIXES)
    choices = [get_cluster_color((hashed + i) % number) for i in range(number)]
    return next((color for color in choices if color not in used), choices[0])


def get_cluster_color(cluster: int) -> str:
    """Return the colour ``#RRGGBB`` of a cluster; grey for -1 (no cluster)."""
    if cluster < 0:
        return NO_CLUSTER
    color = PALETTE[cluster % len(PALETTE)]
    share, grey = _MIXES[cluster // len(PALETTE) % len(_MIXES)]
    channels = (int(color[i : i + 2], 16) for i in (1, 3, 5))
    return "#" + "".join(f"{round((1 - share) * c + share * grey):02X}" for c in channels)
