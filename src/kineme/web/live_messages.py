"""Messages of the page of a stream; see `kineme.web.messages`."""

from __future__ import annotations

from typing import Literal

from msgspec import Struct


class LiveEvent(Struct, frozen=True, kw_only=True):
    """An event of a stream; fields that its kind does not have are 0 or empty."""

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
    """Constant data of a stream: names of the curves, and joints that are connected."""

    channels: list[str]
    sample_fps: float
    bones: list[tuple[int, int]]


class LiveUpdate(Struct, frozen=True, kw_only=True):
    """Changes since the previous update; only the first one has a head.

    ``now_s`` is the length of the stream, ``silent_s`` the time since the last row. ``samples`` are
    rows of the curves from ``first_s`` on, null if missing. ``pose`` has right and up of each joint
    in metres.
    """

    head: LiveHead | None
    now_s: float
    silent_s: float
    has_ended: bool
    events: list[LiveEvent]
    first_s: float
    samples: list[list[float | None]]
    pose: list[float | None]
