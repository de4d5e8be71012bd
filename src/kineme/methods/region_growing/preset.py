"""Presets of the published methods, with the source of each constant.

Lengths are in metres, times in seconds. The sources are

- V14: Vögele, Krüger and Klein 2014, by section
- K17: Krüger, Vögele, Willig, Yao, Klein and Weber 2017, by section
- program: the authors' own program, which contains both methods; if it differs
  from the papers, the program is followed
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Self

from numpy.typing import ArrayLike

from kineme.methods.base import Mirror, Progress
from kineme.methods.region_growing import BASIC_STEPS
from kineme.methods.region_growing.constants import RegionGrowingConstants

if TYPE_CHECKING:
    from kineme.methods.region_growing.analysis import RegionsFound

POSE_CHANNELS, POSE_DEVIATION = 15, 0.13
"""Numbers in a pose, and their mean standard deviation in recordings of CMU's subject 86, m."""


@dataclass(frozen=True, kw_only=True)
class RegionGrowingPreset(RegionGrowingConstants):
    """Preset of a published method."""

    def analyze(
        self,
        features: ArrayLike,
        *,
        mirror: Mirror | None = None,
        progress: Progress | None = None,
    ) -> RegionsFound:
        """Run the method on features; see `kineme.methods.region_growing.analysis`."""
        # Imported here: it loads compiled code.
        from kineme.methods.region_growing.analysis import analyze_regions

        return analyze_regions(features, self, mirror=mirror, progress=progress)

    def for_signals(self) -> Self:
        """Return the preset with its lengths converted to standard deviations of channels.

        For example, a radius of 19 cm over 15 channels, 4.9 cm for each, becomes 0.38
        standard deviations.
        """
        if self.unit == "standard deviations":
            return self
        # Length of a vector of stacked poses in which each number is one deviation.
        per_channel = math.sqrt(POSE_CHANNELS * len(self.offsets)) * POSE_DEVIATION
        lengths = {
            name: value / per_channel
            for name in ("radius", "growth_radius", "zero_cost")
            if (value := getattr(self, name)) is not None
        }
        return replace(self, unit="standard deviations", **lengths)


VOEGELE2014 = RegionGrowingPreset(
    name="voegele2014",
    help="Grows regions of similar poses into activities; as published in 2014, for comparison.",
    offsets=(-1 / 6, 0.0, 1 / 6),  # V14 3: preceding and succeeding frame; program: 5 frames
    radius=0.64,  # V14 5: 64 cm
    max_neighbors=128,  # V14 5
    steps=(*BASIC_STEPS, (2, 1), (1, 2), (2, 2), (5, 5)),  # V14 3 and 5
    skip_penalty=1.0,  # program
    zero_cost=1e-4,  # program: 0.01 cm
    growth="squares",  # V14 3.1
    growth_neighbors=32,  # program: a quarter of them
    diagonal_width=0.5,  # program; V14 3.1: the connected component
    growth_gap=1 / 3,  # program: 10 frames
    growth_count=128,  # program
    growth_distance=1.0,  # program: 30 frames
    min_path=0.25,  # program; V14 3.2: 5 frames
    path_separation=1 / 3,  # program: 10 frames
    min_primitive=0.25,  # program: 7.5 frames
    cluster_neighbors=64,  # program: half of them
    cluster_min_path=1 / 6,  # V14 3.2: 5 frames
    coverage=0.5,  # program
    interpolate=False,
    connection="strong",  # program; V14 4: connected components
)

KRUEGER2017 = RegionGrowingPreset(
    name="krueger2017",
    help="The same with bundled poses and a smaller search; as published in 2017, for comparison.",
    offsets=(-1 / 3, -1 / 6, 0.0, 1 / 6, 1 / 3),  # K17 VI
    radius=0.19 * math.sqrt(5),  # program: generalised radius 19 cm; 30.2 cm without bundling
    max_neighbors=600,  # program
    bundling=32,  # program
    steps=BASIC_STEPS,  # K17 IV
    skip_penalty=0.0,
    zero_cost=1e-6,  # program: 0.0001 cm
    growth="scan_lines",  # K17 IV
    growth_radius=0.27 * math.sqrt(5),  # program; takes effect where ``radius`` is larger
    diagonal_width=1.0,  # program
    growth_gap=1 / 6,  # program: a sixth of a second; K17: 8 frames
    growth_count=120,  # program: four times the frame rate
    min_path=0.5,  # program; K17: 5 frames
    min_primitive=0.25,  # program
    cluster_min_path=0.5,  # program
    coverage=0.66,  # program
    interpolate=True,  # program
    connection="strong",  # program
)
