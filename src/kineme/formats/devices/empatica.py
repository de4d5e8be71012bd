"""Empatica's wristbands: one file a sensor, without names.

The first row tells when the recording began, the second its frame rate, once for each column. What
the columns are only the name of the file tells.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice

from kineme.formats.delimited import DelimitedText, cells_of, is_finite
from kineme.formats.devices.device import Device
from kineme.formats.files import FileContent
from kineme.formats.sniffing import is_row

SINCE_2001 = 1e9
"""Seconds since 1970: a first row of these tells when a recording began."""


def find(content: FileContent) -> DelimitedText:
    """Return the table below the first two rows, its columns named after the file."""
    lines = content.text.splitlines()
    full = _first_rows(lines)
    width = len(cells_of(lines[full[2]], ","))
    axes = [f"_{axis}" for axis in "xyz"] if width == 3 else [f"_{i + 1}" for i in range(width)]
    called = content.path.stem.lower()
    names = [called] if width == 1 else [f"{called}{axis}" for axis in axes]
    return DelimitedText(content, lines, names, full[2], full[2], ",", rate=_rate(lines))


def _first_rows(lines: Sequence[str]) -> list[int]:
    full = (i for i, line in enumerate(lines) if line.strip() and line[0] != "#")
    return list(islice(full, 3))


def _rate(lines: Sequence[str]) -> float | None:
    """Return the second row's number below a first row of seconds since 1970; None for others."""
    rows = [cells_of(lines[i], ",") for i in _first_rows(lines)]
    if len(rows) < 3 or len({len(row) for row in rows}) > 1 or not all(map(is_row, rows)):
        return None
    starts, rates = ({float(cell) if is_finite(cell) else 0.0 for cell in row} for row in rows[:2])
    start, rate = max(starts), max(rates)
    if len(starts) > 1 or len(rates) > 1 or start < SINCE_2001:
        return None
    return rate if 0 < rate < start else None


DEVICE = Device("Empatica", lambda lines: _rate(lines) is not None, find)
