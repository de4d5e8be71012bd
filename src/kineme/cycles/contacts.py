"""Find foot contacts from a gyroscope at the foot, from positions, or from a force plate.

*Gyroscope.* A standing foot does not rotate. Between two stands it rotates one way as the heel
rises (fastest just before toe-off), back during the swing, and the first way again as it lands.
Principal components give the axis of rotation, and this order its sign. Foot off is where the first
rotation has fallen to a fraction of its peak, foot strike where the last one has risen to another
fraction. Both fractions were fitted to recordings with manually checked contacts, so that contacts
are neither early nor late on average.

*Positions.* Heel and toe stand while they are low and slow; the foot stands while one of them does.
Speed is relative to the ground, which is the belt on a treadmill. Height is above the line of the
ground, which rises on a ramp.

*Force.* The foot stands while the force exceeds a threshold above that of the empty plate.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Floats
from kineme._util.checks import as_floats
from kineme.errors import ParameterError
from kineme.features.effectors import find_low_and_slow, measure_speed
from kineme.recordings.arrays import find_spans

STEADY = 0.12
"""Fraction of a moving foot's usual angular speed below which it stands."""
FLAT_S = 0.08
"""Shortest stand in seconds."""
SWING_S = 0.15
"""Shortest swing in seconds."""
SMOOTH_S = 0.015
"""Standard deviation of the Gaussian filter for gyroscopes, seconds."""
OFF, ON = 0.62, 0.63
"""Fractions of the peak rotation before and after a swing at foot off and foot strike."""
HIGH, APART_S = 0.4, 0.3
"""Fraction of the peak forward rotation that marks a swing; least seconds between swings."""
FIRST = 0.3
"""First fraction of a movement, in which the heel rises."""
LOW, SLOW = 0.04, 0.8
"""Height (m, above the lowest position) and speed (m/s) below which heel or toe stands."""
REACH, STEEPEST = 1.0, 0.25
"""Least length (m) and largest slope of a ramp: leg raises are shorter, stairs steeper."""
BRIDGE_S, STAND_S = 0.1, 0.1
"""Shortest break between stands, and shortest stand, in seconds."""
NEWTON = 20.0
"""Least force on a plate in newtons while somebody stands on it."""
EMPTY = 0.1
"""Fraction of the largest force below which the plate is empty; amplifiers have an offset."""


def swings_from_gyroscope(rates: ArrayLike, fps: float) -> Floats:
    """Return the swings of a foot, found from its angular velocity.

    Parameters
    ----------
    rates : (frames, 3) array
        Angular velocity of a sensor at the foot, in any unit and direction.
    fps : float
        Frames per second.

    Returns
    -------
    (swings, 2) array
        Seconds of foot off and foot strike.

    Examples
    --------
    >>> from kineme.cycles import swings_from_gyroscope
    >>> t = np.arange(-0.5, 0.5, 0.01)
    >>> lobes = [(-0.25, 8.0, 0.05), (0.0, -5.0, 0.1), (0.2, 4.0, 0.04)]
    >>> step = sum(high * np.exp(-((t - at) ** 2) / 2 / wide**2) for at, high, wide in lobes)
    >>> rates = np.zeros((300, 3))
    >>> rates[:, 1] = np.tile(step, 3)
    >>> swings_from_gyroscope(rates, 100.0).shape
    (3, 2)
    """
    from scipy.ndimage import gaussian_filter1d

    turning = _check_points(rates, "rates")
    # Remove the constant bias of the sensor.
    turning = turning - np.median(turning, axis=0)
    turning = gaussian_filter1d(turning, SMOOTH_S * fps, axis=0, mode="nearest")
    size = np.linalg.norm(turning, axis=1)
    if not size.any():
        return np.empty((0, 2))
    # The foot may stand most of the time: use only frames in which it moves.
    usual = float(np.percentile(size[size > 0.1 * size.max()], 75))
    steady = find_spans(size < STEADY * usual).tolist()
    stands = [(a, b) for a, b in steady if b - a >= FLAT_S * fps]
    moves = [(before[1], after[0]) for before, after in pairwise(stands)]
    # Main axis of turning: the eigenvector of the largest eigenvalue, which is the last.
    axis = np.linalg.eigh(np.cov(turning.T))[1][:, -1]
    pitch = turning @ axis
    # The eigenvector has either sign; the first part of movements, the heel's rise, fixes it.
    rises = sum(float(pitch[a : a + max(1, int(FIRST * (b - a)))].sum()) for a, b in moves)
    if rises > 0:
        pitch = -pitch  # the heel rises with a negative turn, the foot swings with a positive one
    swings = [
        (start + swing[0], start + swing[1])
        for move in _join_movements(moves, pitch, fps)
        for start, stop in _split_parts(pitch, *move, fps)
        if (swing := _find_swing(pitch[start:stop])) is not None
    ]
    seconds = np.array(swings, np.float64).reshape(-1, 2) / fps
    # The shortest spans are twitches of a standing foot.
    return seconds[np.diff(seconds, axis=1)[:, 0] >= SWING_S]


def _join_movements(
    moves: Sequence[tuple[int, int]], pitch: Floats, fps: float
) -> list[tuple[int, int]]:
    """Join movements if the foot did not stand between them.

    After a stand the heel rises first. If the rotation goes on forward instead, the foot was only
    slow between heel rise and swing, as in the first and last step of a walk.
    """
    joined: list[tuple[int, int]] = []
    for start, stop in moves:
        begins = float(pitch[start : start + max(1, int(FIRST * (stop - start)))].sum())
        # A positive start is no heel rise: the movement before goes on.
        if joined and begins > 0 and start - joined[-1][1] < APART_S * fps:
            joined[-1] = joined[-1][0], stop
        else:
            joined.append((start, stop))
    return joined


def _split_parts(pitch: Floats, start: int, stop: int, fps: float) -> list[tuple[int, int]]:
    """Split a movement in which the foot stands too briefly to be detected.

    It has two swings if two forward rotations are at least `APART_S` apart.
    """
    forward = find_spans(pitch[start:stop] > HIGH * pitch[start:stop].max(initial=0.0)).tolist()
    cuts = [start]
    for (_, before), (after, _) in pairwise(forward):
        if after - before >= APART_S * fps:
            turning = np.abs(pitch[start + before : start + after])
            width = max(1, round(FLAT_S * fps))
            # Moving average of the turning; its least value is the steadiest moment.
            steady = np.convolve(turning, np.ones(width) / width, "valid")
            # `valid` starts at the first full window, so half a width leads to its middle.
            cuts.append(start + before + int(steady.argmin()) + width // 2)
    return [*pairwise([*cuts, stop])]


def _find_swing(pitch: Floats) -> tuple[float, float] | None:
    """Return the frames of foot off and foot strike between two stands; None without a swing."""
    middle = int(pitch.argmax())
    # A maximum at the very start leaves no heel rise before it.
    if middle < 2 or pitch[middle] <= 0:
        return None
    rise = int(pitch[:middle].argmin())
    if pitch[rise] >= 0:
        return None
    # The heel rises with a negative turn; the toes leave while that fades.
    off = _find_crossing(pitch, rise, middle, OFF * pitch[rise])
    # The sole comes down with a negative turn after the swing.
    slap = middle + int(pitch[middle:].argmin())
    positive = np.flatnonzero(pitch[middle:slap] > 0)
    last = middle + (int(positive[-1]) if len(positive) else 0)
    # Without a negative turn the level is 0.
    on = _find_crossing(pitch, last, slap, ON * min(float(pitch[slap]), 0.0))
    return off, on


def _find_crossing(values: Floats, start: int, stop: int, level: float) -> float:
    """Return the fractional frame at which values first reach a level, ``stop`` if never."""
    # Values relative to the level: the crossing is a change of sign.
    span = values[start : stop + 1] - level
    changed = np.flatnonzero(np.signbit(span) != np.signbit(span[0]))
    if len(changed) == 0:
        return float(stop)
    before = int(changed[0]) - 1
    # Straight line between the frames before and after the crossing.
    return start + before + float(span[before] / (span[before] - span[before + 1]))


def stands_from_positions(points: Sequence[ArrayLike], fps: float) -> Floats:
    """Return the stands of a foot, found from positions of heel and toe, or of one point.

    Parameters
    ----------
    points : sequence of (frames, 3) array
        Metres, y up.
    fps : float
        Frames per second.

    Returns
    -------
    (stands, 2) array
        Start and stop of each stand in seconds.

    Examples
    --------
    >>> from kineme.cycles import stands_from_positions
    >>> height = np.array([0.0] * 30 + [0.2] * 30 + [0.0] * 30)
    >>> path = np.stack([0 * height, height, 0 * height], axis=1)
    >>> stands_from_positions([path], 60.0).round(2).tolist()
    [[0.0, 0.48], [1.02, 1.5]]
    """
    if not points:
        raise ParameterError("a foot needs at least one point: heel, toe or ankle")
    paths = [_check_points(each, "points") for each in points]
    if len({len(path) for path in paths}) > 1:
        raise ParameterError("the points of a foot must have the same number of frames")
    # (frames, 3): how far the ground has moved since the start.
    ground_shift = np.arange(len(paths[0]))[:, None] / fps * measure_ground_velocity(paths, fps)
    stands = np.zeros(len(paths[0]), bool)
    for path in _subtract_slope([path - ground_shift for path in paths], fps):
        stands |= find_low_and_slow(path, fps, height=LOW, speed=SLOW)
    return _join_stands(stands, fps)


def measure_ground_velocity(points: Sequence[Floats], fps: float) -> Floats:
    """Return the velocity of the ground: that of a treadmill's belt, else 0.

    It is the median velocity of a foot that stands flat: all its points are low and move alike,
    unlike those of a foot that lands or rises. On a belt the foot returns to its position;
    overground it travels with the body. Points are (frames, 3) in metres, y up; the result (3,) is
    horizontal, metres per second.
    """
    if len(points[0]) < 2:
        return np.zeros(3)
    # Without a limit of speed: a foot that stands on a belt is fast.
    low = np.stack([find_low_and_slow(path, fps, height=LOW, speed=np.inf) for path in points])
    velocities = np.gradient(np.stack(points), axis=1) * fps
    if (flat := low.all(axis=0)).any():
        # Distance of the points' velocities; the half in which they are most alike.
        apart = np.linalg.norm(np.ptp(velocities, axis=0), axis=1)
        low[:] = flat & (apart <= np.median(apart[flat]))
    # The belt is level: no vertical velocity.
    belt = np.median(velocities[low], axis=0) * [1, 0, 1]
    travel = np.mean([path[-1] - path[0] for path in points], axis=0) * [1, 0, 1]
    # From metres in all to metres per second; n frames are n - 1 steps.
    travel *= fps / (len(points[0]) - 1)
    # Overground the low points hardly move, so the feet travel much faster than these.
    is_belt = np.linalg.norm(travel) < np.linalg.norm(belt) / 2
    return np.asarray(belt if is_belt else np.zeros(3))


def _subtract_slope(paths: Sequence[Floats], fps: float) -> list[Floats]:
    """Return paths of a foot with heights above the ramp that it walks on, if it does."""
    places: list[Floats] = []
    for path in paths:
        slow = find_spans(measure_speed(path, fps) < SLOW).tolist()
        rests = [np.median(path[a:b], axis=0) for a, b in slow if b - a >= STAND_S * fps]
        # Heel and toe have different heights: only differences from their means are compared.
        places += [rest - np.mean(rests, axis=0) for rest in rests]
    # Each point has its own height, so a line needs two more places than points.
    if len(places) < len(paths) + 2:
        return [*paths]
    height, flat = np.array(places)[:, 1], np.array(places)[:, [0, 2]]
    # The direction in which the places lie apart: the first right singular vector.
    direction = np.linalg.svd(flat, full_matrices=False)[2][0]
    along = flat @ direction
    slope = float(along @ height / max(along @ along, 1e-12))
    is_ramp = np.ptp(along) > REACH and LOW / np.ptp(along) < abs(slope) < STEEPEST
    if not is_ramp or np.abs(height - slope * along).max() > LOW:
        return [*paths]
    return [path - np.outer(path[:, [0, 2]] @ direction * slope, [0, 1, 0]) for path in paths]


def stands_from_force(force: ArrayLike, fps: float, *, least: float = NEWTON) -> Floats:
    """Return the times during which somebody stands on a force plate.

    Parameters
    ----------
    force : (frames,) array
        Vertical force in newtons. Its sign does not matter, nor does a constant offset of less
        than a tenth of the largest force.
    fps : float
        Frames per second.
    least : float
        Threshold in newtons.

    Returns
    -------
    (stands, 2) array
        Start and stop of each stand in seconds.

    Raises
    ------
    ParameterError
        The force is not one finite number per frame.

    Examples
    --------
    >>> from kineme.cycles import stands_from_force
    >>> stands_from_force([0.0] * 100 + [700.0] * 600 + [0.0] * 100, 1000.0).tolist()
    [[0.1, 0.7]]
    """
    force = as_floats(force, "force")
    values = force.ravel()
    if len(values) != len(force) or not np.isfinite(values).all():
        raise ParameterError("the force must be one finite number per frame")
    # Frames in which the plate is empty; their median is the offset of its amplifier.
    empty = values[np.abs(values) < EMPTY * np.abs(values).max(initial=0.0)]
    offset = float(np.median(empty)) if len(empty) else 0.0
    return _join_stands(np.abs(values - offset) > least, fps)


def _join_stands(stands: NDArray[np.bool_], fps: float) -> Floats:
    """Return stands in seconds, joined over short breaks and without short ones."""
    joined: list[list[int]] = []
    for start, stop in find_spans(stands).tolist():
        if joined and start - joined[-1][1] < BRIDGE_S * fps:
            joined[-1][1] = stop
        else:
            joined.append([start, stop])
    lasting = [each for each in joined if each[1] - each[0] >= STAND_S * fps]
    return np.array(lasting, np.float64).reshape(-1, 2) / fps


def _check_points(values: ArrayLike, name: str) -> Floats:
    array = as_floats(values, name)
    if array.ndim != 2 or array.shape[1] != 3 or len(array) == 0:
        raise ParameterError(f"{name} must be frames x 3, not of shape {array.shape}")
    if not np.isfinite(array).all():
        raise ParameterError(f"{name} hold a value that is not finite")
    return array
