"""Convert columns of numbers to signals: find their rate, fill gaps, and note what was inferred.

============== ==================================================================
CSV, TSV, text names in the first line, or only numbers (channels 1, 2, …);
               separated by commas, tabs, semicolons or blanks
Parquet        one channel per column
MOT, STO       OpenSim's coordinates, forces or other channels
C3D            all analog channels, or the muscles', see `kineme.formats.markers.c3d`
MAT            vectors and columns of matrices that have the most frequent length
============== ==================================================================

The frame rate comes from the file (its header, or a column ``time``, ``time_ms`` or ``fps``, see
`kineme.formats.points`) or from the user. Columns that count rows or hold no numbers are not
channels; a note lists them. `kineme.recordings.regular` converts rows to frames.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Floats
from kineme.errors import ParameterError
from kineme.formats.delimited import NAMELESS, DelimitedText
from kineme.formats.files import RATE_ROUNDING, FileContent
from kineme.formats.sniffing import find_table_timing
from kineme.recordings import Signals
from kineme.recordings.column_names import select_channels
from kineme.recordings.regular import Timing, fill_gaps_in_channels
from kineme.recordings.times import NO_TIMES, name_clock

WILDCARDS = frozenset("*?[")
"""Characters that distinguish a pattern from a name."""

MIN_CLOCK_ROWS = 200
"""Minimum number of rows of an evenly rising column that counts as a clock or counter."""


@dataclass(frozen=True)
class ChannelTable:
    """Columns of numbers, and columns that define their rate."""

    names: list[str]  # of the channels
    values: Floats  # (rows, channels), NaN where missing
    timing: Mapping[str, ArrayLike]  # columns of times or rates
    rate: float | None = None  # the file's own
    notes: tuple[str, ...] = ()  # on skipped columns
    hint: str = ""  # on columns that may be times, if the rate is unknown
    nominal: float | None = None  # rate in a header, next to columns of times

    def find_timing(self, content: FileContent, fps: float | None) -> Timing:
        """Return frames per second and the frame of each row."""
        if fps or self.rate:
            return Timing(content.choose_rate(fps, self.rate or self.nominal))
        if not self.timing:
            raise content.error(f"it does not state its frame rate: give fps (--fps){self.hint}")
        timing = find_table_timing(content, self.timing, values=self.values)
        # Times rounded to milliseconds deviate slightly from the nominal rate.
        nominal = self.nominal or 0.0
        is_near = abs(timing.fps - nominal) <= RATE_ROUNDING * nominal
        return replace(timing, fps=nominal) if is_near and timing.order is None else timing


def to_signals(content: FileContent, name: str, table: ChannelTable, fps: float | None) -> Signals:
    """Return the signals in a table of channels; ``fps`` overrides the table's rate."""
    timing = table.find_timing(content, fps)
    try:
        values, names, gaps, filled = fill_gaps_in_channels(timing, table.values, table.names)
    except ParameterError as error:
        raise content.error(str(error)) from None
    provenance = content.provenance(name, [*table.notes, *timing.notes, *filled])
    provenance = provenance.timed(timing.clock, timing.row_seconds)
    return Signals(values, timing.fps, names, gaps, provenance)


def read_text_channels(text: DelimitedText, columns: Sequence[str] | None) -> ChannelTable:
    """Return the named channels of a text table in this order, or all columns of numbers."""
    text = text.number_columns()
    names, numeric, times = list(text.names), text.find_numeric_columns(), text.times
    columns = select_columns(text.content, names, columns, numeric, times)
    text.refuse_interleaved(columns or ())
    chosen = list_needed_columns(columns, numeric, times or list(filter(name_clock, numeric)))
    places = {name: i for i, name in enumerate(names)}
    values = text.numbers([places[name] for name in chosen])
    columns_by_name = dict(zip(chosen, values.T, strict=True))
    table = make_channel_table(text.content, names, columns_by_name, columns, times)
    notes = (*text.remarks, *table.notes)
    if times or text.rate is None:
        return replace(table, notes=notes, nominal=text.rate)
    return replace(table, rate=text.rate, notes=(*notes, describe_header_rate(text.rate)))


def describe_header_rate(rate: float) -> str:
    """Return a note on a rate in a line above the table."""
    return f"{rate:g} Hz, from a line above the columns"


def select_columns(
    content: FileContent,
    names: Sequence[str],
    columns: Sequence[str] | None,
    numeric: Sequence[str],
    times: Container[str] = (),
) -> list[str] | None:
    """Return the requested columns in this order; None stands for all.

    A name selects that column. ``acc_*`` and ``gyr_?`` select all matching columns of numbers,
    except times, in the order of the file; case is ignored.
    """
    if columns is None:
        return None
    present = set(names)
    exact = [name for name in columns if name in present]
    if len(set(exact)) < len(exact):
        raise content.error("a column is selected twice")
    selected: dict[str, None] = {}
    for pattern in columns:
        if pattern in present:
            selected[pattern] = None
            continue
        matches = [
            name
            for name in numeric
            if fnmatchcase(name.lower(), pattern.lower()) and name not in times
        ]
        if not (matches and WILDCARDS & set(pattern)):
            raise content.error(f"no column {pattern!r}; there are {', '.join(names)}")
        selected |= dict.fromkeys(matches)
    return list(selected)


def list_needed_columns(
    names: Sequence[str] | None, numeric: Iterable[str], times: Container[str]
) -> list[str]:
    """Return the columns to read: those requested, or all of numbers, plus the columns of times."""
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
    """Split the columns that were read into channels and times, and note the remaining ones.

    ``times`` maps columns of times or rates to the names that `find_table_timing` knows.
    """
    timing = {times[name]: column for name, column in values.items() if name in times}
    hints = [f"; {name!r} {NO_TIMES}" for name in times if name not in values]
    if not times:
        # A clock may have gaps or jumps, but mostly rises.
        for name, column in values.items():
            clock, rises = name_clock(name), np.diff(column) > 0
            if clock and len(column) >= MIN_CLOCK_ROWS and rises.mean() > 0.9:
                times, timing = {name: clock}, {clock: column}
                break
    if columns is not None:
        chosen, notes = list(columns), []
    else:
        chosen = [name for name in values if name not in times]
        chosen = [name for name in select_channels(chosen) if not name.startswith(NAMELESS)]
        chosen = [name for name in chosen if np.isfinite(values[name]).any()] or chosen
        rising = {name: None for name in chosen if _is_clock(values[name])}
        if len(rising) < len(chosen):
            chosen = [name for name in chosen if name not in rising]
            hints += [
                f"; {name!r} rises by {_measure_step(values[name]):g} a row" for name in rising
            ]
        used = {*chosen, *times}
        unused = [name for name in names if name not in used]
        notes = [f"columns that are not channels: {', '.join(unused)}"] if unused else []
    if not chosen:
        raise content.error(f"none of its columns is a channel ({', '.join(names)})")
    channels = np.column_stack([values[name] for name in chosen])
    return ChannelTable(chosen, channels, timing, notes=tuple(notes), hint="".join(hints[:1]))


def _is_clock(values: Floats) -> bool:
    """Return whether a column always rises and deviates by at most one step from a straight line.

    Times and counters do so, whatever their names; sensors do not.
    """
    if len(values) < MIN_CLOCK_ROWS or not (np.diff(values) > 0).all():
        return False
    line = values[0] + _measure_step(values) * np.arange(len(values))
    return bool(np.abs(values - line).max() <= _measure_step(values))


def _measure_step(values: Floats) -> float:
    return float((values[-1] - values[0]) / (len(values) - 1))
