"""Events of a stream. A final one never changes; a provisional one is the best guess so far."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, Literal

State = Literal["provisional", "final"]


@dataclass(frozen=True, kw_only=True)
class Event:
    """What a stream tells.

    Attributes
    ----------
    at_s : float
        Second of the stream up to which rows were known when it was told.
    state : {"provisional", "final"}
    """

    at_s: float
    state: State = "final"

    @property
    def is_final(self) -> bool:
        """Return whether it will not change any more."""
        return self.state == "final"

    def to_json(self) -> dict[str, Any]:
        """Return the kind of event as ``event``, and its attributes, as JSON has them.

        Examples
        --------
        >>> Notice(at_s=2.0, text="the clock goes back").to_json()
        {'event': 'Notice', 'at_s': 2.0, 'state': 'final', 'text': 'the clock goes back'}
        """
        rounded = {
            name: round(value, 4) if isinstance(value, float) else value
            for name, value in asdict(self).items()
        }
        return {"event": type(self).__name__} | rounded


@dataclass(frozen=True, kw_only=True)
class ActivityStarted(Event):
    """An activity began at a second of the stream; ``label`` names a known cluster."""

    start_s: float
    cluster: int
    label: str = ""


@dataclass(frozen=True, kw_only=True)
class ActivityEnded(Event):
    """An activity ended, after so many repetitions."""

    start_s: float
    stop_s: float
    cluster: int
    repetitions: int
    label: str = ""


@dataclass(frozen=True, kw_only=True)
class Repetition(Event):
    """One repetition; ``number`` counts those of its activity from 1."""

    number: int
    start_s: float
    stop_s: float
    cluster: int


@dataclass(frozen=True, kw_only=True)
class Gap(Event):
    """Nothing was recorded for a while; a provisional gap goes on."""

    start_s: float
    stop_s: float


@dataclass(frozen=True, kw_only=True)
class Notice(Event):
    """Something is wrong with the rows, which the stream bears."""

    text: str
