"""Frames in which a point was not seen: NaN in, numbers out, or a list of what is missing.

Gaps of up to 0.2 s are filled along a monotone cubic (PCHIP) through the frames
in which the point was seen; at either end of the recording its nearest position
is held. Longer ones are listed; where the body cannot be told without the point
they split the recording, and `bridge_gaps` joins the positions around them so that
every frame has some: nobody is to look at those.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats, bridge_line
from kineme._util.checks import warn
from kineme.recordings import Motion
from kineme.recordings.arrays import find_spans
from kineme.recordings.regular import LONGEST_S

Spans = NDArray[np.intp]


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
        spans = find_spans(missing[:, point])
        lengths = spans[:, 1] - spans[:, 0]
        long = np.asarray((lengths > longest) | (lengths == len(points)))
        at = np.concatenate([np.arange(*span) for span in spans[~long]] or [np.empty(0, np.intp)])
        if len(at):
            visible = np.flatnonzero(~missing[:, point])
            points[at, point] = _interpolate_cubic(visible, points[visible, point], at)
            gaps.filled[point] = len(at)
        if long.any():
            gaps.open[point] = spans[long]
    return gaps


def bridge_gaps(
    points: Floats, gaps: Gaps, chosen: Iterable[int], fps: float
) -> tuple[tuple[int, int], ...]:
    """Return the frames [start, stop) in which any of these points has an open gap.

    They are filled.

    In place, along a straight line. What was seen for no longer than 0.2 s
    between two gaps is part of one.
    """
    n, longest = len(points), int(LONGEST_S * fps + 1e-9)
    missing = np.zeros(n, np.bool_)
    for point in chosen:
        if point not in gaps.open:
            continue
        hidden = mark_spans(gaps.open[point].tolist(), n)
        for axis in range(points.shape[2]):
            bridge_line(points[:, point, axis], hidden)
        missing |= hidden
    for start, stop in find_spans(~missing).tolist():
        if missing.any() and stop - start <= longest:
            missing[start:stop] = True
    return tuple((start, stop) for start, stop in find_spans(missing).tolist())


def mark_spans(spans: Iterable[tuple[int, int]], n: int) -> NDArray[np.bool_]:
    """(n,): whether a frame lies in any of the spans [start, stop)."""
    inside = np.zeros(n, np.bool_)
    for start, stop in spans:
        inside[start:stop] = True
    return inside


def split_at(motion: Motion, spans: Iterable[tuple[int, int]]) -> Motion:
    """Return the motion with these frames [start, stop) in its gaps, besides those that it has."""
    joined = mark_spans([*motion.gaps, *spans], motion.n_frames)
    return replace(motion, gaps=tuple((a, b) for a, b in find_spans(joined).tolist()))


def mark_gaps(motion: Motion) -> list[bool]:
    """Return for each frame whether it lies in a gap of the motion."""
    return list(map(bool, mark_spans(motion.gaps, motion.n_frames)))


def warn_of_gaps(motions: Iterable[Motion], path: Path) -> None:
    """Warn where motions have gaps, and go into a file of a format that has none."""
    seconds = sum((b - a) / motion.fps for motion in motions for a, b in motion.gaps)
    if seconds:
        warn(
            f"{path.name}: gaps of {seconds:.1f} s become movement, since the format has none: "
            "leave these clips out, or write .npz, .csv or .trc"
        )


def _interpolate_cubic(visible: NDArray[np.intp], values: Floats, at: NDArray[np.intp]) -> Floats:
    """(at, 3): the values at frames that were not seen."""
    if len(visible) == 1:
        return np.repeat(values, len(at), axis=0)
    from scipy.interpolate import PchipInterpolator

    inside = np.clip(at, visible[0], visible[-1])
    return np.asarray(PchipInterpolator(visible, values)(inside), np.float64)
