"""What each step costs, and how much the result depends on the constants.

Seconds per step: per trial, and as the recording grows. Sources: Vögele, Krüger, Klein 2014,
figure 7, and figure 4 of its supplement. Every time is the least of three runs, on the machine
that draws the figure.

Scores by the radius r and the number of neighbours k: figure 3 of the supplement. One constant is
changed at a time; the dashed line is the preset's own value. Means over the trials.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from kineme.evaluation.score import evaluate
from kineme.methods.prepare import compute_motion_features
from kineme.methods.presets import PUBLISHED
from kineme.methods.region_growing.analysis import analyze_regions
from kineme.methods.region_growing.preset import RegionGrowingPreset
from kineme.methods.segmenter import segment
from kineme.segments.display import PALETTE
from kineme_reproduction.benchmark import Scores, mean
from kineme_reproduction.figures.style import FAINT, INK, heading, new_figure, save, tidy
from kineme_reproduction.trials import Trial

STEPS = ("features", "bundling", "neighbors", "activities", "primitives", "clusters")
STEP_COLORS = dict(zip(STEPS, (PALETTE[i] for i in (1, 5, 2, 4, 3, 0)), strict=True))
RUNS = 3
POINTS = 7
SHARES = (0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4)
NEIGHBORS = (16, 32, 64, 96, 128, 192, 256, 400, 600)
CURVES: Mapping[str, tuple[str, str]] = {
    "strict": ("strict", PALETTE[4]),
    "tolerant": ("tolerant", PALETTE[0]),
    "one_to_one": ("one to one", PALETTE[2]),
    "border_f1": ("border F1", PALETTE[3]),
    "covering": ("covering", PALETTE[6]),
}

Timings = dict[str, float]


def time_trials(trials: Sequence[Trial], preset: RegionGrowingPreset) -> list[Timings]:
    """Measure the seconds per step and trial, without reading the file."""
    return [
        _least([dict(segment(trial.motion, preset=preset).timings) for _ in range(RUNS)])
        for trial in trials
    ]


def time_growth(trials: Sequence[Trial], preset: RegionGrowingPreset) -> list[tuple[int, Timings]]:
    """Frames and seconds per step, for longer and longer parts of all trials in a row, twice."""
    features = np.concatenate(
        [compute_motion_features(trial.motion, preset) for trial in trials] * 2
    )
    lengths: NDArray[np.int64] = np.geomspace(500, len(features), POINTS).astype(np.int64)
    return [
        (int(n), _least([analyze_regions(features[:n], preset).timings for _ in range(RUNS)]))
        for n in lengths
    ]


def plot_timings(trials: Sequence[Trial], path: Path) -> Path:
    """Draw stacked bars per trial, one panel per preset."""
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
    """Draw seconds per step against frames, both axes logarithmic."""
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


def scores_by_radius(
    trials: Sequence[Trial], preset: RegionGrowingPreset
) -> list[tuple[float, Scores]]:
    """Radius in metres and mean scores; the smaller radius for activities changes with it."""
    return [(share * preset.radius, _mean(trials, _wider(preset, share))) for share in SHARES]


def scores_by_neighbors(
    trials: Sequence[Trial], preset: RegionGrowingPreset
) -> list[tuple[float, Scores]]:
    """Number of neighbours and mean scores; what is derived from it changes with it."""
    return [(float(k), _mean(trials, _with_neighbors(preset, k))) for k in NEIGHBORS]


def plot_sensitivity(trials: Sequence[Trial], path: Path) -> Path:
    """Draw scores against r (left) and k (right), a row per preset."""
    figure = new_figure(9.2, 2.6 * len(PUBLISHED) + 0.3)
    panels = figure.subplots(len(PUBLISHED), 2, sharey=True, squeeze=False)
    for row, preset in zip(panels, PUBLISHED.values(), strict=True):
        _draw(row[0], scores_by_radius(trials, preset), preset.radius)
        _draw(row[1], scores_by_neighbors(trials, preset), preset.max_neighbors)
        row[1].set_xscale("log", base=2)
        row[1].set_xticks([16, 64, 256, 1024], ["16", "64", "256", "1024"])
        heading(row[0], f"{preset.name}: radius r, m")
        heading(row[1], f"{preset.name}: neighbours k")
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="outside lower center", ncols=len(CURVES), frameon=False, fontsize=8
    )
    return save(figure, path)


def _draw(axes: Axes, scores: Sequence[tuple[float, Scores]], preset_value: float) -> None:
    for name, (label, color) in CURVES.items():
        axes.plot(
            [value for value, _ in scores], [row[name] for _, row in scores],
            "o-", ms=3, lw=1.2, color=color, label=label,
        )  # fmt: skip
    axes.axvline(preset_value, color=FAINT, linestyle="--", linewidth=1)
    axes.set_ylim(0, 1.02)
    tidy(axes)


def _mean(trials: Sequence[Trial], preset: RegionGrowingPreset) -> Scores:
    return mean([evaluate(t.truth, segment(t.motion, preset=preset)) for t in trials])


def _wider(preset: RegionGrowingPreset, share: float) -> RegionGrowingPreset:
    inner = preset.growth_radius
    return preset.replace(
        radius=share * preset.radius, growth_radius=None if inner is None else share * inner
    )


def _with_neighbors(preset: RegionGrowingPreset, k: int) -> RegionGrowingPreset:
    changed = {
        name: max(1, round(value * k / preset.max_neighbors))
        for name in ("growth_neighbors", "cluster_neighbors")
        if (value := getattr(preset, name)) is not None
    }
    return preset.replace(max_neighbors=k, **changed)
