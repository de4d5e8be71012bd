"""Contact sheets: strips of several recordings in one picture, each with a title."""

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

WIDTH, HEIGHT = 7.0, 1.4
"""Width and height of a strip in inches."""
MAX_SINGLE_COLUMN = 12
"""Strips up to which one column is used; above, there are three."""
MAX_STRIPS = 300
"""Strips on a sheet; the rest is left out."""


class Strip(NamedTuple):
    """A span of a recording, and the cluster that sets its colour."""

    title: str
    recording: Motion | Signals
    cluster: int


def write_sheet(strips: Sequence[Strip], path: str | PathLike[str]) -> None:
    """Write strips as one picture: ``.png``, ``.pdf`` or ``.svg``."""
    drawn_strips = strips[:MAX_STRIPS]
    columns = 1 if len(drawn_strips) <= MAX_SINGLE_COLUMN else 3
    rows = max(1, -(-len(drawn_strips) // columns))
    figure = Figure(figsize=(WIDTH * columns, HEIGHT * rows), layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes in grid:
        axes.set_axis_off()
    for axes, strip in zip(grid, drawn_strips, strict=False):
        plot_strip(strip.recording, color=get_cluster_color(strip.cluster), ax=axes)
        axes.set_title(strip.title, loc="left", fontsize=8)
    if len(strips) > MAX_STRIPS:
        figure.suptitle(f"the first {MAX_STRIPS} of {len(strips)}", fontsize=8)
    with atomic_write(path) as draft:
        figure.savefig(draft, dpi=120)
