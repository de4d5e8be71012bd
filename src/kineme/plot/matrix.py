"""Plot the self-similarity matrix of a recording with its borders and clusters.

Time runs to the right and downwards. A dark dot at (t, j) means that frame j is similar to frame t.
Squares frame the activities; thin lines inside them separate primitives. The bars along both edges
are coloured by cluster, grey without one. Similarities are those shown in the studio and reports
(`kineme.features.similarity`), at the resolution that fits the plot.

Source: Vögele, Krüger and Klein 2014, figure 2, and figure 1 of its supplement.
"""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray

from kineme._util.checks import check_path, check_type
from kineme._util.files import PICTURES, as_display_name, atomic_write
from kineme.errors import ParameterError, WriteError
from kineme.features.effectors import Names
from kineme.features.similarity import compare_frames
from kineme.plot.timeline import make_axes
from kineme.recordings import Motion, Signals
from kineme.segments.display import (
    NO_CLUSTER,
    choose_label_colors,
    get_cluster_color,
    get_segment_color,
)
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import SegmentTable

MAX_PIXELS = 1600  # largest side of the matrix
INK = "#1B1F2A"
BORDER = "#C2571A"
SHADES = LinearSegmentedColormap.from_list("similarity", ["#FFFFFF", "#B9C0CE", INK])
MIN_FRAMED = 0.004  # share of the plot; borders would hide narrower segments
MAX_LEGEND = 16
MAX_GAPS = 400  # more bars than this are drawn without gaps


def plot_matrix(
    segmentation: Segmentation,
    recording: Motion | Signals,
    *,
    effectors: Names | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw the matrix with frames around activities and primitives; axes are in seconds.

    Parameters
    ----------
    segmentation : Segmentation
    recording : Motion or Signals
        The same recording.
    effectors : joints, optional
        Joints of a motion to use as head, hands and feet if their names are unknown.
    ax : Axes, optional
        Where to draw; Axes of a new figure of pyplot by default.

    Raises
    ------
    ParameterError
        The arguments are not a segmentation and its recording.

    Examples
    --------
    >>> import numpy as np
    >>> from matplotlib.figure import Figure
    >>> import kineme
    >>> angle = np.linspace(0, 16 * np.pi, 480)
    >>> circles = kineme.Signals(np.column_stack([np.sin(angle), np.cos(angle)]), 30.0)
    >>> segments = kineme.segment(circles)
    >>> kineme.plot_matrix(segments, circles, ax=Figure().add_subplot()).get_ylabel()
    'seconds'
    """
    check_type(segmentation, Segmentation, "plot_matrix", "kineme.segment gives one")
    _check_recording(recording, segmentation)
    axes = make_axes(9.4, 8.2) if ax is None else ax
    seconds = segmentation.n_frames / segmentation.fps
    bar = 0.022 * seconds
    matrix = compare_frames(recording, effectors=effectors)
    level = next(i for i, cells in enumerate(matrix.levels) if len(cells) <= MAX_PIXELS)
    axes.imshow(
        matrix.cells(level, slice(None), slice(None)),
        cmap=SHADES,
        vmin=0,
        vmax=1,
        # Row 0 is at the top: time runs down.
        extent=(0, seconds, seconds, 0),
        interpolation="antialiased",
        resample=True,
    )
    _draw_borders(axes, segmentation)
    _draw_bars(axes, segmentation, bar)
    # Leave room for the bars on the left and below.
    axes.set_xlim(-1.5 * bar, seconds)
    axes.set_ylim(seconds + 1.5 * bar, 0)
    axes.set_aspect("equal")
    axes.set_xlabel("seconds")
    axes.set_ylabel("seconds")
    axes.spines[:].set_visible(False)
    axes.tick_params(color="#888888", labelsize=9)
    axes.legend(
        handles=_make_legend(segmentation),
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
    recording: Motion | Signals,
    path: str | PathLike[str],
    *,
    effectors: Names | None = None,
    title: str | None = None,
) -> None:
    """Write the plot of `plot_matrix` as PNG, PDF or SVG, by suffix.

    Parameters
    ----------
    segmentation : Segmentation
    recording : Motion or Signals
        The same recording.
    path : path-like
        Where to write it.
    effectors : joints, optional
        As for `plot_matrix`.
    title : str, optional
        Title of the plot; by default the name of the recording.

    Raises
    ------
    ParameterError
        The arguments are not a segmentation, its recording and a path.
    WriteError
        The suffix is unknown, or the file cannot be written.

    Examples
    --------
    >>> import kineme
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> kineme.plot_segmentation(kineme.segment(motion), motion, "segments.png")
    """
    check_type(segmentation, Segmentation, "plot_segmentation", "kineme.segment gives one")
    check_path(path, "plot_segmentation")
    if Path(path).suffix.lower() not in PICTURES:
        raise WriteError(path, f"pictures are written as {', '.join(PICTURES)}")
    figure = Figure(figsize=(9.4, 8.2))
    axes = figure.add_axes((0.085, 0.075, 0.74, 0.86))
    plot_matrix(segmentation, recording, effectors=effectors, ax=axes)
    axes.set_title(
        _make_title(segmentation) if title is None else title, loc="left", fontsize=10, pad=10
    )
    with atomic_write(path) as draft:
        figure.savefig(draft, dpi=200)


def _check_recording(recording: object, segmentation: Segmentation) -> None:
    """Raise ParameterError unless the recording has the length of the segments."""
    if not isinstance(recording, Motion | Signals):
        raise ParameterError(
            f"a picture needs the segmented Motion or Signals, not {type(recording).__name__}"
        )
    if recording.n_frames != segmentation.n_frames:
        raise ParameterError(
            f"the recording has {recording.n_frames} frames, but its segments "
            f"{segmentation.n_frames}: give the segments of this recording"
        )


def _draw_borders(axes: Axes, segmentation: Segmentation) -> None:
    """Draw a square around each activity, and lines between its primitives."""
    activities, primitives = segmentation.activities, segmentation.primitives
    counts = np.bincount(primitives.activity, minlength=len(activities))
    lengths = (activities.stop_frame - activities.start_frame) / segmentation.n_frames
    # Frame only the activity if its primitives are narrower than a line.
    is_wide = lengths > counts * MIN_FRAMED
    cuts = []
    for row in primitives:
        activity, at = activities[row.activity], row.start_s
        if at > activity.start_s and is_wide[row.activity]:
            # A vertical and a horizontal line across the activity.
            cuts += [
                [(at, activity.start_s), (at, activity.stop_s)],
                [(activity.start_s, at), (activity.stop_s, at)],
            ]
    axes.add_collection(LineCollection(cuts, colors=BORDER, linewidths=0.5, alpha=0.75))
    framed = activities[activities.kind == "activity"]
    squares = _make_boxes(framed.start_s, framed.stop_s, framed.start_s, framed.stop_s)
    width = 1.4 if len(activities) * MIN_FRAMED < 0.2 else 0.7
    axes.add_collection(
        PolyCollection(squares, facecolor="none", edgecolor=BORDER, linewidth=width, clip_on=False)
    )


def _draw_bars(axes: Axes, segmentation: Segmentation, width: float) -> None:
    """Draw bars in the colours of the clusters below and left of the matrix."""
    seconds = segmentation.n_frames / segmentation.fps
    rows = _choose_bars(segmentation)
    labels = choose_label_colors(segmentation)
    colors = [get_segment_color(row, labels) for row in rows]
    below = _make_boxes(rows.start_s, rows.stop_s, seconds + 0.4 * width, seconds + 1.4 * width)
    left = _make_boxes(-1.4 * width, -0.4 * width, rows.start_s, rows.stop_s)
    gap = 0.6 if len(rows) < MAX_GAPS else 0.0
    for bars in (below, left):
        axes.add_collection(
            PolyCollection(bars, facecolors=colors, edgecolors="white", linewidths=gap)
        )


def _make_boxes(left: Any, right: Any, top: Any, bottom: Any) -> list[NDArray[np.float64]]:
    """Return the corners (4, 2) of rectangles; scalars are broadcast."""
    # Corners clockwise from the upper left: eight numbers per box become four points.
    left, right, top, bottom = np.broadcast_arrays(left, right, top, bottom)
    corners = [left, top, right, top, right, bottom, left, bottom]
    return list(np.stack(corners, axis=-1).reshape(-1, 4, 2))


def _choose_bars(segmentation: Segmentation) -> SegmentTable:
    """Return the primitives; those of an activity without repetitions are in its cluster."""
    activities, primitives = segmentation.activities, segmentation.primitives
    if not len(primitives):
        return activities
    is_counted = np.isin(primitives.activity, primitives.activity[primitives.cluster >= 0])
    clusters = np.where(is_counted, primitives.cluster, activities.cluster[primitives.activity])
    return primitives.with_columns(cluster=clusters)


def _make_legend(segmentation: Segmentation) -> list[Patch]:
    """Return entries for the clusters with most bars, in the order of their numbers."""
    labels = {cluster: f"{cluster}  ({n}×)" for cluster, n in segmentation.repetitions().items()}
    clusters, counts = np.unique(_choose_bars(segmentation).cluster, return_counts=True)
    bars = dict(zip(clusters.tolist(), counts.tolist(), strict=True))
    has_other = bars.pop(-1, 0) > 0
    largest = sorted(sorted(bars, key=lambda cluster: -bars[cluster])[:MAX_LEGEND])
    handles = [
        Patch(color=get_cluster_color(cluster), label=labels.get(cluster, str(cluster)))
        for cluster in largest
    ]
    if has_other:
        handles.append(Patch(color=NO_CLUSTER, label="none"))
    if len(bars) > len(largest):
        handles.append(Patch(color="none", label=f"and {len(bars) - len(largest)} more"))
    return handles


def _make_title(segmentation: Segmentation) -> str:
    source = segmentation.provenance.get("input", {}).get("path") or "recording"
    preset = segmentation.provenance.get("preset")
    parts = [as_display_name(Path(source).name), segmentation.describe(), preset]
    return "  ·  ".join(filter(None, parts))
