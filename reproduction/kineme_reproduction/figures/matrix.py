"""The self-similarity matrix, and how activities and primitives come out of it.

`plot_regions` is figure 2 of Vögele, Krüger, Klein 2014: the matrix with the
truth; without its main diagonal, with the regions grown forward and backward;
and what they cut. `plot_paths` is its figure 3: one activity, its connected
components, and the cheapest warping paths that hold.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.colors import to_rgb
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from kineme.evaluation.truth import TRANSITION, Truth
from kineme.methods.prepare import compute_motion_features
from kineme.methods.presets import PUBLISHED
from kineme.methods.region_growing.activities import find_primitive_cuts
from kineme.methods.region_growing.analysis import RegionsFound, analyze_regions
from kineme.methods.region_growing.neighbors import NeighborGraph
from kineme.methods.region_growing.preset import RegionGrowingPreset
from kineme.methods.region_growing.warping import label_components
from kineme.plot.matrix import MAX_PIXELS, SHADES
from kineme.segments.display import PALETTE
from kineme_reproduction.figures.style import BETWEEN, heading, new_figure, save
from kineme_reproduction.trials import Trial

ENTRIES_AT_ONCE = 1 << 20
FORWARD, BACKWARD, FINAL = PALETTE[3], PALETTE[0], PALETTE[2]


def plot_regions(
    trial: Trial, path: Path, preset: RegionGrowingPreset = PUBLISHED["voegele2014"]
) -> Path:
    """Draw truth, forward regions, backward regions and activities in one matrix each."""
    analysis = analyze_regions(compute_motion_features(trial.motion, preset), preset)
    n, fps = len(analysis.graph), preset.working_fps
    figure = new_figure(9.2, 9.2)
    panels = figure.subplots(2, 2).ravel()
    off_diagonal = _growth_pairs(analysis, preset)
    for axes, graph in zip(
        panels, (analysis.graph, off_diagonal, off_diagonal, analysis.graph), strict=True
    ):
        _draw_matrix(axes, graph, n / fps)
    _draw_truth(panels[0], trial.truth)
    cuts = analysis.activity_cuts
    _draw_squares(panels[1], np.concatenate([[0], cuts.forward]) / fps, FORWARD)
    _draw_squares(panels[2], np.concatenate([cuts.backward, [n]]) / fps, BACKWARD)
    spans = analysis.borders / fps
    for repeats, start, stop in zip(analysis.repeats, spans[:-1], spans[1:], strict=True):
        _draw_squares(panels[3], np.array([start, stop]), FINAL if repeats else BETWEEN)
    for axes, text in zip(
        panels,
        (
            f"{trial.name}: neighbours, and what people say",
            "regions grown forward: their ends end activities",
            "regions grown backward: their starts start activities",
            "activities (green), transitions (dark)",
        ),
        strict=True,
    ):
        heading(axes, text)
    return save(figure, path)


def plot_paths(
    trial: Trial, path: Path, preset: RegionGrowingPreset = PUBLISHED["voegele2014"]
) -> Path:
    """Draw the longest activity: matrix, connected components, warping paths."""
    analysis = analyze_regions(compute_motion_features(trial.motion, preset), preset)
    lengths = np.diff(analysis.borders) * analysis.repeats
    first, stop = analysis.borders[lengths.argmax() :][:2].tolist()
    graph, fps = analysis.graph, preset.working_fps
    labels = label_components(graph, steps=preset.steps)
    figure = new_figure(9.2, 3.5)
    panels = figure.subplots(1, 3)
    block = _block(graph, graph.distances, first, stop)
    shades = SHADES(np.where(np.isnan(block), 0, 1 - 0.85 * block / graph.radius))
    groups = _component_colors(_block(graph, labels.astype(float), first, stop))
    extent = (first / fps, stop / fps, stop / fps, first / fps)
    for axes, image in zip(panels, (shades, groups, shades), strict=True):
        axes.imshow(image, extent=extent, interpolation="nearest")
        axes.tick_params(labelsize=7, length=2)
    paths = find_primitive_cuts(graph, (first, min(stop, len(graph) - 1)), preset).paths
    lines = [np.column_stack([columns, rows]) / fps for rows, columns in paths]
    panels[2].add_collection(LineCollection(lines, colors="#D62728", linewidths=1.3))
    cuts = analysis.primitives
    for cut in cuts[(first < cuts) & (cuts < stop)]:
        panels[2].axvline(cut / fps, color=FINAL, linewidth=0.8, linestyle="--")
    for axes, text in zip(
        panels,
        (
            f"{trial.name}, {first / fps:.1f} to {stop / fps:.1f} s",
            "connected components",
            "warping paths; cuts (dashed)",
        ),
        strict=True,
    ):
        heading(axes, text)
    return save(figure, path)


def _growth_pairs(analysis: RegionsFound, preset: RegionGrowingPreset) -> NeighborGraph:
    """The pairs that regions count, with the band as main diagonal."""
    graph = analysis.graph
    if preset.growth_neighbors is not None:
        graph = graph.nearest(preset.growth_neighbors)
    lag = preset.frames(preset.diagonal_width)
    return graph.restrict(radius=preset.growth_radius, min_lag=lag)


def _draw_matrix(axes: Axes, graph: NeighborGraph, seconds: float) -> None:
    axes.imshow(
        draw_neighbors(graph, 900), cmap=SHADES, vmin=0, vmax=1,
        extent=(0, seconds, seconds, 0), interpolation="antialiased",
    )  # fmt: skip
    axes.tick_params(labelsize=7, length=2)


def _draw_squares(axes: Axes, borders: NDArray[np.float64], color: str) -> None:
    boxes = [
        Rectangle((start, start), stop - start, stop - start)
        for start, stop in pairwise(borders.tolist())
    ]
    axes.add_collection(PatchCollection(boxes, facecolor="none", edgecolor=color, linewidth=1.5))


def _draw_truth(axes: Axes, truth: Truth) -> None:
    labelling = truth.labelling()
    for label, start, stop in zip(labelling.labels, labelling.starts, labelling.stops, strict=True):
        first, last = start / labelling.fps, stop / labelling.fps
        if label == TRANSITION:
            for draw in (axes.axvspan, axes.axhspan):
                draw(first, last, color=FORWARD, alpha=0.25, linewidth=0)
        else:
            axes.text(
                *(first, last, f" {label} "), fontsize=7, color=FINAL, ha="left", va="bottom",
                bbox={"facecolor": "white", "alpha": 0.75, "linewidth": 0, "pad": 0.5},
            )  # fmt: skip


def _block(
    graph: NeighborGraph, values: NDArray[np.floating], first: int, stop: int
) -> NDArray[np.float64]:
    """Return a square of the matrix; nan where nothing is stored."""
    image = np.full((stop - first, stop - first), np.nan)
    for row in range(first, stop):
        entries = slice(graph.indptr[row], graph.indptr[row + 1])
        columns = graph.indices[entries]
        inside = (columns >= first) & (columns < stop)
        image[row - first, columns[inside] - first] = values[entries][inside]
    return image


def _component_colors(labels: NDArray[np.float64]) -> NDArray[np.float64]:
    """One colour of the palette per component, the largest first; small ones grey."""
    stored = ~np.isnan(labels)
    names, counts = np.unique(labels[stored], return_counts=True)
    image = np.ones((*labels.shape, 3))
    image[stored] = to_rgb("#D5D7DC")
    shown = names[np.argsort(-counts, kind="stable")][: 2 * len(PALETTE)]
    for i, name in enumerate(shown):
        image[labels == name] = to_rgb(PALETTE[i % len(PALETTE)])
    return image


def draw_neighbors(graph: NeighborGraph, pixels: int = MAX_PIXELS) -> NDArray[np.float32]:
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
    >>> from kineme_reproduction.figures.matrix import draw_neighbors
    >>> graph = kineme.neighbor_graph([[0.0], [0.5], [5.0]], radius=1.0)
    >>> (draw_neighbors(graph) > 0).tolist()
    [[True, True, False], [True, True, False], [False, False, True]]
    """
    n = max(len(graph), graph.n_columns)
    size = min(n, pixels)
    image = np.zeros(size * size, np.float32)
    # A radius of 0 only has neighbours at distance 0.
    scale = graph.radius or 1.0
    for first, last in _runs_of_rows(graph.indptr):
        entries = slice(graph.indptr[first], graph.indptr[last])
        rows = np.repeat(np.arange(first, last), np.diff(graph.indptr[first : last + 1]))
        columns = graph.indices[entries].astype(np.int64)
        # Row and column of each pair in pixels, as one index into the flat image.
        cells = rows * size // n * size + columns * size // n
        # A neighbour at the very rim of the radius is still seen.
        np.maximum.at(image, cells, 1 - 0.85 * graph.distances[entries] / np.float32(scale))
    return image.reshape(size, size)


def _runs_of_rows(indptr: NDArray[np.int64]) -> list[tuple[int, int]]:
    """Rows in runs of about ENTRIES_AT_ONCE entries."""
    bounds = np.arange(0, indptr[-1], ENTRIES_AT_ONCE)
    # The rows whose entries begin nearest to every multiple of ENTRIES_AT_ONCE.
    starts = np.unique(np.searchsorted(indptr, bounds, side="right") - 1).tolist()
    return list(zip(starts, [*starts[1:], len(indptr) - 1], strict=True))
