"""Check motions for implausible data, and fill gaps.

`drop_implausible` checks points before gaps are filled: those that jump or sit at the origin become
gaps. `check_bone_lengths` and `check_posture` check every motion. Each finding is a warning that
states what was assumed. `kineme.formats.units` checks units and up axes.

Gaps of up to 0.2 s are filled along a monotone cubic (PCHIP) through the frames in which the point
was seen. At either end of the recording the nearest position is held. Longer gaps are listed. If
the body cannot be located without the point, the gap splits the recording, and `bridge_gaps`
interpolates the positions so that every frame has finite values, although they are not used.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats, bridge_line
from kineme._util.checks import format_count, join_names, warn
from kineme.formats.units import find_lying_axis, iterate_blocks
from kineme.recordings import Motion, Note
from kineme.recordings.arrays import find_spans, list_spans, mark_spans
from kineme.recordings.regular import LONGEST_S

Spans = NDArray[np.intp]

MAX_SPEED = 15.0
"""Maximum speed of a point relative to the others, in body sizes per second.

This is 25 m/s for an adult; hands of pitchers reach about 20 m/s relative to the trunk.
"""
MIN_RIGID_POINTS = 3
"""Minimum number of markers on a bone to check; two are often estimated joints (Kinect's hips)."""
SAMPLED_FRAMES = 500
"""Number of frames used to measure the body."""
MIN_BONE_LENGTH = 1e-6
"""Metres; shorter bones count as empty."""
MIN_EMPTY_BONES = 3
"""Number of empty bones from which a skeleton is doubtful."""
MAX_DISTANCE_CHANGE = 0.25
"""Fraction by which the distance of two points on one bone may change."""


def drop_implausible(points: Floats, names: Sequence[str], fps: float) -> list[Note]:
    """Set untracked values in points (frames, points, 3) to NaN in place, and return warnings.

    Untracked are frames in which every coordinate is zero, single points at the origin, and points
    that jump away and come back.
    """
    notes = []
    at_origin = (points == 0).all(axis=2)
    empty = at_origin.all(axis=1)
    if empty.any() and not empty.all():
        points[empty] = np.nan
        at_origin[empty] = False
        remark = f"{format_count(int(empty.sum()), 'frame')} with zeros only: read as missing"
        notes.append(Note(remark, "warning"))
    # A point that never leaves the origin defines it: only points that come and go were lost.
    lost = at_origin.any(axis=0) & ~(at_origin | empty[:, None]).all(axis=0)
    if lost.any():
        points[at_origin & lost] = np.nan
        named = join_names([names[i] for i in np.flatnonzero(lost).tolist()])
        remark = f"points exactly at the origin in some frames, read as missing there: {named}"
        notes.append(Note(remark, "warning"))
    jumps, others = _find_jumps(points, fps)
    for point, start, stop in jumps:
        points[start:stop, point] = np.nan
    if jumps:
        parts = [f"{names[point]} (frames {a} to {b - 1})" for point, a, b in jumps]
        remark = f"points that jump away and back, read as missing there: {join_names(parts)}"
        notes.append(Note(remark, "warning"))
    if others:
        first: dict[int, int] = {}
        for point, frame in others:
            first.setdefault(point, frame)
        parts = [f"{names[point]} (first in frame {frame})" for point, frame in first.items()]
        notes.append(Note(f"points that jump: {join_names(parts)}", "warning"))
    return notes


def _find_jumps(
    points: Floats, fps: float
) -> tuple[list[tuple[int, int, int]], list[tuple[int, int]]]:
    """Return short jumps as (point, start, stop), and other jumps as (point, frame).

    A short jump ends within the time for which gaps are filled.
    """
    size = _measure_size(points)
    if not size > 0 or len(points) < 3:
        return [], []
    step = MAX_SPEED * size / fps
    fast = _find_fast_steps(points, step)
    longest = max(1, int(LONGEST_S * fps))
    jumps, others = [], []
    for point in np.flatnonzero(fast.any(axis=0)).tolist():
        steps = np.flatnonzero(fast[:, point]).tolist()
        while steps:
            away, *steps = steps
            back = next((other for other in steps if other - away <= longest), None)
            if back is not None:
                distance = np.linalg.norm(points[back + 1, point] - points[away, point])
            # A point that does not come back, or comes back elsewhere, did not just jump.
            if back is None or distance > step * (back + 1 - away):
                others.append((point, away + 1))
                continue
            jumps.append((point, away + 1, back + 1))
            steps = steps[1:]
    return jumps, others


def _find_fast_steps(points: Floats, step: float) -> NDArray[np.bool_]:
    """Return whether each point moves too far from each frame to the next (frames - 1, points).

    Motion common to all points, as when the origin is moved, is not counted.
    """
    fast = np.zeros((len(points) - 1, points.shape[1]), np.bool_)
    for span in iterate_blocks(len(points) - 1):
        moves = points[span.start + 1 : span.stop + 1] - points[span]
        fast[span] = np.einsum("tpi,tpi->tp", moves, moves) > step**2  # NaN is not above it
        for frame in np.flatnonzero(fast[span].any(axis=1)).tolist():
            common = np.nanmedian(moves[frame], axis=0)
            relative = np.linalg.norm(moves[frame] - common, axis=1) > step
            fast[span.start + frame] &= relative
    return fast


def _measure_size(points: Floats) -> float:
    """Return the largest extent of the points, the median over sampled frames."""
    some = points[:: max(1, len(points) // SAMPLED_FRAMES)]
    seen = np.asarray(~np.isnan(some).any(axis=2))
    some = some[seen.any(axis=1)]
    if not len(some):
        return 0.0
    return float(np.median((np.nanmax(some, axis=1) - np.nanmin(some, axis=1)).max(axis=1)))


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
    return list_spans(missing)


def split_at(motion: Motion, spans: Iterable[tuple[int, int]]) -> Motion:
    """Return the motion with these spans [start, stop) added to its gaps."""
    joined = mark_spans([*motion.gaps, *spans], motion.n_frames)
    return replace(motion, gaps=list_spans(joined))


def mark_gaps(motion: Motion) -> list[bool]:
    """Return for each frame whether it is in a gap of the motion."""
    marked: list[bool] = mark_spans(motion.gaps, motion.n_frames).tolist()
    return marked


def warn_of_gaps(motions: Iterable[Motion], path: Path) -> None:
    """Warn if motions with gaps are written to a format that has no gaps."""
    seconds = sum((b - a) / motion.fps for motion in motions for a, b in motion.gaps)
    if seconds:
        warn(
            f"{path.name}: gaps of {seconds:.1f} s become movement, since the format cannot "
            "store gaps: leave these clips out, or write .npz, .csv or .trc"
        )


def check_rigid_points(
    points: Floats, names: Sequence[str], bone_points: Sequence[int]
) -> list[Note]:
    """Warn of points on one bone whose distance changes: they were swapped or slipped."""
    changes = []
    if len(bone_points) < MIN_RIGID_POINTS:
        return []
    for first, second in combinations(bone_points, 2):
        lengths = np.linalg.norm(points[:, first] - points[:, second], axis=1)
        # Percentiles ignore single outliers.
        low, middle, high = np.percentile(lengths, (2, 50, 98))
        if high - low > MAX_DISTANCE_CHANGE * middle:
            changes.append(f"{names[first]} and {names[second]} (by {(high - low) / middle:.0%})")
    if not changes:
        return []
    return [
        Note(f"points on the same bone change their distance: {join_names(changes)}", "warning")
    ]


def check_bone_lengths(motion: Motion) -> Motion:
    """Warn if most bones of a skeleton have no length: the rest pose is missing in the file."""
    parents = motion.skeleton.parents
    # A few empty bones are normal: files list more joints than the body has.
    bones = [j for j, parent in enumerate(parents) if parent >= 0]
    bones = [j for j in bones if j not in motion.skeleton.end_sites]
    if motion.rotations is None or not bones:
        return motion
    positions = motion.positions[:: max(1, motion.n_frames // SAMPLED_FRAMES)]
    lengths = np.linalg.norm(
        positions[:, bones] - positions[:, [parents[j] for j in bones]], axis=2
    )
    empty = int((lengths.max(axis=0) < MIN_BONE_LENGTH).sum())
    if empty < MIN_EMPTY_BONES or 2 * empty <= len(bones):
        return motion
    remark = f"{empty} of {len(bones)} bones have no length: export the file with its rest pose"
    return motion.noted(Note(remark, "warning"))


def check_posture(motion: Motion) -> Motion:
    """Warn if the body of a motion with y up lies down most of the time: up may be another axis."""
    axis = find_lying_axis(motion.skeleton, motion.positions)
    if axis is None:
        return motion
    remark = f"the body lies along {axis} most of the time; give up= (--up) if it stands there"
    return motion.noted(Note(remark, "warning"))
