"""Timelines of results, alone and below each other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import get_args

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from kineme._util.checks import as_texts, check_type, is_one_of
from kineme._util.files import as_display_name
from kineme.errors import ParameterError
from kineme.segments.colors import choose_label_colors
from kineme.segments.html import get_segment_color
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment, SegmentTable

BAND = 0.8
"""Height of a row's bars; the rest parts it from the next."""
NAMED = 0.06
"""Share of the time from which a bar has room for its label."""
MOST_EDGES = 400
"""Bars of a row; more are drawn without white lines between them."""


def plot_timeline(segmentation: Segmentation, *, ax: Axes | None = None) -> Axes:
    """Activities, and primitives below them, along the seconds of the recording.

    Parameters
    ----------
    segmentation : Segmentation
    ax : Axes, optional
        Where to draw; Axes of a new figure of pyplot by default.

    Returns
    -------
    Axes

    Raises
    ------
    ParameterError
        Something else than a segmentation.

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
    shown = {name: table for name, table in rows.items() if len(table)}
    return draw_timeline(shown, segmentation.n_frames / segmentation.fps, ax=ax)


def compare(
    results: Sequence[Segmentation],
    *,
    names: Sequence[str] | None = None,
    level: Level = "activity",
    ax: Axes | None = None,
) -> Axes:
    """Timelines of several results below each other, so that their borders can be compared.

    Numbers of clusters mean nothing from one result to another. So each cluster of later results
    takes the colour of the one in the first result with which it shares most of its time, one to
    one.

    Parameters
    ----------
    results : sequence of Segmentation
        Usually of one recording: by several presets, or a truth and what was found.
    names : sequence of str, optional
        One for each; by default the preset that each was made with, or its file.
    level : {"activity", "primitive"}
        Which segments to draw.
    ax : Axes, optional
        Where to draw; Axes of a new figure of pyplot by default.

    Returns
    -------
    Axes

    Raises
    ------
    ParameterError
        No results, something else than segmentations, another number of names, or a
        result without segments of that level.

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
    shown = _choose_names(results) if names is None else as_texts(names, "names")
    if len(shown) != len(results) or len(set(shown)) != len(shown):
        raise ParameterError(
            f"names {list(shown)} for {len(results)} results: give a different one for each"
        )
    rows = {name: result.level(level) for name, result in zip(shown, results, strict=True)}
    for name, table in rows.items():
        if not len(table):
            raise ParameterError(f"{name} has no segments of level {level!r}")
    first = rows[shown[0]]
    tables = [_renumber(table, match_clusters(first, table)) for table in rows.values()]
    labels = choose_label_colors(segment for table in tables for segment in table)
    return draw_timeline(
        rows,
        max(result.n_frames / result.fps for result in results),
        colors=[[get_segment_color(segment, labels) for segment in table] for table in tables],
        ax=ax,
    )


def draw_timeline(
    rows: Mapping[str, SegmentTable],
    seconds: float,
    *,
    colors: Sequence[Sequence[str]] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw rows of segments below each other, each with its name at the left."""
    axes = make_axes(9, 0.9 + 0.4 * len(rows)) if ax is None else ax
    if colors is None:
        labels = choose_label_colors(segment for table in rows.values() for segment in table)
        colors = [
            [get_segment_color(segment, labels) for segment in table] for table in rows.values()
        ]
    for number, (table, shades) in enumerate(zip(rows.values(), colors, strict=True)):
        axes.broken_barh(
            list(zip(table.start_s, table.duration_s, strict=True)),
            (number - BAND / 2, BAND),
            facecolors=shades,
            edgecolors="white",
            linewidth=0.6 if len(table) < MOST_EDGES else 0.0,
        )
        for segment, color in zip(table, shades, strict=True):
            if segment.label and segment.duration_s > NAMED * seconds:
                _write_label(axes, segment, number, color)
    axes.set_yticks(range(len(rows)), list(rows))
    # The first row is at the top.
    axes.set_ylim(len(rows) - 0.5, -0.5)
    axes.set_xlim(0, seconds)
    axes.set_xlabel("seconds")
    axes.spines[["left", "right", "top"]].set_visible(False)
    axes.tick_params(axis="y", length=0)
    return axes


def make_axes(width: float, height: float) -> Axes:
    """Return the axes of a new figure of pyplot, so many inches wide and high."""
    from matplotlib import pyplot as plt  # its figures a notebook shows unasked

    return plt.subplots(figsize=(width, height), layout="constrained")[1]


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


def match_clusters(first: SegmentTable, other: SegmentTable) -> dict[int, int]:
    """For each cluster of one table that of another with which it shares most time, one to one.

    Those that share no time with a free cluster are numbered on after those of ``first``.
    """
    first_clusters, other_clusters = (
        np.unique(table.cluster[table.cluster >= 0]) for table in (first, other)
    )
    # Between two of these times nothing changes in either table.
    times = np.unique(np.concatenate([first.start_s, first.stop_s, other.start_s, other.stop_s]))
    middles, lengths = (times[1:] + times[:-1]) / 2, np.diff(times)
    a, b = _find_clusters(first, middles), _find_clusters(other, middles)
    both = (a >= 0) & (b >= 0)
    shared = np.zeros((len(first_clusters), len(other_clusters)))
    # Row and column of each interval's pair of clusters.
    cells = np.searchsorted(first_clusters, a[both]), np.searchsorted(other_clusters, b[both])
    # `add.at` adds repeated pairs one by one.
    np.add.at(shared, cells, lengths[both])
    numbers = {
        int(other_clusters[column]): int(first_clusters[row])
        # Minus, since the assignment minimises.
        for row, column in zip(*linear_sum_assignment(-shared), strict=True)
        if shared[row, column] > 0
    }
    following = int(first_clusters.max(initial=-1)) + 1
    rest = [cluster for cluster in other_clusters.tolist() if cluster not in numbers]
    return numbers | {cluster: following + i for i, cluster in enumerate(rest)}


def _find_clusters(table: SegmentTable, times: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the cluster at each time; -1 where there is none."""
    # The segment that begins last before each time.
    row = np.searchsorted(table.start_s, times, side="right") - 1
    inside = times < table.stop_s[row]
    return np.where(inside, table.cluster[row], -1)


def _renumber(table: SegmentTable, numbers: dict[int, int]) -> list[Segment]:
    return [replace(segment, cluster=numbers.get(segment.cluster, -1)) for segment in table]


def _choose_names(results: Sequence[Segmentation]) -> list[str]:
    """Return what tells the results apart: presets, else files, else their numbers."""
    numbers = [f"result {number}" for number in range(1, len(results) + 1)]
    presets = [result.provenance.get("preset") for result in results]
    paths = [(result.provenance.get("input") or {}).get("path") for result in results]
    files = [as_display_name(Path(path).name) if isinstance(path, str) else None for path in paths]
    for names in (presets, files):
        chosen = [name or number for name, number in zip(names, numbers, strict=True)]
        if len(set(chosen)) == len(chosen):
            return chosen
    return numbers
