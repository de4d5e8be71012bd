"""Holes in channels: short ones are filled in a straight line, long ones split the recording."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kineme._counts import counted
from kineme._interpolation import bridge_line
from kineme.formats.files import FileContent
from kineme.formats.gaps import LONGEST_S, covered, spans_of
from kineme.formats.timing import Timing

Floats = NDArray[np.float64]


def without_gaps(
    content: FileContent, values: Floats, timing: Timing, names: Sequence[str]
) -> tuple[Floats, list[tuple[int, int]], list[str]]:
    """Finite values, the spans in which a channel is missing for long, and what was done.

    Parameters
    ----------
    values : ndarray of shape (frames, channels)
        NaN or infinite where there is nothing.
    timing : Timing
        Frames per second, and the frames at which the times jump.
    names : sequence of str
        Of the channels.

    Raises
    ------
    ReadError
        The holes leave nothing.
    """
    missing = ~np.isfinite(values)
    if not missing.any():
        return values, list(timing.gaps), []
    if missing.all(axis=0).any():
        name = names[int(missing.all(axis=0).argmax())]
        raise content.error(f"column {name!r} holds no number at all: name the others (--columns)")
    filled = np.array(values)
    long = np.zeros(len(values), np.bool_)
    for channel in np.flatnonzero(missing.any(axis=0)).tolist():
        bridge_line(filled[:, channel], missing[:, channel])
        for start, stop in spans_of(missing[:, channel]).tolist():
            if stop - start > LONGEST_S * timing.fps + 1e-9:
                long[start:stop] = True
    jumps = covered(timing.gaps, len(values))
    if (long | jumps).all():
        raise content.error("in every frame some channel is missing for long: choose columns")
    holes = spans_of(long)
    gaps = [(start, stop) for start, stop in spans_of(long | jumps).tolist()]
    short = int((missing & ~long[:, None]).sum())
    notes = [f"{counted(short, 'missing value')} filled in a straight line"] if short else []
    if len(holes):
        notes.append(
            f"{counted(len(holes), 'gap')} of more than {LONGEST_S:g} s, "
            f"{counted(int(long.sum()), 'frame')}"
        )
    return filled, gaps, notes
