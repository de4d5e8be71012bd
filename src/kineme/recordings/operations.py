"""Cut, resample, scale, turn and move recordings.

Each function returns a new recording and adds a note to its provenance.
"""

from __future__ import annotations

from dataclasses import replace
from math import ceil, cos, floor, sin
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from kineme._util import rotations as rot
from kineme._util.arrays import Floats, interpolate_frames
from kineme._util.checks import check_rates, check_type, is_number
from kineme.errors import MotionError, ParameterError
from kineme.recordings.kinematics import compute_local_translations, forward_kinematics
from kineme.recordings.motion import Motion, check_motion
from kineme.recordings.signals import Signals

AnyRecording = TypeVar("AnyRecording", Motion, Signals)


def resample(recording: AnyRecording, fps: float) -> AnyRecording:
    """Return the recording at the times 0, 1/fps, 2/fps, ... up to its last frame.

    The result has floor((N - 1) fps / old) + 1 frames. If the old rate is a whole multiple of the
    new one, frames are selected. Otherwise rotations of joints are interpolated on the sphere and
    translations linearly, so that bones keep their length. Positions without rotations, and
    channels, are interpolated linearly. No filter is applied: smooth what is faster than fps / 2
    first.

    Parameters
    ----------
    recording : Motion or Signals
    fps : float
        Frames per second.

    Returns
    -------
    Motion or Signals
        The same object if it has this rate already.

    Raises
    ------
    ParameterError
        ``fps`` is not a positive number, or too large.

    Notes
    -----
    [V14], section 5 works at 30 Hz; at whole ratios the spline of the authors' program
    amounts to taking every fourth frame as well.

    Examples
    --------
    >>> import kineme
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> kineme.resample(motion, 30.0).n_frames, motion.n_frames
    (1449, 2898)
    """
    advice = "kineme.read(path) and kineme.as_signals(array) give one"
    check_type(recording, (Motion, Signals), "resample", advice)
    if not (is_number(fps) and fps > 0):
        raise ParameterError(f"fps is {fps!r:.60}: give frames per second, above 0")
    ratio = recording.fps / fps
    if ratio == 1:
        return recording
    check_rates(recording.fps, fps)
    # The small number keeps the last frame despite rounding errors.
    n = floor((recording.n_frames - 1) / ratio + 1e-9) + 1
    # Rounding must not lead beyond the last frame.
    at = np.minimum(np.arange(n) * ratio, recording.n_frames - 1)
    # A whole ratio, up to rounding: select frames instead of interpolating.
    is_whole = abs(ratio - round(ratio)) < 1e-9 * ratio
    provenance = recording.provenance.noted(f"resampled from {recording.fps:g} to {fps:g} Hz")
    gaps = _move_gaps(recording, ratio, n)
    if isinstance(recording, Signals):
        values = recording.values
        values = values[:: round(ratio)] if is_whole else interpolate_frames(values, at)
        return replace(recording, values=values, fps=fps, gaps=gaps, provenance=provenance)
    skeleton, positions, rotations = recording.skeleton, recording.positions, recording.rotations
    if is_whole:
        positions = positions[:: round(ratio)]
        rotations = None if rotations is None else rotations[:: round(ratio)]
    elif rotations is None:
        positions = interpolate_frames(positions, at)
    else:
        # Translations are interpolated in the parents' frames, so bones keep their length.
        translations = compute_local_translations(skeleton, positions, rotations)
        rotations = _interpolate_rotations(rotations, at)
        positions = forward_kinematics(
            skeleton, rotations, translations=interpolate_frames(translations, at)
        )
    return Motion(skeleton, positions, fps, rotations, provenance, gaps)


def cut(recording: AnyRecording, start: int, stop: int) -> AnyRecording:
    """Return frames start to stop - 1, with the gaps and events in them.

    Same as ``recording[start:stop]``, but raises for frames outside the recording.

    Parameters
    ----------
    recording : Motion or Signals
    start, stop : int
        Frames.

    Returns
    -------
    Motion or Signals

    Raises
    ------
    ParameterError
        Unless 0 <= start < stop <= n_frames.

    Examples
    --------
    >>> import kineme
    >>> from kineme.recordings.operations import cut
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> cut(motion, 60, 180).duration
    2.0
    """
    if not 0 <= start < stop <= recording.n_frames:
        raise ParameterError(
            f"frames {start} to {stop} are not within a recording of {recording.n_frames} frames"
        )
    return recording[start:stop]


def split_at_gaps(recording: AnyRecording) -> list[tuple[int, AnyRecording]]:
    """Return the parts between gaps, each with its first frame.

    Parameters
    ----------
    recording : Motion or Signals
        Returned whole if it has no gaps.

    Returns
    -------
    list of (int, Motion or Signals)

    Raises
    ------
    MotionError
        The whole motion is a gap.

    Examples
    --------
    >>> from kineme import Signals
    >>> from kineme.recordings.operations import split_at_gaps
    >>> signals = Signals([[0.0]] * 9, fps=3, gaps=[(3, 5)])
    >>> [(start, span.n_frames) for start, span in split_at_gaps(signals)]
    [(0, 3), (5, 4)]
    """
    if not recording.gaps:
        return [(0, recording)]
    parts = [(start, recording[start:stop]) for start, stop in recording.spans()]
    if not parts:
        raise MotionError("the body is not seen in any frame of this motion")
    return parts


def scale(motion: Motion, factor: float) -> Motion:
    """Return the motion with the body and its path scaled by a factor.

    Parameters
    ----------
    motion : Motion
    factor : float
        Above 0.

    Returns
    -------
    Motion

    Examples
    --------
    >>> import kineme
    >>> from kineme.recordings.operations import scale
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> bool((scale(motion, 2.0).positions == 2 * motion.positions).all())
    True
    """
    check_motion(motion, "scale")
    if not (is_number(factor) and factor > 0):
        raise ParameterError(f"factor is {factor!r:.60}: give a number above 0")
    skeleton = motion.skeleton
    rig = None if skeleton.rig is None else skeleton.rig.scale(factor)
    return replace(
        motion,
        skeleton=replace(skeleton, offsets=factor * skeleton.offsets, rig=rig),
        positions=factor * motion.positions,
        provenance=motion.provenance.noted(f"scaled by {factor:g}"),
    )


def turn(motion: Motion, angle: float) -> Motion:
    """Return the motion turned about the vertical through the origin.

    Parameters
    ----------
    motion : Motion
    angle : float
        Radians.

    Returns
    -------
    Motion

    Examples
    --------
    >>> import numpy as np
    >>> import kineme
    >>> from kineme.recordings.operations import turn
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> half = turn(motion, np.pi)
    >>> bool(np.allclose(half.positions[..., 0], -motion.positions[..., 0]))
    True
    """
    check_motion(motion, "turn")
    if not is_number(angle):
        raise ParameterError(f"angle is {angle!r:.60}: give a finite number, in radians")
    # A quaternion of half the angle about y.
    about_y = np.array([cos(angle / 2), 0.0, sin(angle / 2), 0.0])
    rotations = motion.rotations
    if rotations is not None:
        rotations = np.array(rotations)
        roots = [j for j, parent in enumerate(motion.skeleton.parents) if parent < 0]
        # Only roots: all other joints are relative to their parents.
        rotations[:, roots] = rot.multiply(about_y, rotations[:, roots])
    return replace(
        motion,
        positions=rot.rotate(about_y, motion.positions),
        rotations=rotations,
        provenance=motion.provenance.noted(f"turned about the vertical by {angle:g} rad"),
    )


def move(motion: Motion, offset: ArrayLike) -> Motion:
    """Return the motion with an offset added to every position.

    Parameters
    ----------
    motion : Motion
    offset : array_like, shape (3,)
        Metres.

    Returns
    -------
    Motion

    Examples
    --------
    >>> import kineme
    >>> from kineme.recordings.operations import move
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> move(motion, [1.0, 0.0, 0.0]).provenance.notes[-1].text
    'moved by [1.0, 0.0, 0.0] m'
    """
    step = np.asarray(offset, float)
    if step.shape != (3,) or not np.isfinite(step).all():
        raise ParameterError(f"offset is {offset!r}: give three numbers in metres")
    return replace(
        motion,
        positions=motion.positions + step,
        provenance=motion.provenance.noted(f"moved by {step.tolist()} m"),
    )


def _move_gaps(recording: Motion | Signals, ratio: float, n: int) -> tuple[tuple[int, int], ...]:
    """Return the gaps of the recording, in the n frames of one resampled every ``ratio`` frames.

    A new frame between a recorded frame and a gap belongs to the gap.
    """
    spans: list[tuple[int, int]] = []
    # The small numbers keep borders on whole frames despite rounding errors.
    for start, stop in recording.gaps:
        # The first new frame after the last recorded one before the gap.
        begin = max(0, floor((start - 1) / ratio + 1e-9) + 1)
        # The first new frame at or after the end of the gap.
        end = min(n, ceil(stop / ratio - 1e-9))
        # Gaps that touch at the new rate become one.
        if spans and begin <= spans[-1][1]:
            begin = spans.pop()[0]
        if begin < end:
            spans.append((begin, end))
    return tuple(spans)


def _interpolate_rotations(rotations: Floats, at: Floats) -> Floats:
    """Return rotations at fractional frames, interpolated along the shorter arc."""
    from scipy.spatial.transform import Rotation, Slerp  # heavy, and seldom needed

    if len(rotations) == 1:
        return np.repeat(rotations, len(at), axis=0)
    frames = np.arange(len(rotations))
    out = np.empty((len(at), rotations.shape[1], 4))
    for j in range(rotations.shape[1]):
        # SciPy puts w last in a quaternion, kineme first.
        turns = Rotation.from_quat(np.roll(rotations[:, j], -1, axis=1))
        out[:, j] = np.roll(Slerp(frames, turns)(at).as_quat(), 1, axis=1)
    return out
