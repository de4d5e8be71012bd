"""The constants by which events are found: what recurs anywhere.

Lengths are in body sizes, times in seconds; see ``kineme.methods.recurrence.constants``.
"""

from __future__ import annotations

from dataclasses import dataclass

from kineme.methods.constants import (
    COUNT,
    FACTOR,
    SHARE,
    SOME_FACTOR,
    SOME_LENGTH,
    SOME_SHARE,
    SOME_TIME,
    TIME,
    constant,
)
from kineme.methods.recurrence.repeating.counting import CountingPreset


@dataclass(frozen=True, kw_only=True)
class EventConstants(CountingPreset):
    """Of occurrences, and of what they take the place of."""

    min_periodic: float = constant(
        "actions whose counts are less probable than this, in the mean of their activities, may be "
        "occurrences instead of repetitions", limits=SHARE, fine=True,
    )  # fmt: skip
    event_scale: float = constant(
        "distance from which two moments of an event are not similar", unit="body sizes",
        limits=SOME_LENGTH, slider=(0.2, 0.8, 0.05),
    )  # fmt: skip
    event_velocity: float = constant(
        "velocities count as much as poses that they change in this time", unit="s", limits=TIME,
        fine=True,
    )  # fmt: skip
    event_rest: float = constant(
        "share at which movement time goes by while nothing moves", limits=SOME_SHARE, fine=True
    )
    max_stand: float = constant(
        "who stands still for longer, at a quarter of the usual movement, is in no event", unit="s",
        limits=SOME_TIME,
    )  # fmt: skip
    event_cost: float = constant(
        "similarity that an event must gain for each moment that it lasts", limits=FACTOR
    )
    event_cover: float = constant(
        "share of an event that each occurrence must match", limits=SOME_SHARE, fine=True
    )
    event_window: float = constant(
        "occurrences are found no farther apart than this, in movement time", unit="s",
        limits=SOME_TIME, fine=True,
    )  # fmt: skip
    min_event: float = constant(
        "shortest event, in movement time; a single repetition that is shorter is none", unit="s",
        limits=SOME_TIME,
    )  # fmt: skip
    max_event: float = constant(
        "longest event, in movement time", unit="s", limits=SOME_TIME, fine=True
    )
    min_recurrence: float = constant(
        "similarity times movement time that is no chance", unit="s", limits=SOME_TIME,
        slider=(0.2, 2.0, 0.05),
    )  # fmt: skip
    event_link: float = constant(
        "share of that from which an occurrence joins a set in which another reaches it",
        limits=SOME_SHARE, fine=True,
    )  # fmt: skip
    pair_factor: float = constant("sets of two need min_recurrence times this", limits=SOME_FACTOR)
    whole_share: float = constant(
        "an occurrence alone in an activity of one repetition is all of it if it takes this share",
        limits=SOME_SHARE, fine=True,
    )  # fmt: skip
    few_activities: int = constant(
        "so many activities of one repetition each are a set if they move as much as a set of two "
        "must recur; nothing is chance in a recording of so many activities", limits=COUNT,
        fine=True,
    )  # fmt: skip
