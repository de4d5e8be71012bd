"""Check motions for implausible data: points that jump or sit at the origin, bodies that lie down.

`drop_implausible` checks points before gaps are filled; `check_bone_lengths` and `check_posture`
check every motion. Dropped points become gaps. Each finding is a warning that states what was
assumed. `kineme.formats.units` checks units and up axes.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme._util.checks import format_count, join_names
from kineme.formats.units import find_lying_axis, iterate_blocks
from kineme.recordings import Motion, Note
from kineme.recordings.regular import LONGEST_S

FASTEST = 15.0
"""Sizes of the body that a point moves in a second at most, beside the other points.

25 m/s for an adult; hands of pitchers reach about 20 m/s beside the trunk.
"""
CLUSTER = 3
"""Markers on one bone at least; two are often estimates of joints, as a Kinect's hips."""
SAMPLED = 500
"""Frames from which the size of the body is taken."""
SHORTEST = 1e-6
"""Metres, below which a bone has no length."""
FEWEST_EMPTY = 3
"""Bones of no length below which none is doubted."""
BEND = 0.25
"""Share by which the distance of two points on one bone may change."""


def drop_implausible(points: Floats, names: Sequence[str], fps: float) -> list[Note]:
    """Make what was not tracked NaN in points (frames, points, 3), in place, and say so.

    That are frames in which every coordinate is zero, single points at the origin of
    coordinates, and points that jump away and come back.
    """
    notes = []
    at_origin = (points == 0).all(axis=2)
    empty = at_origin.all(axis=1)
    if empty.any() and not empty.all():
        points[empty] = np.nan
        at_origin[empty] = False
        remark = (
            f"{format_count(int(empty.sum()), 'frame')} with nothing but zeros: taken as not seen"
        )
        notes.append(Note(remark, "warning"))
    # A point that never leaves the origin is what the others are measured from.
    lost = at_origin.any(axis=0) & ~(at_origin | empty[:, None]).all(axis=0)
    if lost.any():
        points[at_origin & lost] = np.nan
        named = join_names([names[i] for i in np.flatnonzero(lost).tolist()])
        remark = f"exactly at the origin in some frames, taken as not seen there: {named}"
        notes.append(Note(remark, "warning"))
    jumps, others = _find_jumps(points, fps)
    for point, start, stop in jumps:
        points[start:stop, point] = np.nan
    if jumps:
        parts = [f"{names[point]} (frames {a} to {b - 1})" for point, a, b in jumps]
        remark = f"points that jump away and back, taken as not seen there: {join_names(parts)}"
        notes.append(Note(remark, "warning"))
    if others:
        first: dict[int, int] = {}
        for point, frame in others:
            first.setdefault(point, frame)
        parts = [f"{names[point]} (first in frame {frame})" for point, frame in first.items()]
        notes.append(Note(f"points that jump: {join_names(parts)}", "warning"))
    return notes


def check_rigid_points(points: Floats, names: Sequence[str], made_of: Sequence[int]) -> list[Note]:
    """Warn of points on one bone whose distance changes: they were exchanged or slipped."""
    moved = []
    if len(made_of) < CLUSTER:
        return []
    for one, other in combinations(made_of, 2):
        lengths = np.linalg.norm(points[:, one] - points[:, other], axis=1)
        low, middle, high = np.percentile(lengths, (2, 50, 98))
        if high - low > BEND * middle:
            moved.append(f"{names[one]} and {names[other]} (by {(high - low) / middle:.0%})")
    if not moved:
        return []
    return [Note(f"points on one bone change their distance: {join_names(moved)}", "warning")]


def check_bone_lengths(motion: Motion) -> Motion:
    """Warn if most bones of a skeleton have no length: its rest pose was left out."""
    parents = motion.skeleton.parents
    # Some bones of no length are usual: the file lists more joints than its body has.
    bones = [j for j, parent in enumerate(parents) if parent >= 0]
    bones = [j for j in bones if j not in motion.skeleton.end_sites]
    if motion.rotations is None or not bones:
        return motion
    places = motion.positions[:: max(1, motion.n_frames // SAMPLED)]
    lengths = np.linalg.norm(places[:, bones] - places[:, [parents[j] for j in bones]], axis=2)
    empty = int((lengths.max(axis=0) < SHORTEST).sum())
    if empty < FEWEST_EMPTY or 2 * empty <= len(bones):
        return motion
    remark = f"{empty} of {len(bones)} bones have no length: export the file with its rest pose"
    return motion.noted(Note(remark, "warning"))


def check_posture(motion: Motion) -> Motion:
    """Warn if the body of a motion with y up lies throughout: its up axis may be another."""
    axis = find_lying_axis(motion.skeleton, motion.positions)
    if axis is None:
        return motion
    remark = f"the body lies along {axis} most of the time; give up= (--up) if it stands there"
    return motion.noted(Note(remark, "warning"))


def _find_jumps(
    points: Floats, fps: float
) -> tuple[list[tuple[int, int, int]], list[tuple[int, int]]]:
    """Return points and frames [start, stop) of short jumps, and points and frames of others.

    A short jump is over within the time for which gaps are filled.
    """
    size = _measure_size(points)
    if not size > 0 or len(points) < 3:
        return [], []
    step = FASTEST * size / fps
    fast = _find_fast_steps(points, step)
    longest = max(1, int(LONGEST_S * fps))
    jumps, others = [], []
    for point in np.flatnonzero(fast.any(axis=0)).tolist():
        steps = np.flatnonzero(fast[:, point]).tolist()
        while steps:
            away, *steps = steps
            back = next((each for each in steps if each - away <= longest), None)
            if back is not None:
                moved = np.linalg.norm(points[back + 1, point] - points[away, point])
            if back is None or moved > step * (back + 1 - away):
                others.append((point, away + 1))
                continue
            jumps.append((point, away + 1, back + 1))
            steps = steps[1:]
    return jumps, others


def _find_fast_steps(points: Floats, step: float) -> NDArray[np.bool_]:
    """Return for each frame but the last, and each point, whether it moves too far to the next.

    How all points move, as when the origin is moved, is not counted.
    """
    fast = np.zeros((len(points) - 1, points.shape[1]), np.bool_)
    for span in iterate_blocks(len(points) - 1):
        moves = points[span.start + 1 : span.stop + 1] - points[span]
        fast[span] = np.einsum("tpi,tpi->tp", moves, moves) > step**2  # NaN is not above it
        for frame in np.flatnonzero(fast[span].any(axis=1)).tolist():
            common = np.nanmedian(moves[frame], axis=0)
            beside = np.linalg.norm(moves[frame] - common, axis=1) > step
            fast[span.start + frame] &= beside
    return fast


def _measure_size(points: Floats) -> float:
    """Return the largest extent of the points, in the middle of some frames."""
    some = points[:: max(1, len(points) // SAMPLED)]
    seen = np.asarray(~np.isnan(some).any(axis=2))
    some = some[seen.any(axis=1)]
    if not len(some):
        return 0.0
    return float(np.median((np.nanmax(some, axis=1) - np.nanmin(some, axis=1)).max(axis=1)))
