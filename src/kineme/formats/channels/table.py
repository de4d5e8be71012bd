"""Columns of numbers: which are wanted as channels, which tell times, which count rows."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme.formats.columns import is_timing, timed
from kineme.formats.files import FileContent, unique
from kineme.formats.timing import NO_TIMES, Timing

Floats = NDArray[np.float64]

COUNTERS = frozenset(
    {"frame", "frames", "frame#", "index", "idx", "sample", "row", "id", "unnamed: 0"}
    | {"__index_level_0__"}
)
"""Names of columns that count rows."""

LABELS = frozenset(
    {"label", "labels", "class", "annotation", "ground_truth"} | {"class_id", "label_id"}
)
"""Names of columns in which people say what is done."""
WILD = frozenset("*?[")
"""Characters by which a pattern is told from a name."""

NAMELESS = "(no name)"
"""What a column is called whose name is empty."""

CLOCK_ROWS = 200
"""Rows from which on a column that rises evenly is a clock or a count, and no channel."""


@dataclass(frozen=True)
class ChannelTable:
    """Columns of numbers.

    Parameters
    ----------
    names : list of str
        Of the channels.
    values : ndarray, shape (rows, channels)
        NaN where there is nothing.
    timing : mapping of str to array_like
        Columns that tell times or a rate.
    rate : float, optional
        The file's own.
    notes : tuple of str
        On what was left out.
    hint : str
        On what may tell the rate, where nothing does.
    """

    names: list[str]
    values: Floats
    timing: Mapping[str, ArrayLike]
    rate: float | None = None
    notes: tuple[str, ...] = ()
    hint: str = ""

    def timed(self, content: FileContent, fps: float | None) -> Timing:
        """Frames per second, pauses, and what was seen of the times."""
        if fps or self.rate:
            return Timing(fps or self.rate or 0.0)
        if not self.timing:
            raise content.error(f"nothing in it tells the frame rate: give fps (--fps){self.hint}")
        return timed(content, self.timing, None)


def asked_for(
    content: FileContent,
    names: Sequence[str],
    columns: Sequence[str] | None,
    numeric: Sequence[str],
) -> list[str] | None:
    """The columns that are asked for, in this order; None for all.

    A name is that column. ``acc_*`` and ``gyr_?`` are all columns of numbers that they fit, in
    the order of the file, but for times; capitals and small letters are the same.
    """
    if columns is None:
        return None
    known = set(names)
    plain = [name for name in columns if name in known]
    if len(set(plain)) < len(plain):
        raise content.error("a column is asked for twice")
    found: dict[str, None] = {}
    for pattern in columns:
        if pattern in known:
            found[pattern] = None
            continue
        fitting = [
            name
            for name in numeric
            if fnmatchcase(name.lower(), pattern.lower()) and not is_timing(name)
        ]
        if not (fitting and WILD & set(pattern)):
            raise content.error(f"no column {pattern!r}; there are {', '.join(names)}")
        found |= dict.fromkeys(fitting)
    return list(found)


def wanted_columns(names: Sequence[str] | None, numeric: Iterable[str]) -> list[str]:
    """The columns to read: those asked for, or all that hold numbers, and those of times."""
    timing = [name for name in numeric if is_timing(name)]
    chosen = numeric if names is None else names
    return [*dict.fromkeys([*chosen, *timing])]


def channel_table(
    content: FileContent,
    names: list[str],
    values: Mapping[str, Floats],
    columns: Sequence[str] | None,
) -> ChannelTable:
    """The columns read, taken apart: channels, times, and a note of what is neither."""
    timing = {name: column for name, column in values.items() if is_timing(name)}
    hints = [f"; {name!r} {NO_TIMES}" for name in names if is_timing(name) and name not in timing]
    if columns is not None:
        chosen, notes = list(columns), []
    else:
        chosen = [name for name in values if name not in timing and not _is_told(name)]
        clocks = {name: None for name in chosen if _is_clock(values[name])}
        if len(clocks) < len(chosen):
            chosen = [name for name in chosen if name not in clocks]
            hints += [f"; {name!r} rises by {_step(values[name]):g} a row" for name in clocks]
        used = {*chosen, *timing}
        left = [name for name in names if name not in used]
        notes = [f"columns that are no channels: {', '.join(left)}"] if left else []
    if not chosen:
        raise content.error(f"none of its columns is a channel ({', '.join(names)})")
    channels = np.column_stack([values[name] for name in chosen])
    return ChannelTable(chosen, channels, timing, None, tuple(notes), "".join(hints[:1]))


def _is_told(name: str) -> bool:
    """Whether a column of this name counts rows, is nameless, or says what is done."""
    plain = name.strip().lower()
    return plain in COUNTERS or plain in LABELS or name.startswith(NAMELESS)


def _is_clock(values: Floats) -> bool:
    """Whether a column rises all the time, by a step from a straight line at most.

    So do times and counts under names that nobody knows, and no sensor.
    """
    if len(values) < CLOCK_ROWS or not (np.diff(values) > 0).all():
        return False
    line = values[0] + _step(values) * np.arange(len(values))
    return bool(np.abs(values - line).max() <= _step(values))


def _step(values: Floats) -> float:
    return float((values[-1] - values[0]) / (len(values) - 1))


def named(names: Iterable[str]) -> list[str]:
    """The names, each of them once, and none of them empty."""
    return unique(name.strip() or NAMELESS for name in names)
