"""What curves are drawn of a recording: heights, speeds, angles, channels.

Angles and speeds are those that `kineme.cycles` measures.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from kineme._util.arrays import Floats
from kineme.cycles.channels import ANGLE, channels_of
from kineme.cycles.joints import bend
from kineme.features.feet import measure_speed
from kineme.recordings import Motion, Signals


@dataclass(frozen=True)
class Drawn:
    """A curve, and how it comes from a recording."""

    name: str
    group: str
    unit: str
    values: Callable[[Motion | Signals], Floats]
    of_frames: bool = True

    def with_gaps(self, recording: Motion | Signals) -> Floats:
        """Return the values, nan in gaps."""
        values = np.array(self.values(recording), np.float64)
        for start, stop in recording.gaps if self.of_frames else ():
            values[start:stop] = np.nan
        return values


def draw_signals(signals: Signals) -> list[Drawn]:
    """Return each channel."""
    return [Drawn(name, "channels", "", _channel(i)) for i, name in enumerate(signals.names)]


def draw_analog(signals: Signals, n_frames: int, fps: float) -> list[Drawn]:
    """Channels beside a motion of so many frames: the least and the greatest value of each."""
    return [
        Drawn(name, "analog", "", _reduce_to_frames(i, n_frames, fps), of_frames=False)
        for i, name in enumerate(signals.names)
    ]


def _reduce_to_frames(
    number: int, n_frames: int, fps: float
) -> Callable[[Motion | Signals], Floats]:
    """Least and greatest value of a channel in each frame of a slower recording."""

    def pairs(recording: Motion | Signals) -> Floats:
        # A copy: gaps are set to nan.
        channel = np.array(_values(recording)[:, number])
        for start, stop in recording.gaps:
            channel[start:stop] = np.nan
        # First sample of each frame; the small number guards against rounding.
        starts = np.floor(np.arange(n_frames) * (recording.fps / fps) + 1e-9).astype(np.intp)
        # The channel may end before the motion.
        starts = starts[starts < len(channel)]
        found = np.full((n_frames, 2), np.nan)
        if len(starts):
            found[: len(starts), 0] = np.fmin.reduceat(channel, starts)
            found[: len(starts), 1] = np.fmax.reduceat(channel, starts)
        return found

    return pairs


def draw_motion(motion: Motion) -> list[Drawn]:
    """Return the body's angles; height, place and speed of each joint, and how far it is bent."""
    names, parents = motion.skeleton.names, motion.skeleton.parents
    lengths = np.linalg.norm(motion.skeleton.offsets, axis=1)
    drawn = [Drawn(name, "height", "m", _place(i, 1)) for i, name in enumerate(names)]
    drawn += [Drawn(name, "speed", "m/s", _measure_speed(i)) for i, name in enumerate(names)]
    for joint, name in enumerate(names):
        # Bones of some length below the joint; a bend needs exactly one.
        ends = [i for i, parent in enumerate(parents) if parent == joint and lengths[i] > 0]
        if parents[joint] >= 0 and lengths[joint] > 0 and len(ends) == 1:
            bend = _flexion(parents[joint], joint, ends[0])
            drawn.append(Drawn(name, "flexion angle", "°", bend))
    for axis, group in ((0, "x"), (2, "z")):
        drawn += [Drawn(name, group, "m", _place(i, axis)) for i, name in enumerate(names)]
    angles = [each for each in channels_of(motion) if each.group == ANGLE]
    return [Drawn(each.name, each.group, each.unit, _angle(each.name)) for each in angles] + drawn


def _channel(number: int) -> Callable[[Motion | Signals], Floats]:
    return lambda recording: _values(recording)[:, number]


def _place(joint: int, axis: int) -> Callable[[Motion | Signals], Floats]:
    return lambda recording: _positions(recording)[:, joint, axis]


def _measure_speed(joint: int) -> Callable[[Motion | Signals], Floats]:
    return lambda recording: measure_speed(_positions(recording)[:, joint], recording.fps)


def _flexion(parent: int, joint: int, end: int) -> Callable[[Motion | Signals], Floats]:
    """Degrees between a bone and the next one; 0 where they are in line."""
    return lambda recording: bend(
        *(_positions(recording)[:, each] for each in (parent, joint, end))
    )


def _angle(name: str) -> Callable[[Motion | Signals], Floats]:
    return lambda recording: channels_of(recording, [name])[0].values()


def _positions(recording: Motion | Signals) -> Floats:
    if not isinstance(recording, Motion):
        raise TypeError("the curve is of a motion")
    return recording.positions


def _values(recording: Motion | Signals) -> Floats:
    if not isinstance(recording, Signals):
        raise TypeError("the curve is of signals")
    return recording.values
