"""Segment bars of every trial: the truth above what each method found.

A cluster has the colour of the class it is assigned to one to one; the other
clusters have that of the class most of their frames are in, lighter. What the
annotators leave open, and transitions, are dark. Source: Vögele, Krüger, Klein
2014, figure 4.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.patches import Rectangle

from kineme.evaluation.comparison import Comparison
from kineme.evaluation.truth import TRANSITION, UNLABELLED, Labelling, make_labelling
from kineme.segments.display import PALETTE
from kineme_reproduction.benchmark import Result
from kineme_reproduction.figures.style import BETWEEN, INK, heading, new_figure, save
from kineme_reproduction.trials import Trial

LIGHTER = 0.55
ROW_INCHES = 0.17


def plot_bars(results: Sequence[Result], path: Path) -> Path:
    """Draw all trials below each other in one picture."""
    trials = list(dict.fromkeys(r.trial for r in results))
    methods = len({r.method for r in results})
    height = len(trials) * ((methods + 1) * ROW_INCHES + 0.42)
    figure = new_figure(9.2, height + 0.2)
    panels = figure.subplots(len(trials), 1, squeeze=False)[:, 0]
    for axes, trial in zip(panels, trials, strict=True):
        draw_bars(axes, trial, [r for r in results if r.trial is trial])
    panels[-1].set_xlabel("seconds", fontsize=8)
    return save(figure, path)


def plot_trials(results: Sequence[Result], folder: Path) -> list[Path]:
    """Draw one picture per trial, ``TRIAL.png``."""
    return [
        plot_bars([r for r in results if r.trial is trial], folder / f"{trial.name}.png")
        for trial in dict.fromkeys(r.trial for r in results)
    ]


def draw_bars(axes: Axes, trial: Trial, results: Sequence[Result]) -> None:
    """Draw the rows of one trial."""
    truth = trial.truth.labelling()
    classes = list(dict.fromkeys(label for label in truth.labels if label != TRANSITION))
    colors = {label: (PALETTE[i % len(PALETTE)], 0.0) for i, label in enumerate(classes)}
    _draw_row(axes, 0, truth, colors)
    _name_classes(axes, truth, colors)
    for row, result in enumerate(results, 1):
        found = units(result)
        _draw_row(axes, row, found, _colors(truth, found, colors))
    axes.set_yticks(range(len(results) + 1), ["truth", *(r.method for r in results)])
    axes.set_ylim(len(results) + 0.6, -0.6)
    axes.set_xlim(0, truth.frames / truth.fps)
    axes.tick_params(labelsize=7, length=2, colors=INK)
    axes.spines[:].set_visible(False)
    heading(axes, trial.name)


def units(result: Result) -> Labelling:
    """Return the smallest segments of a result, at the rate of the truth."""
    truth, found = result.trial.truth, result.found
    rows = found.primitives if len(found.primitives) else found.activities
    return make_labelling(rows, fps=found.fps).at(frames=truth.frames, fps=truth.fps)


def classes_of(truth: Labelling, found: Labelling) -> dict[str, str]:
    """Return the most frequent class of each cluster, over certain frames."""
    true, given = truth.per_frame(), found.per_frame()
    classes = {}
    for label in set(found.labels) - {TRANSITION}:
        inside = true[(given == label) & (true != TRANSITION)]
        names, counts = np.unique(inside.astype(str), return_counts=True)
        if names.size:
            classes[label] = str(names[counts.argmax()])
    return classes


def _colors(
    truth: Labelling, found: Labelling, colors: Mapping[str, tuple[str, float]]
) -> dict[str, tuple[str, float]]:
    """Return colour and lightness per cluster."""
    best = _assignment(truth, found)
    return {
        label: colors[best[label]] if label in best else (colors[name][0], LIGHTER)
        for label, name in classes_of(truth, found).items()
    }


def _assignment(truth: Labelling, found: Labelling) -> dict[str, str]:
    """Return the best one-to-one assignment of clusters to classes, over certain frames."""
    true, given = truth.numbers(), found.numbers()
    certain = (true != UNLABELLED) & (given != UNLABELLED)
    if not certain.any():
        return {}
    compared = Comparison(true[certain], given[certain], truth.fps)
    right = compared.mapped == compared.truth
    clusters, classes = found.names(), truth.names()
    pairs = set(zip(compared.found[right].tolist(), compared.truth[right].tolist(), strict=True))
    return {clusters[cluster]: classes[kind] for cluster, kind in pairs}


def _draw_row(
    axes: Axes, row: int, found: Labelling, colors: Mapping[str, tuple[str, float]]
) -> None:
    seconds = found.borders / found.fps
    boxes = [
        Rectangle((start, row - 0.4), stop - start, 0.8)
        for start, stop in pairwise(seconds.tolist())
    ]
    faces = [_mixed(*colors.get(label, (BETWEEN, 0.0))) for label in found.labels]
    axes.add_collection(
        PatchCollection(boxes, facecolors=faces, edgecolors="white", linewidths=0.5)
    )


def _name_classes(axes: Axes, truth: Labelling, colors: Mapping[str, tuple[str, float]]) -> None:
    for label, start, stop in zip(truth.labels, truth.starts, truth.stops, strict=True):
        room = (stop - start) / truth.frames * 110  # letters that fit
        if label != TRANSITION and room > 2:
            text = label if len(label) <= room else f"{label[: int(room) - 1]}…"
            middle, color = (start + stop) / 2 / truth.fps, _readable_on(colors[label][0])
            axes.text(middle, 0.03, text, fontsize=5.5, color=color, ha="center", va="center")


def _readable_on(color: str) -> str:
    """Return a dark text colour for light colours, and a light one for dark colours."""
    red, green, blue = _mixed(color, 0.0)
    return INK if 0.299 * red + 0.587 * green + 0.114 * blue > 0.6 else "white"


def _mixed(color: str, lightness: float) -> tuple[float, ...]:
    channels = (int(color[i : i + 2], 16) / 255 for i in (1, 3, 5))
    return tuple((1 - lightness) * c + lightness for c in channels)
