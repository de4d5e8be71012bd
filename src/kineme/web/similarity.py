"""What the self-similarity matrix compares: features of each frame, in units of its scale.

Those of a motion are those of the ``kineme`` method, the ends of the body in
its own frame; two frames are 1 apart at a fifth of a body. Motions without a
known body are compared by the distances between their points, signals by their
channels, each divided by its deviation.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Floats
from kineme.errors import MotionError, ParameterError
from kineme.features import Names, body_size, distance_features, end_effectors, pose_features
from kineme.features.distances import SIZE
from kineme.recordings import Motion
from kineme.recordings.operations import resample
from kineme.web.matrix import RATE, Matrix, pyramid

BODY_SCALE = 0.2  # body sizes; where the activities of subject 86 stand out
SIGNAL_SCALE = 0.5  # of the distance of two samples drawn at random
MOST_CHANNELS = 16


def matrix_of_motion(motion: Motion, *, effectors: Names | None = None) -> Matrix:
    """Return the matrix of a motion.

    Of the distances between its points where it has no known body.

    Examples
    --------
    >>> import kineme
    >>> from kineme.datasets import bundled_recording
    >>> matrix = matrix_of_motion(kineme.read(bundled_recording()))
    >>> matrix.tile(0, 0, 0)[1:4]
    b'PNG'
    """
    try:
        found = end_effectors(motion, names=effectors)
        values = pose_features(motion, effectors=found)
        values /= BODY_SCALE * body_size(motion, found)
    except MotionError:
        motion = resample(motion, min(motion.fps, 3 * RATE))  # distances are many
        values = _distances(motion)
    for start, stop in motion.gaps:
        values[start:stop] = np.nan
    return pyramid(values, motion.fps, motion.duration)


def matrix_of_signal(values: ArrayLike, fps: float) -> Matrix:
    """Return the matrix of any signal (frames, channels) or (frames,); nan for what was not seen.

    ParameterError for what is no such signal, or a frame rate that is not positive.

    Examples
    --------
    >>> matrix_of_signal([[0.0], [1.0], [0.0], [1.0]], fps=2.0).head().sizes
    [4]
    """
    try:
        signal = np.asarray(values, np.float64)
    except (ValueError, TypeError):
        raise ParameterError(
            "a signal is frames x channels of numbers: columns of texts?"
        ) from None
    signal = signal[:, None] if signal.ndim == 1 else signal
    if signal.ndim != 2 or 0 in signal.shape:
        raise ParameterError(f"a signal is frames x channels, not of shape {signal.shape}")
    if not (np.isfinite(fps) and fps > 0):
        raise ParameterError(f"the frame rate must be a positive number, not {fps}")
    averaged = max(1, int(fps / (2 * RATE)))  # frames whose mean is compared: 0.05 s
    starts = np.arange(0, len(signal), averaged)
    lengths = np.diff(starts, append=len(signal))
    means = np.add.reduceat(signal, starts, axis=0) / lengths[:, None]
    return pyramid(_standardise(means), fps / averaged, len(signal) / fps)


def _distances(motion: Motion) -> Floats:
    """Return the features of a motion without a body, in units of the scale.

    Any values in its gaps.
    """
    visible = np.ones(motion.n_frames, np.bool_)
    for start, stop in motion.gaps:
        visible[start:stop] = False
    if motion.skeleton.n_joints < 2 or not visible.any():
        return np.zeros((motion.n_frames, 1))
    features, _ = distance_features(motion.positions[visible])
    values = np.zeros((motion.n_frames, features.shape[1]))
    values[visible] = features / (BODY_SCALE * SIZE)
    return values


def _standardise(values: Floats) -> Floats:
    """Return the channels over their deviation, reduced to the main ones if there are many."""
    visible = np.asarray(np.isfinite(values).all(axis=1))
    if not visible.any():
        return np.full((len(values), 1), np.nan)
    out = np.where(visible[:, None], values, np.nan) - values[visible].mean(axis=0)
    deviation = out[visible].std(axis=0)
    out = out[:, deviation > 0] / deviation[deviation > 0]
    if out.shape[1] == 0:
        return np.where(visible[:, None], 0.0, np.nan)
    if out.shape[1] > MOST_CHANNELS:
        from scipy.linalg import eigh

        n = out.shape[1]
        axes = eigh(np.cov(out[visible].T), subset_by_index=(n - MOST_CHANNELS, n - 1))[1]
        out = out @ axes
    return np.asarray(out / (SIGNAL_SCALE * np.sqrt(2 * out[visible].var(axis=0).sum())))
