"""Make signals from arrays, data frames and xarray, and join sensors with their own clocks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Floats, interpolate_frames
from kineme._util.checks import (
    as_floats,
    check_type,
    is_number,
    join_names,
    make_unique,
    require_extra,
    warn,
)
from kineme.errors import ParameterError
from kineme.recordings.arrays import as_rate, list_spans, mark_spans
from kineme.recordings.cells import parse_texts
from kineme.recordings.column_names import (
    describe_alternation,
    is_owner,
    name_column,
    select_channels,
)
from kineme.recordings.provenance import Note, Provenance
from kineme.recordings.recording import Recording
from kineme.recordings.regular import LONGEST_S, Timing, fill_gaps_in_channels, place_rows
from kineme.recordings.signals import Signals
from kineme.recordings.times import (
    UNITS_NAMED,
    Clock,
    as_seconds,
    find_time_unit,
    find_unnamed_clock,
    is_rate,
    is_time,
)

ASSUMED_FPS = 30.0
"""Default rows per second if neither data nor caller tell the rate."""

_ZONES_S = 26 * 3600.0  # largest difference of the clocks of two time zones


def as_signals(data: Any, *, fps: float | None = None, times: ArrayLike | None = None) -> Signals:
    """Return rows of numbers as signals at their true times.

    Guesses are reported by a `KinemeWarning`; pass `fps` or `times` to avoid them.

    Parameters
    ----------
    data : array_like, data frame, table of pyarrow or xarray object
        (rows,) or (rows, channels), NaN where missing. Counters, labels and columns without numbers
        are left out.
    fps : float, optional
        Rows per second. Rows are then frames, and the index is ignored.
    times : (rows,) array_like or str, optional
        Time of each row: numbers in any unit from any origin, dates, or texts of these; or the
        name of a column of a data frame. By default the dates in the index, the coordinate
        ``time``, or a column of that name.

    Returns
    -------
    Signals
        Frames are rows if the times are even, else see `kineme.recordings.regular`.

    Raises
    ------
    ParameterError
        No numbers, times without a rate, or numbers of times and rows differ.

    Examples
    --------
    >>> import kineme
    >>> kineme.as_signals([0.0, 1.0, 3.0, 4.0], times=[0, 0.1, 0.3, 0.4]).values.ravel().tolist()
    [0.0, 1.0, 2.0, 3.0, 4.0]
    """
    return read_samples(data, fps=fps, times=times)[0]


def read_samples(
    data: Any,
    *,
    fps: float | None = None,
    times: ArrayLike | None = None,
    assumed_fps: float = ASSUMED_FPS,
) -> tuple[Signals, Timing]:
    """Return the signals of `as_signals`, and the frame of each row.

    ``assumed_fps`` is used if neither data nor caller tell the rate.
    """
    if hasattr(data, "column_names") and hasattr(data, "to_pandas"):  # a table of pyarrow
        with require_extra("pandas", "tables"):
            data = data.to_pandas()
    unit = None
    if isinstance(times, str):
        if times not in getattr(data, "columns", ()):
            raise ParameterError(
                f"times is {times!r:.60}: give a time for each row, or the name of a column of a "
                "data frame"
            )
        unit = find_time_unit(times)
        times, data = data[times], data.drop(columns=times)
    samples = _convert_samples(data)
    if times is not None:
        samples = replace(samples, times=times, unit=unit)
    timing, notes = _find_rate_and_frames(samples, fps, times, assumed_fps)
    values, names, gaps, filled = fill_gaps_in_channels(timing, samples.values, samples.names)
    notes = [*samples.notes, *notes, *timing.notes, *filled]
    provenance = Provenance().noted(*notes).timed(timing.clock, timing.row_seconds)
    if remarks := provenance.warnings:
        warn("; ".join(remarks))
    return Signals(values, timing.fps, names, gaps, provenance), timing


@dataclass(frozen=True, eq=False)
class _Samples:
    """Rows of channels, and data about their times."""

    values: Floats
    names: tuple[str, ...]
    times: Any = None
    unit: str | None = None
    rate: float | None = None
    order: Any = None  # sorts rows by a shuffled integer index
    notes: list[Note | str] = field(default_factory=list)


def _find_rate_and_frames(
    samples: _Samples, fps: float | None, times: ArrayLike | None, assumed_fps: float
) -> tuple[Timing, list[Note | str]]:
    """Return the rate and frames of rows, and notes.

    Times that the caller gives are always used, with the rate as that of the frames if it is given,
    too. Without them a given rate makes each row a frame, and the times in the data are ignored.
    """
    n = len(samples.values)
    if samples.times is not None and (fps is None or times is not None):
        try:
            seconds, guessed_unit = as_seconds(samples.times, samples.unit)
        except (ValueError, TypeError) as error:
            raise ParameterError(f"the times are not valid: {error}") from None
        if seconds.shape != (n,):
            raise ParameterError(
                f"times have shape {seconds.shape}: give one for each of the {n} rows"
            )
        # A rate of 0 is estimated from the times.
        timing = place_rows(seconds, samples.values, fps=0.0 if fps is None else as_rate(fps))
        if guessed_unit is None:
            return timing, []
        guess = f"times are read in {UNITS_NAMED[guessed_unit]}, inferred from their steps"
        return timing, [Note(guess, "warning")]
    notes: list[Note | str] = []
    rate = samples.rate if fps is None else as_rate(fps)
    if rate is None:
        rate = assumed_fps
        notes = [Note(f"{rate:g} rows a second assumed: give fps= or times=", "warning")]
    if samples.order is None:
        return Timing(rate), notes
    notes.append(Note("rows are not in the order of their index: sorted", "warning"))
    frames = np.arange(n, dtype=np.float64)
    return Timing(rate, order=samples.order, at=frames, n_frames=n), notes


def _convert_samples(data: Any) -> _Samples:
    """Return the rows of an array, a data frame or series, or an xarray object."""
    if isinstance(data, list | tuple) and any(isinstance(each, Recording) for each in data):
        raise ParameterError(
            "this is a list of recordings: give one at a time; kineme.join_signals joins sensors "
            "that recorded at the same time"
        )
    if isinstance(data, Signals):
        raise ParameterError("these are signals already and have their own fps: leave fps= out")
    if hasattr(data, "dims") and hasattr(data, "coords"):
        return _convert_xarray(data)
    if hasattr(data, "to_frame") and hasattr(data, "index"):
        data = data.to_frame()  # a series
    if hasattr(data, "columns") and hasattr(data, "__getitem__"):
        return _convert_frame(data)
    values = as_floats(data, "signals")
    if values.ndim == 1:
        values = values[:, None]
    if values.ndim != 2 or 0 in values.shape:
        raise ParameterError(f"signals are rows x channels, not of shape {values.shape}")
    return _Samples(values, tuple(map(str, range(1, values.shape[1] + 1))))


def _convert_xarray(data: Any) -> _Samples:
    """Return variables along ``time`` or the first dimension, one channel per column."""
    arrays = list(data.data_vars.values()) if hasattr(data, "data_vars") else [data]
    along = "time" if "time" in data.dims else next(iter(data.dims), None)
    columns = [
        pair for array in arrays if along in array.dims for pair in _list_columns(array, along)
    ]
    if not columns:
        raise ParameterError("no numeric variable has a dimension such as time")
    names, values = zip(*columns, strict=True)
    times = data.coords[along].values if along == "time" and along in data.coords else None
    return _Samples(
        np.column_stack(values).astype(np.float64),
        tuple(make_unique(names, allow_empty=True)),
        times,
    )


def _list_columns(array: Any, along: Any) -> Iterator[tuple[str, Any]]:
    """Yield the name and values of each column of a numeric data array.

    ``along`` is the time dimension. Names combine that of the array and the column's labels.
    """
    if array.dtype.kind not in "iufb":
        return
    others = [dim for dim in array.dims if dim != along]
    values = array.transpose(along, *others).values
    prefix = [] if array.name is None else [str(array.name)]
    labels = [
        array.coords[d].values if d in array.coords else range(array.sizes[d]) for d in others
    ]
    for index in np.ndindex(*values.shape[1:]):
        parts = [str(label[i]) for label, i in zip(labels, index, strict=True)]
        # A single column without any name is called "1".
        yield "_".join([*prefix, *parts]) or "1", values[(slice(None), *index)]


def _convert_frame(frame: Any) -> _Samples:
    """Return the numeric columns of a data frame, and its times."""
    names = list(frame.columns)
    by_place = getattr(frame, "iloc", None)
    columns = [frame[n] if by_place is None else by_place[:, i] for i, n in enumerate(names)]
    texts = {i: c for i, c in enumerate(columns) if str(c.dtype) in ("object", "str", "string")}
    parsed, remarks = parse_texts(texts)
    columns = [parsed.get(i, column) for i, column in enumerate(columns)]
    kinds = [getattr(column.dtype, "kind", "O") for column in columns]
    called = [*map(name_column, names)]
    numbers = [i for i, kind in enumerate(kinds) if kind in "iufb"]
    dates = [i for i, kind in enumerate(kinds) if kind in "mM"]
    timing = [i for i, name in enumerate(called) if is_time(name)]
    timing = timing or find_unnamed_clock(called, dates)
    rates = [i for i, name in enumerate(called) if is_rate(name) and i in numbers]
    chosen = [i for i in numbers if i not in (*timing, *rates)]
    measured = select_channels(called[i] for i in chosen)
    chosen = [i for i in chosen if called[i] in measured]
    chosen = [i for i in chosen if np.isfinite(_convert_numbers(columns[i])).any()] or chosen
    if not chosen:
        raise ParameterError(f"none of the columns is a channel ({join_names(called)})")
    owners = {name: columns[i] for i, name in enumerate(called) if is_owner(name)}
    if error := describe_alternation(owners):
        raise ParameterError(error)
    left = [called[i] for i in range(len(called)) if i not in (*chosen, *timing[:1])]
    notes: list[Note | str] = [*remarks]
    if left:
        notes.append(f"columns that are not channels: {', '.join(left)}")
    values = np.column_stack([_convert_numbers(columns[i]) for i in chosen])
    channels = tuple(make_unique((called[i] for i in chosen), allow_empty=True))
    found = _Samples(values, channels, notes=notes)
    index: Any = getattr(frame, "index", None)
    kind = getattr(getattr(index, "dtype", None), "kind", "O")
    named = isinstance(getattr(index, "name", None), str) and is_time(index.name)
    if kind in "mM" or (named and kind in "iufO"):
        return replace(found, times=index, unit=find_time_unit(index.name) if named else None)
    if timing:
        return replace(found, times=columns[timing[0]], unit=find_time_unit(called[timing[0]]))
    if rates:
        rate = _convert_numbers(columns[rates[0]])
        # A rate column must be constant.
        if rate[0] > 0 and np.ptp(rate) == 0:
            return replace(found, rate=float(rate[0]))
    if kind in "iu" and not index.is_monotonic_increasing and index.is_unique:
        return replace(found, order=np.argsort(np.asarray(index), kind="stable"))
    return found


def _convert_numbers(column: Any) -> Floats:
    """Return a column as numbers, NaN for missing values of pandas."""
    try:
        return np.asarray(column, np.float64)
    except (ValueError, TypeError):
        return np.asarray(column.to_numpy(dtype=np.float64, na_value=np.nan))


def join_signals(*signals: Signals, offsets: Sequence[float] | None = None) -> Signals:
    """Return the channels of several sensors on one clock, while all of them recorded.

    Parameters
    ----------
    *signals : Signals
        Recorded at the same time, each with its own rate and clock.
    offsets : sequence of float, optional
        Start of each in seconds on a common clock. By default their clocks are used if they
        overlap; else all start at once, with a warning.

    Returns
    -------
    Signals
        At the highest rate, with the gaps of all. Names that occur more than once get the name of
        their file, or a number, as a prefix.

    Raises
    ------
    ParameterError
        They do not overlap, or are not signals.

    Examples
    --------
    >>> import kineme
    >>> one = kineme.Signals([0.0, 2.0, 4.0], 1.0, ["acc"])
    >>> other = kineme.Signals([0.0, 1.0, 2.0, 3.0, 4.0], 2.0, ["gyro"])
    >>> kineme.join_signals(one, other, offsets=[0, 0]).values.tolist()
    [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 3.0], [4.0, 4.0]]
    """
    for sensor in signals:
        check_type(sensor, Signals, "join_signals", "kineme.as_signals(array, fps=...) gives some")
    if not signals:
        raise ParameterError("join_signals takes one or more signals")
    clocks, notes = _compare_clocks(signals, offsets)
    begins = [float(clock.time(0.0)) for clock in clocks]
    ends = [
        float(clock.time((sensor.n_frames - 1) / sensor.fps))
        for clock, sensor in zip(clocks, signals, strict=True)
    ]
    fps = max(sensor.fps for sensor in signals)
    # Keep the frames of the fastest sensor, from the first one at which all have started.
    grid = next(at for at, sensor in zip(begins, signals, strict=True) if sensor.fps == fps)
    start = grid + np.ceil((max(begins) - grid) * fps - 1e-3) / fps
    n_frames = int(np.floor((min(ends) - start) * fps + 1e-3)) + 1
    if n_frames < 1:
        raise ParameterError(
            "the recordings do not overlap in time: the last begins "
            f"{max(begins) - min(ends):.4g} s after the first ends; offsets= sets when each "
            "begins"
        )
    lost = max(ends) - min(begins) - (n_frames - 1) / fps
    if lost > LONGEST_S:
        remark = f"{lost:.4g} s left out in which not all sensors recorded"
        notes.append(Note(remark, "warning" if lost > n_frames / fps else "info"))
    if doubts := [note for note in notes if isinstance(note, Note) and note.severity == "warning"]:
        warn("; ".join(doubts))
    times = start + np.arange(n_frames) / fps
    columns, missing = [], np.zeros(n_frames, np.bool_)
    for clock, sensor in zip(clocks, signals, strict=True):
        seconds = clock.second(times)
        at = np.clip(seconds * sensor.fps, 0, sensor.n_frames - 1)
        columns.append(interpolate_frames(sensor.values, at))
        # The gaps of this sensor are looked up at the nearest frames.
        hidden = mark_spans(sensor.gaps, sensor.n_frames)
        missing |= hidden[np.rint(at).astype(np.intp)]
        missing |= np.abs(clock.time(seconds) - times) > LONGEST_S  # times within a pause
    names = _make_names_unique(signals)
    source = signals[0].provenance
    notes = [*(note for sensor in signals for note in sensor.provenance.notes), *notes]
    joined = Provenance(source.path, source.format, source.sha256).noted(*dict.fromkeys(notes))
    begun = Clock([0.0], [start]) if abs(start) > 0.5 / fps else None
    values = np.concatenate(columns, axis=1)
    return Signals(values, fps, names, list_spans(missing), joined.timed(begun))


def _compare_clocks(
    signals: Sequence[Signals], offsets: Sequence[float] | None
) -> tuple[list[Clock], list[Note | str]]:
    """Return a clock for each, all with the same origin, and notes."""
    clocks = [each.provenance.clock or Clock([0.0], [0.0]) for each in signals]
    if offsets is not None:
        if len(offsets) != len(signals) or not all(map(is_number, offsets)):
            raise ParameterError(f"offsets are {len(signals)} numbers, not {offsets!r:.60}")
        return [
            Clock(clock.seconds, [time + offset for time in clock.make_relative().times])
            for clock, offset in zip(clocks, offsets, strict=True)
        ], []
    stops = [float(c.time(each.duration)) for c, each in zip(clocks, signals, strict=True)]
    overlap = min(stops) - max(clock.times[0] for clock in clocks)
    # Dates have one origin; times that count from any other must overlap for long.
    dates = all(clock.shows_dates for clock in clocks)
    enough = 0.0 if dates else 0.5 * min(each.duration for each in signals)
    if overlap > enough or (dates and overlap < -_ZONES_S):
        return clocks, []
    reason = "the sensors have no common clock"
    if dates:
        reason = f"the recordings do not overlap ({-overlap:.5g} s apart)"
    remark = f"{reason}: assumed to begin together (kineme.join_signals takes their offsets)"
    return [clock.make_relative() for clock in clocks], [Note(remark, "warning")]


def _make_names_unique(signals: Sequence[Signals]) -> tuple[str, ...]:
    """Return the names of all channels, with the sensor as a prefix if several have the name."""
    every = [name for each in signals for name in each.names]
    stems = [Path(each.provenance.path or str(k)).stem for k, each in enumerate(signals, 1)]
    if len(set(stems)) < len(stems):
        stems = [str(k) for k in range(1, len(signals) + 1)]
    names = (
        f"{stem}_{name}" if every.count(name) > 1 else name
        for stem, each in zip(stems, signals, strict=True)
        for name in each.names
    )
    return tuple(make_unique(names, allow_empty=True))
