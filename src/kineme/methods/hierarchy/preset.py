"""The constants of the method for sensors, one set for all signals.

Lengths are multiples of the median distance of the recording, times seconds.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar, Self

from kineme.methods.base import RATE, Mirror, Unit
from kineme.methods.constants import SHARE, SOME, SOME_TIME, TIME, Limits, constant
from kineme.methods.recurrence.counting import CountingPreset

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from kineme.methods.hierarchy.analysis import HierarchyFound
    from kineme.methods.stages import Progress


@dataclass(frozen=True, kw_only=True)
class HierarchyPreset(CountingPreset):
    """Constants of the method for sensors: statistics, a tree of segments, its best level."""

    method: ClassVar[str] = "hierarchy"
    units: ClassVar[tuple[Unit, ...]] = ("any",)

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
        "what a cluster must explain: time at the median distance", unit="s", limits=TIME,
        slider=(0.1, 5.0, 0.1),
    )  # fmt: skip
    counting_fps: float = constant(
        "frames per second at which repetitions are counted, at most", unit="Hz", limits=RATE,
        fine=True,
    )  # fmt: skip
    max_clusters: int = constant("clusters at most", limits=SOME, fine=True)
    unsure_count: float = constant(
        "score below which a note says to look at the repetitions", limits=SHARE, fine=True
    )

    def analyze(
        self,
        features: ArrayLike,
        *,
        mirror: Mirror | None = None,  # noqa: ARG002 (left and right are told apart)
        progress: Progress | None = None,
    ) -> HierarchyFound:
        """Segments, clusters and repetitions; see :mod:`kineme.methods.hierarchy.analysis`."""
        from kineme.methods.hierarchy.analysis import analyze_channels  # compiled code

        return analyze_channels(features, self, progress=progress)

    def at_most(self, fps: float) -> Self:
        """The preset for a recording of that rate: energies above it are not there."""
        if not RATE.minimum <= fps < self.working_fps:
            return self
        apart = len({round(offset * fps) for offset in self.offsets}) == len(self.offsets)
        return replace(self, working_fps=fps, offsets=self.offsets if apart else (0.0,))

    def samples(self, seconds: float) -> float:
        """Seconds in samples, at `rate`."""
        return seconds * self.rate


SENSORS = HierarchyPreset(
    name="sensors",
    help="Finds activities of sensors by posture and energy; what kineme is for signals.",
    offsets=(-0.2, -0.1, 0.0, 0.1, 0.2),
    rate=5.0,
    averaging=1.0,
    bands=(0.3, 1.0, 2.4, 7.0, 20.0),
    fine_cost=0.4,
    max_fine=80.0,
    min_action=1.4,
    segment_cost=0.15,
    cluster_cost=0.8,
    max_clusters=16,
    counting_fps=25.0,
    unsure_count=0.5,
)
