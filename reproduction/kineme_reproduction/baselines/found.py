"""What the baselines find: one level of segments."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kineme.methods.base import Columns
from kineme_reproduction.baselines.segments import Segments

if TYPE_CHECKING:
    from kineme.methods.region_growing.neighbors import NeighborGraph

# For pictures: neighbours per sample at most, and the pairs that tell how far samples lie apart.
PICTURED, PAIRS = 128, 2000


@dataclass(frozen=True, eq=False)
class SegmentsFound:
    """Segments of the activity level, each in a cluster.

    Attributes
    ----------
    features : (samples, dims) array
    segments : Segments
    timings : dict of str to float
        Seconds per stage.
    """

    features: NDArray[np.float64]
    segments: Segments
    timings: dict[str, float] = field(default_factory=dict)

    def columns(self) -> Columns:
        """Activities only; methods without clusters number them."""
        n = len(self.segments.clusters)
        return {
            "level": np.full(n, "activity"),
            "kind": np.full(n, "activity"),
            "start_frame": self.segments.starts,
            "stop_frame": self.segments.stops,
            "cluster": self.segments.clusters,
            "confidence": np.full(n, np.nan),
        }

    @cached_property
    def graph(self) -> NeighborGraph:
        """Neighbours of every sample, for pictures: the nearest tenth of all pairs."""
        from kineme.methods.region_growing.neighbors import neighbor_graph

        n = len(self.features)
        first, second = np.random.default_rng(0).integers(0, n, (2, PAIRS))
        distances = np.linalg.norm(self.features[first] - self.features[second], axis=1)
        return neighbor_graph(self.features, radius=float(np.quantile(distances, 0.1)), k=PICTURED)

    def doubts(self, columns: Columns, fps: float) -> list[str]:  # noqa: ARG002
        """None: the baselines give no confidence."""
        return []
