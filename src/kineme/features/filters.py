"""Butterworth filters without delay: run forwards, then backwards.

They are equal to `scipy.signal.butter` and ``sosfiltfilt``, whose import takes longer than the
segmentation of a recording.

Sources: T. W. Parks and C. S. Burrus, Digital Filter Design, 1987, chapter 7; for the padding and
the initial state: F. Gustafsson, Determining the initial states in forward-backward filtering, IEEE
Transactions on Signal Processing 44(4), 1996.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats

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
    from kineme.features._filter_kernels import filter_sections

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
