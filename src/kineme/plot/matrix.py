"""Self-similarity matrix of a recording, with the borders and clusters found in it.

Time runs to the right and downwards. A dark dot at (t, j) means that frame j
looks like frame t: the darker, the nearer. Squares frame the activities, fine
lines inside them the primitives. The bars along both edges are coloured by
cluster; grey is what belongs to none.

Only stored pairs are drawn, reduced to the pixels of the picture row by row:
an hour takes no more memory than a minute.

Source: Vögele, Krüger and Klein 2014, figure 2, and figure 1 of its supplement.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, floor
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray

from kineme._util.checks import check_path, check_type
from kineme._util.files import as_display_name, atomic_write
from kineme.errors import WriteError
from kineme.plot.timeline import new_axes
from kineme.segments.colors import NO_CLUSTER, cluster_color, label_colors
from kineme.segments.html import segment_color
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment

if TYPE_CHECKING:
    from kineme.methods.base import Found
    from kineme.methods.region_growing.neighbors import NeighborGraph

SUFFIXES = (".png", ".pdf", ".svg")
PIXELS = 1600
ENTRIES_AT_ONCE = 1 << 20
INK = "#1B1F2A"
BORDER = "#C2571A"
SHADES = LinearSegmentedColormap.from_list("similarity", ["#FFFFFF", "#B9C0CE", INK])
NARROW = 0.004  # share of the picture below which borders would hide what they frame
MAX_LEGEND = 16
MAX_GAPS = 400  # bars; more are drawn without gaps between them


def plot_matrix(
    segmentation: Segmentation, graph: NeighborGraph | Found, *, ax: Axes | None = None
) -> Axes:
    """Return the matrix with frames around activities and primitives, seconds along both edges.

    Parameters
    ----------
    segmentation : Segmentation
    graph : NeighborGraph or Found
        The neighbour graph of the same recording, at any frame rate; or what a method
        found, which has one.
    ax : Axes, optional
        Where to draw; Axes of a new figure of pyplot by default.

    Returns
    -------
    Axes

    Raises
    ------
    ParameterError
        Something else than a segmentation and its graph.

    Examples
    --------
    >>> import numpy as np
    >>> from matplotlib.figure import Figure
    >>> import kineme
    >>> angle = np.linspace(0, 16 * np.pi, 480)
    >>> circles = kineme.Signals(np.column_stack([np.sin(angle), np.cos(angle)]), 30.0)
    >>> segments, found = kineme.segment_and_found(circles)
    >>> kineme.plot_matrix(segments, found, ax=Figure().add_subplot()).get_ylabel()
    'seconds'
    """
    check_type(segmentation, Segmentation, "plot_matrix", "kineme.segment gives one")
    graph = _graph_of(graph, "plot_matrix")
    axes = new_axes(9.4, 8.2) if ax is None else ax
    seconds = segmentation.n_frames / segmentation.fps
    bar = 0.022 * seconds
    gaps = segmentation.provenance.get("gaps", ())
    axes.imshow(
        similarity_image(insert_gaps(graph, gaps, segmentation.n_frames) if gaps else graph),
        cmap=SHADES,
        vmin=0,
        vmax=1,
        extent=(0, seconds, seconds, 0),
        interpolation="antialiased",
        resample=True,
    )
    _draw_borders(axes, segmentation)
    _draw_bars(axes, segmentation, bar)
    axes.set_xlim(-1.5 * bar, seconds)
    axes.set_ylim(seconds + 1.5 * bar, 0)
    axes.set_aspect("equal")
    axes.set_xlabel("seconds")
    axes.set_ylabel("seconds")
    axes.spines[:].set_visible(False)
    axes.tick_params(color="#888888", labelsize=9)
    axes.legend(
        handles=_legend(segmentation),
        title="cluster",
        loc="upper left",
        bbox_to_anchor=(1.01, 1.0),
        frameon=False,
        fontsize=9,
        alignment="left",
    )
    return axes


def plot_segmentation(
    segmentation: Segmentation,
    graph: NeighborGraph | Found,
    path: str | PathLike[str],
    *,
    title: str | None = None,
) -> None:
    """Write the picture that `plot_matrix` draws as PNG, PDF or SVG, by suffix.

    Parameters
    ----------
    segmentation : Segmentation
    graph : NeighborGraph or Found
        As for `plot_matrix`.
    path : path-like
        Where to write it.
    title : str, optional
        A line above it; by default the name of the recording.

    Raises
    ------
    ParameterError
        Something else than a segmentation, its graph and a path.
    WriteError
        Another suffix, or the file cannot be written.

    Examples
    --------
    >>> import kineme
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> segments, found = kineme.segment_and_found(motion)
    >>> kineme.plot_segmentation(segments, found, "segments.png")
    """
    check_type(segmentation, Segmentation, "plot_segmentation", "kineme.segment gives one")
    graph = _graph_of(graph, "plot_segmentation")
    check_path(path, "plot_segmentation")
    if Path(path).suffix.lower() not in SUFFIXES:
        raise WriteError(path, f"pictures are written as {', '.join(SUFFIXES)}")
    figure = Figure(figsize=(9.4, 8.2))
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.085, 0.075, 0.74, 0.86))
    plot_matrix(segmentation, graph, ax=axes)
    axes.set_title(
        _title(segmentation) if title is None else title, loc="left", fontsize=10, pad=10
    )
    with atomic_write(path) as draft:
        figure.savefig(draft, dpi=200)


def similarity_image(graph: NeighborGraph, pixels: int = PIXELS) -> NDArray[np.float32]:
    """Square picture of the graph: 1 where frames are equal, 0 where none are neighbours.

    Parameters
    ----------
    graph : NeighborGraph
    pixels : int
        Of each edge, at most. Where several pairs of frames fall on one pixel, the most
        similar one counts.

    Returns
    -------
    (size, size) array

    Examples
    --------
    >>> import kineme
    >>> from kineme.plot import similarity_image
    >>> graph = kineme.neighbor_graph([[0.0], [0.5], [5.0]], radius=1.0)
    >>> (similarity_image(graph) > 0).tolist()
    [[True, True, False], [True, True, False], [False, False, True]]
    """
    n = max(len(graph), graph.n_columns)
    size = min(n, pixels)
    image = np.zeros(size * size, np.float32)
    scale = graph.radius or 1.0
    for first, last in _runs_of_rows(graph.indptr):
        entries = slice(graph.indptr[first], graph.indptr[last])
        rows = np.repeat(np.arange(first, last), np.diff(graph.indptr[first : last + 1]))
        columns = graph.indices[entries].astype(np.int64)
        cells = rows * size // n * size + columns * size // n
        # A neighbour at the very rim of the radius is still seen.
        np.maximum.at(image, cells, 1 - 0.85 * graph.distances[entries] / np.float32(scale))
    return image.reshape(size, size)


def _runs_of_rows(indptr: NDArray[np.int64]) -> list[tuple[int, int]]:
    """Rows in runs of about ENTRIES_AT_ONCE entries."""
    bounds = np.arange(0, indptr[-1], ENTRIES_AT_ONCE)
    starts = np.unique(np.searchsorted(indptr, bounds, side="right") - 1).tolist()
    return list(zip(starts, [*starts[1:], len(indptr) - 1], strict=True))


def _draw_borders(axes: Axes, segmentation: Segmentation) -> None:
    activities, primitives = segmentation.activities, segmentation.primitives
    counts = np.bincount(primitives.activity, minlength=len(activities))
    lengths = (activities.stop_frame - activities.start_frame) / segmentation.n_frames
    wide = lengths > counts * NARROW
    cuts = [
        line
        for row in primitives
        if row.start_s > activities.start_s[row.activity] and wide[row.activity]
        for line in _cross(row.start_s, activities[row.activity])
    ]
    axes.add_collection(LineCollection(cuts, colors=BORDER, linewidths=0.5, alpha=0.75))
    shown = activities[activities.kind == "activity"]
    squares = _boxes(shown.start_s, shown.stop_s, shown.start_s, shown.stop_s)
    width = 1.4 if len(activities) * NARROW < 0.2 else 0.7
    axes.add_collection(
        PolyCollection(squares, facecolor="none", edgecolor=BORDER, linewidth=width, clip_on=False)
    )


def _cross(at: float, within: Segment) -> list[list[tuple[float, float]]]:
    """Return a line across an activity in each direction."""
    return [
        [(at, within.start_s), (at, within.stop_s)],
        [(within.start_s, at), (within.stop_s, at)],
    ]


def _draw_bars(axes: Axes, segmentation: Segmentation, width: float) -> None:
    seconds = segmentation.n_frames / segmentation.fps
    rows = segmentation.primitives if len(segmentation.primitives) else segmentation.activities
    labels = label_colors(segmentation)
    colors = [segment_color(row, labels) for row in rows]
    below = _boxes(rows.start_s, rows.stop_s, seconds + 0.4 * width, seconds + 1.4 * width)
    left = _boxes(-1.4 * width, -0.4 * width, rows.start_s, rows.stop_s)
    gap = 0.6 if len(rows) < MAX_GAPS else 0.0
    for bars in (below, left):
        axes.add_collection(
            PolyCollection(bars, facecolors=colors, edgecolors="white", linewidths=gap)
        )


def _boxes(left: Any, right: Any, top: Any, bottom: Any) -> list[NDArray[np.float64]]:
    """Corners (4, 2) of upright rectangles; a number stands for as many as needed."""
    left, right, top, bottom = np.broadcast_arrays(left, right, top, bottom)
    corners = [left, top, right, top, right, bottom, left, bottom]
    return list(np.stack(corners, axis=-1).reshape(-1, 4, 2))


def _legend(segmentation: Segmentation) -> list[Patch]:
    """Return the largest clusters by number of primitives, in the order of their numbers."""
    counts = segmentation.repetitions()
    shown = sorted(sorted(counts, key=lambda cluster: -counts[cluster])[:MAX_LEGEND])
    handles = [
        Patch(color=cluster_color(cluster), label=f"{cluster}  ({counts[cluster]}×)")
        for cluster in shown
    ]
    if (segmentation.primitives.cluster < 0).any():
        handles.append(Patch(color=NO_CLUSTER, label="none"))
    if len(counts) > len(shown):
        handles.append(Patch(color="none", label=f"and {len(counts) - len(shown)} more"))
    return handles


def _graph_of(graph: Any, caller: str) -> NeighborGraph:
    """Return the neighbour graph given, or that of what a method found; else ParameterError."""
    from kineme.methods.region_growing.neighbors import NeighborGraph  # compiled code

    given = getattr(graph, "graph", graph)
    check_type(given, NeighborGraph, caller, "kineme.neighbor_graph gives one")
    found: NeighborGraph = given
    return found


def _title(segmentation: Segmentation) -> str:
    source = segmentation.provenance.get("input", {}).get("path") or "recording"
    preset = segmentation.provenance.get("preset")
    parts = [
        as_display_name(Path(source).name),
        segmentation.describe(),
        *([preset] if preset else []),
    ]
    return "  ·  ".join(parts)


def insert_gaps(
    graph: NeighborGraph, gaps: Sequence[Sequence[int]], n_frames: int
) -> NeighborGraph:
    """Return the graph with empty rows and columns in gaps, so that it shows all of the time.

    Parameters
    ----------
    graph : NeighborGraph
        Of the spans without gaps, at any rate.
    gaps : sequence of pairs of int
        Frames [start, stop).
    n_frames : int
        Of the recording.
    """
    from kineme.methods.region_growing.neighbors import NeighborGraph

    n_present = n_frames - sum(stop - start for start, stop in gaps)
    per_frame = len(graph) / max(n_present, 1)
    place = np.arange(len(graph))
    before = 0
    for start, stop in gaps:
        at = floor((start - before) * per_frame + 0.5)
        before += stop - start
        place[at:] = np.arange(at, len(graph)) + ceil(before * per_frame)
    n = max(floor(n_frames * per_frame + 0.5), int(place[-1]) + 1)
    counts = np.zeros(n, np.int64)
    counts[place] = graph.counts
    indptr = np.concatenate([[0], np.cumsum(counts)])
    indices = place[graph.indices].astype(np.int32)
    return NeighborGraph(indptr, indices, graph.distances, n, graph.radius)
