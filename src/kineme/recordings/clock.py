"""Convert between seconds of a recording and the times in its file.

Frame i is at second i / fps of the recording; pauses do not count. A `Clock` maps these seconds to
the times in the file. It consists of spans, each with the second and the time at which it begins;
within a span both advance together. If the clock was set back, a time that occurs twice maps to the
first of the two. A time within a pause maps to the end of the pause.
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
"""Seconds by which times may deviate from their span before a new span begins."""

_DATES = (978_307_200.0, 4_102_444_800.0)  # 2001 to 2100, in seconds since 1970


@dataclass(frozen=True)
class Clock:
    """Map seconds of a recording to times of its file, and back.

    Parameters
    ----------
    seconds : sequence of float
        Seconds of the recording at which the spans begin, increasing from 0.
    times : sequence of float
        Times of the clock at these seconds, in seconds since any origin, midnight or 1970.

    Raises
    ------
    ParameterError
        Lengths differ, values are not numbers, or seconds do not increase from 0.

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
            values = getattr(self, name)
            if not isinstance(values, Sequence) or not all(map(is_number, values)):
                raise ParameterError(f"{name} of a clock must be numbers, not {values!r:.60}")
            object.__setattr__(self, name, tuple(map(float, values)))
        starts = self.seconds
        rising = bool(starts) and starts[0] == 0 and all(a < b for a, b in pairwise(starts))
        if len(starts) != len(self.times) or not rising:
            raise ParameterError(
                "a clock needs one time per second value, and seconds that increase from 0"
            )

    @classmethod
    def from_times(cls, times: ArrayLike, fps: float) -> Clock | None:
        """Return the clock of frames with these times in seconds.

        None if the times are those of frames counted from 0.
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
        """Return the clock from the output of `to_json`; raise ParameterError if it is invalid."""
        if not isinstance(data, Mapping) or not {"seconds", "times"} <= data.keys():
            raise ParameterError(f"a clock has seconds and times, not {data!r:.60}")
        return cls(data["seconds"], data["times"])

    def to_json(self) -> dict[str, list[float]]:
        """Return seconds and times for JSON."""
        return {"seconds": list(self.seconds), "times": list(self.times)}

    @property
    def shows_dates(self) -> bool:
        """Return whether the times count from 1970, judging by their size."""
        return is_unix_time(self.times[0])

    def time(self, seconds: ArrayLike) -> Floats:
        """Return the times of the clock at seconds of the recording."""
        at = np.asarray(seconds, np.float64)
        # The span of each second: the last that begins at or before it.
        k = np.maximum(np.searchsorted(self.seconds, at, side="right") - 1, 0)
        shown: Floats = np.asarray(self.times)[k] + at - np.asarray(self.seconds)[k]
        return shown

    def second(self, times: ArrayLike) -> Floats:
        """Return the first second of the recording at which the clock shows a time.

        Below 0 for times before the recording, beyond its length for times after it.
        """
        at = np.asarray(times, np.float64)
        begin, shown = np.asarray(self.seconds), np.asarray(self.times)
        # Each span lasts until the next one; the last one has no end.
        end = np.append(begin[1:], np.inf)
        # Latest time up to the end of each span; the running maximum handles steps back.
        k = np.searchsorted(np.maximum.accumulate(shown + end - begin), at, side="right")
        since = at - shown[k]
        # Times in a pause are negative here and belong to the start of the next span.
        found: Floats = begin[k] + np.where(k > 0, np.maximum(since, 0.0), since)
        return found

    def make_relative(self) -> Clock:
        """Return the clock relative to the beginning of the recording."""
        return Clock(self.seconds, [time - self.times[0] for time in self.times])

    def cut(self, start: float, stop: float) -> Clock:
        """Return the clock of the part between two seconds of the recording."""
        later = [second for second in self.seconds if start < second < stop]
        seconds = [start, *later]
        return Clock([second - start for second in seconds], self.time(seconds).tolist())

    def format_time(self, second: float) -> str:
        """Return the time at a second of the recording as text: a number, or an ISO date in UTC."""
        time = float(self.time(second))
        if not self.shows_dates:
            return repr(round(time, 6))
        return datetime.fromtimestamp(time, UTC).isoformat(timespec="milliseconds")


def is_unix_time(seconds: float) -> bool:
    """Return whether a time in seconds counts from 1970, judging by its size."""
    return bool(_DATES[0] <= seconds < _DATES[1])
