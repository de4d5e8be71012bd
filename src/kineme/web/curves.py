"""Curves over time for a page, at any zoom, in tiles: heights, speeds, angles, channels.

At level ``l`` of a curve, one pair holds the minimum and maximum of ``FACTOR ** l`` frames, so that
no peak is lost when a pixel covers that many frames. Level 0 is the curve itself. A tile has `TILE`
pairs of little-endian 32-bit floats; missing values are nan. Angles and speeds are computed as in
`kineme.cycles`.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from dataclasses import replace
from math import ceil
from threading import Lock

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Floats
from kineme.cycles.channels import ANGLE, Channel, channels_of, make_motion_channels
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
        self.n_frames, self.fps = recording.n_frames, recording.fps
        # Only heads are kept: channels would keep the recording in memory.
        self._heads = [
            Curve(name=each.name, group=each.group, unit=each.unit)
            for each in list_curves(recording)
        ]
        self._first_analog = len(self._heads)
        if analog is not None:
            self._heads += [Curve(name=name, group="analog", unit="") for name in analog.names]
        self._recent: OrderedDict[int, list[Pairs]] = OrderedDict()
        self._lock = Lock()

    def head(self) -> CurveList:
        """Return the list of curves and the layout of their tiles."""
        n_levels = len(compute_level_sizes(self.n_frames))
        return CurveList(curves=self._heads, factor=FACTOR, tile=TILE, levels=n_levels)

    def tile(
        self, read: Callable[[bool], Motion | Signals], curve: int, level: int, number: int
    ) -> bytes | None:
        """Return the pairs of a tile as bytes; None if there is no such tile.

        ``read(is_analog)`` returns the recording, or its analog channels. It is called only if the
        curve is not cached.
        """
        if not 0 <= curve < len(self._heads):
            return None
        with self._lock:
            levels = self._recent.get(curve)
            if levels is None:
                levels = self._recent[curve] = build_levels(self._compute(read, curve))
            self._recent.move_to_end(curve)
            while len(self._recent) > MAX_CURVES:
                # Drop the least recently used curve.
                self._recent.popitem(last=False)
        if not 0 <= level < len(levels) or not 0 <= number * TILE < len(levels[level]):
            return None
        return levels[level][number * TILE : (number + 1) * TILE].tobytes()

    def _compute(self, read: Callable[[bool], Motion | Signals], curve: int) -> Floats:
        if curve < self._first_analog:
            return list_curves(read(False))[curve].values()
        channel = list_curves(read(True))[curve - self._first_analog]
        return _find_frame_extremes(channel, self.n_frames, self.fps)


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


def list_curves(recording: Motion | Signals) -> list[Channel]:
    """Return the channels of signals; or a body's angles, and height, speed, x and z of joints."""
    if isinstance(recording, Signals):
        return [replace(channel, group="channels") for channel in channels_of(recording)]
    channels = make_motion_channels(recording)
    curves = [channel for channel in channels if channel.group == ANGLE]
    for ending, group in (("y", "height"), ("speed", "speed"), ("x", "x"), ("z", "z")):
        curves += [
            replace(channel, name=channel.source, group=group)  # the page shows joints by group
            for channel in channels
            if channel.group in ("position", "speed")
            and channel.name == f"{channel.source}.{ending}"
        ]
    return curves


def _find_frame_extremes(channel: Channel, n_frames: int, fps: float) -> Floats:
    """Return minimum and maximum of an analog channel in each frame of the motion."""
    values = channel.values()
    # First sample of each frame; the small number compensates rounding errors.
    starts = np.floor(np.arange(n_frames) * (channel.fps / fps) + 1e-9).astype(np.intp)
    # The channel may end before the motion.
    starts = starts[starts < len(values)]
    extremes = np.full((n_frames, 2), np.nan)
    if len(starts):
        extremes[: len(starts), 0] = np.fmin.reduceat(values, starts)
        extremes[: len(starts), 1] = np.fmax.reduceat(values, starts)
    return extremes
