"""Scores per trial and method, and how similar the segments of one cluster are.

`plot_accuracies` is figure 6 of Vögele, Krüger, Klein 2014: above the two published protocols,
below two fair scores. Diamonds are the values printed in the paper.

`plot_by_class` is its figure 5: mean (bars) and
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

from kineme_reproduction.benchmark import PublishedCuts, Result, published
from kineme_reproduction.figures.segments import classes_of, units
from kineme_reproduction.figures.style import (
    FAINT,
    INK,
    grouped,
    heading,
    method_color,
    new_figure,
    save,
    tidy,
)
from kineme_reproduction.variance import ClusterVariance, feature_variance, point_cloud_variance

METHODS = ("kineme", "voegele2014", "krueger2017", "aca", "haca")
"""Whose clusters are shown."""
PANELS = {
    "tolerant": "tolerant accuracy (published protocol)",
    "strict": "strict accuracy (published protocol)",
    "one_to_one": "one-to-one frame accuracy (fair)",
    "border_f1": "border F1 (fair)",
}


def plot_accuracies(results: Sequence[Result], path: Path) -> Path:
    """Draw bars per trial, and their means, for four scores."""
    methods = list(dict.fromkeys(r.method for r in results))
    figure = new_figure(9.2, 8.4)
    for axes, (score, title) in zip(figure.subplots(len(PANELS), 1), PANELS.items(), strict=True):
        _draw_accuracies(axes, results, methods, score)
        heading(axes, title)
    handles: list[Patch | Line2D] = [Patch(color=method_color(m), label=m) for m in methods]
    handles.append(
        Line2D([], [], marker="D", mfc="white", mec=INK, ls="", ms=4, label="as printed")
    )
    figure.legend(
        handles=handles, loc="outside lower center", ncols=len(handles), frameon=False, fontsize=8
    )
    return save(figure, path)


def _draw_accuracies(
    axes: Axes, results: Sequence[Result], methods: Sequence[str], score: str
) -> None:
    trials = list(dict.fromkeys(r.trial.name for r in results))
    values = {(r.trial.name, r.method): r.scores[score] for r in results}
    printed = published().get(f"accuracy_{score}", {})
    width, offsets = grouped(len(trials) + 1, len(methods))
    places = np.append(np.arange(len(trials)), len(trials) + 0.3)
    for method, offset in zip(methods, offsets, strict=True):
        heights = [values[trial, method] for trial in trials]
        heights.append(float(np.nanmean(heights)))
        axes.bar(places + offset, heights, 0.92 * width, color=method_color(method))
        if method in printed:
            published_values = [printed[method][trial] for trial in trials]
            published_values.append(float(np.mean(published_values)))
            axes.plot(places + offset, published_values, "D", mfc="white", mec=INK, ms=3.5, mew=0.8)
    axes.set_xticks(places, [*trials, "mean"])
    axes.set_ylim(0, 1.02)
    tidy(axes)


def plot_published_cuts(found: Sequence[PublishedCuts], path: Path) -> Path:
    """ACA's and HACA's published cuts: what they score, and what was printed for them."""
    figure = new_figure(9.2, 5.2)
    panels = figure.subplots(2, 2, sharex=True, sharey=True)
    for row, method in zip(panels, ("aca", "haca"), strict=True):
        cuts = [p for p in found if p.method == method]
        for axes, score in zip(row, ("strict", "tolerant"), strict=True):
            _draw_gap(axes, cuts, score)
            heading(axes, f"{method.upper()}, {score}")
    handles = [
        Line2D([], [], marker="o", color=INK, ls="", ms=5, label="authors' function"),
        Line2D([], [], marker="s", color=FAINT, ls="", ms=4, label="clusters one to one"),
        Line2D([], [], marker="D", mfc="white", mec=INK, ls="", ms=5, label="as printed"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=3, frameon=False, fontsize=8)
    return save(figure, path)


def _draw_gap(axes: Axes, found: Sequence[PublishedCuts], score: str) -> None:
    places = np.arange(len(found))
    scored = np.array([p.scores[score] for p in found])
    printed = np.array([p.printed[score] for p in found])
    fair = "one_to_one" if score == "strict" else "one_to_one_agreed"
    assigned = np.array([p.scores.get(fair, np.nan) for p in found])
    axes.vlines(places, printed, scored, color=FAINT, linewidth=1)
    axes.plot(places, scored, "o", color=method_color(found[0].method), ms=5)
    axes.plot(places, assigned, "s", color=FAINT, ms=3.5)
    axes.plot(places, printed, "D", mfc="white", mec=INK, ms=4.5, mew=0.9)
    axes.set_xticks(places, [p.trial.removeprefix("86_") for p in found])
    axes.set_ylim(0.4, 1.02)
    tidy(axes)


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
    """Measure each cluster of at least two segments of every result."""
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
                group = [m for m in clusters if (m.method, m.name) == (method, name)]
                if group:
                    _draw_bar(axes, place + offset, width, group, values)
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
    axes: Axes, place: float, width: float, group: Sequence[Measured], values: Values
) -> None:
    mean, variance = np.nanmean([values(m) for m in group], axis=0)
    axes.bar(place, mean, 0.92 * width, color=method_color(group[0].method))
    axes.plot(place, variance, "_", color=INK, ms=5, mew=1.4)
    count = sum(m.cloud.segments for m in group)
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
