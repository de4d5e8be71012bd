"""Pictures of segmentations, each on Axes of matplotlib that are given or made."""

from kineme.plot.matrix import plot_matrix, plot_segmentation, similarity_image
from kineme.plot.strips import plot_strip
from kineme.plot.timeline import compare, plot_timeline

__all__ = [
    "compare",
    "plot_matrix",
    "plot_segmentation",
    "plot_strip",
    "plot_timeline",
    "similarity_image",
]
