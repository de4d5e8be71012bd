"""Constants of the published methods: what each does, its unit and its limits.

Lengths are metres, times seconds.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from kineme.methods.base import (
    COUNT,
    LENGTH,
    SOME,
    SOME_LENGTH,
    SOME_SHARE,
    SOME_TIME,
    TIME,
    Limits,
    Preset,
    Unit,
    constant,
)
from kineme.methods.region_growing import Step


@dataclass(frozen=True, kw_only=True)
class RegionGrowingConstants(Preset):
    """Constants of growing regions and warping paths."""

    method: ClassVar[str] = "region_growing"
    units: ClassVar[tuple[Unit, ...]] = ("metres", "standard deviations")

    unit: Unit = "metres"
    radius: float = constant(
        "largest distance of two neighbours, in the stacked space", unit="metres",
        limits=SOME_LENGTH, slider=(0.1, 1.6, 0.01),
    )  # fmt: skip
    max_lag: float | None = constant(
        "largest time between similar samples; none: unlimited", unit="s",
        limits=SOME_TIME, default=None,
    )  # fmt: skip
    max_neighbors: int = constant(
        "largest number of nearest neighbours kept per sample", limits=SOME
    )
    bundling: int | None = constant(
        "number of similar features to whose mean each feature is moved first; none: "
            "features stay unchanged", limits=SOME, default=None,
    )  # fmt: skip
    mirror: bool = constant(
        "also cut where a repetition with left and right exchanged starts", default=False
    )
    steps: tuple[Step, ...] = constant("warping steps (a, b)", limits=Limits(0, 1000))
    skip_penalty: float = constant(
        "cost of each sample a step passes over, in radii", limits=LENGTH
    )
    zero_cost: float = constant(
        "cost of a node whose distance is zero", unit="metres", limits=SOME_LENGTH
    )
    growth: Literal["squares", "scan_lines"] = constant("form of the growing region")
    growth_radius: float | None = constant(
        "smaller radius for growing regions; none: the general radius", unit="metres",
        limits=SOME_LENGTH, default=None,
    )  # fmt: skip
    growth_neighbors: int | None = constant(
        "fewer neighbours for growing regions; none: all", limits=SOME, default=None
    )
    diagonal: Literal["band", "component"] = constant(
        "how the main diagonal is removed: a band, or the connected component of the first sample",
        default="band",
    )
    diagonal_width: float = constant("half width of that band", unit="s", limits=TIME)
    growth_gap: float = constant(
        "time without a new neighbour that ends a region", unit="s", limits=SOME_TIME,
        slider=(1 / 30, 2.0, 1 / 30),
    )  # fmt: skip
    growth_count: int = constant("number of neighbours that a region must exceed", limits=COUNT)
    growth_distance: float = constant(
        "shortest time between two cuts of one direction (squares)", unit="s", limits=TIME,
        default=0.0,
    )  # fmt: skip
    min_path: float = constant("shortest warping path inside an activity", unit="s", limits=TIME)
    path_separation: float | None = constant(
        "keep several paths of a component if they begin at least this far apart; none: "
            "only the cheapest", unit="s", limits=SOME_TIME, default=None,
    )  # fmt: skip
    max_slope: float = constant(
        "largest factor by which the two sides of a path may differ in length",
        limits=Limits(1.0, 1000.0), default=2.0,
    )  # fmt: skip
    symmetry: float = constant(
        "share of a path that must also match when its two spans are exchanged",
        limits=SOME_SHARE,
        default=0.5,
    )
    min_primitive: float = constant(
        "shortest primitive", unit="s", limits=TIME, slider=(0.05, 3.0, 0.05)
    )
    cluster_neighbors: int | None = constant(
        "fewer neighbours for clusters; none: all", limits=SOME, default=None
    )
    cluster_min_path: float = constant(
        "shortest warping path between segments", unit="s", limits=TIME
    )
    coverage: float = constant(
        "share of both segments that a linking path must cover", limits=SOME_SHARE,
        slider=(0.1, 1.0, 0.02),
    )  # fmt: skip
    interpolate: bool = constant(
        "measure the coverage by the rows where the path enters and leaves the other "
        "segment, instead of all its rows"
    )
    connection: Literal["weak", "strong"] = constant(
        "clusters need links in one direction (weak) or in both (strong)"
    )
