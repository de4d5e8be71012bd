"""What the page of a stream is told; see `kineme.web.messages`."""

from __future__ import annotations

from typing import Literal

from msgspec import Struct


class LiveEvent(Struct, frozen=True, kw_only=True):
    """An event of a stream; 0 or empty is what its kind does not have."""

    event: Literal["ActivityStarted", "ActivityEnded", "Repetition", "Gap", "Notice"]
    at_s: float
    state: Literal["provisional", "final"]
    start_s: float
    stop_s: float
    cluster: int
    label: str
    number: int
    repetitions: int
    text: str


class LiveHead(Struct, frozen=True, kw_only=True):
    """What does not change in a stream: names of the curves, and joints that are connected."""

    channels: list[str]
    sample_fps: float
    bones: list[tuple[int, int]]


class LiveUpdate(Struct, frozen=True, kw_only=True):
    """What is new since the update before; the first one has a head.

    ``now_s`` is how long the stream is, ``silent_s`` how long no row has come. ``samples`` are rows
    of the curves from ``first_s`` on, null where nothing was recorded, ``pose`` right and up of
    each joint in metres.
    """

    head: LiveHead | None
    now_s: float
    silent_s: float
    has_ended: bool
    events: list[LiveEvent]
    first_s: float
    samples: list[list[float | None]]
    pose: list[float | None]
