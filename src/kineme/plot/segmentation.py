"""The picture of a segmentation as a file."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from kineme._checks import check_path, check_type
from kineme._files import atomic_write
from kineme.errors import WriteError
from kineme.plot.matrix import graph_of, plot_matrix
from kineme.segments.segmentation import Segmentation

if TYPE_CHECKING:
    from kineme.graph import NeighborGraph
    from kineme.methods.base import Found

SUFFIXES = (".png", ".pdf", ".svg")


def plot_segmentation(
    segmentation: Segmentation,
    graph: NeighborGraph | Found,
    path: str | PathLike[str],
    *,
    title: str | None = None,
) -> None:
    """Write the picture that `plot_matrix` draws as PNG, PDF or SVG, by suffix.

    Parameters
    ----------
    segmentation : Segmentation
    graph : NeighborGraph or Found
        As for `plot_matrix`.
    path : path-like
        Where to write it.
    title : str, optional
        A line above it; by default the name of the recording.

    Raises
    ------
    ParameterError
        Something else than a segmentation, its graph and a path.
    WriteError
        Another suffix, or the file cannot be written.

    Examples
    --------
    >>> import kineme
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> segments, found = kineme.segment_and_found(motion)
    >>> kineme.plot_segmentation(segments, found, "segments.png")
    """
    check_type(segmentation, Segmentation, "plot_segmentation", "kineme.segment gives one")
    graph = graph_of(graph, "plot_segmentation")
    check_path(path, "plot_segmentation")
    if Path(path).suffix.lower() not in SUFFIXES:
        raise WriteError(path, f"pictures are written as {', '.join(SUFFIXES)}")
    figure = Figure(figsize=(9.4, 8.2))
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.085, 0.075, 0.74, 0.86))
    plot_matrix(segmentation, graph, ax=axes)
    axes.set_title(
        _title(segmentation) if title is None else title, loc="left", fontsize=10, pad=10
    )
    with atomic_write(path) as draft:
        figure.savefig(draft, dpi=200)


def _title(segmentation: Segmentation) -> str:
    source = segmentation.provenance.get("input", {}).get("path") or "recording"
    preset = segmentation.provenance.get("preset")
    parts = [Path(source).name, segmentation.describe(), *([preset] if preset else [])]
    return "  ·  ".join(parts)
