"""Holes in channels: short ones are filled in a straight line, long ones split the recording."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kineme.formats.files import Source
from kineme.formats.gaps import LONGEST_S, spans_of

Floats = NDArray[np.float64]


def without_gaps(
    source: Source, values: Floats, fps: float, names: Sequence[str]
) -> tuple[Floats, list[tuple[int, int]], list[str]]:
    """Finite values, the stretches in which a channel is missing for long, and what was done.

    Parameters
    ----------
    values : (frames, channels), NaN or infinite where there is nothing
    fps : frames per second
    names : of the channels

    Raises
    ------
    ReadError : the holes leave nothing
    """
    missing = ~np.isfinite(values)
    if not missing.any():
        return values, [], []
    if missing.all(axis=0).any():
        name = names[int(missing.all(axis=0).argmax())]
        raise source.error(f"column {name!r} holds no number at all: name the others (--columns)")
    filled = np.array(values)
    long = np.zeros(len(values), np.bool_)
    for channel in np.flatnonzero(missing.any(axis=0)).tolist():
        seen = np.flatnonzero(~missing[:, channel])
        at = np.flatnonzero(missing[:, channel])
        filled[at, channel] = np.interp(at, seen, values[seen, channel])
        for start, stop in spans_of(missing[:, channel]).tolist():
            if stop - start > LONGEST_S * fps + 1e-9:
                long[start:stop] = True
    if long.all():
        raise source.error("in every frame some channel is missing for long: choose columns")
    gaps = [(start, stop) for start, stop in spans_of(long).tolist()]
    notes = [f"{int((missing & ~long[:, None]).sum())} missing values filled in a straight line"]
    if gaps:
        notes.append(f"{len(gaps)} gaps of more than {LONGEST_S:g} s, {int(long.sum())} frames")
    return filled, gaps, notes
