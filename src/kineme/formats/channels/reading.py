"""From columns of numbers to signals: their rate, their holes, and what was inferred.

============== ==================================================================
CSV, TSV, text names in the first line, or numbers only (channels 1, 2, …);
               between commas, tabs, semicolons or blanks
Parquet        one channel per column
MOT, STO       OpenSim's coordinates, forces or other channels
C3D            the analog channels, or those of muscles, see `kineme.formats.markers.c3d`
MAT            vectors, and columns of matrices, of the length that most have
============== ==================================================================

The frame rate comes from the file (its own, or a column ``time``, ``time_ms``
or ``fps``, see `kineme.formats.columns`) or from the user. Columns that count
rows, and those that do not hold numbers, are no channels; this is said. Rows become
frames as `kineme.recordings.regular` says.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from itertools import islice

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Floats
from kineme.errors import ParameterError
from kineme.formats.delimited import NAMELESS, DelimitedText
from kineme.formats.files import FileContent
from kineme.formats.timing import find_table_timing
from kineme.recordings import Signals
from kineme.recordings.channel_names import is_channel_name
from kineme.recordings.regular import Timing, fill_gaps_in_channels
from kineme.recordings.times import NO_TIMES, name_clock

WILD = frozenset("*?[")
"""Characters by which a pattern is told from a name."""

CLOCK_ROWS = 200
"""Rows from which on a column that rises evenly is a clock or a count, and no channel."""


@dataclass(frozen=True)
class ChannelTable:
    """Columns of numbers, with what tells their rate."""

    names: list[str]  # of the channels
    values: Floats  # (rows, channels), NaN where there is nothing
    timing: Mapping[str, ArrayLike]  # columns that tell times or a rate
    rate: float | None = None  # the file's own
    notes: tuple[str, ...] = ()  # on what was left out
    hint: str = ""  # on what may tell the rate, where nothing does
    nominal: float | None = None  # what a header says beside times

    def timed(self, content: FileContent, fps: float | None) -> Timing:
        """Return frames per second, and the frame of each row."""
        if fps or self.rate:
            return Timing(fps or self.rate or 0.0)
        if not self.timing:
            raise content.error(f"nothing in it tells the frame rate: give fps (--fps){self.hint}")
        timing = find_table_timing(content, self.timing, values=self.values)
        # times rounded to milliseconds miss the rate by a little
        nominal = self.nominal or 0.0
        near = abs(timing.fps - nominal) <= 0.005 * nominal
        return replace(timing, fps=nominal) if near and timing.order is None else timing


def to_signals(content: FileContent, name: str, table: ChannelTable, fps: float | None) -> Signals:
    """Return the signals in a table of channels.

    ``fps`` stands in place of what the table tells.
    """
    timing = table.timed(content, fps)
    try:
        values, gaps, filled = fill_gaps_in_channels(timing, table.values, table.names)
    except ParameterError as error:
        raise content.error(str(error)) from None
    provenance = content.provenance(name, [*table.notes, *timing.notes, *filled])
    provenance = provenance.timed(timing.clock, timing.row_seconds)
    return Signals(values, timing.fps, table.names, gaps, provenance)


def read_text_channels(text: DelimitedText, columns: Sequence[str] | None) -> ChannelTable:
    """Return the channels of a text table: those named, in this order, or all that hold numbers."""
    text = text.numbered()
    text.refuse_interleaved()
    names, numeric, times = list(text.names), text.numeric(), text.times
    columns = select_columns(text.content, names, columns, numeric, times)
    chosen = list_needed_columns(columns, numeric, times or list(filter(name_clock, numeric)))
    places = {name: i for i, name in enumerate(names)}  # each is there once
    values = text.numbers([places[name] for name in chosen])
    read = dict(zip(chosen, values.T, strict=True))
    table = make_channel_table(text.content, names, read, columns, times)
    notes = (*text.remarks, *table.notes)
    if times or text.rate is None:
        return replace(table, notes=notes, nominal=text.rate)
    return replace(table, rate=text.rate, notes=(*notes, describe_header_rate(text.rate)))


def choose_channels(
    content: FileContent, signals: Signals, columns: Sequence[str] | None
) -> Signals:
    """Return those of a file's signals that are asked for, in this order; None for all."""
    names = select_columns(content, signals.names, columns, signals.names)
    return signals if names is None else signals.select(names)


def describe_header_rate(rate: float) -> str:
    """Return the note on a rate that stands above the names of a table."""
    return f"{rate:g} Hz, as a line above the columns says"


def select_columns(
    content: FileContent,
    names: Sequence[str],
    columns: Sequence[str] | None,
    numeric: Sequence[str],
    times: Container[str] = (),
) -> list[str] | None:
    """Return the columns that are asked for, in this order; None for all.

    A name is that column. ``acc_*`` and ``gyr_?`` are all columns of numbers that they fit, in
    the order of the file, but for times; capitals and small letters are the same.
    """
    if columns is None:
        return None
    present = set(names)
    plain = [name for name in columns if name in present]
    if len(set(plain)) < len(plain):
        raise content.error("a column is asked for twice")
    found: dict[str, None] = {}
    for pattern in columns:
        if pattern in present:
            found[pattern] = None
            continue
        fitting = [
            name
            for name in numeric
            if fnmatchcase(name.lower(), pattern.lower()) and name not in times
        ]
        if not (fitting and WILD & set(pattern)):
            raise content.error(f"no column {pattern!r}; there are {', '.join(names)}")
        found |= dict.fromkeys(fitting)
    return list(found)


def list_needed_columns(
    names: Sequence[str] | None, numeric: Iterable[str], times: Container[str] = ()
) -> list[str]:
    """Return the columns to read: those asked for, or all that hold numbers, and those of times."""
    timing = [name for name in numeric if name in times]
    chosen = numeric if names is None else names
    return [*dict.fromkeys([*chosen, *timing])]


def make_channel_table(
    content: FileContent,
    names: list[str],
    values: Mapping[str, Floats],
    columns: Sequence[str] | None,
    times: Mapping[str, str],
) -> ChannelTable:
    """Return the columns read, taken apart: channels, times, and a note of what is neither.

    ``times`` are the columns that tell times or a rate, and how `find_table_timing` knows them.
    """
    timing = {times[name]: column for name, column in values.items() if name in times}
    hints = [f"; {name!r} {NO_TIMES}" for name in times if name not in values]
    if not times:
        clocks = (name for name in values if name_clock(name) and _is_mostly_rising(values[name]))
        times = {name: name_clock(name) or "" for name in islice(clocks, 1)}
        timing = {called: values[name] for name, called in times.items()}
    if columns is not None:
        chosen, notes = list(columns), []
    else:
        chosen = [name for name in values if name not in times and _may_be_channel(name)]
        chosen = [name for name in chosen if np.isfinite(values[name]).any()] or chosen
        rising = {name: None for name in chosen if _is_clock(values[name])}
        if len(rising) < len(chosen):
            chosen = [name for name in chosen if name not in rising]
            hints += [
                f"; {name!r} rises by {_measure_step(values[name]):g} a row" for name in rising
            ]
        used = {*chosen, *times}
        left = [name for name in names if name not in used]
        notes = [f"columns that are no channels: {', '.join(left)}"] if left else []
    if not chosen:
        raise content.error(f"none of its columns is a channel ({', '.join(names)})")
    channels = np.column_stack([values[name] for name in chosen])
    return ChannelTable(chosen, channels, timing, None, tuple(notes), "".join(hints[:1]))


def _may_be_channel(name: str) -> bool:
    return is_channel_name(name) and not name.startswith(NAMELESS)


def _is_clock(values: Floats) -> bool:
    """Return whether a column rises all the time, by a step from a straight line at most.

    So do times and counts under names that nobody knows, and no sensor.
    """
    if len(values) < CLOCK_ROWS or not (np.diff(values) > 0).all():
        return False
    line = values[0] + _measure_step(values) * np.arange(len(values))
    return bool(np.abs(values - line).max() <= _measure_step(values))


def _is_mostly_rising(values: Floats) -> bool:
    """Return whether a column rises as clocks do, be it with holes or set now and then."""
    return len(values) >= CLOCK_ROWS and bool((np.diff(values) > 0).mean() > 0.9)


def _measure_step(values: Floats) -> float:
    return float((values[-1] - values[0]) / (len(values) - 1))
