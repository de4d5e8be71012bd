"""Fill short gaps, in which a point was not seen (NaN), and list long ones.

Gaps of up to 0.2 s are filled along a monotone cubic (PCHIP) through the frames in which the point
was seen. At either end of the recording the nearest position is held. Longer gaps are listed. If
the body cannot be located without the point, the gap splits the recording, and `bridge_gaps`
interpolates the positions so that every frame has finite values, although they are not used.
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
    """Filled and open gaps of points.

    ``filled`` is the number of filled frames by the index of the point; ``open`` are the remaining
    spans [start, stop) of a point.
    """

    filled: dict[int, int]
    open: dict[int, Spans]


def fill_gaps(points: Floats, fps: float) -> Gaps:
    """Fill the short gaps of ``points`` (frames, points, 3) in place.

    A point with NaN in any coordinate counts as not seen.
    """
    missing = np.asarray(np.isnan(points).any(axis=2))
    longest = int(LONGEST_S * fps + 1e-9)  # the margin undoes rounding of the product
    gaps = Gaps({}, {})
    for point in np.flatnonzero(missing.any(axis=0)).tolist():
        spans = find_spans(missing[:, point])
        lengths = spans[:, 1] - spans[:, 0]
        # A point never seen has no neighbours to interpolate, however short the recording is.
        long = np.asarray((lengths > longest) | (lengths == len(points)))
        missing_frames = np.concatenate(
            [np.arange(*span) for span in spans[~long]] or [np.empty(0, np.intp)]
        )
        if len(missing_frames):
            visible = np.flatnonzero(~missing[:, point])
            points[missing_frames, point] = _interpolate_cubic(
                visible, points[visible, point], missing_frames
            )
            gaps.filled[point] = len(missing_frames)
        if long.any():
            gaps.open[point] = spans[long]
    return gaps


def bridge_gaps(
    points: Floats, gaps: Gaps, chosen: Iterable[int], fps: float
) -> tuple[tuple[int, int], ...]:
    """Fill the open gaps of the chosen points in place and return the filled frames [start, stop).

    Values are interpolated linearly. Frames seen for at most 0.2 s between two gaps are part of
    one gap.
    """
    n, longest = len(points), int(LONGEST_S * fps + 1e-9)
    missing = np.zeros(n, np.bool_)
    for point in chosen:
        if point not in gaps.open:
            continue
        is_hidden = mark_spans(gaps.open[point].tolist(), n)
        for axis in range(points.shape[2]):
            bridge_line(points[:, point, axis], is_hidden)
        missing |= is_hidden
    for start, stop in find_spans(~missing).tolist():
        if missing.any() and stop - start <= longest:
            missing[start:stop] = True
    return tuple((start, stop) for start, stop in find_spans(missing).tolist())


def mark_spans(spans: Iterable[tuple[int, int]], n: int) -> NDArray[np.bool_]:
    """Return a mask (n,) of the frames inside any of the spans [start, stop)."""
    inside = np.zeros(n, np.bool_)
    for start, stop in spans:
        inside[start:stop] = True
    return inside


def split_at(motion: Motion, spans: Iterable[tuple[int, int]]) -> Motion:
    """Return the motion with these spans [start, stop) added to its gaps."""
    joined = mark_spans([*motion.gaps, *spans], motion.n_frames)
    return replace(motion, gaps=tuple((a, b) for a, b in find_spans(joined).tolist()))


def mark_gaps(motion: Motion) -> list[bool]:
    """Return for each frame whether it is in a gap of the motion."""
    return list(map(bool, mark_spans(motion.gaps, motion.n_frames)))


def warn_of_gaps(motions: Iterable[Motion], path: Path) -> None:
    """Warn if motions with gaps are written to a format that has no gaps."""
    seconds = sum((b - a) / motion.fps for motion in motions for a, b in motion.gaps)
    if seconds:
        warn(
            f"{path.name}: gaps of {seconds:.1f} s become movement, since the format cannot "
            "store gaps: leave these clips out, or write .npz, .csv or .trc"
        )


def _interpolate_cubic(
    visible: NDArray[np.intp], values: Floats, frames: NDArray[np.intp]
) -> Floats:
    """Return values (frames, 3) at the frames that were not seen."""
    if len(visible) == 1:
        return np.repeat(values, len(frames), axis=0)
    from scipy.interpolate import PchipInterpolator

    # Clipping holds the nearest position at both ends.
    inside = np.clip(frames, visible[0], visible[-1])
    return np.asarray(PchipInterpolator(visible, values)(inside), np.float64)
