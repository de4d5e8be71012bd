"""Draw the pictures of the documentation from the bundled recording.

    python docs/make_figures.py

They follow figures 2 and 3 of Vögele, Krüger and Klein 2014.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

import kineme
from kineme.datasets import bundled_truth
from kineme.methods.kineme.pipeline import KinemeFound
from kineme.methods.kineme.preset import KINEME
from kineme.methods.prepare import compute_motion_features
from kineme.methods.region_growing.activities import find_primitive_cuts
from kineme.methods.region_growing.analysis import RegionsFound
from kineme.methods.region_growing.preset import KRUEGER2017
from kineme.methods.region_growing.preset import VOEGELE2014 as PRESET
from kineme.methods.region_growing.warping import label_components
from kineme.plot.matrix import (
    BORDER,
    INK,
    SHADES,
    plot_matrix,
)
from kineme.segments.display import PALETTE, get_cluster_color
from kineme_reproduction.figures.matrix import draw_neighbors

IMAGES = Path(__file__).parent / "images"
EFFECTORS = ("left ankle", "right ankle", "head", "left wrist", "right wrist")
FPS = PRESET.working_fps
SQUATS = 1  # which segment of kineme they are
ZOOMED = 2  # and which of the published methods, in the picture of the primitives


def main() -> None:
    motion = kineme.read(kineme.bundled_recording())
    segments, found = kineme.segment_and_found(motion, preset=KINEME)

    figure = _figure(7.6, 6.6)
    plot_matrix(segments, motion, ax=figure.add_subplot())
    _save(figure, "exercises")

    figure = _figure(8, 3)
    draw_features(figure.add_subplot(), motion)
    _save(figure, "features")

    figure = _figure(8, 3)
    draw_visits(figure.add_subplot(), compute_motion_features(motion, KINEME), found)
    _save(figure, "repetitions")

    figure = _figure(8, 3.6)
    draw_bundling(figure.subplots(1, 2, sharex=True, sharey=True), motion, segments)
    _save(figure, "bundling")

    published, analysis = kineme.segment_and_found(motion, preset=PRESET)

    figure = _figure(9, 4.6)
    draw_regions(figure.subplots(1, 2, sharey=True), analysis)
    _save(figure, "activities")

    figure = _figure(9, 4.6)
    draw_paths(figure.subplots(1, 2, sharey=True), analysis)
    _save(figure, "primitives")

    rows = {"truth": kineme.read_segments(bundled_truth()), "kineme": segments}
    rows |= {"voegele2014": published, "krueger2017": kineme.segment(motion, preset="krueger2017")}
    figure = _figure(9, 3)
    draw_bars(figure.add_subplot(), rows)
    _save(figure, "clusters")


def draw_features(axes: Axes, motion: kineme.Motion) -> None:
    """Heights of the five points relative to the pelvis."""
    heights = kineme.pose_features(kineme.resample(motion, FPS))[:, 1::3]
    seconds = np.arange(len(heights)) / FPS
    for name, height, color in zip(EFFECTORS, heights.T, PALETTE, strict=False):
        axes.plot(seconds, height, color=color, linewidth=1, label=name)
    axes.set(xlabel="seconds", ylabel="metres above the pelvis", xlim=(0, seconds[-1]))
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(ncols=5, frameon=False, fontsize=8, loc="upper center", bbox_to_anchor=(0.5, 1.15))


def draw_visits(axes: Axes, features: np.ndarray, found: KinemeFound) -> None:
    """How far the squats are from three of their own poses, and where the repetitions begin."""
    start, stop = found.borders[SQUATS : SQUATS + 2].tolist()
    seconds = np.arange(start, stop) / FPS
    for share, color in zip((0.1, 0.17, 0.24), PALETTE[2:], strict=False):
        at = round(start + share * (stop - start))
        distance = np.linalg.norm(features[start:stop] - features[at], axis=1)
        axes.plot(seconds, distance, color=color, linewidth=1.2, label=f"{at / FPS:.1f} s")
    for cut in found.primitives[(found.primitives > start) & (found.primitives < stop)] / FPS:
        axes.axvline(cut, color=BORDER, linewidth=1.5)
    axes.set(xlabel="seconds", ylabel="body sizes", xlim=(seconds[0], seconds[-1]), ylim=(0, None))
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(
        title="distance from", frameon=False, fontsize=8, loc="upper left", bbox_to_anchor=(1, 1)
    )


def draw_bundling(pair: np.ndarray, motion: kineme.Motion, segments: kineme.Segmentation) -> None:
    """The features' path, a cluster in a colour, on their two widest axes."""
    plain = compute_motion_features(motion, KRUEGER2017)
    center = plain.mean(axis=0)
    axes = np.linalg.svd(plain - center, full_matrices=False)[2][:2].T
    for panel, features, title in zip(
        pair, (plain, kineme.bundle(plain)), ("as they are", "bundled"), strict=True
    ):
        x, y = ((features - center) @ axes).T
        for row in segments.activities:
            if row.kind == "activity":
                span = slice(round(row.start_s * FPS), round(row.stop_s * FPS))
                panel.plot(x[span], y[span], color=get_cluster_color(row.cluster), linewidth=0.7)
        panel.set_title(title, loc="left", fontsize=10)
        panel.set(xlabel="metres", aspect="equal")
        panel.spines[["top", "right"]].set_visible(False)


def draw_regions(pair: np.ndarray, analysis: RegionsFound) -> None:
    """Regions grown forward and backward, on the neighbours they count."""
    n = len(analysis.graph)
    graph = analysis.graph.nearest(PRESET.growth_neighbors)
    graph = graph.restrict(min_lag=PRESET.frames(PRESET.diagonal_width))
    cuts = analysis.activity_cuts
    forward = np.concatenate([[0], cuts.forward, [n]])
    backward = np.concatenate([[0], cuts.backward, [n]])
    for axes, borders, title in zip(
        pair, (forward, backward), ("grown forward: ends", "grown backward: starts"), strict=True
    ):
        _matrix(axes, draw_neighbors(graph), n)
        for start, stop in zip(borders[:-1] / FPS, borders[1:] / FPS, strict=True):
            size = stop - start
            axes.add_patch(Rectangle((start, start), size, size, fill=False, color=BORDER))
        axes.set_title(title, loc="left", fontsize=10)


def draw_paths(pair: np.ndarray, analysis: RegionsFound) -> None:
    """The connected components inside one activity, and the paths and cuts they give."""
    first, stop = analysis.borders[ZOOMED : ZOOMED + 2].tolist()
    image, extent = components(analysis.graph, first, stop)
    found = find_primitive_cuts(analysis.graph, (first, stop), PRESET)
    colors = ListedColormap(["white", *PALETTE])
    pair[0].imshow(image, cmap=colors, vmin=0, vmax=len(PALETTE), extent=extent)
    pair[0].set_title("connected components", loc="left", fontsize=10)
    pair[1].imshow(image > 0, cmap=SHADES, vmax=3, extent=extent)
    for rows, columns in found.paths:
        pair[1].plot(columns / FPS, rows / FPS, color=INK, linewidth=1.2)
    for cut in found.cuts / FPS:
        pair[1].axvline(cut, color=BORDER, linewidth=1.5)
    pair[1].set_title("warping paths that hold, and cuts", loc="left", fontsize=10)
    for axes in pair:
        axes.set(xlabel="seconds", xlim=extent[:2], ylim=extent[2:])
    pair[0].set_ylabel("seconds")


def components(
    graph: kineme.NeighborGraph, first: int, stop: int
) -> tuple[np.ndarray, tuple[float, float, float, float]]:
    """A picture of one activity, numbered by component, and its extent in seconds."""
    dense = graph.to_scipy()[first:stop, first:stop].tocoo()
    inside = kineme.NeighborGraph(
        np.concatenate([[0], np.cumsum(np.bincount(dense.row, minlength=stop - first))]),
        dense.col.astype(np.int32),
        dense.data,
        stop - first,
        graph.radius,
    )
    labels = label_components(inside, steps=PRESET.steps)
    _, number = np.unique(labels, return_inverse=True)
    image = np.zeros((stop - first, stop - first))
    image[dense.row, dense.col] = number % len(PALETTE) + 1
    start_s, stop_s = first / FPS, stop / FPS
    return image, (start_s, stop_s, stop_s, start_s)


def draw_bars(axes: Axes, rows: dict[str, kineme.Segmentation]) -> None:
    """One bar per result, coloured by cluster."""
    for place, result in enumerate(rows.values()):
        for row in result.primitives:
            box = Rectangle((row.start_s, place), row.stop_s - row.start_s, 0.8)
            box.set(facecolor=get_cluster_color(row.cluster), edgecolor="white", linewidth=0.8)
            axes.add_patch(box)
    axes.set(xlim=(0, result.n_frames / result.fps), ylim=(len(rows), 0), xlabel="seconds")
    axes.set_yticks(np.arange(len(rows)) + 0.4, list(rows))
    axes.tick_params(left=False)
    axes.spines[:].set_visible(False)


def _matrix(axes: Axes, image: np.ndarray, frames: int) -> None:
    seconds = frames / FPS
    axes.imshow(image, cmap=SHADES, vmin=0, vmax=1, extent=(0, seconds, seconds, 0))
    axes.set(xlabel="seconds", ylabel="seconds")


def _figure(width: float, height: float) -> Figure:
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def _save(figure: Figure, name: str) -> None:
    options = {"dpi": 120, "bbox_inches": "tight", "pil_kwargs": {"optimize": True}}
    figure.savefig(IMAGES / f"{name}.png", **options)


if __name__ == "__main__":
    main()
