"""Rides: what carries a person who stands still, such as a lift, from accelerometers alone.

A lift changes neither how a sensor hangs nor how it is shaken, so posture and energy do not show
it. But at rest an accelerometer reads gravity, whose length is the same however it hangs. While a
lift gathers speed, all of them read more or less than that by the same share, without being turned.
The sum of these pulses is the speed of the lift: it rises, stays, and comes back to nothing.

Three things make this safe where nobody rides. Only channels are taken whose
length at rest is one, which no gyroscope and no place in a room has. There must
be two such sensors at least, which feel the same: who sits down moves as a
whole, too. And a pulse must be taken back by another.

Source: speed by integrating acceleration between frames at rest is that of
inertial navigation (zero velocity updates); the rest is ours.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

RATE, WINDOW = 10.0, 0.5
"""Means over half a second are looked at, so many a second."""
GRAVITY = 9.81
AXES = 3
"""Channels of an accelerometer, side by side."""
QUIET, QUIET_SHARE = 0.03, 0.05
"""At rest it is shaken by less than this share of gravity, for this share of the time at least."""
SAME, SAME_SHARE = 0.01, 0.75
"""By less than this share gravity's length differs at rest, for this share of the time."""
SENSORS = 2
"""Accelerometers at least."""
OVER = 15.0
"""Seconds whose median tells how a sensor hangs."""
SHAKEN, TURNED = 0.1, 0.15
"""Shares of gravity: who is shaken or turned by more is on the move."""
EQUAL = 0.3
"""Shares that differ by less of their mean, from sensor to sensor, are the same."""
LEAST = 0.06
"""Least acceleration of a pulse, m/s²."""
SPEED = 0.3
"""Least speed of a ride, m/s."""
LEFT = 0.3
"""Share of its speed that may be left at the end, for what is not seen."""
LONGEST = 60.0
"""Seconds of a ride, at most."""
APART, SOON = 3.0, 4.0
"""Seconds: a second start so long after the first is another ride, a last touch so soon after
the end belongs to it."""


class Ride(NamedTuple):
    """Frames ``[start, stop)`` in which all is carried at a speed of m/s, upwards above 0.

    Examples
    --------
    >>> from kineme.features.rides import Ride
    >>> Ride(start=100, stop=400, speed=-1.5).speed < 0  # downwards
    True
    """

    start: int
    stop: int
    speed: float


def rides(values: ArrayLike, fps: float) -> list[Ride]:
    """The rides of somebody who wears two accelerometers or more.

    Parameters
    ----------
    values : (frames, channels) array
        As recorded: gravity and all. The three axes of a sensor are side by side and of
        one unit; what other channels hold plays no part.
    fps : float
        Frames per second.

    Returns
    -------
    list of Ride

    Examples
    --------
    >>> t = np.arange(0, 40, 0.02)
    >>> pulses = 1.0 * ((10 < t) & (t < 11)) - 1.0 * ((20 < t) & (t < 21))
    >>> rng = np.random.default_rng(0)
    >>> felt = (9.81 + pulses)[:, None] * [0.6, 0.8, 0, 0, 0, 1]
    >>> [ride] = rides(felt + 0.02 * rng.standard_normal(felt.shape), 50.0)
    >>> round(ride.start / 50), round(ride.stop / 50), round(ride.speed)
    (10, 21, 1)
    """
    array = np.asarray(values, np.float64)
    largest = np.abs(array).max(initial=0.0)
    if fps < RATE or len(array) < OVER * fps or largest == 0:
        return []
    acceleration = _shared_acceleration(*_sampled(array / largest, fps))
    frames = fps / RATE
    return [
        Ride(round(start * frames), min(round(stop * frames), len(array)), speed)
        for start, stop, speed in _rides(_pulses(acceleration))
    ]


def _sampled(values: Floats, fps: float) -> tuple[Floats, Floats]:
    """Means and variances of the channels over `WINDOW`, `RATE` times a second."""
    from scipy.ndimage import uniform_filter1d

    width = max(1, round(WINDOW * fps))
    means = uniform_filter1d(values, width, axis=0, mode="nearest")
    squares = uniform_filter1d(values**2, width, axis=0, mode="nearest")
    at = np.rint(np.arange(0, len(values) - 1, fps / RATE)).astype(np.int64)
    return means[at], np.maximum(squares[at] - means[at] ** 2, 0.0)


def _accelerometers(means: Floats, variances: Floats) -> tuple[int, ...]:
    """The first channel of each three whose length at rest is one: as many as there can be.

    Of equally many, those are taken that fit best.
    """
    best: list[tuple[int, float, tuple[int, ...]]] = [(0, 0.0, ())] * AXES
    for first in range(means.shape[1] - AXES + 1):
        axes = slice(first, first + AXES)
        length = np.linalg.norm(means[:, axes], axis=1)
        quiet = np.sqrt(variances[:, axes].sum(axis=1)) < QUIET * length
        differs = np.inf
        if quiet.mean() > QUIET_SHARE:
            gravity = np.median(length[quiet])
            differs = float(np.quantile(np.abs(length[quiet] / gravity - 1), SAME_SHARE))
        fewer, sum_before, before = best[first]
        with_it = (fewer - 1, sum_before + differs, (*before, first))
        best.append(min(best[-1], with_it) if differs < SAME else best[-1])
    return best[-1][2]


def _shared_acceleration(means: Floats, variances: Floats) -> Floats:
    """Acceleration along gravity that most sensors share while not turned, m/s²; else 0."""
    from scipy.ndimage import median_filter

    sensors = _accelerometers(means, variances)
    if len(sensors) < SENSORS:
        return np.zeros(len(means))
    shares, carried = [], []
    for first in sensors:
        axes = slice(first, first + AXES)
        usual = median_filter(means[:, axes], size=(round(OVER * RATE) | 1, 1), mode="nearest")
        gravity = np.maximum(np.linalg.norm(usual, axis=1), 1e-12)
        share = np.linalg.norm(means[:, axes], axis=1) / gravity
        turned = np.linalg.norm(means[:, axes] - share[:, None] * usual, axis=1)
        shaken = np.sqrt(variances[:, axes].sum(axis=1))
        shares.append(share - 1)
        carried.append((turned < TURNED * gravity) & (shaken < SHAKEN * gravity))
    changes, counted = np.array(shares), np.array(carried)
    count = np.maximum(counted.sum(axis=0), 1)
    mean = (changes * counted).sum(axis=0) / count
    spread = np.sqrt(((changes - mean) ** 2 * counted).sum(axis=0) / count)
    most = (counted.sum(axis=0) >= SENSORS) & (2 * counted.sum(axis=0) > len(sensors))
    return np.where(most & (spread < EQUAL * np.abs(mean)), GRAVITY * mean, 0.0)


def _pulses(acceleration: Floats) -> list[Ride]:
    """Where acceleration keeps its sign, and by how much it changes the speed."""
    signs = np.where(np.abs(acceleration) > LEAST, np.sign(acceleration), 0).astype(np.int64)
    borders = [0, *(np.flatnonzero(np.diff(signs)) + 1).tolist(), len(signs)]
    return [
        Ride(start, stop, float(acceleration[start:stop].sum() / RATE))
        for start, stop in pairwise(borders)
        if signs[start]
    ]


def _rides(pulses: list[Ride]) -> list[Ride]:
    """Pulses in a row whose sum comes back to nothing, in the samples that they are in."""
    found, at = [], 0
    while at < len(pulses):
        end, speed = _end(pulses[at:])
        if end:
            found.append(Ride(pulses[at].start, pulses[at + end - 1].stop, speed))
        at += max(end, 1)
    return found


def _end(pulses: list[Ride]) -> tuple[int, float]:
    """How many of the pulses are one ride, 0 for none, and its largest speed."""
    total, fastest = pulses[0].speed, pulses[0].speed
    for i, (before, pulse) in enumerate(pairwise(pulses), start=1):
        late = (pulse.start - before.stop) / RATE
        again = pulse.speed * total > 0 and abs(pulse.speed) > abs(total) / 2
        if (pulse.stop - pulses[0].start) / RATE > LONGEST or (again and late > APART):
            break
        total += pulse.speed
        fastest = max(fastest, total, key=abs)
        if abs(fastest) >= SPEED and abs(total) < LEFT * abs(fastest):
            return i + 1 + _touches(pulses[i:], total), fastest
    return 0, 0.0


def _touches(pulses: list[Ride], left: float) -> int:
    """How many pulses after the first take back what is left of the speed."""
    count = 0
    for before, pulse in pairwise(pulses):
        late = (pulse.start - before.stop) / RATE
        if late > SOON or abs(left + pulse.speed) >= abs(left):
            break
        left += pulse.speed
        count += 1
    return count
