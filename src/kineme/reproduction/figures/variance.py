"""How similar are the segments of one cluster, by class and by method.

`plot_by_class` is figure 5 of Vögele, Krüger, Klein 2014: mean (bars) and
variance (glyphs) of the dynamic-time-warping distance on point clouds and on
stacked features, and of the lengths, per class, with the number of segments.
`plot_spread` is figure 8 of Krüger et al. 2017: the distances of all clusters.
A cluster counts for the class that most of its frames have; what is alone in
its cluster has no distance.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from kineme.evaluation.variance import ClusterVariance, feature_variance, point_cloud_variance
from kineme.reproduction.benchmark import Result
from kineme.reproduction.figures.bars import classes_of, units
from kineme.reproduction.figures.style import (
    FAINT,
    INK,
    grouped,
    heading,
    method_color,
    new_figure,
    save,
    tidy,
)

METHODS = ("kineme", "voegele2014", "krueger2017", "aca", "haca")


class Measured(NamedTuple):
    """A cluster of at least two segments: whose it is, and both its distances."""

    method: str
    name: str
    cloud: ClusterVariance
    feature: ClusterVariance


Values = Callable[[Measured], tuple[float, float]]

QUANTITIES: tuple[tuple[str, Values], ...] = (
    ("point clouds, m", lambda m: (m.cloud.distance_mean, m.cloud.distance_variance)),
    ("stacked features, m", lambda m: (m.feature.distance_mean, m.feature.distance_variance)),
    ("length, s", lambda m: (m.cloud.length_mean_s, m.cloud.length_variance_s2)),
)


def measure(results: Sequence[Result]) -> list[Measured]:
    """Every cluster of at least two segments of every result."""
    found = []
    for result in results:
        segments, trial = units(result), result.trial
        names = classes_of(trial.truth.labelling(), segments)
        clouds = point_cloud_variance(trial.positions, segments)
        features = feature_variance(trial.features, segments)
        found += [
            Measured(result.method, names[cloud.label], cloud, feature)
            for cloud, feature in zip(clouds, features, strict=True)
            if cloud.segments > 1 and cloud.label in names
        ]
    return found


def plot_by_class(clusters: Sequence[Measured], path: Path) -> Path:
    """Means and variances per class and method; segments counted below the bars."""
    methods = list(dict.fromkeys(m.method for m in clusters))
    names = sorted({m.name for m in clusters})
    figure = new_figure(9.2, 7.2)
    for axes, (title, values) in zip(figure.subplots(3, 1, sharex=True), QUANTITIES, strict=True):
        width, offsets = grouped(len(names), len(methods))
        for method, offset in zip(methods, offsets, strict=True):
            for place, name in enumerate(names):
                own = [m for m in clusters if (m.method, m.name) == (method, name)]
                if own:
                    _draw_bar(axes, place + offset, width, own, values)
        axes.set_xticks(range(len(names)), names, rotation=20, ha="right", rotation_mode="anchor")
        axes.set_xlim(-0.6, len(names) - 0.4)
        axes.set_ylim(bottom=0)
        tidy(axes)
        heading(axes, title)
    handles: list[Patch | Line2D] = [Patch(color=method_color(m), label=m) for m in methods]
    handles.append(
        Line2D([], [], marker="_", color=INK, ls="", ms=7, mew=1.6, label="variance (unit squared)")
    )
    figure.legend(
        handles=handles, loc="outside lower center", ncols=len(handles), frameon=False, fontsize=8
    )
    return save(figure, path)


def _draw_bar(
    axes: Axes, place: float, width: float, own: Sequence[Measured], values: Values
) -> None:
    mean, variance = np.nanmean([values(m) for m in own], axis=0)
    axes.bar(place, mean, 0.92 * width, color=method_color(own[0].method))
    axes.plot(place, variance, "_", color=INK, ms=5, mew=1.4)
    count = sum(m.cloud.segments for m in own)
    axes.annotate(
        str(count), (place, mean), (0, 1.5), textcoords="offset points",
        ha="center", fontsize=5.5, color=INK,
    )  # fmt: skip


def plot_spread(clusters: Sequence[Measured], path: Path) -> Path:
    """One dot per cluster, its mean distance; the line is the mean over the clusters."""
    methods = list(dict.fromkeys(m.method for m in clusters))
    figure = new_figure(9.2, 3.2)
    random = np.random.default_rng(0)
    for axes, (title, values) in zip(figure.subplots(1, 2), QUANTITIES[:2], strict=True):
        for place, method in enumerate(methods):
            distances = [values(m)[0] for m in clusters if m.method == method]
            shift = random.uniform(-0.18, 0.18, len(distances))
            axes.plot(place + shift, distances, "o", color=method_color(method), ms=4, alpha=0.75)
            axes.hlines(np.mean(distances), place - 0.3, place + 0.3, color=INK, linewidth=1.6)
        axes.set_xticks(range(len(methods)), methods)
        axes.set_ylim(bottom=0)
        tidy(axes)
        heading(axes, f"distance within clusters, {title}")
    figure.text(0.995, 0.995, "line: mean", ha="right", va="top", fontsize=7, color=FAINT)
    return save(figure, path)
