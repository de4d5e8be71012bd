"""What a page draws as curves over time, at any zoom, a tile at a time.

A curve has levels: at level ``l`` one number pair stands for ``FACTOR ** l`` frames, the least and
the greatest value in them, so that a pixel wide as many frames shows everything that happens in
them. Level 0 is the curve itself. A tile holds `TILE` pairs, 32-bit floats, little end first;
nan where nothing was seen.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from math import ceil
from threading import Lock

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Floats
from kineme.recordings import Motion, Signals
from kineme.web.drawn import list_analog_curves, list_motion_curves, list_signal_curves
from kineme.web.messages import Curve, CurveList

Pairs = NDArray[np.float32]

FACTOR = 4
TILE = 1024
MOST_BYTES = 4_000_000
"""Of the tiles in a report."""
MOST_IN_MEMORY = 24
"""Curves whose levels stay in memory: 6 MB each for an hour at 120 Hz."""


class Curves:
    """Curves of a recording; those looked at last stay in memory.

    ``analog`` are channels beside a motion, at a rate of their own: of each frame the least and the
    greatest value are drawn.
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
        """Return which curves there are, and how their tiles are asked for."""
        curves = [Curve(name=each.name, group=each.group, unit=each.unit) for each in self._drawn]
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
        """Some pairs of a curve; None where there are none.

        ``read`` gives the recording where the curve is not in memory; with True, its analog
        channels.
        """
        if not 0 <= curve < len(self._drawn):
            return None
        with self._lock:
            levels = self._recent.get(curve)
            if levels is None:
                source = read(curve >= self._first_analog)
                levels = self._recent[curve] = build_levels(self._drawn[curve].with_gaps(source))
            self._recent.move_to_end(curve)
            while len(self._recent) > MOST_IN_MEMORY:
                # Drop the curve that was looked at longest ago.
                self._recent.popitem(last=False)
        if not 0 <= level < len(levels) or not 0 <= number * TILE < len(levels[level]):
            return None
        # Pairs of 4-byte floats, little end first.
        return levels[level][number * TILE : (number + 1) * TILE].tobytes()


def as_recording(recording: Motion | Signals | ArrayLike, fps: float) -> Motion | Signals:
    """Return the recording; signals where it is an array (frames, channels) of that rate."""
    if isinstance(recording, Motion | Signals):
        return recording
    return Signals(np.nan_to_num(np.asarray(recording, np.float64)), fps)


def make_report_curves(
    recording: Motion | Signals | ArrayLike, fps: float, most_bytes: int = MOST_BYTES
) -> tuple[CurveList, dict[str, bytes]]:
    """Return the curves of signals, with tiles by "curve/level/number", for a page that cannot ask.

    ``fps`` is that of an array (frames, channels). Finer levels are left out where all together
    would be longer than ``most_bytes``.
    """
    signals = as_recording(recording, fps)
    curves, tiles = Curves(signals), dict[str, bytes]()
    head, left = curves.head(), most_bytes
    # Coarse levels first: they cover the whole recording in little room.
    for level in reversed(range(head.levels)):
        bins = compute_level_sizes(signals.n_frames)[level]
        places = [(c, level, n) for c in range(len(head.curves)) for n in range(ceil(bins / TILE))]
        # Two floats of 4 bytes a bin.
        left -= 8 * bins * len(head.curves)
        if left < 0 and tiles:
            break
        for place in places:
            tiles["/".join(map(str, place))] = curves.tile(lambda _: signals, *place) or b""
    return head, tiles


def build_levels(values: Floats) -> list[Pairs]:
    """Least and greatest values (bins, 2) of ever more frames; the last has `TILE` bins at most.

    Values are nan where nothing was seen; two are the least and the greatest of a frame.

    Examples
    --------
    >>> build_levels(np.array([1.0, 3.0, 2.0]))[0].tolist()
    [[1.0, 1.0], [3.0, 3.0], [2.0, 2.0]]
    """
    pairs = values if values.ndim == 2 else np.repeat(values[:, None], 2, axis=1)
    levels = [pairs.astype("<f4")]
    for size in compute_level_sizes(len(values))[1:]:
        # The first bin of each group; the last group may be shorter.
        at = np.arange(size) * FACTOR
        # `fmin` and `fmax` ignore nan unless all are nan.
        least = np.fmin.reduceat(levels[-1][:, 0], at)
        greatest = np.fmax.reduceat(levels[-1][:, 1], at)
        levels.append(np.stack([least, greatest], axis=1).astype("<f4"))
    return levels


def compute_level_sizes(n_frames: int) -> list[int]:
    """Return how many bins each level has."""
    sizes = [n_frames]
    while sizes[-1] > TILE:
        sizes.append(ceil(sizes[-1] / FACTOR))
    return sizes
