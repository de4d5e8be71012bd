"""What borders are compared by: the pose of a body, or all channels of signals."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import ceil

import numpy as np

from kineme._util.arrays import Floats
from kineme.errors import EndEffectorError, MotionError
from kineme.features import distance_features, pose_features
from kineme.recordings import Motion, Signals

RATE = 250.0
"""Samples per second, at most: what is faster is averaged."""
SMOOTH_S = 0.02
"""Features are smoothed by a normal curve that deviates by this."""
STEADY_S = 0.08
"""Again, before their speed is taken, so that noise is no movement."""


@dataclass(frozen=True)
class FineFeatures:
    """Features of a recording at its rate, or at most `RATE`.

    Attributes
    ----------
    values : (samples, dims) array
    rate : float
        Samples per second.
    comparable : bool
        Whether those of another recording of as many dimensions can be compared with them.
    """

    values: Floats
    rate: float
    comparable: bool

    @cached_property
    def speed(self) -> Floats:
        """How fast they change, per second, smoothed."""
        from scipy.ndimage import gaussian_filter1d

        if len(self.values) < 2:
            return np.zeros(len(self.values))
        # Smoothed once more, since a derivative amplifies noise.
        steady = gaussian_filter1d(self.values, STEADY_S * self.rate, axis=0, mode="nearest")
        return np.asarray(np.linalg.norm(np.gradient(steady, axis=0), axis=1) * self.rate)


def fine_features(recording: Motion | Signals) -> FineFeatures:
    """Return the pose of a body, distances between its points where it has none, or all channels.

    Parameters
    ----------
    recording : Motion or Signals

    Returns
    -------
    FineFeatures
    """
    from scipy.ndimage import gaussian_filter1d

    # An odd number of frames, so that each mean is centred on a frame.
    many = ceil(recording.fps / RATE) // 2 * 2 + 1 if recording.fps > RATE else 1
    rate = recording.fps / many
    found, comparable = _features(recording)
    values = _average_frames(found, many)
    # Channels have different units: each counts by its own deviation, a constant one is only 0.
    if isinstance(recording, Signals):
        deviation = values.std(axis=0)
        values = (values - values.mean(axis=0)) / np.where(deviation > 0, deviation, 1)
    values = gaussian_filter1d(values, SMOOTH_S * rate, axis=0, mode="nearest")
    return FineFeatures(values, rate, comparable)


def _features(recording: Motion | Signals) -> tuple[Floats, bool]:
    """Features of each frame, and whether those of another recording can be compared with them."""
    if isinstance(recording, Signals):
        return recording.values, True
    try:
        return pose_features(recording), True
    except (EndEffectorError, MotionError):
        single = recording.skeleton.n_joints < 2
        positions = recording.positions
        # A single point has no distances: its path is compared.
        return positions[:, 0] if single else distance_features(positions)[0], False


def _average_frames(values: Floats, many: int) -> Floats:
    """Return the mean of the frames about every so many; the last may be of fewer."""
    if many == 1:
        return values
    from scipy.ndimage import uniform_filter1d

    # The mean about each frame, of which every n-th is kept.
    return np.asarray(uniform_filter1d(values, many, axis=0, mode="nearest")[::many])
