"""Plots of segmentations, drawn on given or new matplotlib Axes."""

from kineme.plot.curves import plot_curves, plot_sessions, plot_sides
from kineme.plot.matrix import plot_matrix, plot_segmentation
from kineme.plot.strips import plot_strip
from kineme.plot.timeline import compare, plot_timeline

__all__ = [
    "compare",
    "plot_curves",
    "plot_matrix",
    "plot_segmentation",
    "plot_sessions",
    "plot_sides",
    "plot_strip",
    "plot_timeline",
]
