"""Constants of the method, in the order of its stages, with their values for bodies.

Costs are in seconds, relative to the median distance of two samples within a minute: one second of
samples at this distance from their cluster costs 1 s. So costs do not depend on the kind or the
length of the recording. Lengths of events are in body sizes.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, Self

from kineme.errors import ParameterError
from kineme.methods.base import (
    FACTOR,
    LENGTH,
    RATE,
    SHARE,
    SOME,
    SOME_FACTOR,
    SOME_LENGTH,
    SOME_SHARE,
    SOME_TIME,
    TIME,
    Limits,
    Preset,
    Unit,
    constant,
)


@dataclass(frozen=True, kw_only=True)
class KinemeConstants(Preset):
    """Constants of views, segments, borders, repetitions and events."""

    method: ClassVar[str] = "kineme"
    units: ClassVar[tuple[Unit, ...]] = ("body sizes", "any")
    accepts_joints: ClassVar[bool] = True

    unit: Unit = "body sizes"
    working_fps: float = constant(
        "samples per second to which the recording is resampled", unit="Hz", limits=RATE,
        default=30.0,
    )  # fmt: skip
    smoothing: float = constant(
        "channels of signals are averaged over this", unit="s", limits=TIME, default=0.0
    )
    # Views: posture and energy, a few times a second.
    rate: float = constant(
        "samples per second that are compared", unit="Hz", limits=RATE, default=5.0
    )
    averaging: float = constant(
        "means and energies are computed over this", unit="s", limits=SOME_TIME, default=1.0
    )
    bands: tuple[float, ...] = constant(
        "edges of the bands of frequency whose energies are compared", unit="Hz",
        limits=Limits(0.0, 500.0, above=True), default=(0.3, 1.0, 2.4, 7.0, 20.0),
    )  # fmt: skip
    shared: tuple[float, ...] = constant(
        "per view: variance that channels share is reduced to at most this, where one channel "
        "has 1; from the number of channels on: not reduced",
        limits=SOME_LENGTH, fine=True, default=(1e4, 1e4, 1.0, 0.3, 0.3),
    )  # fmt: skip
    weights: tuple[float, ...] = constant(
        "per view: statistics are divided by their scale to this power", limits=SHARE,
        fine=True, default=(0.5, 1.0, 1.0, 0.5, 1.0),
    )  # fmt: skip
    restless_over: tuple[float, ...] = constant(
        "per view: the scale of a statistic is its mean change over this; 0: the deviation of "
        "all means, or of its band",
        unit="s", limits=TIME, fine=True, default=(0.0, 1.0, 0.0, 0.0, 1.0),
    )  # fmt: skip
    view_margin: float = constant(
        "the last view replaces the first if it agrees with all views better by more than this "
        "(mean mutual information)", limits=SHARE, fine=True, default=0.06,
    )  # fmt: skip
    half_views: bool = constant(
        "whether views of half of the channels also vote on which view is taken",
        limits=None, fine=True, default=False,
    )  # fmt: skip
    velocity_weight: float = constant(
        "weight of the velocities of joints; that of their positions is 1", limits=FACTOR,
        fine=True, default=0.5,
    )  # fmt: skip
    # Segments: the tree and its shortest description.
    part: float = constant(
        "longer recordings are segmented in parts of at most about this length", unit="s",
        limits=SOME_TIME, fine=True, default=600.0,
    )  # fmt: skip
    compared_within: float = constant(
        "samples farther apart than this are not compared, for the median distance and the "
        "finest segments", unit="s", limits=SOME_TIME, fine=True, default=60.0,
    )  # fmt: skip
    fine_cost: float = constant(
        "cost of a border of the finest level, as seconds at the median distance", unit="s",
        limits=TIME, fine=True, default=0.4,
    )  # fmt: skip
    segment_cost: float = constant(
        "cost of a segment, as seconds at the median distance", unit="s", limits=TIME,
        slider=(0.02, 2.0, 0.02), default=0.15,
    )  # fmt: skip
    cluster_cost: float = constant(
        "cost of a cluster in a recording of one minute, as seconds at the median distance",
        unit="s", limits=TIME, slider=(0.1, 5.0, 0.1), default=0.66,
    )  # fmt: skip
    cluster_growth: float = constant(
        "power of the duration with which `cluster_cost` grows",
        limits=SHARE,
        fine=True,
        default=0.2,
    )
    min_action: float = constant(
        "shortest action", unit="s", limits=TIME, slider=(0.2, 10.0, 0.1), default=1.4
    )
    max_clusters: int = constant("largest number of clusters", limits=SOME, fine=True, default=16)
    # Segments that repeat a movement.
    two_movements: float = constant(
        "repetitions count as two movements if separate means of the first and the last leave "
        "less than this share of what one common mean leaves",
        limits=SHARE, fine=True, default=0.65,
    )  # fmt: skip
    same_channels: float = constant(
        "the same test as `two_movements`, for how strongly each channel moves",
        limits=SHARE, fine=True, default=0.45,
    )  # fmt: skip
    chance_count: float = constant(
        "up to this number, repetitions may be similar by chance",
        limits=SOME_FACTOR,
        fine=True,
        default=4.0,
    )
    chance_duration: float = constant(
        "similarity of few repetitions counts from this total duration on, even below "
        "`chance_count`", unit="s", limits=SOME_TIME, fine=True, default=14.0,
    )  # fmt: skip
    chance_period: float = constant(
        "repetitions shorter than this do not lower the cost of a segment", unit="s",
        limits=SOME_TIME, fine=True, default=1.7,
    )  # fmt: skip
    max_repetition: float = constant(
        "longest repetition; longer ones are a series of activities", unit="s",
        limits=SOME_TIME, default=8.0,
    )  # fmt: skip
    same_set: float = constant(
        "neighbours are one set if repetitions across their border are at least this similar, "
        "relative to those within each side; more than 1: never",
        limits=SOME_FACTOR, fine=True, default=0.8,
    )  # fmt: skip
    # Borders, to the frame.
    border_shift: float = constant(
        "how far a border moves from where means over `averaging` put it (0) to where single "
        "frames do (1)", limits=SHARE, fine=True, default=0.6,
    )  # fmt: skip
    transition_cost: float = constant(
        "a transition replaces a border if it raises the log-likelihood by more than this (mean "
        "of channels, summed over seconds)",
        unit="s", limits=SOME_FACTOR, fine=True, default=1.2,
    )  # fmt: skip
    # Repetitions.
    noise_share: float = constant(
        "dips of the distance to a pose are noise if shallower than this share of its usual "
        "largest value", limits=SHARE, fine=True, default=0.05,
    )  # fmt: skip
    centering: float = constant(
        "share of its mean pose that is subtracted from each repetition before they are "
        "compared; at 1 only movement counts, at 0 posture as well",
        limits=SHARE, fine=True, default=1.0,
    )  # fmt: skip
    end_distance: float = constant(
        "an incomplete repetition at either end is followed while its squared distance from the "
        "mean repetition is below this share of the variance",
        limits=SHARE, fine=True, default=0.55,
    )  # fmt: skip
    end_scatter: float = constant(
        "poses of such an end count fully up to this many times the scatter of the repetitions, "
        "and less beyond", limits=FACTOR, fine=True, default=2.0,
    )  # fmt: skip
    max_unexplained: float = constant(
        "a division is rejected if the mean repetition leaves more than this share of the "
        "activity unexplained; few repetitions may leave more",
        limits=SHARE, fine=True, default=0.7,
    )  # fmt: skip
    same_cost: float = constant(
        "the number of repetitions is a mean over the divisions that cost at most this more "
        "than the best",
        limits=FACTOR, fine=True, default=0.1,
    )  # fmt: skip
    min_similarity: float = constant(
        "similarity from which clusters are one movement, at another pace or phase; 1: never",
        limits=SOME_SHARE, default=0.75,
    )  # fmt: skip
    # Events.
    event_scale: float = constant(
        "distance from which two samples of an event are not similar; 0: no search for events",
        unit="body sizes", limits=LENGTH, slider=(0.0, 0.8, 0.05), default=0.45,
    )  # fmt: skip
    event_velocity: float = constant(
        "weight of velocities beside poses", unit="s", limits=TIME, fine=True, default=0.2
    )
    event_rest: float = constant(
        "speed of movement time while nothing moves; at the usual speed of movement it is about 1",
        limits=SOME_SHARE, fine=True, default=0.1,
    )  # fmt: skip
    event_cost: float = constant(
        "similarity that an event must gain for each sample that it lasts", limits=FACTOR,
        default=0.25,
    )  # fmt: skip
    event_cover: float = constant(
        "share of an event that each occurrence must match", limits=SOME_SHARE, fine=True,
        default=0.8,
    )  # fmt: skip
    min_recurrence: float = constant(
        "shortest event: its similarity, summed over movement time, must reach this", unit="s",
        limits=SOME_TIME, slider=(0.2, 2.0, 0.05), default=0.6,
    )  # fmt: skip

    def __post_init__(self) -> None:
        super().__post_init__()
        if not len(self.shared) == len(self.weights) == len(self.restless_over):
            raise ParameterError(
                "shared, weights and restless_over must have a number for each view, not "
                f"{len(self.shared)}, {len(self.weights)} and {len(self.restless_over)}"
            )

    def at_most(self, fps: float) -> Self:
        """Return the preset with a working rate of at most ``fps``, the recording's rate."""
        return replace(self, working_fps=fps) if RATE.minimum <= fps < self.working_fps else self

    def cluster_price(self, samples: int) -> float:
        """Return the cost of a cluster in a recording with this number of samples, in samples.

        It grows with the length: long recordings differ more within themselves by chance.

        Examples
        --------
        >>> from kineme.methods.kineme.preset import SENSORS
        >>> [round(SENSORS.cluster_price(samples), 1) for samples in (300, 1200)]
        [3.3, 4.4]
        """
        minutes = min(samples / self.rate, self.part) / 60
        return self.samples(self.cluster_cost) * float(minutes**self.cluster_growth)

    def samples(self, seconds: float) -> float:
        """Convert seconds to samples at `rate`."""
        return seconds * self.rate

    def select_view(self, view: int) -> Self:
        """Return the preset with one view only."""
        shared, weight = self.shared[view], self.weights[view]
        change_window = self.restless_over[view]
        return replace(self, shared=(shared,), weights=(weight,), restless_over=(change_window,))

    @property
    def comparison_width(self) -> int:
        """Return `compared_within` in samples."""
        return max(2, round(self.samples(self.compared_within)))
