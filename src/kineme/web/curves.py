"""Curves over time for a page, at any zoom, in tiles.

At level ``l`` of a curve, one pair holds the minimum and maximum of ``FACTOR ** l`` frames, so that
no peak is lost when a pixel covers that many frames. Level 0 is the curve itself. A tile has `TILE`
pairs of little-endian 32-bit floats; missing values are nan.

@@curve_sources: Curves that a page draws of a recording: heights, speeds, angles, channels.

Angles and speeds are computed as in `kineme.cycles`.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from math import ceil
from threading import Lock

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Floats
from kineme.cycles.channels import ANGLE, channels_of
from kineme.cycles.joints import bend
from kineme.features.effectors import measure_speed
from kineme.recordings import Motion, Signals
from kineme.web.messages import Curve, CurveList


@dataclass(frozen=True)
class CurveSource:
    """A curve and the function that computes it from a recording."""

    name: str
    group: str
    unit: str
    values: Callable[[Motion | Signals], Floats]
    of_frames: bool = True

    def compute(self, recording: Motion | Signals) -> Floats:
        """Return the values, with nan in gaps."""
        values = np.array(self.values(recording), np.float64)
        for start, stop in recording.gaps if self.of_frames else ():
            values[start:stop] = np.nan
        return values


def list_signal_curves(signals: Signals) -> list[CurveSource]:
    """Return a curve for each channel."""
    return [
        CurveSource(name, "channels", "", _make_channel(i)) for i, name in enumerate(signals.names)
    ]


def list_analog_curves(signals: Signals, n_frames: int, fps: float) -> list[CurveSource]:
    """Return a curve for each analog channel: its minimum and maximum in each frame."""
    return [
        CurveSource(name, "analog", "", _make_frame_extremes(i, n_frames, fps), of_frames=False)
        for i, name in enumerate(signals.names)
    ]


def _make_frame_extremes(
    number: int, n_frames: int, fps: float
) -> Callable[[Motion | Signals], Floats]:
    """Return a function that computes minimum and maximum of a channel in each motion frame."""

    def compute(recording: Motion | Signals) -> Floats:
        # Copy, since gaps are set to nan.
        channel = np.array(_get_values(recording)[:, number])
        for start, stop in recording.gaps:
            channel[start:stop] = np.nan
        # First sample of each frame; the small number compensates rounding errors.
        starts = np.floor(np.arange(n_frames) * (recording.fps / fps) + 1e-9).astype(np.intp)
        # The channel may end before the motion.
        starts = starts[starts < len(channel)]
        extremes = np.full((n_frames, 2), np.nan)
        if len(starts):
            extremes[: len(starts), 0] = np.fmin.reduceat(channel, starts)
            extremes[: len(starts), 1] = np.fmax.reduceat(channel, starts)
        return extremes

    return compute


def list_motion_curves(motion: Motion) -> list[CurveSource]:
    """Return the body's angles, then height, speed, bend and floor position of each joint."""
    names, parents = motion.skeleton.names, motion.skeleton.parents
    lengths = np.linalg.norm(motion.skeleton.offsets, axis=1)
    curves = [
        CurveSource(name, "height", "m", _make_coordinate(i, 1)) for i, name in enumerate(names)
    ]
    curves += [CurveSource(name, "speed", "m/s", _make_speed(i)) for i, name in enumerate(names)]
    for joint, name in enumerate(names):
        # Child bones with a length; a bend is only defined with exactly one.
        ends = [i for i, parent in enumerate(parents) if parent == joint and lengths[i] > 0]
        if parents[joint] >= 0 and lengths[joint] > 0 and len(ends) == 1:
            bend = _make_flexion(parents[joint], joint, ends[0])
            curves.append(CurveSource(name, "flexion angle", "°", bend))
    for axis, group in ((0, "x"), (2, "z")):
        curves += [
            CurveSource(name, group, "m", _make_coordinate(i, axis)) for i, name in enumerate(names)
        ]
    angles = [channel for channel in channels_of(motion) if channel.group == ANGLE]
    return [
        CurveSource(channel.name, channel.group, channel.unit, _make_angle(channel.name))
        for channel in angles
    ] + curves


def _make_channel(number: int) -> Callable[[Motion | Signals], Floats]:
    return lambda recording: _get_values(recording)[:, number]


def _make_coordinate(joint: int, axis: int) -> Callable[[Motion | Signals], Floats]:
    return lambda recording: _get_positions(recording)[:, joint, axis]


def _make_speed(joint: int) -> Callable[[Motion | Signals], Floats]:
    return lambda recording: measure_speed(_get_positions(recording)[:, joint], recording.fps)


def _make_flexion(parent: int, joint: int, end: int) -> Callable[[Motion | Signals], Floats]:
    """Return a function that computes the angle between two bones in degrees; 0 if straight."""
    return lambda recording: bend(
        *(_get_positions(recording)[:, each] for each in (parent, joint, end))
    )


def _make_angle(name: str) -> Callable[[Motion | Signals], Floats]:
    return lambda recording: channels_of(recording, [name])[0].values()


def _get_positions(recording: Motion | Signals) -> Floats:
    if not isinstance(recording, Motion):
        raise TypeError("the curve is of a motion")
    return recording.positions


def _get_values(recording: Motion | Signals) -> Floats:
    if not isinstance(recording, Signals):
        raise TypeError("the curve is of signals")
    return recording.values


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
        self._drawn = (
            list_motion_curves(recording)
            if isinstance(recording, Motion)
            else list_signal_curves(recording)
        )
        self._first_analog = len(self._drawn)
        if analog is not None:
            self._drawn += list_analog_curves(analog, recording.n_frames, recording.fps)
        self._recent: OrderedDict[int, list[Pairs]] = OrderedDict()
        self._lock = Lock()

    def head(self) -> CurveList:
        """Return the list of curves and the layout of their tiles."""
        curves = [
            Curve(name=curve.name, group=curve.group, unit=curve.unit) for curve in self._drawn
        ]
        return CurveList(
            curves=curves, factor=FACTOR, tile=TILE, levels=len(compute_level_sizes(self.n_frames))
        )

    def tile(
        self,
        read: Callable[[bool], Motion | Signals],
        curve: int,
        level: int,
        number: int,
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


def as_recording(recording: Motion | Signals | ArrayLike, fps: float) -> Motion | Signals:
    """Return the recording; an array (frames, channels) becomes signals of this rate."""
    if isinstance(recording, Motion | Signals):
        return recording
    return Signals(np.nan_to_num(np.asarray(recording, np.float64)), fps)


def make_report_curves(
    recording: Motion | Signals | ArrayLike, fps: float, max_bytes: int = MAX_BYTES
) -> tuple[CurveList, dict[str, bytes]]:
    """Return the curves of signals for a report, with tiles by "curve/level/number".

    ``fps`` is the rate of an array (frames, channels). Finer levels are omitted once all tiles
    exceed ``max_bytes``.
    """
    signals = as_recording(recording, fps)
    curves, tiles = Curves(signals), dict[str, bytes]()
    head, bytes_left = curves.head(), max_bytes
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
