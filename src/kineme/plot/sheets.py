"""A contact sheet: strips of several recordings in one picture, each under its title."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from typing import NamedTuple

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from kineme._util.files import atomic_write
from kineme.plot.strips import plot_strip
from kineme.recordings import Motion, Signals
from kineme.segments.colors import get_cluster_color

WIDE, TALL = 7.0, 1.4
"""Inches of a strip."""
COLUMN = 12
"""Strips below each other in one column; more stand in three columns."""
MOST = 300
"""Strips in a sheet, the first ones."""


class Strip(NamedTuple):
    """A span of a recording, and the cluster that gives it its color."""

    title: str
    recording: Motion | Signals
    cluster: int


def write_sheet(strips: Sequence[Strip], path: str | PathLike[str]) -> None:
    """Write strips as one picture, ``.png``, ``.pdf`` or ``.svg``."""
    shown = strips[:MOST]
    columns = 1 if len(shown) <= COLUMN else 3
    rows = max(1, -(-len(shown) // columns))
    figure = Figure(figsize=(WIDE * columns, TALL * rows), layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes in grid:
        axes.set_axis_off()
    for axes, strip in zip(grid, shown, strict=False):
        plot_strip(strip.recording, color=get_cluster_color(strip.cluster), ax=axes)
        axes.set_title(strip.title, loc="left", fontsize=8)
    if len(strips) > MOST:
        figure.suptitle(f"the first {MOST} of {len(strips)}", fontsize=8)
    with atomic_write(path) as draft:
        figure.savefig(draft, dpi=120)
