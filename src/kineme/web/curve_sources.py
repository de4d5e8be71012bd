"""Curves that a page draws of a recording: heights, speeds, angles, channels.

Angles and speeds are computed as in `kineme.cycles`.
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
