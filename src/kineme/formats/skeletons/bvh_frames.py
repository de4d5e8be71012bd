"""The channel values of a BVH file, a line per frame as nearly every file has them.

The text is taken in pieces, its numbers go into one array: more is not held at a time.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Iterator
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from kineme._counts import counted
from kineme.errors import ReadError
from kineme.formats.files import FileContent, numbers

Floats = NDArray[np.float64]

PIECE = 1 << 20
"""Bytes of text that are split into words at a time."""

_GLUED = re.compile(rb"(?<=[0-9.])-")


def read_frames(content: FileContent, start: int, width: int, declared: int) -> Floats:
    """Channel values, (frames, width), from the bytes after ``start``.

    The last line may break off, which is warned about. Lines laid out otherwise than one per
    frame are taken as one stream of numbers, if exactly the declared frames come of it.
    """
    if width == 0:
        raise content.error("no joint has a channel, so there is no motion")
    values = array("d")
    odd: list[tuple[int, int]] = []
    fault: ReadError | None = None
    glued = 0
    last = number = content.line_at(start)
    for number, line in enumerate(_lines(content.data, start), last):
        last = number
        if fault is not None:  # which is pardoned in the last line alone
            raise fault
        try:
            row, apart = _row(line)
        except ValueError as error:
            fault = content.error(str(error), number)
            continue
        glued += apart
        values.extend(row)
        if row and len(row) != width:
            odd.append((number, len(row)))
    if odd and (fault or len(values) != width * declared):
        number, found = odd[0]
        fault = content.error(f"{found} values, but the hierarchy has {width} channels", number)
        if number < last or found > width:
            raise fault
        del values[-found:]
    if not values:
        raise fault or content.error("the file ends before its first frame: there is no motion")
    if fault is not None:
        content.warn(f"{fault.reason}: the last frame is truncated and left out", fault.line)
    if glued:
        content.warn(
            f"blanks before minus signs are missing in {counted(glued, 'frame')}: put there"
        )
    return np.frombuffer(values).reshape(-1, width)


def read_some(data: bytes, start: int, width: int, every: int) -> Floats | None:
    """The values of each ``every``-th frame only; None where lines are not one per frame."""
    lines = (line for line in _lines(data, start) if line.strip())
    try:
        rows = [numbers(line.split()) for line in islice(lines, 0, None, every)]
    except ValueError:
        return None
    return np.array(rows) if rows and all(len(row) == width for row in rows) else None


def _lines(data: bytes, start: int) -> Iterator[bytes]:
    """The lines from ``start`` on, without the blank ones at the end; a piece at a time."""
    stop = _end(data, start)
    while start < stop:
        cut = min(data.find(b"\n", start + PIECE) + 1 or stop, stop)
        yield from data[start:cut].splitlines()
        start = cut


def _end(data: bytes, start: int) -> int:
    """Where blanks and empty lines follow only."""
    for at in range(len(data), start, -PIECE):
        first = max(start, at - PIECE)
        if kept := data[first:at].rstrip():
            return first + len(kept)
    return start


def _row(line: bytes) -> tuple[list[float], bool]:
    """The numbers of a line, and whether some were not apart (``0.0-7.5``, as SlimeVR wrote)."""
    try:
        return numbers(line.split()), False
    except ValueError:
        apart = _GLUED.sub(b" -", line)
        if apart == line:
            raise
        return numbers(apart.split()), True
