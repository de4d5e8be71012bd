"""Clock of a recording: what time it was at a second of it, and back.

Seconds of a recording count its frames: frame i is at i / fps, whatever was paused between them. A
clock is what the times in the file say of that. It has spans, each with the second of the recording
and the time at which it begins; within a span both go on together. Where the clock goes back, a
time that it shows twice is the first of the two; a time within a pause is where the recording goes
on.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Floats
from kineme._util.checks import is_number
from kineme.errors import ParameterError

CLOSE_S = 0.05
"""Seconds by which times may miss those of a span: closer than people can say when it was."""

_DATES = (978_307_200.0, 4_102_444_800.0)  # 2001 to 2100, in seconds since 1970


@dataclass(frozen=True)
class Clock:
    """When a recording was taken.

    Parameters
    ----------
    seconds : sequence of float
        Of the recording, rising from 0: where the spans begin.
    times : sequence of float
        What the clock shows there, in seconds: from any beginning, of the day, or since 1970.

    Raises
    ------
    ParameterError
        They are not as many of both, no numbers, or seconds that do not rise from 0.

    Examples
    --------
    >>> clock = Clock([0.0, 60.0], [0.0, 660.0])  # a pause of ten minutes
    >>> clock.time([59.0, 61.0]).tolist(), clock.second([100.0, 661.0]).tolist()
    ([59.0, 661.0], [60.0, 61.0])
    """

    seconds: Sequence[float]
    times: Sequence[float]

    def __post_init__(self) -> None:
        for name in ("seconds", "times"):
            given = getattr(self, name)
            if not isinstance(given, Sequence) or not all(map(is_number, given)):
                raise ParameterError(f"{name} of a clock are numbers, not {given!r:.60}")
            object.__setattr__(self, name, tuple(map(float, given)))
        begin = self.seconds
        rising = bool(begin) and begin[0] == 0 and all(a < b for a, b in pairwise(begin))
        if len(begin) != len(self.times) or not rising:
            raise ParameterError("a clock has as many times as seconds, which rise from 0")

    @classmethod
    def of(cls, times: ArrayLike, fps: float) -> Clock | None:
        """Return the clock that shows these times, in seconds.

        None for one that counts frames from 0.
        """
        shown = np.asarray(times, np.float64)
        seconds = np.arange(len(shown)) / fps
        # How far the clock is ahead of the frames: constant within a span.
        ahead = shown - seconds
        # Half a frame at high rates, where 0.05 s would be several frames.
        near = min(CLOSE_S, 0.5 / fps)
        if np.abs(ahead).max(initial=0.0) <= near:
            return None
        starts, since = [0], float(ahead[0])
        if np.abs(ahead - since).max() <= CLOSE_S:
            return cls([0.0], [since])
        for i, off in enumerate(ahead.tolist()):
            # Small errors of single times begin no new span.
            if abs(off - since) > CLOSE_S:
                starts.append(i)
                since = off
        return cls(seconds[starts].tolist(), shown[starts].tolist())

    @classmethod
    def from_json(cls, data: Any) -> Clock:
        """Return the clock that `to_json` gave; ParameterError where that is none."""
        if not isinstance(data, Mapping) or not {"seconds", "times"} <= data.keys():
            raise ParameterError(f"a clock has seconds and times, not {data!r:.60}")
        return cls(data["seconds"], data["times"])

    def to_json(self) -> dict[str, list[float]]:
        """Seconds and times, as JSON holds them."""
        return {"seconds": list(self.seconds), "times": list(self.times)}

    @property
    def tells_dates(self) -> bool:
        """Return whether it counts from 1970, which the size of its times tells."""
        return is_unix_time(self.times[0])

    def time(self, seconds: ArrayLike) -> Floats:
        """Return what it shows at seconds of the recording."""
        at = np.asarray(seconds, np.float64)
        # The span of each second: the last that begins at or before it.
        k = np.maximum(np.searchsorted(self.seconds, at, side="right") - 1, 0)
        shown: Floats = np.asarray(self.times)[k] + at - np.asarray(self.seconds)[k]
        return shown

    def second(self, times: ArrayLike) -> Floats:
        """Return the first second of the recording at which it shows a time, or one beyond it.

        Below 0 for times before the recording, beyond its length for those after it.
        """
        at = np.asarray(times, np.float64)
        begin, shown = np.asarray(self.seconds), np.asarray(self.times)
        # Each span lasts until the next one; the last one has no end.
        end = np.append(begin[1:], np.inf)
        # Latest time shown up to the end of each span; the accumulation holds where the clock goes
        # back.
        k = np.searchsorted(np.maximum.accumulate(shown + end - begin), at, side="right")
        since = at - shown[k]
        # Times in a pause are negative here and belong to the start of the next span.
        found: Floats = begin[k] + np.where(k > 0, np.maximum(since, 0.0), since)
        return found

    def since_first(self) -> Clock:
        """Return the same clock, had it been set to 0 when the recording began."""
        return Clock(self.seconds, [time - self.times[0] for time in self.times])

    def between(self, start: float, stop: float) -> Clock:
        """Return the clock of what lies between two seconds of the recording."""
        later = [second for second in self.seconds if start < second < stop]
        seconds = [start, *later]
        return Clock([second - start for second in seconds], self.time(seconds).tolist())

    def shown(self, second: float) -> str:
        """Return the time at a second of the recording: a number, or a date of ISO 8601 in UTC."""
        time = float(self.time(second))
        if not self.tells_dates:
            return repr(round(time, 6))
        return datetime.fromtimestamp(time, UTC).isoformat(timespec="milliseconds")


def is_unix_time(seconds: float) -> bool:
    """Return whether a time is one since 1970, by its size."""
    return bool(_DATES[0] <= seconds < _DATES[1])
