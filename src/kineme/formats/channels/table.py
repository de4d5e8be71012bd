"""Columns of numbers: which are wanted as channels, which tell times, which count rows."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme.formats.columns import is_timing, timed
from kineme.formats.files import FileContent, unique
from kineme.formats.timing import Timing

Floats = NDArray[np.float64]

COUNTERS = frozenset(
    {"frame", "frames", "frame#", "index", "idx", "sample", "row", "id", "unnamed: 0"}
    | {"__index_level_0__"}
)
"""Names of columns that count rows."""

NAMELESS = "(no name)"
"""What a column is called whose name is empty."""


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
    """

    names: list[str]
    values: Floats
    timing: Mapping[str, ArrayLike]
    rate: float | None = None
    notes: tuple[str, ...] = ()

    def timed(self, content: FileContent, fps: float | None) -> Timing:
        """Frames per second, pauses, and what was seen of the times."""
        if fps or self.rate:
            return Timing(fps or self.rate or 0.0)
        if not self.timing:
            raise content.error("nothing in it tells the frame rate: give fps (--fps)")
        return timed(content, self.timing, None)


def wanted_columns(
    content: FileContent, names: list[str], columns: Sequence[str] | None, numeric: Iterable[str]
) -> list[str]:
    """The columns to read: those asked for, or all that hold numbers, and those of times."""
    for name in columns or ():
        if name not in names:
            raise content.error(f"no column {name!r}; there are {', '.join(names)}")
    if columns is not None and len(set(columns)) < len(columns):
        raise content.error("a column is asked for twice")
    timing = [name for name in numeric if is_timing(name)]
    chosen = list(numeric) if columns is None else list(columns)
    return [*chosen, *(name for name in timing if name not in chosen)]


def channel_table(
    content: FileContent,
    names: list[str],
    values: Mapping[str, Floats],
    columns: Sequence[str] | None,
) -> ChannelTable:
    """The columns read, taken apart: channels, times, and a note of what is neither."""
    timing = {name: column for name, column in values.items() if is_timing(name)}
    if columns is not None:
        chosen, notes = list(columns), []
    else:
        chosen = [name for name in values if name not in timing and not _counts(name)]
        left = [name for name in names if name not in chosen and name not in timing]
        notes = [f"columns that are no channels: {', '.join(left)}"] if left else []
    if not chosen:
        raise content.error(f"none of its columns is a channel ({', '.join(names)})")
    return ChannelTable(
        chosen, np.column_stack([values[name] for name in chosen]), timing, None, tuple(notes)
    )


def _counts(name: str) -> bool:
    """Whether a column of this name counts rows, as the one that pandas leaves nameless."""
    return name.strip().lower() in COUNTERS or name.startswith(NAMELESS)


def named(names: Iterable[str]) -> list[str]:
    """The names, each of them once, and none of them empty."""
    return unique(name.strip() or NAMELESS for name in names)
