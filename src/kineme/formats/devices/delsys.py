"""Read Delsys Trigno: channels follow their own columns of times, each at its own rate.

EMGworks writes ``X[s],"biceps: EMG 1 [Volts]",X[s],"biceps: ACC X [g]"``. Trigno Discover writes
names such as ``EMG 1 Time Series (s),EMG 1 (mV)`` below lines of sensors and their modes. Slower
channels end with empty cells or zeros. All channels are interpolated at the times of the fastest.
"""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import accumulate, chain, repeat

import numpy as np

from kineme._util.arrays import Floats
from kineme._util.checks import format_count
from kineme.formats.channels.reading import ChannelTable, to_signals
from kineme.formats.delimited import DelimitedText, make_unique_names, split_cells
from kineme.formats.devices import Layout, begins_with
from kineme.formats.dialects import Dialect
from kineme.formats.options import ReadOptions
from kineme.recordings import Signals
from kineme.recordings.cells import is_number

_TIME = r'"?(?:X ?\[s\]|[^,;\t]*Time Series \(s\))'
_EMG = re.compile(r"\bEMG\b")
_NUMBER = re.compile(r" *\(\d+\)$")  # number of a sensor


def read(text: DelimitedText, options: ReadOptions) -> Signals:
    """Return all channels at the rate of the fastest, or with ``emg`` those of muscles."""
    content, table = text.content, Layout(head=_TIME)(text)
    is_time = [re.match(_TIME, name) is not None for name in table.names]
    # Each channel belongs to the nearest column of times on its left.
    clocks = [*accumulate((i if time else 0 for i, time in enumerate(is_time)), max)]
    names = make_unique_names(_prefix_sensors(table))
    chosen = [i for i, time in enumerate(is_time) if not time]
    if options.emg:
        chosen = [i for i in chosen if _EMG.search(names[i])]
    if not chosen:
        raise content.error(f"none of its columns is a channel ({', '.join(names)})")
    # Discover writes the rates between names and rows.
    firsts = (split_cells(line, table.separator)[0] for line in table.rows)
    skipped = next((i for i, first in enumerate(firsts) if is_number(first)), 0)
    columns = replace(table, first_row=table.first_row + skipped).numbers().T
    lengths = [_count_times(columns[clock]) for clock in clocks]
    fastest = max(chosen, key=lengths.__getitem__)
    times = columns[clocks[fastest], : lengths[fastest]]
    values = []
    for i in chosen:
        sample_times, samples = columns[[clocks[i], i], : lengths[i]]
        values.append(np.interp(times, sample_times, samples, left=np.nan, right=np.nan))
    slower = sum(lengths[i] < len(times) for i in chosen)
    notes = (f"{format_count(slower, 'slower channel')} interpolated",) if slower else ()
    chosen_names, timing = [names[i] for i in chosen], {"time (s)": times}
    channels = ChannelTable(chosen_names, np.stack(values, 1), timing, notes=notes)
    return to_signals(content, "Delsys table", channels, options.fps)


def _prefix_sensors(table: DelimitedText) -> list[str]:
    """Return the names of columns with the sensor's name in front, if a line above states it."""
    above = [line for line in table.lines[: table.head] if line.strip(f"{table.separator} ")]
    if len(above) < 2 or not above[-1].startswith("sensor mode"):
        return [*table.names]
    names = split_cells(table.lines[table.head], table.separator)[: len(table.names)]
    # Only the first column of a sensor has its name above.
    sensors = [_NUMBER.sub("", cell) for cell in split_cells(above[-2], table.separator)]
    filled: accumulate[str] = accumulate(
        chain(sensors, repeat("")), lambda sensor, cell: cell or sensor
    )
    return [f"{sensor} {name}" for name, sensor in zip(names, filled, strict=False)]


def _count_times(times: Floats) -> int:
    """Return the number of times before the first one that is empty or does not rise."""
    ends = np.flatnonzero(~(np.diff(times) > 0))
    return int(ends[0]) + 1 if len(ends) else len(times)


DIALECT = Dialect("Delsys", begins_with(_TIME, within=60), read)
