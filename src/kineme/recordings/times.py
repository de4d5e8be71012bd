"""Recognise columns of times, parse their values, and map seconds of a recording to them.

Columns of times are called ``time``, ``t``, ``timestamp``, ``datetime``, ``elapsed`` or
``seconds``, with or without a unit as in ``time_ms``, ``Time (s)`` or ``epoch_ns``. Columns with
the rate in every row are called ``fps`` or ``rate``.

Times may be dates: ISO 8601 with or without a zone (UTC without), the time of day, or a date as
loggers and spreadsheets write it, ``31.01.2026 09:30:00`` or ``1/31/2026 9:30:00 AM``. Without a
date, ``9:30:00`` is hours, minutes and seconds, and ``9:30`` or ``09:30.25`` minutes and seconds.
A column of ``9:30`` without seconds is hours and minutes if it shows this (`counts_hours`); for
labels, if the clock of the recording does (`kineme.labels.spans.convert_clock_times`).
Numbers may count from 1970 in seconds, milli-, micro- or nanoseconds. Their size tells the unit: a
year from 2001 to 2100 in one unit lies outside these years in another. The unit of numbers with
another origin, such as the start of a phone, is guessed from their steps.

Frame i is at second i / fps of the recording; pauses do not count. A `Clock` maps these seconds to
the times in the file. It consists of spans, each with the second and the time at which it begins;
within a span both advance together. If the clock was set back, a time that occurs twice maps to the
first of the two. A time within a pause maps to the end of the pause.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import pairwise
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Floats
from kineme._util.checks import is_number
from kineme.errors import ParameterError
from kineme.recordings.cells import parse_texts

T = TypeVar("T")

UNITS_OF_TIME = {"s": 1.0, "ms": 1e3, "us": 1e6, "µs": 1e6, "μs": 1e6, "ns": 1e9}
"""Units of time, and how many of each make a second."""

UNITS_NAMED = {"ms": "milliseconds", "us": "microseconds", "ns": "nanoseconds"}
"""Names of the units that may be guessed."""

RATE = "fps"
"""Name of a column of frame rates in files written by kineme."""

HOURLESS = "times without hours are read as minutes and seconds"
"""Note added if times such as 9:45 may also be hours and minutes."""

HOURS = "times such as 9:45 are read as hours and minutes"
"""Note added if such times are those of a clock."""

NO_TIMES = "holds neither numbers nor ISO dates such as 2026-01-31T09:30:00.25"
"""Error for a column that is named like times but holds none."""

CLOSE_S = 0.05
"""Seconds by which times may deviate from their span before a new span begins."""

_DATES = (978_307_200.0, 4_102_444_800.0)  # 2001 to 2100, in seconds since 1970
_ROWS_PER_MINUTE = 55  # of a sensor with a row a second, with some lost
_SLOWEST = 4.0  # least rows per second in a guessed unit

_TIME = re.compile(
    r"((?:unix|epoch|utc|sensor|elapsed)?[\s_]*time(?:[\s_]*stamp)?|t|date[\s_]*time|elapsed|"
    rf"seconds?(?:[\s_]*elapsed)?|epoch?(?=[\s_]*[\[(]?[mun]?s\b))[\s_]*(?:[\[(]?({'|'.join(UNITS_OF_TIME)})?[\])]?|"
    r"[\[(]?(?:utc|iso|[+-]\d{2}:?\d{2})[\])]?)",
    re.IGNORECASE,
)
_RATE = re.compile(r"fps|rate|frame[\s_]?rate", re.IGNORECASE)
_CLOCK = re.compile(  # a name that contains "time", with an optional unit
    r".*(?:[Tt]ime[Ss]tamp|[Tt]ime(?![a-z])|TIME).*?"
    rf"(?:[\s_]*[\[(_\s]({'|'.join(UNITS_OF_TIME)})[\])]?)?"
)
_MONTHS = ["jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec"]
_WRITTEN = re.compile(
    rf"(?P<first>\d{{1,4}})(?P<mark>[-/. ])(?P<second>\d{{1,2}}|{'|'.join(_MONTHS)})(?P=mark)"
    r"(?P<third>\d{2,4})[ T,]+(?P<hour>\d{1,2})(?P<rest>:\d\d(?::\d\d(?:[.,]\d+)?)?)"
    r"(?:\s*(?P<half>[ap])\.?m\.?)?\s*(?P<zone>Z|[+-]\d\d:?\d\d)?",
    re.IGNORECASE,
)
# Two parts are minutes and seconds; `datetime` would take 00:01.200 for a minute and 0.2 s.
_ELAPSED = re.compile(r"(?:(\d{1,4}):(?=[0-5]\d:))?(\d{1,4}):([0-5]\d(?:[.,]\d+)?)")
_TWO_PARTS = re.compile(r"(\d{1,4}):[0-5]\d")
_LEAP = re.compile(r"(?<=:\d\d:)60(?!\d)")


def is_timing(column: str) -> bool:
    """Return whether a column of this name holds times or rates."""
    return is_time(column) or is_rate(column)


def is_time(column: str) -> bool:
    """Return whether a column of this name holds times."""
    return _TIME.fullmatch(column.strip()) is not None


def is_rate(column: str) -> bool:
    """Return whether a column of this name holds rates."""
    return _RATE.fullmatch(column.strip()) is not None


def find_date_columns(names: Sequence[str], cells: Sequence[str]) -> list[int]:
    """Return the columns of a text table that hold dates, judging by their first cells."""
    dates = [i for i, (_, cell) in enumerate(zip(names, cells, strict=False)) if is_date(cell)]
    times_of_day = [i for i in dates if ":" in cells[i]]
    return [i for i in dates if is_time(names[i])] or find_unnamed_clock(names, times_of_day)


def find_unnamed_clock(names: Iterable[str], dates: list[T]) -> list[T]:
    """Return the first column of dates if no name is that of times or rates, else none."""
    return [] if any(map(is_timing, names)) else dates[:1]


def append_unit(name: str, unit: str) -> str:
    """Return the name of a column of times with the unit from the line below it.

    Other names stay unchanged.

    Examples
    --------
    >>> append_unit("time", "ms"), append_unit("time", "hh:mm"), append_unit("time_s", "ms")
    ('time (ms)', 'time', 'time_s')
    """
    match = _TIME.fullmatch(name.strip())
    if match is None or match[2] or unit.lower() not in UNITS_OF_TIME:
        return name
    return f"{name} ({unit.lower()})"


def name_clock(name: str) -> str | None:
    """Return a standard name for an increasing column if its name contains "time", else None.

    Examples
    --------
    >>> name_clock("accelerometerTimestamp_sinceReboot(s)"), name_clock("SampleTimeFine")
    ('time (s)', 'time')
    >>> name_clock("PacketCounter")
    """
    match = _CLOCK.fullmatch(name.strip())
    return match and (f"time ({match[1]})" if match[1] else "time")


def find_time_unit(column: str) -> str | None:
    """Return the unit in the name of a column of times, or None."""
    match = _TIME.fullmatch(column.strip())
    return match[2].lower() if match and match[2] else None


def as_seconds(values: ArrayLike, unit: str | None = None) -> tuple[Floats, str | None]:
    """Return times (rows,) in seconds, NaN if missing, and the unit if guessed from their steps.

    ``values`` (rows,) are numbers, dates of numpy and pandas, or texts; raise ValueError or
    TypeError for others. ``unit`` is one of `UNITS_OF_TIME`. By default it is the one in which the
    numbers are dates of this century; else seconds, or the coarsest unit with at least four rows a
    second if steps are large.

    Examples
    --------
    >>> as_seconds([81_000_000_000, 81_020_000_000, 81_040_000_000])
    (array([81.  , 81.02, 81.04]), 'ns')
    """
    times = np.asarray(values)
    zone = getattr(getattr(values, "dtype", None), "tz", None)
    if zone is not None:  # pandas gives objects for dates with a time zone
        times = np.asarray(values, "M8[ns]")
    if times.dtype.kind in "mM":
        stamps = times.astype(f"{times.dtype.kind}8[ns]")
        return np.where(np.isnat(stamps), np.nan, stamps.astype(np.int64) / 1e9), None
    if times.dtype.kind in "OUS":
        if any(isinstance(value, str) for value in times.ravel()[:9]):
            cells = times.tolist()
            texts = [cell.strip() if isinstance(cell, str) else "" for cell in cells]
            parsed, _ = parse_texts({0: texts})
            if not parsed:
                found = np.array([parse_date(text) if text else np.nan for text in texts])
                return found * (60 if counts_hours(texts) else 1), None
            times = parsed[0]
        elif any(isinstance(value, datetime) for value in times.ravel()[:9]):
            return np.array([_convert_date(value) for value in times.tolist()]), None
    numbers = np.asarray(times, np.float64)
    if unit or (unit := _find_unit_since_1970(numbers)):
        return numbers / UNITS_OF_TIME[unit], None
    guessed = _find_unit_of_steps(numbers)
    return numbers / UNITS_OF_TIME[guessed or "s"], guessed


def is_date(text: str) -> bool:
    """Return whether a text is a date or a time of day."""
    try:
        parse_date(text)
    except ValueError:
        return False
    return True


def parse_date(text: str, *, day_first: bool | None = None) -> float:
    """Return seconds since 1970, or since 0:00 without a date; raise ValueError for other texts.

    Two parts such as ``9:45`` are minutes and seconds, see `counts_hours`.
    A leap second, ``23:59:60``, equals the first second of the next minute, as in Unix time.
    ``day_first`` is the result of `is_day_first`; None for the usual order.
    """
    if not any(mark in text for mark in "-:"):
        raise ValueError(f"{text[:40]!r} is not an ISO date")
    if leap := _LEAP.search(text):
        before = f"{text[: leap.start()]}59{text[leap.end() :]}"
        return parse_date(before, day_first=day_first) + 1
    if elapsed := _ELAPSED.fullmatch(text):
        hours, minutes, seconds = elapsed.groups("0")
        return 3600 * int(hours) + 60 * int(minutes) + float(seconds.replace(",", "."))
    try:
        when = datetime.fromisoformat(text)
    except ValueError:
        written = _WRITTEN.fullmatch(text)
        iso = _format_iso(written, day_first) if written else f"1970-01-01T{text.removeprefix('T')}"
        try:
            when = datetime.fromisoformat(iso)
        except ValueError:
            raise ValueError(
                f"{text[:40]!r} is not an ISO date such as 2026-01-31T09:30:00.25"
            ) from None
    return (when if when.tzinfo else when.replace(tzinfo=UTC)).timestamp()


def may_count_hours(texts: Iterable[str]) -> bool:
    """Return whether all texts are times such as ``9:45``, which may be hours and minutes."""
    times = [_TWO_PARTS.fullmatch(text) for text in texts if text]
    return bool(times) and all(time is not None and int(time[1]) < 24 for time in times)


def counts_hours(texts: Sequence[str], header: str = "") -> bool:
    """Return whether the times of rows are hours and minutes rather than minutes and seconds.

    They are if ``header`` says so, if midnight follows 23:59, or if many rows share each time and
    the first is not 0:00, where elapsed times begin.

    Examples
    --------
    >>> counts_hours(["9:45"] * 60 + ["9:46"] * 60), counts_hours(["9:45"] * 20 + ["9:46"] * 20)
    (True, False)
    """
    if not may_count_hours(texts):
        return False
    times = [parse_date(text) for text in texts if text]
    is_midnight = -(24 * 60 - 1) in np.diff(times)
    is_shared = times[0] > 0 and max(Counter(times).values()) >= _ROWS_PER_MINUTE
    return bool(re.search("h:mm(?!:)", header.lower())) or is_midnight or is_shared


def is_day_first(texts: Sequence[str]) -> bool | None:
    """Return whether days come before months in numeric dates that end with the year.

    None for other formats, or if all dates are ambiguous.

    Examples
    --------
    >>> is_day_first(["5/6/2026 23:59:59", "13/6/2026 0:00:00"])
    True
    >>> is_day_first(["5/6/2026 1:00", "13-Jun-2026 1:00"])
    """
    for text in filter(is_ambiguous, texts):
        first, second = map(int, re.findall(r"\d+", text)[:2])
        if max(first, second) > 12:
            return first > 12
    return None


def is_ambiguous(text: str) -> bool:
    """Return whether a date alone does not state the order of day and month, as ``5/6/2026``."""
    match = _WRITTEN.fullmatch(text)
    if match is None or len(match["first"]) == 4 or match["mark"] == ".":
        return False
    return match["second"].isdigit()


def _format_iso(date: re.Match[str], day_first: bool | None) -> str:
    first, second, third = date["first"], date["second"].lower(), date["third"]
    if len(first) == 4:
        year, month, day = first, second, third
    else:
        if day_first is None:
            day_first = date["mark"] != "/" or int(first) > 12
        year = third if len(third) == 4 else f"20{third}"
        month, day = (second, first) if day_first or second in _MONTHS else (first, second)
    if month in _MONTHS:
        month = str(_MONTHS.index(month) + 1)
    hour = int(date["hour"])
    if date["half"]:
        hour = hour % 12 + 12 * (date["half"].lower() == "p")
    zone = date["zone"] or ""
    return f"{year}-{int(month):02}-{int(day):02}T{hour:02}{date['rest']}{zone}"


def _convert_date(value: Any) -> float:
    """Return a datetime as seconds since 1970, in UTC if it has no zone; NaN for NaT."""
    if not isinstance(value, datetime) or value != value:  # noqa: PLR0124 (NaT)
        return np.nan
    return (value if value.tzinfo else value.replace(tzinfo=UTC)).timestamp()


def _find_unit_since_1970(numbers: Floats) -> str | None:
    """Return the unit in which these numbers are dates of this century, or None."""
    finite = numbers[np.isfinite(numbers)]
    middle = float(np.median(finite)) if len(finite) else 0.0
    units = ("s", "ms", "us", "ns")
    return next((u for u in units if is_unix_time(middle / UNITS_OF_TIME[u])), None)


def _find_unit_of_steps(numbers: Floats) -> str | None:
    """Return the unit in which the steps give a sensor's rate; None if they may be seconds."""
    finite = np.sort(numbers[np.isfinite(numbers)])
    steps = np.diff(finite)
    steps = steps[steps > 0]
    # Steps of 1 are a row counter, or seconds.
    step = float(np.median(steps)) if len(steps) > 1 else 0.0
    if step < 2:
        return None
    return next((u for u in ("ms", "us") if UNITS_OF_TIME[u] >= _SLOWEST * step), "ns")


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


def is_near_full_hour(seconds: ArrayLike, tolerance: float) -> NDArray[np.bool_]:
    """Return whether each time is at most so many seconds from a full hour.

    Examples
    --------
    >>> is_near_full_hour([7199.9, 7230.0], 0.2).tolist()
    [True, False]
    """
    times = np.asarray(seconds)
    return np.asarray(np.abs(times - np.rint(times / 3600) * 3600) <= tolerance)
