"""The constants of the ``kineme`` method, one set for every recording.

Lengths are shares of the body's size (see ``kineme.features.body_size``), or of
what stands for it in signals, times seconds. ``docs/method.md`` says what each does
and what other values measure.
"""

from __future__ import annotations

from dataclasses import dataclass

from kineme._checks import is_number
from kineme.errors import ParameterError
from kineme.methods.base import Preset, Unit


@dataclass(frozen=True, kw_only=True)
class ActionPreset(Preset):
    """Constants of the ``kineme`` method: recurrence, change points and actions.

    Parameters
    ----------
    resolution : seconds between two moments that are compared
    window : moments this far apart are compared to find borders, seconds
    phase : a moment may find its like this much earlier or later at most, seconds
    recurrence_time : the scale of a moment is the distance within which so many seconds of
        the recording recur
    min_scale : smallest scale, body sizes
    max_scale : largest scale, body sizes
    softness : scales at which similarity has fallen to 1/e
    border_cost : seconds of likeness that a border between activities must gain
    min_stretch : shortest stretch between two such borders, seconds
    part_gap : what is no farther away does not count as recurrence in a neighbour, seconds
    part_softness : scales at which recurrence in a neighbour has fallen to 1/e
    part_share : share of a stretch that must recur in its neighbour to be part of it
    likeness : similarity, relative to that within, from which stretches are one action
    likeness_softness : scales at which that similarity has fallen to 1/e
    any_pace : whether the same at another pace is the same action
    min_repetition : share of a stretch that must recur for it to be an activity
    switch_cost : seconds of unlikeness that a change of action costs
    no_action_cost : unlikeness at which a moment is better in no action
    min_action : shortest action, seconds
    transition_factor : moments that recur farther than this times the 90 % quantile of their
        action are transition, at the ends of an activity
    max_transition : longest transition taken from one end of an activity, seconds
    """

    unit: Unit = "sizes"
    resolution: float
    window: float
    phase: float
    recurrence_time: float
    min_scale: float
    max_scale: float
    softness: float
    border_cost: float
    min_stretch: float
    part_gap: float
    part_softness: float
    part_share: float
    likeness: float
    likeness_softness: float
    any_pace: bool
    min_repetition: float
    switch_cost: float
    no_action_cost: float
    min_action: float
    transition_factor: float
    max_transition: float

    def __post_init__(self) -> None:
        positive = [
            "working_fps", "max_lag", "resolution", "window", "recurrence_time", "min_scale",
            "max_scale", "softness", "part_softness", "part_share", "likeness_softness",
            "transition_factor",
        ]  # fmt: skip
        not_negative = [
            "phase", "border_cost", "min_stretch", "part_gap", "switch_cost", "min_action",
            "max_transition", "no_action_cost", "min_repetition",
        ]  # fmt: skip
        self._check(positive, not_negative)
        if self.unit != "sizes":
            raise ParameterError(f"unit must be sizes in {self.name}, not {self.unit!r}")
        if self.min_scale > self.max_scale:
            raise ParameterError(
                f"min_scale {self.min_scale} is larger than max_scale {self.max_scale}"
            )
        if not (is_number(self.likeness) and 0 < self.likeness <= 1):
            raise ParameterError(
                f"likeness is a share above 0 and at most 1, not {self.likeness!r}"
            )

    @property
    def step(self) -> int:
        """Frames of the working rate between two moments."""
        return max(1, self.frames(self.resolution))

    def moments(self, seconds: float) -> int:
        """Seconds in whole moments."""
        return round(seconds * self.working_fps / self.step)


KINEME = ActionPreset(
    name="kineme",
    offsets=(-0.2, -0.1, 0.0, 0.1, 0.2),
    resolution=0.1,
    window=60.0,
    phase=1.25,
    recurrence_time=3.0,
    min_scale=0.08,
    max_scale=0.16,
    softness=1.6,
    border_cost=1.75,
    min_stretch=0.6,
    part_gap=0.75,
    part_softness=2.0,
    part_share=0.3,
    likeness=0.6,
    likeness_softness=1.3,
    any_pace=True,
    min_repetition=0.5,
    switch_cost=0.6,
    no_action_cost=0.55,
    min_action=1.0,
    transition_factor=1.15,
    max_transition=0.4,
)
