"""Curves over time for a page, at any zoom, in tiles: heights, speeds, angles, channels.

At level ``l`` of a curve, one pair holds the minimum and maximum of ``FACTOR ** l`` frames, so that
no peak is lost when a pixel covers that many frames. Level 0 is the curve itself. A tile has `TILE`
pairs of little-endian 32-bit floats; missing values are nan. Angles and speeds are computed as in
`kineme.cycles`.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from math import ceil
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Floats
from kineme.cycles.channels import ANGLE, channels_of
from kineme.cycles.joints import bend
from kineme.features.effectors import measure_speed
from kineme.recordings import Motion, Signals
from kineme.web.messages import Curve, CurveList

Pairs = NDArray[np.float32]
FACTOR = 4
"""Frames per pair grow by this factor from level to level."""
TILE = 1024
"""Pairs in a tile."""
MAX_BYTES = 4_000_000
"""Size of all curve tiles in a report."""
MAX_CURVES = 24
"""Curves cached in memory: 6 MB each for an hour at 120 Hz."""


class Curves:
    """Curves of a recording; the most recently used ones are cached.

    ``analog`` are channels beside a motion with their own sampling rate; the minimum and maximum in
    each frame are drawn.
    """

    def __init__(self, recording: Motion | Signals, analog: Signals | None = None):
        self.n_frames = recording.n_frames
        if isinstance(recording, Motion):
            self._drawn = list_motion_curves(recording)
        else:
            self._drawn = [
                CurveSource(name, "channels", "", partial(_get_channel, number=i))
                for i, name in enumerate(recording.names)
            ]
        self._first_analog = len(self._drawn)
        if analog is not None:
            compute = partial(_find_frame_extremes, n_frames=recording.n_frames, fps=recording.fps)
            self._drawn += [
                CurveSource(name, "analog", "", partial(compute, number=i), of_frames=False)
                for i, name in enumerate(analog.names)
            ]
        self._recent: OrderedDict[int, list[Pairs]] = OrderedDict()
        self._lock = Lock()

    def head(self) -> CurveList:
        """Return the list of curves and the layout of their tiles."""
        curves = [Curve(name=each.name, group=each.group, unit=each.unit) for each in self._drawn]
        n_levels = len(compute_level_sizes(self.n_frames))
        return CurveList(curves=curves, factor=FACTOR, tile=TILE, levels=n_levels)

    def tile(
        self, read: Callable[[bool], Motion | Signals], curve: int, level: int, number: int
    ) -> bytes | None:
        """Return the pairs of a tile as bytes; None if there is no such tile.

        ``read(is_analog)`` returns the recording, or its analog channels. It is called only if the
        curve is not cached.
        """
        if not 0 <= curve < len(self._drawn):
            return None
        with self._lock:
            levels = self._recent.get(curve)
            if levels is None:
                source = read(curve >= self._first_analog)
                levels = self._recent[curve] = build_levels(self._drawn[curve].compute(source))
            self._recent.move_to_end(curve)
            while len(self._recent) > MAX_CURVES:
                # Drop the least recently used curve.
                self._recent.popitem(last=False)
        if not 0 <= level < len(levels) or not 0 <= number * TILE < len(levels[level]):
            return None
        return levels[level][number * TILE : (number + 1) * TILE].tobytes()


def make_report_curves(
    recording: Motion | Signals | ArrayLike, fps: float
) -> tuple[CurveList, dict[str, bytes]]:
    """Return the curves of signals for a report, with tiles by "curve/level/number".

    ``fps`` is the rate of an array (frames, channels). Finer levels are omitted once all tiles
    exceed `MAX_BYTES`.
    """
    signals = as_recording(recording, fps)
    curves, tiles = Curves(signals), dict[str, bytes]()
    head, bytes_left = curves.head(), MAX_BYTES
    # Coarse levels first: they cover the whole recording with few bytes.
    for level in reversed(range(head.levels)):
        bins = compute_level_sizes(signals.n_frames)[level]
        indices = [(c, level, n) for c in range(len(head.curves)) for n in range(ceil(bins / TILE))]
        # Two floats of 4 bytes per bin.
        bytes_left -= 8 * bins * len(head.curves)
        if bytes_left < 0 and tiles:
            break
        for index in indices:
            tiles["/".join(map(str, index))] = curves.tile(lambda _: signals, *index) or b""
    return head, tiles


def as_recording(recording: Motion | Signals | ArrayLike, fps: float) -> Motion | Signals:
    """Return the recording; an array (frames, channels) becomes signals of this rate."""
    if isinstance(recording, Motion | Signals):
        return recording
    return Signals(np.nan_to_num(np.asarray(recording, np.float64)), fps)


def build_levels(values: Floats) -> list[Pairs]:
    """Return minimum and maximum (bins, 2) at each level; the last level has at most `TILE` bins.

    ``values`` are (frames,), or (frames, 2) with a minimum and a maximum; nan if missing.

    Examples
    --------
    >>> build_levels(np.array([1.0, 3.0, 2.0]))[0].tolist()
    [[1.0, 1.0], [3.0, 3.0], [2.0, 2.0]]
    """
    pairs = values if values.ndim == 2 else np.repeat(values[:, None], 2, axis=1)
    levels = [pairs.astype("<f4")]
    for size in compute_level_sizes(len(values))[1:]:
        # First bin of each group of FACTOR bins; the last group may be shorter.
        at = np.arange(size) * FACTOR
        # `fmin` and `fmax` ignore nan unless all are nan.
        least = np.fmin.reduceat(levels[-1][:, 0], at)
        greatest = np.fmax.reduceat(levels[-1][:, 1], at)
        levels.append(np.stack([least, greatest], axis=1).astype("<f4"))
    return levels


def compute_level_sizes(n_frames: int) -> list[int]:
    """Return the number of bins of each level."""
    sizes = [n_frames]
    while sizes[-1] > TILE:
        sizes.append(ceil(sizes[-1] / FACTOR))
    return sizes


@dataclass(frozen=True)
class CurveSource:
    """A curve and the function that computes it from a recording, a motion or signals."""

    name: str
    group: str
    unit: str
    values: Callable[[Any], Floats]
    of_frames: bool = True

    def compute(self, recording: Motion | Signals) -> Floats:
        """Return the values, with nan in gaps."""
        values = np.array(self.values(recording), np.float64)
        for start, stop in recording.gaps if self.of_frames else ():
            values[start:stop] = np.nan
        return values


def list_motion_curves(motion: Motion) -> list[CurveSource]:
    """Return the body's angles, then height, speed, bend and floor position of each joint."""
    names, parents = motion.skeleton.names, motion.skeleton.parents
    lengths = np.linalg.norm(motion.skeleton.offsets, axis=1)
    curves = [
        CurveSource(channel.name, ANGLE, channel.unit, partial(_measure_angle, name=channel.name))
        for channel in channels_of(motion)
        if channel.group == ANGLE
    ]
    curves += _list_coordinates(names, 1, "height")
    curves += [
        CurveSource(name, "speed", "m/s", partial(_measure_speed, joint=i))
        for i, name in enumerate(names)
    ]
    for joint, name in enumerate(names):
        # Child bones with a length; a bend is only defined with exactly one.
        ends = [i for i, parent in enumerate(parents) if parent == joint and lengths[i] > 0]
        if parents[joint] >= 0 and lengths[joint] > 0 and len(ends) == 1:
            joints = parents[joint], joint, ends[0]
            bend_of = partial(_measure_bend, joints=joints)
            curves.append(CurveSource(name, "flexion angle", "°", bend_of))
    return [*curves, *_list_coordinates(names, 0, "x"), *_list_coordinates(names, 2, "z")]


def _find_frame_extremes(signals: Signals, number: int, *, n_frames: int, fps: float) -> Floats:
    """Return minimum and maximum of an analog channel in each frame of the motion."""
    # Copy, since gaps are set to nan.
    channel = np.array(signals.values[:, number])
    for start, stop in signals.gaps:
        channel[start:stop] = np.nan
    # First sample of each frame; the small number compensates rounding errors.
    starts = np.floor(np.arange(n_frames) * (signals.fps / fps) + 1e-9).astype(np.intp)
    # The channel may end before the motion.
    starts = starts[starts < len(channel)]
    extremes = np.full((n_frames, 2), np.nan)
    if len(starts):
        extremes[: len(starts), 0] = np.fmin.reduceat(channel, starts)
        extremes[: len(starts), 1] = np.fmax.reduceat(channel, starts)
    return extremes


def _list_coordinates(names: Sequence[str], axis: int, group: str) -> list[CurveSource]:
    return [
        CurveSource(name, group, "m", partial(_get_coordinate, joint=i, axis=axis))
        for i, name in enumerate(names)
    ]


def _get_channel(signals: Signals, number: int) -> Floats:
    return signals.values[:, number]


def _get_coordinate(motion: Motion, joint: int, axis: int) -> Floats:
    return motion.positions[:, joint, axis]


def _measure_speed(motion: Motion, joint: int) -> Floats:
    return measure_speed(motion.positions[:, joint], motion.fps)


def _measure_bend(motion: Motion, joints: tuple[int, int, int]) -> Floats:
    """Return the angle between two bones in degrees; 0 if straight."""
    return bend(*(motion.positions[:, joint] for joint in joints))


def _measure_angle(motion: Motion, name: str) -> Floats:
    return channels_of(motion, [name])[0].values()
