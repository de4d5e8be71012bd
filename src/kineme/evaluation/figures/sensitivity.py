"""How much the result depends on the radius r and the number of neighbours k.

Source: supplement of Vögele, Krüger, Klein 2014, figure 3. One constant is
changed at a time; the dashed line is the preset's own value. Means over the
trials.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from matplotlib.axes import Axes

from kineme._colors import PALETTE
from kineme.evaluation.benchmark import Scores, mean
from kineme.evaluation.figures.style import FAINT, heading, new_figure, save, tidy
from kineme.evaluation.scores import evaluate_segmentation
from kineme.evaluation.trials import Trial
from kineme.methods.presets import PUBLISHED
from kineme.methods.region_growing.preset import RegionGrowingPreset
from kineme.segmentation.segmenter import segment

SHARES = (0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4)
NEIGHBORS = (16, 32, 64, 96, 128, 192, 256, 400, 600)
CURVES: Mapping[str, tuple[str, str]] = {
    "strict": ("strict", PALETTE[4]),
    "tolerant": ("tolerant", PALETTE[0]),
    "one_to_one": ("one to one", PALETTE[2]),
    "border_f1": ("border F1", PALETTE[3]),
    "covering": ("covering", PALETTE[6]),
}


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
    """Scores against r (left) and k (right), a row per preset."""
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


def _draw(axes: Axes, scores: Sequence[tuple[float, Scores]], own: float) -> None:
    for name, (label, color) in CURVES.items():
        axes.plot(
            [value for value, _ in scores], [row[name] for _, row in scores],
            "o-", ms=3, lw=1.2, color=color, label=label,
        )  # fmt: skip
    axes.axvline(own, color=FAINT, linestyle="--", linewidth=1)
    axes.set_ylim(0, 1.02)
    tidy(axes)


def _mean(trials: Sequence[Trial], preset: RegionGrowingPreset) -> Scores:
    return mean([evaluate_segmentation(t.truth, segment(t.motion, preset=preset)) for t in trials])


def _wider(preset: RegionGrowingPreset, share: float) -> RegionGrowingPreset:
    inner = preset.growth_radius
    return preset.replace(
        radius=share * preset.radius, growth_radius=None if inner is None else share * inner
    )


def _with_neighbors(preset: RegionGrowingPreset, k: int) -> RegionGrowingPreset:
    changed = {
        name: max(1, round(own * k / preset.max_neighbors))
        for name in ("growth_neighbors", "cluster_neighbors")
        if (own := getattr(preset, name)) is not None
    }
    return preset.replace(max_neighbors=k, **changed)
