"""The preset for sensors, one set of constants for all signals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from kineme.methods import weights
from kineme.methods.base import Mirror
from kineme.methods.hierarchy.constants import HierarchyConstants
from kineme.methods.stages import Progress

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from kineme.methods.hierarchy.found import HierarchyFound


@dataclass(frozen=True, kw_only=True)
class HierarchyPreset(HierarchyConstants):
    """The method for sensors by its constants."""

    def analyze(
        self,
        features: ArrayLike,
        *,
        mirror: Mirror | None = None,  # noqa: ARG002 (left and right are told apart)
        progress: Progress | None = None,
        carried: ArrayLike | None = None,
        joints: bool = False,
    ) -> HierarchyFound:
        """Segments, clusters and repetitions; see :mod:`kineme.methods.hierarchy.analysis`."""
        from kineme.methods.hierarchy.analysis import analyze_channels  # compiled code

        return analyze_channels(features, self, carried=carried, joints=joints, progress=progress)


SENSORS = HierarchyPreset(
    name="sensors",
    help="Finds activities of sensors by posture and energy; what kineme is for signals.",
    offsets=(-0.2, -0.1, 0.0, 0.1, 0.2),
    rate=5.0,
    averaging=1.0,
    bands=(0.3, 1.0, 2.4, 7.0, 20.0),
    shared=(1e4, 1e4, 1e4, 1.0, 1.0, 1.0, 0.3, 0.3, 0.3),
    weights=(0.5, 1.0, 1.0) * 3,
    restless_over=(0.0, 0.0, 1.0) * 3,
    velocity_weight=0.5,
    ride_weight=5.0,
    part=600.0,
    fine_cost=0.4,
    max_fine=80.0,
    min_action=1.4,
    segment_cost=0.15,
    cluster_cost=0.66,
    cluster_growth=0.2,
    spread_share=0.5,
    border_shift=0.4,
    joint_border_shift=1.0,
    max_clusters=16,
    counting_fps=25.0,
    centering=0.4,
    end_distance=0.65,
    end_scatter=100.0,
    link_weights=weights.SENSOR_LINK,
    border_weights=weights.SENSOR_BORDER,
)
