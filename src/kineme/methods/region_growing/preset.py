"""The published methods' constants, and where each comes from.

Lengths are metres, times seconds. Sources are named as

- V14: Vögele, Krüger and Klein 2014, by section
- K17: Krüger, Vögele, Willig, Yao, Klein and Weber 2017, by section
- program: the authors' own program, which keeps both methods; where it parts
  from the papers, the program is followed
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from kineme._checks import is_number
from kineme.errors import ParameterError
from kineme.methods.base import Preset

Step = tuple[int, int]

BASIC_STEPS: tuple[Step, ...] = ((1, 1), (1, 0), (0, 1))


@dataclass(frozen=True, kw_only=True)
class RegionPreset(Preset):
    """Constants of the published methods: growing regions and warping paths.

    Parameters
    ----------
    radius : largest distance of two neighbours, metres in the stacked space
    max_neighbors : neighbours kept per frame at most, the nearest
    bundling : draw frames together first, each towards so many of those like it; None for
        features as they are
    mirror : also cut where a repetition with left and right exchanged starts
    steps : warping steps (a, b)
    skip_penalty : cost of each frame a step passes over, in radii
    zero_cost : cost of a node whose distance is zero, metres
    growth : form of the growing region: ``squares`` or ``scan_lines``
    growth_radius : smaller radius for growing regions, metres; None for ``radius``
    growth_neighbors : fewer neighbours for growing regions; None for all
    diagonal : how the main diagonal is removed: a ``band``, or the connected ``component``
        of the first frame
    diagonal_width : half width of that band, seconds
    growth_gap : seconds without a new neighbour that end a region
    growth_count : neighbours that a region must hold more than
    growth_distance : seconds between two cuts of one direction at least (squares)
    min_path : shortest warping path inside an activity, seconds
    path_separation : several paths of a component are kept if they begin at least this
        far apart, seconds; None for the cheapest only
    max_slope : a path's two stretches differ by this factor at most
    symmetry : share of a path that must be matched the other way round
    min_primitive : shortest primitive, seconds
    cluster_neighbors : fewer neighbours for clusters; None for all
    cluster_min_path : shortest warping path between segments, seconds
    coverage : share of both segments that a linking path must cover
    interpolate : judge the coverage by the rows at which the path enters and leaves the
        other segment, instead of all its rows
    connection : links one way make a cluster (``weak``), or links both ways (``strong``)
    """

    radius: float
    max_neighbors: int
    bundling: int | None = None
    mirror: bool = False
    steps: tuple[Step, ...]
    skip_penalty: float
    zero_cost: float
    growth: Literal["squares", "scan_lines"]
    growth_radius: float | None = None
    growth_neighbors: int | None = None
    diagonal: Literal["band", "component"] = "band"
    diagonal_width: float
    growth_gap: float
    growth_count: int
    growth_distance: float = 0.0
    min_path: float
    path_separation: float | None = None
    max_slope: float = 2.0
    symmetry: float = 0.5
    min_primitive: float
    cluster_neighbors: int | None = None
    cluster_min_path: float
    coverage: float
    interpolate: bool
    connection: Literal["weak", "strong"]

    def __post_init__(self) -> None:
        self._check(_POSITIVE, _NOT_NEGATIVE)
        for name in ("symmetry", "coverage"):
            value = getattr(self, name)
            if not (is_number(value) and 0 < value <= 1):
                raise ParameterError(f"{name} is a share above 0 and at most 1, not {value!r}")
        if not (is_number(self.max_slope) and self.max_slope >= 1):
            raise ParameterError(f"max_slope must be at least 1, not {self.max_slope!r}")
        for name, choices in _CHOICES.items():
            if getattr(self, name) not in choices:
                raise ParameterError(
                    f"{name} must be {' or '.join(choices)}, not {getattr(self, name)!r}"
                )


_POSITIVE = (
    "working_fps", "radius", "max_neighbors", "max_lag", "bundling", "growth_radius",
    "growth_neighbors", "growth_gap", "path_separation", "cluster_neighbors", "zero_cost",
)  # fmt: skip
_NOT_NEGATIVE = (
    "skip_penalty", "diagonal_width", "growth_count", "growth_distance", "min_path",
    "min_primitive", "cluster_min_path",
)  # fmt: skip
_CHOICES = {
    "unit": ("metres", "standard deviations"),
    "growth": ("squares", "scan_lines"),
    "diagonal": ("band", "component"),
    "connection": ("weak", "strong"),
}

VOEGELE2014 = RegionPreset(
    name="voegele2014",
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

KRUEGER2017 = RegionPreset(
    name="krueger2017",
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
