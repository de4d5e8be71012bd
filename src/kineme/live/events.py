"""Events of a stream. A final event never changes; a provisional one is the best guess so far."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, Literal

State = Literal["provisional", "final"]


@dataclass(frozen=True, kw_only=True)
class Event:
    """Base class of all events.

    Attributes
    ----------
    at_s : float
        Time of the newest row when the event was sent, in seconds since the stream began.
    state : {"provisional", "final"}

    Examples
    --------
    >>> Event(at_s=2.0, state="provisional").is_final
    False
    """

    at_s: float
    state: State = "final"

    @property
    def is_final(self) -> bool:
        """Return whether the event is final."""
        return self.state == "final"

    def to_json(self) -> dict[str, Any]:
        """Return the name of the class as ``event``, and all attributes.

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
    """An activity began at `start_s`; ``label`` is the name of a known cluster.

    Examples
    --------
    >>> ActivityStarted(at_s=14.0, start_s=9.0, cluster=2).start_s
    9.0
    """

    start_s: float
    cluster: int
    label: str = ""


@dataclass(frozen=True, kw_only=True)
class ActivityEnded(Event):
    """An activity ended, with its number of repetitions.

    Examples
    --------
    >>> ActivityEnded(at_s=30.0, start_s=9.0, stop_s=25.0, cluster=2, repetitions=8).repetitions
    8
    """

    start_s: float
    stop_s: float
    cluster: int
    repetitions: int
    label: str = ""


@dataclass(frozen=True, kw_only=True)
class Repetition(Event):
    """One repetition; ``number`` counts those of its activity from 1.

    Examples
    --------
    >>> Repetition(at_s=16.0, number=1, start_s=9.0, stop_s=11.0, cluster=2).number
    1
    """

    number: int
    start_s: float
    stop_s: float
    cluster: int


@dataclass(frozen=True, kw_only=True)
class Gap(Event):
    """Nothing was recorded for a while; a provisional gap has not ended yet.

    Examples
    --------
    >>> Gap(at_s=5.0, start_s=3.0, stop_s=5.0).stop_s
    5.0
    """

    start_s: float
    stop_s: float


@dataclass(frozen=True, kw_only=True)
class Notice(Event):
    """Something is wrong with the rows; the stream continues.

    Examples
    --------
    >>> Notice(at_s=5.0, text="the clock goes back by 3 s").text
    'the clock goes back by 3 s'
    """

    text: str
