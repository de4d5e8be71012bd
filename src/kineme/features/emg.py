"""Muscle signals: what is left of an electromyogram when only its strength counts.

Electrodes see a noise of both signs whose strength tells how active a muscle
is. Rectified and low-passed it becomes the envelope that repeats itself as the
movement does; resampling follows with that of all signals.

Source: Krüger et al. 2017, section VII-B (rectified, resampled, low-passed). The
low-pass comes before the resampling here, so that nothing folds back. Its
cutoff and order are those usual for linear envelopes in biomechanics.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme.errors import ParameterError
from kineme.features.filters import filter_low

CUTOFF = 6.0
"""Hertz."""


def emg_envelope(values: ArrayLike, fps: float, *, cutoff: float = CUTOFF) -> NDArray[np.float64]:
    """Return envelope (frames, channels) of raw muscle signals, at the same rate, never below 0.

    Each channel loses its mean, is rectified, and low-passed without delay
    (Butterworth of second order, forwards and backwards: fourth order in all).

    Parameters
    ----------
    values : (frames, channels) or (frames,)
    fps : float
        Samples per second; more than twice the cutoff.
    cutoff : float, optional
        Hertz.

    Raises
    ------
    ParameterError
        A cutoff that the sampling rate does not reach.

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
    # One cycle of the cutoff, but less than the recording.
    padding = min(len(raw) - 1, int(fps / cutoff))
    smooth = filter_low(rectified.reshape(len(raw), -1), fps, cutoff, padding)
    # The filter overshoots below 0 after strong bursts.
    return np.asarray(np.maximum(smooth, 0.0), np.float64).reshape(raw.shape)
