"""Compute the envelopes of muscle signals (electromyograms).

Electrodes measure noise of both signs, whose strength shows the activity of a muscle.
The rectified and low-passed signal is the envelope, which repeats with the movement.

Source: Krüger et al. 2017, section VII-B (rectified, resampled, low-passed). Here the
low-pass filter comes before the resampling, to avoid aliasing. Its cutoff and order are
those usual for linear envelopes in biomechanics.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme.errors import ParameterError
from kineme.features.filters import filter_low

CUTOFF = 6.0
"""Default cutoff of the low-pass filter, Hz."""


def emg_envelope(values: ArrayLike, fps: float, *, cutoff: float = CUTOFF) -> NDArray[np.float64]:
    """Return the envelopes (frames, channels) of raw muscle signals, at the same rate, at least 0.

    Each channel is centred, rectified, and low-passed without delay (Butterworth filter
    of second order, forwards and backwards: fourth order in total).

    Parameters
    ----------
    values : (frames, channels) or (frames,)
    fps : float
        Samples per second; more than twice the cutoff.
    cutoff : float, optional
        Cutoff frequency, Hz.

    Raises
    ------
    ParameterError
        The cutoff is not below half of the sampling rate.

    Examples
    --------
    >>> import numpy as np
    >>> import kineme
    >>> burst = np.sin(np.arange(2000.0)) * (np.arange(2000) > 1000)
    >>> envelope = kineme.emg_envelope(burst, 1000.0)
    >>> bool(envelope[1500] > 10 * envelope[500])
    True
    """
    if not 0 < cutoff < fps / 2:
        raise ParameterError(
            f"a cutoff of {cutoff:g} Hz needs signals of more than {2 * cutoff:g} Hz, not {fps:g}"
        )
    raw = np.asarray(values, np.float64)
    rectified = np.abs(raw - raw.mean(axis=0))
    # One period of the cutoff, but less than the recording.
    padding = min(len(raw) - 1, int(fps / cutoff))
    smooth = filter_low(rectified.reshape(len(raw), -1), fps, cutoff, padding)
    # The filter overshoots below 0 after strong bursts.
    return np.asarray(np.maximum(smooth, 0.0), np.float64).reshape(raw.shape)
