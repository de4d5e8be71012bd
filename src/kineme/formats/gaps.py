"""Frames in which a point was not seen: NaN in, numbers out, or a list of what is missing.

Gaps of up to 0.2 s are filled along a monotone cubic (PCHIP) through the frames
in which the point was seen; at either end of the recording its nearest position
is held. Nothing else is made up.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Spans = NDArray[np.intp]

LONGEST_S = 0.2
"""Seconds: gaps up to this long are filled."""


@dataclass(frozen=True)
class Gaps:
    """What was filled and what was not.

    ``filled`` is the number of frames filled in each point that had a short
    gap, by its index; ``open`` the spans [start, stop) left in a point.
    """

    filled: dict[int, int]
    open: dict[int, Spans]


def fill_gaps(points: Floats, fps: float) -> Gaps:
    """Fill the short gaps of ``points`` (frames, points, 3) in place.

    A point that is not a number in any coordinate counts as not seen.
    """
    missing = np.asarray(np.isnan(points).any(axis=2))
    longest = int(LONGEST_S * fps + 1e-9)
    gaps = Gaps({}, {})
    for point in np.flatnonzero(missing.any(axis=0)).tolist():
        spans = spans_of(missing[:, point])
        lengths = spans[:, 1] - spans[:, 0]
        long = np.asarray((lengths > longest) | (lengths == len(points)))
        at = np.concatenate([np.arange(*span) for span in spans[~long]] or [np.empty(0, np.intp)])
        if len(at):
            seen = np.flatnonzero(~missing[:, point])
            points[at, point] = _between(seen, points[seen, point], at)
            gaps.filled[point] = len(at)
        if long.any():
            gaps.open[point] = spans[long]
    return gaps


def spans_of(mask: NDArray[np.bool_]) -> Spans:
    """(spans, 2): where the mask is true, half-open."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(np.int8)))
    return edges.reshape(-1, 2)


def _between(seen: NDArray[np.intp], values: Floats, at: NDArray[np.intp]) -> Floats:
    """(at, 3): the values at frames that were not seen."""
    if len(seen) == 1:
        return np.repeat(values, len(at), axis=0)
    from scipy.interpolate import PchipInterpolator

    inside = np.clip(at, seen[0], seen[-1])
    return np.asarray(PchipInterpolator(seen, values)(inside), np.float64)
