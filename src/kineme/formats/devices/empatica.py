"""Read Empatica's wristbands: one file per sensor, without names.

The first row is the start time of the recording, the second its frame rate, repeated for each
column. The name of the file is the only description of the columns.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice

from kineme.formats.delimited import DelimitedText, is_finite, split_cells
from kineme.formats.dialects import Dialect
from kineme.formats.sniffing import is_row

MIN_START = 1e9
"""Seconds since 1970 (in 2001); larger numbers in the first row are start times."""


def recognises(_: Sequence[str], lines: Sequence[str]) -> bool:
    """Return whether the first row repeats a start time and the second a lower rate."""
    rows = [split_cells(lines[i], ",") for i in _find_first_rows(lines)]
    if len(rows) < 3 or len({len(row) for row in rows}) > 1 or not all(map(is_row, rows)):
        return False
    if any(len(set(row)) > 1 or not is_finite(row[0]) for row in rows[:2]):
        return False
    start, rate = (float(row[0]) for row in rows[:2])
    return start >= MIN_START and 0 < rate < start


def lay_out(text: DelimitedText) -> DelimitedText:
    """Return the table below the first two rows, with columns named after the file."""
    _, second, below = _find_first_rows(text.lines)
    width, sensor = len(split_cells(text.lines[below], ",")), text.content.path.stem.lower()
    axes = "xyz" if width == 3 else range(1, width + 1)
    names = [sensor] if width == 1 else [f"{sensor}_{axis}" for axis in axes]
    rate = float(split_cells(text.lines[second], ",")[0])
    return DelimitedText(
        text.content, text.lines, names, below, below, separator=",", rate=rate, clocks={}
    )


def _find_first_rows(lines: Sequence[str]) -> list[int]:
    full = (i for i, line in enumerate(lines) if line.strip() and line[0] != "#")
    return list(islice(full, 3))


DIALECT = Dialect("Empatica", recognises, layout=lay_out)
