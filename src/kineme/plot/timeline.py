"""Plot results as timelines, alone or below each other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import get_args

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from kineme._util.checks import as_texts, check_type, is_one_of
from kineme._util.files import as_display_name
from kineme.errors import ParameterError
from kineme.segments.display import choose_label_colors, get_segment_color
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment, SegmentTable

BAR_HEIGHT = 0.8
"""Height of the bars of a row; rows are 1 apart."""
MIN_LABELLED = 0.06
"""Share of the total time from which a bar has room for its label."""
MAX_EDGES = 400
"""Bars of a row up to which white lines separate them."""


def plot_timeline(segmentation: Segmentation, *, ax: Axes | None = None) -> Axes:
    """Draw activities, with primitives below them, over the seconds of the recording.

    Parameters
    ----------
    segmentation : Segmentation
    ax : Axes, optional
        Where to draw; Axes of a new figure of pyplot by default.

    Raises
    ------
    ParameterError
        The argument is not a segmentation.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from kineme import datasets, plot, read_segments
    >>> segments = read_segments(datasets.bundled_truth(), fps=60)
    >>> plot.plot_timeline(segments, ax=Figure().add_subplot()).get_xlabel()
    'seconds'
    """
    check_type(segmentation, Segmentation, "plot_timeline", "kineme.segment gives one")
    rows = {"activities": segmentation.activities, "primitives": segmentation.primitives}
    filled_rows = {name: table for name, table in rows.items() if len(table)}
    return draw_timeline(filled_rows, segmentation.n_frames / segmentation.fps, ax=ax)


def compare(
    results: Sequence[Segmentation],
    *,
    names: Sequence[str] | None = None,
    level: Level = "activity",
    ax: Axes | None = None,
) -> Axes:
    """Draw timelines of several results below each other, to compare their borders.

    Cluster numbers of different results are unrelated. So each cluster of a later result takes the
    colour of the cluster in the first result with which it shares most time, one to one.

    Parameters
    ----------
    results : sequence of Segmentation
        Usually of one recording: by several presets, or the truth and a result.
    names : sequence of str, optional
        One per result; by default its preset or file.
    level : {"activity", "primitive"}
        Which segments to draw.
    ax : Axes, optional
        Where to draw; Axes of a new figure of pyplot by default.

    Raises
    ------
    ParameterError
        There are no results, some are not segmentations, the number of names differs, or a
        result has no segments of that level.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from kineme import compare, datasets, read_segments
    >>> truth = read_segments(datasets.bundled_truth(), fps=60)
    >>> ax = compare([truth, truth], names=["by hand", "again"], ax=Figure().add_subplot())
    >>> [text.get_text() for text in ax.get_yticklabels()]
    ['by hand', 'again']
    """
    check_type(results, Sequence, "compare", "give a list of segmentations")
    if not results:
        raise ParameterError("compare takes at least one result, not an empty list")
    for result in results:
        check_type(result, Segmentation, "compare", "kineme.segment gives one")
    if not is_one_of(level, get_args(Level)):
        raise ParameterError(f"level must be 'activity' or 'primitive', not {level!r:.60}")
    row_names = _choose_names(results) if names is None else as_texts(names, "names")
    if len(row_names) != len(results) or len(set(row_names)) != len(row_names):
        raise ParameterError(
            f"names {list(row_names)} for {len(results)} results: give a different one for each"
        )
    rows = {name: result.level(level) for name, result in zip(row_names, results, strict=True)}
    for name, table in rows.items():
        if not len(table):
            raise ParameterError(f"{name} has no segments of level {level!r}")
    first = rows[row_names[0]]
    for name, table in rows.items():
        numbers = match_clusters(first, table)
        clusters = [numbers.get(cluster, -1) for cluster in table.cluster.tolist()]
        rows[name] = table.with_columns(cluster=np.array(clusters, np.int64))
    return draw_timeline(rows, max(result.n_frames / result.fps for result in results), ax=ax)


def match_clusters(first: SegmentTable, other: SegmentTable) -> dict[int, int]:
    """Map each cluster of ``other`` to that of ``first`` with most shared time, one to one.

    Clusters without a match get numbers above those of ``first``.
    """
    first_clusters, other_clusters = (
        np.unique(table.cluster[table.cluster >= 0]) for table in (first, other)
    )
    # Clusters are constant between two of these times.
    times = np.unique(np.concatenate([first.start_s, first.stop_s, other.start_s, other.stop_s]))
    middles, lengths = (times[1:] + times[:-1]) / 2, np.diff(times)
    a, b = _find_clusters(first, middles), _find_clusters(other, middles)
    both = (a >= 0) & (b >= 0)
    shared = np.zeros((len(first_clusters), len(other_clusters)))
    # Row and column in `shared` for each interval.
    cells = np.searchsorted(first_clusters, a[both]), np.searchsorted(other_clusters, b[both])
    # `add.at` also adds up repeated indices.
    np.add.at(shared, cells, lengths[both])
    numbers = {
        int(other_clusters[column]): int(first_clusters[row])
        # Negative, since the assignment minimises.
        for row, column in zip(*linear_sum_assignment(-shared), strict=True)
        if shared[row, column] > 0
    }
    next_free = int(first_clusters.max(initial=-1)) + 1
    rest = [cluster for cluster in other_clusters.tolist() if cluster not in numbers]
    return numbers | {cluster: next_free + i for i, cluster in enumerate(rest)}


def _find_clusters(table: SegmentTable, times: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the cluster at each time; -1 without one."""
    # The last segment that begins at or before each time.
    row = np.searchsorted(table.start_s, times, side="right") - 1
    inside = times < table.stop_s[row]
    return np.where(inside, table.cluster[row], -1)


def _choose_names(results: Sequence[Segmentation]) -> list[str]:
    """Return names of the results: presets, else files, else numbers, if they are unique."""
    numbers = [f"result {number}" for number in range(1, len(results) + 1)]
    presets = [result.provenance.get("preset") for result in results]
    paths = [(result.provenance.get("input") or {}).get("path") for result in results]
    files = [as_display_name(Path(path).name) if isinstance(path, str) else None for path in paths]
    for names in (presets, files):
        chosen = [name or number for name, number in zip(names, numbers, strict=True)]
        if len(set(chosen)) == len(chosen):
            return chosen
    return numbers


def draw_timeline(
    rows: Mapping[str, SegmentTable], seconds: float, *, ax: Axes | None = None
) -> Axes:
    """Draw rows of segments below each other, with their names on the left."""
    axes = make_axes(9, 0.9 + 0.4 * len(rows)) if ax is None else ax
    labels = choose_label_colors(segment for table in rows.values() for segment in table)
    for number, table in enumerate(rows.values()):
        shades = [get_segment_color(segment, labels) for segment in table]
        axes.broken_barh(
            list(zip(table.start_s, table.duration_s, strict=True)),
            (number - BAR_HEIGHT / 2, BAR_HEIGHT),
            facecolors=shades,
            edgecolors="white",
            linewidth=0.6 if len(table) < MAX_EDGES else 0.0,
        )
        for segment, color in zip(table, shades, strict=True):
            if segment.label and segment.duration_s > MIN_LABELLED * seconds:
                _write_label(axes, segment, number, color)
    axes.set_yticks(range(len(rows)), list(rows))
    # The first row is at the top.
    axes.set_ylim(len(rows) - 0.5, -0.5)
    axes.set_xlim(0, seconds)
    axes.set_xlabel("seconds")
    axes.spines[["left", "right", "top"]].set_visible(False)
    axes.tick_params(axis="y", length=0)
    return axes


def _write_label(axes: Axes, segment: Segment, row: int, color: str) -> None:
    # Red, green and blue from "#rrggbb".
    red, green, blue = (int(color[i : i + 2], 16) for i in (1, 3, 5))
    # Perceived brightness (weights of ITU-R BT.601), 0 to 255.
    dark = 0.299 * red + 0.587 * green + 0.114 * blue < 140
    axes.text(
        (segment.start_s + segment.stop_s) / 2,
        row,
        segment.label.replace("$", r"\$"),  # no formula
        ha="center",
        va="center",
        fontsize=8,
        color="white" if dark else "black",
        clip_on=True,
    )


def make_axes(width: float, height: float) -> Axes:
    """Return the axes of a new pyplot figure of this size in inches."""
    from matplotlib import pyplot as plt  # notebooks show pyplot figures automatically

    return plt.subplots(figsize=(width, height), layout="constrained")[1]
