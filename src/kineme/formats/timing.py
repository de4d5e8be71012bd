"""What a column of times tells of a recording: its frame rate, and where it pauses.

Columns of times are called ``time``, ``t``, ``timestamp``, ``datetime``, ``elapsed`` or
``seconds``, with or without a unit as in ``time_ms``, ``Time (s)`` or ``epoch_ns``; those with
a rate in every row ``fps`` or ``rate``.

The rows of a file are the frames of the recording, whatever their times: none is
added, left out or moved. The rate is that of the ordinary steps from row to row.
Clocks do worse than that: they are set while they run, they give several rows one time
(those that count whole seconds, those that stamp a packet of samples), rows are lost or
come late. All of this is said; a step that is longer or shorter than usual by
more than 0.2 s, forward or back, splits the recording as any other gap does.

Times may be dates: ISO 8601 with or without a zone (UTC without), the time of day, or a date as
loggers and spreadsheets write it, ``31.01.2026 09:30:00`` or ``1/31/2026 9:30:00 AM``.
Numbers may count from 1970 in seconds, milli-, micro- or nanoseconds, which their size
tells: those of the years 2001 to 2100 in one unit are none of these years in another.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime, time
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Floats
from kineme._util.checks import format_count, join_names
from kineme.formats.files import FileContent
from kineme.formats.gaps import LONGEST_S
from kineme.recordings import Note
from kineme.recordings.arrays import spans_of
from kineme.recordings.clock import Clock

UNEVEN = 0.1
"""Share of a period by which times may differ from even ones."""

UNITS_OF_TIME = {"s": 1.0, "ms": 1e3, "us": 1e6, "µs": 1e6, "μs": 1e6, "ns": 1e9}
"""How many of each make a second."""

RATE = "fps"
"""A column that tells a rate, as it is written."""

NO_TIMES = "holds neither numbers nor ISO dates such as 2026-01-31T09:30:00.25"
"""Of a column that is called as times are, and tells none."""

_ORDINARY = 0.5  # share of the median step by which an ordinary step differs from it at most
_MOST = 2 / 3  # share of steps that are ordinary, else the rate is that of the whole duration
_ADDS_UP = 0.1  # share by which steps of whole periods may miss the duration
_SHUFFLED = 0.25  # share of steps backward from which on the rows are in no order of time
_EPOCH = (978_307_200.0, 4_102_444_800.0)  # 2001 to 2100, in seconds since 1970
_SLOWEST = 1.0  # frames per second: at or below, times of no stated unit are hardly seconds
_FINER = {"milliseconds": 1e3, "microseconds": 1e6, "nanoseconds": 1e9}

_TIME = re.compile(
    r"((?:unix|epoch|utc|sensor|elapsed)?[\s_]*time(?:[\s_]*stamp)?|t|date[\s_]*time|elapsed|"
    rf"seconds?(?:[\s_]*elapsed)?|epoch?(?=[\s_]*[\[(]?[mun]?s\b))[\s_]*(?:[\[(]?({'|'.join(UNITS_OF_TIME)})?[\])]?|"
    r"[\[(]?(?:utc|iso|[+-]\d{2}:?\d{2})[\])]?)",
    re.IGNORECASE,
)
_RATE = re.compile(r"fps|rate|frame[\s_]?rate", re.IGNORECASE)
_CLOCK = re.compile(  # a name that says time, with a unit perhaps
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
_LEAP = re.compile(r"(?<=:\d\d:)60(?!\d)")


class Timing(NamedTuple):
    """What times tell.

    ``gaps`` are frames [start, stop): the last before each jump, which lasts as long as it.
    ``clock`` is None where frames are at their number over the rate.
    """

    fps: float
    gaps: tuple[tuple[int, int], ...] = ()
    notes: tuple[str, ...] = ()
    clock: Clock | None = None


def is_timing(column: str) -> bool:
    """Return whether a column of this name tells a time or a rate."""
    return any(pattern.fullmatch(column.strip()) for pattern in (_TIME, _RATE))


def is_rate(column: str) -> bool:
    """Return whether a column of this name tells a rate."""
    return _RATE.fullmatch(column.strip()) is not None


def date_columns(names: Sequence[str], cells: Sequence[str]) -> list[int]:
    """Return which columns of a text table tell the time by dates, as their first cells do.

    Where none is called as times are, the first that holds a time of day, whatever its name.
    """
    dates = [i for i, (_, cell) in enumerate(zip(names, cells, strict=False)) if is_date(cell)]
    if any(map(is_timing, names)):
        return [i for i in dates if _TIME.fullmatch(names[i].strip())]
    return [i for i in dates if ":" in cells[i]][:1]


def append_unit(name: str, unit: str) -> str:
    """Return the name of a column of times with the unit that stands below it.

    As it is where none does.

    Examples
    --------
    >>> append_unit("time", "ms"), append_unit("time", "hh:mm"), append_unit("time_s", "ms")
    ('time (ms)', 'time', 'time_s')
    """
    match = _TIME.fullmatch(name.strip())
    if match is None or match[2] or unit.lower() not in UNITS_OF_TIME:
        return name
    return f"{name} ({unit.lower()})"


def clock_name(name: str) -> str | None:
    """Return what to call a column that rises as clocks do, if its name says that it is one.

    Examples
    --------
    >>> clock_name("accelerometerTimestamp_sinceReboot(s)"), clock_name("SampleTimeFine")
    ('time (s)', 'time')
    >>> clock_name("PacketCounter")
    """
    match = _CLOCK.fullmatch(name.strip())
    return match and (f"time ({match[1]})" if match[1] else "time")


def table_timing(
    content: FileContent, columns: Mapping[str, ArrayLike], fps: float | None = None
) -> Timing:
    """Frames per second, pauses, and what was seen of the times; ``fps`` stands in place of these.

    ReadError where no column tells the rate, or one contradicts itself.
    """
    if fps:
        return Timing(fps)
    for column in columns:
        if is_rate(column):
            return Timing(_one_rate(content, numbers_in(content, columns, column)))
    clocks = {column: match for column in columns if (match := _TIME.fullmatch(column.strip()))}
    stopped = [column for column in clocks if len(clocks) > 1 and _is_stopped(columns[column])]
    # Of several clocks those count that run; a single one is refused with the reason.
    for column in [name for name in clocks if name not in stopped] or clocks:
        unit = clocks[column][2]
        timing = timing_of(content, _times(content, columns, column, unit))
        if timing.fps <= _SLOWEST and not unit:
            raise content.error(_hardly_seconds(timing.fps))
        if stopped:
            remark = f"no time in {join_names(stopped)}: {column} taken"
            return timing._replace(notes=(Note(remark, "warning"), *timing.notes))
        return timing
    raise content.error("no column 'time' or 'fps' found: give fps= (--fps)")


def numbers_in(
    content: FileContent, columns: Mapping[str, ArrayLike], name: str, rows: int | None = None
) -> Floats:
    """(rows,): a column as numbers; ReadError where it holds others, or is of another length."""
    try:
        values = np.asarray(columns[name], np.float64)
    except (ValueError, TypeError):
        raise content.error(f"column {name!r} does not hold numbers") from None
    if values.ndim != 1 or len(values) == 0 or len(values) != (rows or len(values)):
        raise content.error(f"column {name!r} has shape {values.shape}, not one value per row")
    return values


def timing_of(content: FileContent, times: Floats) -> Timing:
    """Return the frame rate, the pauses, and what was seen of uneven times, in seconds.

    NaN has none.

    A rate within a millionth of whole thousandths of a hertz is taken as such, and so is
    one that the times, as large as they are, cannot tell from it. ReadError where times stand
    still, are in no order, or are too few to tell a rate.
    """
    finite = np.isfinite(times)
    if finite.sum() < 2 or finite.mean() < 0.5:
        raise content.error("the times are too few or not numbers: give fps= (--fps)")
    rows = np.arange(len(times))
    times = np.interp(rows, rows[finite], times[finite])
    steps = np.diff(times)
    if not (steps > 0).any():
        row = int(steps.argmin()) + 1
        raise content.error(
            f"times do not increase: row {row + 1} has {times[row]:g} s; sort the rows, or give "
            "fps= (--fps) if their order is right"
        )
    if (steps < 0).mean() > _SHUFFLED:
        raise content.error(
            f"its rows are in no order of time, {(steps < 0).sum()} of {len(steps)} steps go "
            "back: sort them, or give fps= (--fps) if their order is right"
        )
    jumps = np.abs(steps - np.median(steps[steps > 0])) > LONGEST_S + 1e-9
    jumps &= steps != 0
    even = _is_even(times, steps)
    duration = float(times[-1] - times[0])
    period = duration / len(steps) if even else _period(steps, jumps)
    if not period > 0:
        raise content.error("the times do not tell a rate: give fps= (--fps)")
    jumps &= np.abs(steps - period) > 0.75 * period  # at low rates a frame may come late
    doubt = 2 * np.spacing(np.abs(times).max()) / (period * len(steps))
    fps = _round_rate(len(steps) / duration if even else 1 / period, max(1e-6, float(doubt)))
    notes = [] if even else [_unevenness(steps, jumps, period, fps)]
    if not finite.all():
        untimed = format_count(int((~finite).sum()), "row")
        notes.append(f"{untimed} without a time counted as frames")
    gaps = tuple((start, stop) for start, stop in spans_of(jumps).tolist())
    return Timing(fps, gaps, tuple(notes), Clock.of(times, fps))


def seconds(values: ArrayLike, unit: str | None = None) -> Floats:
    """Times as seconds: numbers, dates of numpy and pandas, or text; NaN where there is none.

    The unit is one of `UNITS_OF_TIME`; None for seconds, or what numbers of this size since 1970
    must be. ValueError or TypeError where they are no times.
    """
    times = np.asarray(values)
    if times.dtype.kind in "mM":
        stamps = times.astype(f"{times.dtype.kind}8[ns]")
        return np.where(np.isnat(stamps), np.nan, stamps.astype(np.int64) / 1e9)
    if times.dtype.kind in "OUS" and any(isinstance(value, str) for value in times.ravel()[:9]):
        return np.array([_nan_or_date(value) for value in times.tolist()])
    numbers = np.asarray(times, np.float64)
    return numbers / UNITS_OF_TIME[unit or _unit_since_1970(numbers)]


def is_date(text: str) -> bool:
    """Return whether a cell holds a date or a time of day."""
    try:
        date_seconds(text)
    except ValueError:
        return False
    return True


def date_seconds(text: str, *, day_first: bool | None = None) -> float:
    """Seconds since 1970, or since midnight for a time of day; ValueError if it is neither.

    A leap second, ``23:59:60``, is the first of the next minute, as clocks since 1970 count.
    ``day_first`` is what `day_comes_first` found; None for what is usual.
    """
    if not any(mark in text for mark in "-:"):
        raise ValueError(f"{text[:40]!r} is no ISO date")
    if leap := _LEAP.search(text):
        before = f"{text[: leap.start()]}59{text[leap.end() :]}"
        return date_seconds(before, day_first=day_first) + 1
    try:
        when = datetime.fromisoformat(text)
    except ValueError:
        if written := _WRITTEN.fullmatch(text):
            when = datetime.fromisoformat(_iso(written, day_first))
        else:
            when = datetime.combine(datetime(1970, 1, 1).date(), _time_of_day(text))  # noqa: DTZ001
    return (when if when.tzinfo else when.replace(tzinfo=UTC)).timestamp()


def day_comes_first(texts: Sequence[str]) -> bool | None:
    """Return whether days stand before months in dates of numbers that end in the year.

    None where they are written otherwise, or each could be either.

    Examples
    --------
    >>> day_comes_first(["5/6/2026 23:59:59", "13/6/2026 0:00:00"])
    True
    >>> day_comes_first(["5/6/2026 1:00"])
    """
    for text in texts:
        match = _WRITTEN.fullmatch(text)
        if match and max(int(match["first"]), int(match["second"])) > 12:
            return int(match["first"]) > 12
    return None


def is_ambiguous(text: str) -> bool:
    """Return whether a date names day and month in an order that it does not tell."""
    match = _WRITTEN.fullmatch(text)
    if match is None or len(match["first"]) == 4 or match["mark"] == ".":
        return False
    return match["second"].isdigit()


def _is_stopped(cells: ArrayLike) -> bool:
    """Return whether a column of times is empty, or the same in all of several rows."""
    texts = {str(cell).strip() for cell in np.asarray(cells).ravel()}
    return texts <= {"", "nan", "None"} or (len(texts) == 1 and np.size(cells) > 1)


def _times(
    content: FileContent, columns: Mapping[str, ArrayLike], name: str, unit: str | None
) -> Floats:
    """(rows,): a column of times in seconds."""
    try:
        times = seconds(columns[name], unit and unit.lower())
    except (ValueError, TypeError) as error:
        raise content.error(f"column {name!r} does not tell times: {error}") from None
    return numbers_in(content, {name: times}, name)


def _hardly_seconds(rate: float) -> str:
    """Return what to do about times that are so far apart that they are hardly seconds."""
    unit = next((unit for unit in _FINER if rate * _FINER[unit] > _SLOWEST), "milliseconds")
    return (
        f"its times are {1 / rate:g} apart; if these are not seconds, give fps "
        f"(--fps; {rate * _FINER[unit]:g} for {unit})"
    )


def _one_rate(content: FileContent, rates: Floats) -> float:
    rate = float(rates[0])
    if not (np.isfinite(rate) and rate > 0) or np.ptp(rates) > 0:
        raise content.error(
            f"the frame rate is not one positive number ({rate:g} first): give fps= (--fps)"
        )
    return rate


def _nan_or_date(value: Any) -> float:
    """As `date_seconds`; NaN for None and empty text."""
    return date_seconds(value.strip()) if value and value.strip() else np.nan


def _iso(date: re.Match[str], day_first: bool | None) -> str:
    """Return a date as ISO 8601 writes it."""
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


def _time_of_day(text: str) -> time:
    try:
        return time.fromisoformat(text)
    except ValueError:
        raise ValueError(f"{text[:40]!r} is no ISO date such as 2026-01-31T09:30:00.25") from None


def _unit_since_1970(numbers: Floats) -> str:
    finite = numbers[np.isfinite(numbers)]
    middle = float(np.median(finite)) if len(finite) else 0.0
    units = ("ms", "us", "ns")
    return next((u for u in units if _EPOCH[0] <= middle / UNITS_OF_TIME[u] < _EPOCH[1]), "s")


def _is_even(times: Floats, steps: Floats) -> bool:
    """Return whether the times are even ones, give or take a tenth of a period."""
    period = float(np.median(steps))
    if steps.min() <= 0:
        return False
    drift = times - period * np.arange(len(times))
    return bool(
        np.abs(drift - drift.mean()).max() <= UNEVEN * period or np.ptp(steps) <= UNEVEN * period
    )


def _period(steps: Floats, jumps: NDArray[np.bool_]) -> float:
    """Seconds from row to row where times are uneven.

    The mean of the steps that are nearly the median: clocks that count milliseconds
    give 120 Hz steps of 8 and 9, and lost rows leave steps of several periods. Where
    that does not add up, as in packets under one time or where one row in three comes
    late, all count but the jumps, from one change of the time to another.
    """
    median = float(np.median(steps))
    ordinary = np.abs(steps - median) <= _ORDINARY * median * (1 + 1e-9)
    if median > 0 and ordinary.mean() >= _MOST:
        period = float(steps[ordinary].mean())
        lasted = float(steps[~jumps].sum())
        expected = period * float(np.maximum(np.rint(steps[~jumps] / period), 1).sum())
        if abs(expected - lasted) <= _ADDS_UP * lasted:
            return period
    changes = np.flatnonzero(steps > 0)
    between = slice(changes[0] + 1, changes[-1] + 1) if len(changes) > 1 else slice(None)
    used = steps[between][~jumps[between]]
    return float(used.mean()) if len(used) else 0.0


def _unevenness(steps: Floats, jumps: NDArray[np.bool_], period: float, fps: float) -> str:
    """One sentence on uneven times."""
    counts: Sequence[tuple[int, str, str]] = [
        (int((steps == 0).sum()), "row", "with the time of the row before"),
        (int((steps < 0).sum()), "step", "back in time"),
        (int((steps > 1.5 * period).sum()), "step", "longer than a frame and a half"),
    ]
    parts = [f"{format_count(n, one)} {what}" for n, one, what in counts if n]
    sentence = f"times are uneven ({', '.join(parts) or 'jitter'}): rows are frames, at {fps:g} Hz"
    if not jumps.any():
        return sentence
    at = np.flatnonzero(jumps)
    shown = join_names([f"{steps[i]:.4g} s after frame {i}" for i in at.tolist()], most=4)
    return f"{sentence}; times jump {shown}: the recording is split there, and seconds count frames"


def _round_rate(fps: float, share: float) -> float:
    """Return the rate to thousandths of a hertz where it is within this share of that."""
    rounded = round(fps, 3)
    return rounded if rounded > 0 and abs(fps - rounded) <= share * fps else fps
