"""What each step costs, per trial, and how it grows with the recording.

Sources: Vögele, Krüger, Klein 2014, figure 7, and figure 4 of its supplement.
Every time is the least of three runs, on the machine that draws the figure.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from kineme._colors import PALETTE
from kineme.evaluation.figures.style import INK, heading, new_figure, save, tidy
from kineme.evaluation.trials import Trial
from kineme.methods.presets import PUBLISHED
from kineme.methods.region_growing.analysis import analyze_regions
from kineme.methods.region_growing.preset import RegionGrowingPreset
from kineme.segmentation.bodies import motion_features
from kineme.segmentation.segmenter import segment

STEPS = ("features", "bundling", "neighbors", "activities", "primitives", "clusters")
STEP_COLORS = dict(zip(STEPS, (PALETTE[i] for i in (1, 5, 2, 4, 3, 0)), strict=True))
RUNS = 3
POINTS = 7

Timings = dict[str, float]


def time_trials(trials: Sequence[Trial], preset: RegionGrowingPreset) -> list[Timings]:
    """Seconds per step and trial, without reading the file."""
    return [
        _least([dict(segment(trial.motion, preset=preset).timings) for _ in range(RUNS)])
        for trial in trials
    ]


def time_growth(trials: Sequence[Trial], preset: RegionGrowingPreset) -> list[tuple[int, Timings]]:
    """Frames and seconds per step, for longer and longer parts of all trials in a row, twice."""
    features = np.concatenate([motion_features(trial.motion, preset) for trial in trials] * 2)
    lengths: NDArray[np.int64] = np.geomspace(500, len(features), POINTS).astype(np.int64)
    return [
        (int(n), _least([analyze_regions(features[:n], preset).timings for _ in range(RUNS)]))
        for n in lengths
    ]


def plot_timings(trials: Sequence[Trial], path: Path) -> Path:
    """Stacked bars per trial, one panel per preset."""
    figure = new_figure(9.2, 3.2)
    panels = figure.subplots(1, len(PUBLISHED), sharey=True, squeeze=False)[0]
    for axes, preset in zip(panels, PUBLISHED.values(), strict=True):
        rows = time_trials(trials, preset)
        bottom = np.zeros(len(trials))
        for step in STEPS:
            heights = np.array([1000 * row.get(step, 0.0) for row in rows])
            axes.bar(range(len(rows)), heights, 0.6, bottom, color=STEP_COLORS[step], label=step)
            bottom += heights
        names = [f"{t.name}\n{t.truth.frames} frames" for t in trials]
        axes.set_xticks(range(len(trials)), names)
        tidy(axes)
        heading(axes, preset.name)
    panels[0].set_ylabel("milliseconds", fontsize=8)
    panels[0].legend(frameon=False, fontsize=7)
    return save(figure, path)


def plot_growth(trials: Sequence[Trial], path: Path) -> Path:
    """Seconds per step against frames, both axes logarithmic."""
    figure = new_figure(9.2, 3.6)
    panels = figure.subplots(1, len(PUBLISHED), sharey=True, squeeze=False)[0]
    for axes, preset in zip(panels, PUBLISHED.values(), strict=True):
        growth = time_growth(trials, preset)
        frames = np.array([n for n, _ in growth])
        for step in growth[0][1]:
            seconds = [timings[step] for _, timings in growth]
            axes.plot(frames, seconds, "o-", ms=3, lw=1.2, color=STEP_COLORS[step], label=step)
        total = np.array([sum(timings.values()) for _, timings in growth])
        axes.plot(frames, total, "o-", ms=3, lw=1.6, color=INK, label="all")
        _quadratic(axes, frames, total)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_xlabel("frames at 30 Hz", fontsize=8)
        tidy(axes)
        slope = np.polyfit(np.log(frames[-4:]), np.log(total[-4:]), 1)[0]
        heading(axes, f"{preset.name}: frames to the power of {slope:.1f}")
    panels[0].set_ylabel("seconds", fontsize=8)
    panels[0].legend(frameon=False, fontsize=7)
    return save(figure, path)


def _quadratic(axes: Axes, frames: NDArray[np.int64], total: NDArray[np.float64]) -> None:
    line = total[-1] * (frames / frames[-1]) ** 2
    axes.plot(frames, line, ":", lw=1, color=INK, label="frames squared")


def _least(runs: Sequence[Timings]) -> Timings:
    return {step: min(run[step] for run in runs) for step in runs[0]}
