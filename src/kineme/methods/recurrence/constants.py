"""The constants of the ``kineme`` method: what each does, its unit and its limits.

Lengths are shares of the body's size (see ``kineme.features.body_size``) or of what stands
for it in signals, times seconds. ``docs/experiments.md`` says what other values measure.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar, Self

from kineme.errors import ParameterError
from kineme.methods.base import Unit
from kineme.methods.constants import (
    FACTOR,
    SHARE,
    SOME,
    SOME_FACTOR,
    SOME_LENGTH,
    SOME_SHARE,
    SOME_TIME,
    TIME,
    Limits,
    constant,
)
from kineme.methods.recurrence.event_constants import EventConstants


@dataclass(frozen=True, kw_only=True)
class RecurrenceConstants(EventConstants):
    """Of recurrence, change points, actions, repetitions and events."""

    method: ClassVar[str] = "recurrence"
    units: ClassVar[tuple[Unit, ...]] = ("body sizes",)

    unit: Unit = "body sizes"
    # Recurrence: how similar any two samples are, whatever the phase.
    resolution: float = constant(
        "time between two samples that are compared", unit="s", limits=Limits(0.001, 60.0)
    )
    window: float = constant(
        "samples this far apart are compared to find borders", unit="s", limits=SOME_TIME
    )
    phase: float = constant(
        "a sample may find its like this much earlier or later at most", unit="s",
        limits=Limits(0.0, 60.0), slider=(0.25, 5.0, 0.25),
    )  # fmt: skip
    phase_shares: tuple[float, ...] = constant(
        "similarity is the mean of those with phases of these shares of the widest",
        limits=SOME_SHARE, fine=True,
    )  # fmt: skip
    recurrence_time: float = constant(
        "the scale of a sample is the distance within which so much of the recording recurs",
        unit="s", limits=SOME_TIME,
    )  # fmt: skip
    min_scale: float = constant("smallest scale", unit="body sizes", limits=SOME_LENGTH)
    max_scale: float = constant(
        "largest scale", unit="body sizes", limits=SOME_LENGTH, slider=(0.08, 0.4, 0.01)
    )
    softness: float = constant("scales at which similarity has fallen to 1/e", limits=SOME_FACTOR)
    # Change points, and which of the segments between them are one action.
    border_cost: float = constant(
        "similarity that a border between activities must gain", unit="s", limits=TIME,
        slider=(0.25, 6.0, 0.25),
    )  # fmt: skip
    min_segment: float = constant("shortest segment between two borders", unit="s", limits=TIME)
    merge_gap: float = constant(
        "what is no farther away does not count as recurrence in a neighbour", unit="s", limits=TIME
    )
    merge_softness: float = constant(
        "scales at which recurrence in a neighbour has fallen to 1/e", limits=SOME_FACTOR
    )
    merge_share: float = constant(
        "share of a segment that must recur in its neighbour to be part of it", limits=SOME_FACTOR
    )
    # Short actions, which a wide phase window blurs.
    narrow_share: float = constant(
        "short actions are told apart with a phase, recurrence time and costs of borders of this "
        "share", limits=SOME_SHARE,
    )  # fmt: skip
    distinct_share: float = constant(
        "a part that recurs in the rest of its segment by no more than this share of how it "
        "recurs in itself is an activity of its own", limits=FACTOR,
    )  # fmt: skip
    sure_pace: float = constant(
        "where counts and borders are less probable than this, in the mean, a recording is divided "
        "again with all times shortened by narrow_share", limits=SHARE, fine=True,
    )  # fmt: skip
    link_similarity: float = constant(
        "similarity, relative to that within, from which segments are one action",
        limits=SOME_SHARE, slider=(0.1, 1.0, 0.05),
    )  # fmt: skip
    link_softness: float = constant(
        "scales at which that similarity has fallen to 1/e", limits=SOME_FACTOR
    )
    link_common: float = constant(
        "it counts in full where this share of the poses of each segment is in the other, and "
        "less where less is", limits=SOME_SHARE, fine=True,
    )  # fmt: skip
    link_gap: float = constant(
        "samples of a short segment that are nearer than this share of it are not compared",
        limits=FACTOR, fine=True,
    )  # fmt: skip
    link_samples: int = constant(
        "segments are compared by so many of their samples at most", limits=SOME, fine=True
    )
    any_pace: bool = constant("whether the same at another pace is the same action")
    least_self_similarity: float = constant(
        "a segment is taken to be at least so similar within", limits=SOME_SHARE, fine=True
    )
    min_repetition: float = constant(
        "share of a segment that must recur for it to be an activity", limits=FACTOR
    )
    # Actions: what each sample belongs to.
    switch_cost: float = constant(
        "dissimilarity that a change of action costs", unit="s", limits=TIME
    )
    no_action_cost: float = constant(
        "dissimilarity at which a sample is better in no action", limits=FACTOR
    )
    least_similarity: float = constant(
        "samples less similar to an action than this share of its own are as dissimilar as can be",
        limits=Limits(0.0, 0.999, above=True), fine=True,
    )  # fmt: skip
    rounds: int = constant(
        "times that actions are learnt anew from their samples", limits=Limits(1, 100), fine=True
    )
    min_action: float = constant("shortest action", unit="s", limits=TIME, slider=(0.2, 10.0, 0.1))
    # Transitions: where one activity ends and the next begins.
    transition_factor: float = constant(
        "samples that recur farther than this times the usual distance of their action are "
        "transition, at the ends of an activity", limits=SOME_FACTOR,
    )  # fmt: skip
    transition_spread: float = constant(
        "thresholds from one minus this to one plus this times that factor vote",
        limits=Limits(0.0, 0.999), fine=True,
    )  # fmt: skip
    usual_quantile: float = constant(
        "quantile of an action's distances that is called usual", limits=SHARE, fine=True
    )
    max_transition: float = constant(
        "longest transition taken from one end of an activity", unit="s", limits=TIME
    )
    max_transition_share: float = constant(
        "largest share of an activity that a transition takes from one end", limits=Limits(0, 0.5),
        fine=True,
    )  # fmt: skip
    # Parts: repetitions of one action that are two movements.
    part_gap: float = constant(
        "repetitions are in two clusters where these are so many times as far apart as those in "
        "them", limits=Limits(1.0, 1000.0),
    )  # fmt: skip
    # Signals, which have no size of their own.
    recurs_at: float = constant(
        "distance at which the median sample of signals recurs: their unit of length", fine=True,
        unit="body sizes", limits=SOME_LENGTH,
    )  # fmt: skip
    exact_below: float = constant(
        "what recurs nearer than this recurs exactly, as in made-up signals", fine=True,
        unit="standard deviations", limits=SOME_LENGTH,
    )  # fmt: skip

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.min_scale > self.max_scale:
            raise ParameterError(
                f"min_scale {self.min_scale} is larger than max_scale {self.max_scale}"
            )

    @cached_property
    def narrowed(self) -> Self:
        """The preset for short actions."""
        share = self.narrow_share
        return replace(
            self,
            phase=share * self.phase,
            phase_shares=(1.0,),
            recurrence_time=share * self.recurrence_time,
            border_cost=share * self.border_cost,
            min_segment=share * self.min_segment,
            merge_gap=share * self.merge_gap,
        )

    @cached_property
    def hurried(self) -> Self:
        """The preset for recordings in which all actions are short."""
        share = self.narrow_share
        return replace(
            self.narrowed,
            phase_shares=self.phase_shares,
            switch_cost=share * self.switch_cost,
            min_action=share * self.min_action,
            max_transition=share * self.max_transition,
        )

    @property
    def step(self) -> int:
        """Frames of the working rate between two samples."""
        return max(1, self.frames(self.resolution))

    def samples(self, seconds: float) -> int:
        """Seconds in whole samples, one in ``step`` frames of the working rate."""
        return round(seconds * self.working_fps / self.step)
