"""What the baselines find: one level of segments."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from kineme.methods.base import Columns
from kineme_reproduction.baselines.segments import Segments


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

    def doubts(self, columns: Columns, fps: float) -> list[str]:  # noqa: ARG002
        """None: the baselines give no confidence."""
        return []
