"""Accuracies per trial and method, as measured and as printed.

Above the two published protocols, below two fair scores. Diamonds are the
values printed in the paper. Sources: Vögele, Krüger, Klein 2014, figure 6, and
`kineme.reproduction.published`.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from kineme.reproduction.benchmark import PublishedCuts, Result
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
from kineme.reproduction.published import published

PANELS = {
    "tolerant": "tolerant accuracy (published protocol)",
    "strict": "strict accuracy (published protocol)",
    "one_to_one": "one-to-one frame accuracy (fair)",
    "border_f1": "border F1 (fair)",
}


def plot_accuracies(results: Sequence[Result], path: Path) -> Path:
    """Bars per trial, and their means, for four scores."""
    methods = list(dict.fromkeys(r.method for r in results))
    figure = new_figure(9.2, 8.4)
    for axes, (score, title) in zip(figure.subplots(len(PANELS), 1), PANELS.items(), strict=True):
        _draw(axes, results, methods, score)
        heading(axes, title)
    handles: list[Patch | Line2D] = [Patch(color=method_color(m), label=m) for m in methods]
    handles.append(
        Line2D([], [], marker="D", mfc="white", mec=INK, ls="", ms=4, label="as printed")
    )
    figure.legend(
        handles=handles, loc="outside lower center", ncols=len(handles), frameon=False, fontsize=8
    )
    return save(figure, path)


def _draw(axes: Axes, results: Sequence[Result], methods: Sequence[str], score: str) -> None:
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
            said = [printed[method][trial] for trial in trials]
            said.append(float(np.mean(said)))
            axes.plot(places + offset, said, "D", mfc="white", mec=INK, ms=3.5, mew=0.8)
    axes.set_xticks(places, [*trials, "mean"])
    axes.set_ylim(0, 1.02)
    tidy(axes)


def plot_published_cuts(found: Sequence[PublishedCuts], path: Path) -> Path:
    """ACA's and HACA's published cuts: what they score, and what was printed for them."""
    figure = new_figure(9.2, 5.2)
    panels = figure.subplots(2, 2, sharex=True, sharey=True)
    for row, method in zip(panels, ("aca", "haca"), strict=True):
        own = [p for p in found if p.method == method]
        for axes, score in zip(row, ("strict", "tolerant"), strict=True):
            _draw_gap(axes, own, score)
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
