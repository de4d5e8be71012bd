"""Butterworth filters without delay: run forwards, then backwards.

They are equal to `scipy.signal.butter` and ``sosfiltfilt``, whose import takes longer than the
segmentation of a recording.

Sources: T. W. Parks and C. S. Burrus, Digital Filter Design, 1987, chapter 7; for the padding and
the initial state: F. Gustafsson, Determining the initial states in forward-backward filtering, IEEE
Transactions on Signal Processing 44(4), 1996.

@@emg: Compute the envelopes of muscle signals (electromyograms).

Electrodes measure noise of both signs, whose strength shows the activity of a muscle.
The rectified and low-passed signal is the envelope, which repeats with the movement.

Source: Krüger et al. 2017, section VII-B (rectified, resampled, low-passed). Here the
low-pass filter comes before the resampling, to avoid aliasing. Its cutoff and order are
those usual for linear envelopes in biomechanics.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Floats
from kineme.errors import ParameterError

Poles = NDArray[np.complex128]

BLOCK = 16
"""Number of channels that are filtered at a time, to limit memory."""
POLES: Poles = np.array([np.exp(0.75j * np.pi)])
"""One of the two conjugate poles of the low-pass filter of second order, at frequency 1."""


def filter_low(values: Floats, fps: float, cutoff: float, padding: int) -> Floats:
    """Remove frequencies above the cutoff, in Hz, from values (frames, channels).

    Parameters
    ----------
    values : (frames, channels) array
    fps : float
    cutoff : float
        Less than half of `fps`.
    padding : int
        Number of frames by which the ends are extended; less than the number of frames.

    Examples
    --------
    >>> slow, fast = np.sin(np.arange(300) / 20), np.sin(np.arange(300) * 2)
    >>> left = filter_low((slow + fast)[:, None], 100.0, 5.0, 60)[:, 0]
    >>> bool(np.abs(left - slow)[20:-20].max() < 0.03)
    True
    """
    edge = _warp(cutoff, fps)
    poles = POLES * edge
    return _filter_both_ways(values, _make_sections(poles, edge**2, [1.0, 2.0, 1.0]), padding)


def filter_band(values: Floats, fps: float, low: float, high: float, padding: int) -> Floats:
    """Keep only frequencies between two limits, in Hz, of values (frames, channels).

    Parameters
    ----------
    values : (frames, channels) array
    fps : float
    low, high : float
        Less than half of `fps`.
    padding : int
        Number of frames by which the ends are extended; less than the number of frames.
    """
    edges = _warp(low, fps), _warp(high, fps)
    width, center = edges[1] - edges[0], edges[0] * edges[1]
    half = POLES * width / 2
    root = np.sqrt(half**2 - center)
    # Each pole of the low-pass filter becomes one below and one above the centre of the band.
    poles = np.concatenate([half + root, half - root])
    # Two zeros of the band-pass are at infinite analogue frequency; each adds a factor 4 to the
    # gain. In z there are two zeros at 1 and two at -1.
    return _filter_both_ways(
        values, _make_sections(poles, width**2 * 16, [1.0, 0.0, -1.0]), padding
    )


def _warp(frequency: float, fps: float) -> float:
    """Return the analogue frequency that the bilinear transform (rate 2) maps to a frequency."""
    return 4 * float(np.tan(np.pi * frequency / fps))


def _make_sections(poles: Poles, gain: float, zeros: list[float]) -> Floats:
    """Convert analogue poles, each with its conjugate, to digital sections (poles, 5).

    ``zeros`` is the numerator of each section; ``gain`` is that of the analogue filter.
    """
    # The bilinear transform s = 4 (z - 1) / (z + 1), solved for z.
    digital = (4 + poles) / (4 - poles)
    gain /= float(np.prod(np.abs(4 - poles) ** 2))
    sections = np.empty((len(poles), 5))
    sections[:, :3] = zeros
    # The first section has the gain of the whole cascade.
    sections[0, :3] *= gain
    # Denominator (1 - p / z) (1 - p* / z) of a pole and its conjugate.
    sections[:, 3], sections[:, 4] = -2 * digital.real, np.abs(digital) ** 2
    return sections


def _filter_both_ways(values: Floats, sections: Floats, padding: int) -> Floats:
    """Filter values forwards and backwards, with ends extended by point reflection."""
    from kineme.features._kernels import filter_sections

    filtered = np.empty(values.shape)
    for start in range(0, values.shape[1], BLOCK):
        part = values[:, start : start + BLOCK]
        # Odd extension: value and slope are continuous at the ends, so the filter has no transient.
        before = 2 * part[:1] - part[padding:0:-1]
        after = 2 * part[-1:] - part[-2 : -padding - 2 : -1]
        padded = np.ascontiguousarray(np.concatenate([before, part, after]))
        filter_sections(padded, sections)
        padded = np.ascontiguousarray(padded[::-1])
        filter_sections(padded, sections)
        filtered[:, start : start + BLOCK] = padded[::-1][padding : padding + len(part)]
    return filtered


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
