"""What a page draws as curves over time, at any zoom, a piece at a time.

A curve has levels: at level ``l`` one number pair stands for ``FACTOR ** l`` frames, the least and
the greatest value in them, so that a pixel wide as many frames shows everything that happens in
them. Level 0 is the curve itself. A piece holds `PIECE` pairs, 32-bit floats, little end first;
nan where nothing was seen.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from math import ceil
from threading import Lock

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme.recordings import Motion, Signals
from kineme.web.messages import Curve, CurveList

Floats = NDArray[np.float64]
Pairs = NDArray[np.float32]

FACTOR = 4
PIECE = 1024
MOST_BYTES = 4_000_000
"""Of the pieces in a report."""
MOST_KNOWN = 24
"""Curves whose levels stay in memory: 6 MB each for an hour at 120 Hz."""


@dataclass(frozen=True)
class Drawn:
    """A curve, and how it comes from a recording."""

    name: str
    group: str
    unit: str
    values: Callable[[Motion | Signals], Floats]
    of_frames: bool = True

    def seen(self, recording: Motion | Signals) -> Floats:
        """The values, nan in gaps."""
        values = np.array(self.values(recording), np.float64)
        for start, stop in recording.gaps if self.of_frames else ():
            values[start:stop] = np.nan
        return values


class Curves:
    """The curves of a recording; those looked at last stay in memory.

    Parameters
    ----------
    recording : Motion or Signals
    analog : Signals, optional
        Channels beside a motion, at a rate of their own: of each frame the least and the
        greatest value are drawn.
    """

    def __init__(self, recording: Motion | Signals, analog: Signals | None = None):
        self.n_frames = recording.n_frames
        self._drawn = (
            _of_motion(recording) if isinstance(recording, Motion) else _of_signals(recording)
        )
        self._first_analog = len(self._drawn)
        if analog is not None:
            self._drawn += _of_analog(analog, recording.n_frames, recording.fps)
        self._known: OrderedDict[int, list[Pairs]] = OrderedDict()
        self._lock = Lock()

    def head(self) -> CurveList:
        """Which curves there are, and how their pieces are asked for."""
        curves = [Curve(name=each.name, group=each.group, unit=each.unit) for each in self._drawn]
        return CurveList(
            curves=curves, factor=FACTOR, piece=PIECE, levels=len(level_sizes(self.n_frames))
        )

    def piece(
        self,
        read: Callable[[bool], Motion | Signals],
        curve: int,
        level: int,
        number: int,
    ) -> bytes | None:
        """Some pairs of a curve; None where there are none.

        Parameters
        ----------
        read : callable
            Gives the recording, where the curve is not in memory; with True its analog channels.
        curve : int
            Its place in the list.
        level, number : int
            Each from 0.

        Returns
        -------
        bytes or None
        """
        if not 0 <= curve < len(self._drawn):
            return None
        with self._lock:
            levels = self._known.get(curve)
            if levels is None:
                source = read(curve >= self._first_analog)
                levels = self._known[curve] = levels_of(self._drawn[curve].seen(source))
            self._known.move_to_end(curve)
            while len(self._known) > MOST_KNOWN:
                self._known.popitem(last=False)
        if not 0 <= level < len(levels) or not 0 <= number * PIECE < len(levels[level]):
            return None
        return levels[level][number * PIECE : (number + 1) * PIECE].tobytes()


def curves_of(
    recording: Motion | Signals | ArrayLike, fps: float, most_bytes: int = MOST_BYTES
) -> tuple[CurveList, dict[str, bytes]]:
    """The curves of signals as a page has them that cannot ask for them.

    Parameters
    ----------
    recording : Motion, Signals or array_like
        Arrays are (frames, channels).
    fps : float
        Frames per second of an array.
    most_bytes : int
        Length of all pieces together; finer levels are left out where they are longer.

    Returns
    -------
    head : CurveList
    pieces : dict
        By "curve/level/number".
    """
    if not isinstance(recording, Motion | Signals):
        recording = Signals(np.nan_to_num(np.asarray(recording, np.float64)), fps)
    signals = recording
    curves, pieces = Curves(signals), dict[str, bytes]()
    head, left = curves.head(), most_bytes
    for level in reversed(range(head.levels)):
        bins = level_sizes(signals.n_frames)[level]
        places = [(c, level, n) for c in range(len(head.curves)) for n in range(ceil(bins / PIECE))]
        left -= 8 * bins * len(head.curves)
        if left < 0 and pieces:
            break
        for place in places:
            pieces["/".join(map(str, place))] = curves.piece(lambda _: signals, *place) or b""
    return head, pieces


def levels_of(values: Floats) -> list[Pairs]:
    """Least and greatest values of ever more frames.

    Parameters
    ----------
    values : (frames,) or (frames, 2) array
        nan where nothing was seen; two are the least and the greatest of a frame.

    Returns
    -------
    list of (bins, 2) array
        The last has at most `PIECE` bins.

    Examples
    --------
    >>> levels_of(np.array([1.0, 3.0, 2.0]))[0].tolist()
    [[1.0, 1.0], [3.0, 3.0], [2.0, 2.0]]
    """
    pairs = values if values.ndim == 2 else np.repeat(values[:, None], 2, axis=1)
    levels = [pairs.astype("<f4")]
    for size in level_sizes(len(values))[1:]:
        at = np.arange(size) * FACTOR
        least = np.fmin.reduceat(levels[-1][:, 0], at)
        greatest = np.fmax.reduceat(levels[-1][:, 1], at)
        levels.append(np.stack([least, greatest], axis=1).astype("<f4"))
    return levels


def level_sizes(n_frames: int) -> list[int]:
    """How many bins each level has."""
    sizes = [n_frames]
    while sizes[-1] > PIECE:
        sizes.append(ceil(sizes[-1] / FACTOR))
    return sizes


def _of_signals(signals: Signals) -> list[Drawn]:
    return [Drawn(name, "channels", "", _channel(i)) for i, name in enumerate(signals.names)]


def _of_analog(signals: Signals, n_frames: int, fps: float) -> list[Drawn]:
    return [
        Drawn(name, "analog", "", _in_frames(i, n_frames, fps), of_frames=False)
        for i, name in enumerate(signals.names)
    ]


def _in_frames(number: int, n_frames: int, fps: float) -> Callable[[Motion | Signals], Floats]:
    """Least and greatest value of a channel in each frame of a slower recording."""

    def pairs(recording: Motion | Signals) -> Floats:
        channel = np.array(_values(recording)[:, number])
        for start, stop in recording.gaps:
            channel[start:stop] = np.nan
        starts = np.floor(np.arange(n_frames) * (recording.fps / fps) + 1e-9).astype(np.intp)
        there = starts[starts < len(channel)]
        found = np.full((n_frames, 2), np.nan)
        if len(there):
            found[: len(there), 0] = np.fmin.reduceat(channel, there)
            found[: len(there), 1] = np.fmax.reduceat(channel, there)
        return found

    return pairs


def _of_motion(motion: Motion) -> list[Drawn]:
    """Height, place and speed of each joint, and how far it is bent where two bones meet."""
    names, parents = motion.skeleton.names, motion.skeleton.parents
    lengths = np.linalg.norm(motion.skeleton.offsets, axis=1)
    drawn = [Drawn(name, "height", "m", _place(i, 1)) for i, name in enumerate(names)]
    drawn += [Drawn(name, "speed", "m/s", _speed(i)) for i, name in enumerate(names)]
    for joint, name in enumerate(names):
        ends = [i for i, parent in enumerate(parents) if parent == joint and lengths[i] > 0]
        if parents[joint] >= 0 and lengths[joint] > 0 and len(ends) == 1:
            bend = _flexion(parents[joint], joint, ends[0])
            drawn.append(Drawn(name, "flexion angle", "°", bend))
    for axis, group in ((0, "x"), (2, "z")):
        drawn += [Drawn(name, group, "m", _place(i, axis)) for i, name in enumerate(names)]
    return drawn


def _channel(number: int) -> Callable[[Motion | Signals], Floats]:
    return lambda recording: _values(recording)[:, number]


def _place(joint: int, axis: int) -> Callable[[Motion | Signals], Floats]:
    return lambda recording: _positions(recording)[:, joint, axis]


def _speed(joint: int) -> Callable[[Motion | Signals], Floats]:
    def values(recording: Motion | Signals) -> Floats:
        places = _positions(recording)[:, joint]
        if len(places) < 2:
            return np.zeros(len(places))
        return np.asarray(np.linalg.norm(np.gradient(places, axis=0), axis=1) * recording.fps)

    return values


def _flexion(parent: int, joint: int, end: int) -> Callable[[Motion | Signals], Floats]:
    """Degrees between a bone and the next one; 0 where they are in line."""

    def values(recording: Motion | Signals) -> Floats:
        places = _positions(recording)
        before, after = places[:, joint] - places[:, parent], places[:, end] - places[:, joint]
        sine = np.linalg.norm(np.cross(before, after), axis=1)
        return np.asarray(np.degrees(np.arctan2(sine, (before * after).sum(axis=1))))

    return values


def _positions(recording: Motion | Signals) -> Floats:
    if not isinstance(recording, Motion):
        raise TypeError("the curve is of a motion")
    return recording.positions


def _values(recording: Motion | Signals) -> Floats:
    if not isinstance(recording, Signals):
        raise TypeError("the curve is of signals")
    return recording.values
