"""What the figures share: one colour per method, quiet axes, files whole or not at all."""

from __future__ import annotations

from collections.abc import Iterable
from io import BytesIO
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from kineme._util.files import atomic_write
from kineme.segments.display import PALETTE

INK = "#1B1F2A"
FAINT = "#8A8F9B"
BETWEEN = "#3A3A3A"  # transitions and what annotators leave open
OTHER = "#BBBBBB"
DPI = 130

METHOD_COLORS = {
    "kineme": PALETTE[5],
    "voegele2014": PALETTE[2],
    "krueger2017": PALETTE[7],
    "aca": PALETTE[4],
    "haca": PALETTE[0],
    "pca": PALETTE[1],
    "ppca": PALETTE[6],
    "gmm": PALETTE[3],
}


def method_color(name: str) -> str:
    """Return the colour of a method; grey if it has none."""
    return METHOD_COLORS.get(name, OTHER)


def new_figure(width: float, height: float) -> Figure:
    """Return an empty figure of this size in inches with constrained layout."""
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def tidy(axes: Axes, *, grid: bool = True) -> None:
    """Remove lines that do not help to read values."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(FAINT)
    axes.tick_params(colors=INK, labelsize=8, length=3, color=FAINT)
    if grid:
        axes.grid(axis="y", color="#E4E6EB", linewidth=0.6)
        axes.set_axisbelow(True)


def heading(axes: Axes, text: str) -> None:
    """Add a small title on the left."""
    axes.set_title(text, loc="left", fontsize=9, color=INK)


def grouped(n_groups: int, n_bars: int, share: float = 0.82) -> tuple[float, Iterable[float]]:
    """Return the width of a bar, and the offsets of bars from the middle of their group."""
    width = share / n_bars
    return width, [(i - (n_bars - 1) / 2) * width for i in range(n_bars)] if n_groups else []


def save(figure: Figure, path: Path) -> Path:
    """Write a figure as a PNG with 128 colours, a third as large as with all colours."""
    pixels = BytesIO()
    figure.savefig(pixels, format="png", dpi=DPI, facecolor="white")
    picture = Image.open(pixels).convert("RGB").quantize(128, dither=Image.Dither.NONE)
    with atomic_write(path) as draft:
        picture.save(draft, format="png", optimize=True)
    return path
