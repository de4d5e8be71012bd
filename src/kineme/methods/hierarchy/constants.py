"""The constants of the method for sensors: what each does, its unit and its limits.

Lengths are multiples of the median distance of the recording, times seconds.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, Self

from kineme.errors import ParameterError
from kineme.methods.base import RATE, Unit
from kineme.methods.constants import (
    FACTOR,
    SHARE,
    SOME,
    SOME_LENGTH,
    SOME_TIME,
    TIME,
    Limits,
    constant,
)
from kineme.methods.recurrence.repeating.counting import CountingPreset


@dataclass(frozen=True, kw_only=True)
class HierarchyConstants(CountingPreset):
    """Of statistics, a tree of segments, and its best level."""

    method: ClassVar[str] = "hierarchy"
    units: ClassVar[tuple[Unit, ...]] = ("any",)
    told_bodies: ClassVar[bool] = True
    told_rides: ClassVar[bool] = True

    unit: Unit = "any"
    working_fps: float = constant(
        "samples per second at which the recording is looked at", unit="Hz", limits=RATE,
        default=50.0,
    )  # fmt: skip
    smoothing: float = constant(
        "channels of signals are averaged over this", unit="s", limits=TIME, default=0.0
    )
    rate: float = constant("samples per second that are compared", unit="Hz", limits=RATE)
    averaging: float = constant(
        "means and energies of channels are taken over this", unit="s", limits=SOME_TIME
    )
    bands: tuple[float, ...] = constant(
        "edges of the bands of frequency whose energies are compared", unit="Hz",
        limits=Limits(0.0, 500.0, above=True),
    )  # fmt: skip
    shared: tuple[float, ...] = constant(
        "per view: largest variance that channels share, where that of a channel is 1",
        limits=SOME_LENGTH, fine=True,
    )  # fmt: skip
    weights: tuple[float, ...] = constant(
        "per view: power to which what statistics vary is divided out", limits=SHARE, fine=True
    )
    restless_over: tuple[float, ...] = constant(
        "per view: a statistic varies as much as it changes over this; 0: as its band does",
        unit="s", limits=TIME, fine=True,
    )  # fmt: skip
    velocity_weight: float = constant(
        "how much the velocity of joints counts, beside where they are", limits=FACTOR, fine=True
    )
    ride_weight: float = constant(
        "how far riding, as in a lift, is from standing, where all else deviates by 1",
        limits=FACTOR, fine=True,
    )  # fmt: skip
    part: float = constant(
        "a longer recording is segmented in parts of this at most", unit="s", limits=SOME_TIME,
        fine=True,
    )  # fmt: skip
    fine_cost: float = constant(
        "what a border of the finest level must gain: time at the median distance", unit="s",
        limits=TIME, fine=True,
    )  # fmt: skip
    max_fine: float = constant(
        "longest segment of the finest level", unit="s", limits=SOME_TIME, fine=True
    )
    min_action: float = constant("shortest action", unit="s", limits=TIME, slider=(0.2, 10.0, 0.1))
    segment_cost: float = constant(
        "what a segment must explain: time at the median distance", unit="s", limits=TIME,
        slider=(0.02, 2.0, 0.02),
    )  # fmt: skip
    cluster_cost: float = constant(
        "what a cluster must explain in a minute: time at the median distance", unit="s",
        limits=TIME, slider=(0.1, 5.0, 0.1),
    )  # fmt: skip
    cluster_growth: float = constant(
        "power of the duration with which that grows", limits=SHARE, fine=True
    )
    spread_share: float = constant(
        "clusters are nearer than their samples by this share of the distances within them",
        limits=SHARE, fine=True,
    )  # fmt: skip
    border_shift: float = constant(
        "how far a border is moved from where means over `averaging` put it to where frames do",
        limits=SHARE, fine=True,
    )  # fmt: skip
    joint_border_shift: float = constant(
        "how far a border is moved so where channels are joints", limits=SHARE, fine=True
    )
    counting_fps: float = constant(
        "frames per second at which repetitions are counted, at most", unit="Hz", limits=RATE,
        fine=True,
    )  # fmt: skip
    max_clusters: int = constant("clusters at most", limits=SOME, fine=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        lengths = {len(self.shared), len(self.weights), len(self.restless_over)}
        if lengths - {len(self.shared) or 1}:
            raise ParameterError(
                "shared, weights and restless_over must have a number for each view, not "
                f"{len(self.shared)}, {len(self.weights)} and {len(self.restless_over)}"
            )

    def at_most(self, fps: float) -> Self:
        """The preset for a recording of that rate: energies above it are not there."""
        if not RATE.minimum <= fps < self.working_fps:
            return self
        apart = len({round(offset * fps) for offset in self.offsets}) == len(self.offsets)
        return replace(self, working_fps=fps, offsets=self.offsets if apart else (0.0,))

    def cluster_price(self, samples: int) -> float:
        """What a cluster costs in a stretch of so many samples, in samples.

        The longer it is, the more of it differs from the rest by chance.

        Examples
        --------
        >>> from kineme.methods.hierarchy.preset import SENSORS
        >>> [round(SENSORS.cluster_price(samples), 1) for samples in (300, 1200)]
        [3.3, 4.4]
        """
        minutes = min(samples / self.rate, self.part) / 60
        return self.samples(self.cluster_cost) * float(minutes**self.cluster_growth)

    def samples(self, seconds: float) -> float:
        """Seconds in samples, at `rate`."""
        return seconds * self.rate
