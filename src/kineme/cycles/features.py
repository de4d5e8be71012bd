"""What borders are compared by: the pose of a body, or all channels of signals."""

from __future__ import annotations

from math import ceil

import numpy as np
from numpy.typing import NDArray

from kineme.errors import EndEffectorError, MotionError
from kineme.features import distance_features, pose_features
from kineme.recordings import Motion, Signals

Floats = NDArray[np.float64]

RATE = 250.0
"""Samples per second, at most: what is faster is averaged."""
SMOOTH_S = 0.02
"""Signals are smoothed by a normal curve that deviates by this."""


def fine_features(recording: Motion | Signals) -> tuple[Floats, float, bool]:
    """Features of a recording at its rate, or at most `RATE`.

    Parameters
    ----------
    recording : Motion or Signals

    Returns
    -------
    features : (samples, dims) array
    rate : float
        Samples per second.
    comparable : bool
        Whether those of another recording of as many dimensions can be compared with them.
    """
    if isinstance(recording, Signals):
        return *_of_signals(recording), True
    many = ceil(recording.fps / RATE) // 2 * 2 + 1 if recording.fps > RATE else 1
    try:
        return _averaged(pose_features(recording), many), recording.fps / many, True
    except (EndEffectorError, MotionError):
        if recording.skeleton.n_joints < 2:
            return _averaged(recording.positions[:, 0], many), recording.fps / many, False
        found = distance_features(recording.positions)[0]
        return _averaged(found, many), recording.fps / many, False


def _of_signals(signals: Signals) -> tuple[Floats, float]:
    from scipy.ndimage import gaussian_filter1d

    many = ceil(signals.fps / RATE) // 2 * 2 + 1 if signals.fps > RATE else 1
    values, rate = _averaged(signals.values, many), signals.fps / many
    deviation = values.std(axis=0)
    scaled = (values - values.mean(axis=0)) / np.where(deviation > 0, deviation, 1)
    return gaussian_filter1d(scaled, SMOOTH_S * rate, axis=0, mode="nearest"), rate


def _averaged(values: Floats, many: int) -> Floats:
    """The mean of every so many frames, centred on the first of them; the last may be of fewer."""
    if many == 1:
        return values
    from scipy.ndimage import uniform_filter1d

    return np.asarray(uniform_filter1d(values, many, axis=0, mode="nearest")[::many])


def speeds(features: Floats, rate: float, smooth_s: float = 0.08) -> Floats:
    """How fast features change, per second, smoothed."""
    from scipy.ndimage import gaussian_filter1d

    if len(features) < 2:
        return np.zeros(len(features))
    steady = gaussian_filter1d(features, smooth_s * rate, axis=0, mode="nearest")
    return np.asarray(np.linalg.norm(np.gradient(steady, axis=0), axis=1) * rate)
