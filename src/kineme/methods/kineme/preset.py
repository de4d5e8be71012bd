"""Presets ``kineme``, for bodies, and ``sensors``, for signals."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from kineme.methods.base import Mirror
from kineme.methods.kineme.constants import KinemeConstants
from kineme.methods.stages import Progress

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from kineme.methods.kineme.found import KinemeFound


@dataclass(frozen=True, kw_only=True)
class KinemePreset(KinemeConstants):
    """Preset of the method."""

    def analyze(
        self,
        features: ArrayLike,
        *,
        mirror: Mirror | None = None,  # noqa: ARG002 (left and right differ)
        progress: Progress | None = None,
        joints: bool = False,
    ) -> KinemeFound:
        """Run the method on features; see :func:`kineme.methods.kineme.pipeline.analyze`."""
        # Imported here: it loads compiled code.
        from kineme.methods.kineme.pipeline import analyze

        return analyze(features, self, joints=joints, progress=progress)


KINEME = KinemePreset(
    name="kineme", help="Finds activities and counts their repetitions; the default."
)

OF_SENSORS: Mapping[str, Any] = {
    "unit": "any",
    "working_fps": 50.0,
    "view_margin": 0.0,
    "half_views": True,  # a sensor may be loose, or on a limb that does not take part
    "min_explained": 0.6,  # idle channels have the same weight as those that move
    "chance_count": 8.0,
    "chance_duration": 32.0,  # so that sitting down twice is not an exercise
    "centering": 0.4,
    "min_similarity": 1.0,
    "event_scale": 0.0,
    "transition_cost": 1000.0,  # labels of sensor data have no transitions between activities
}
"""Constants that differ for signals: lengths have no meaning, and a few channels say less."""

SENSORS = KinemePreset(
    name="sensors",
    help="The same by posture and energy of channels; the default for signals.",
    **OF_SENSORS,
)
