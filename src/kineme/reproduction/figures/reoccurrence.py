"""The share of poses that reoccur, recording by recording."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from kineme._colors import PALETTE
from kineme.reproduction.figures.style import INK, heading, new_figure, save, tidy
from kineme.reproduction.reoccurrence import PUBLISHED, Recording, share_of_poses


def plot_reoccurrence(recordings: Sequence[Recording], path: Path) -> Path:
    """Bars, one per recording, by share; lines at the share of all poses and as printed."""
    rows = sorted(recordings, key=lambda r: r.share)
    figure = new_figure(9.2, 3.0)
    axes = figure.subplots()
    axes.bar(range(len(rows)), [r.share for r in rows], 0.75, color=PALETTE[2])
    lines = {"all poses": (share_of_poses(rows), "-"), "as printed": (PUBLISHED, ":")}
    for name, (share, style) in lines.items():
        axes.axhline(share, color=INK, linestyle=style, linewidth=1.2, label=f"{name}: {share:.1%}")
    axes.set_xticks(range(len(rows)), [r.path.stem for r in rows], rotation=40, ha="right")
    axes.set_ylim(0, 1.25)
    axes.set_yticks(np.linspace(0, 1, 6))
    axes.legend(frameon=False, fontsize=8, loc="upper left", ncols=2)
    tidy(axes)
    heading(axes, "share of poses that come back within 10 s, recordings longer than 8 s")
    return save(figure, path)
