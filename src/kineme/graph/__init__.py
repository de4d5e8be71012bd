"""Which frames are similar, and which spans match: graph and warping paths.

Nothing here knows what a skeleton is: any array of frames × dims will do.
"""

from kineme.graph.neighbors import NeighborGraph, neighbor_graph
from kineme.graph.warping import BASIC_STEPS, WarpingPaths, component_labels, warping_paths

__all__ = [
    "BASIC_STEPS",
    "NeighborGraph",
    "WarpingPaths",
    "component_labels",
    "neighbor_graph",
    "warping_paths",
]
