"""Butterworth filters without delay: forwards, then backwards.

The same as `scipy.signal.butter` and ``sosfiltfilt``, which take longer to import than a recording
takes to segment.

Source: T. W. Parks and C. S. Burrus, Digital Filter Design, 1987, chapter 7; how the ends are
continued and where the filter begins: F. Gustafsson, Determining the initial states in
forward-backward filtering, IEEE Transactions on Signal Processing 44(4), 1996.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats

Poles = NDArray[np.complex128]

FILTERED = 16
"""Channels that are filtered at a time: copies stay small."""
POLES: Poles = np.array([np.exp(0.75j * np.pi)])
"""One of the two conjugate poles of the low-pass filter of second order, at frequency 1."""


def filter_low(values: Floats, fps: float, cutoff: float, padding: int) -> Floats:
    """Return the values (frames, channels) without what is above the cutoff, in hertz.

    Parameters
    ----------
    values : (frames, channels) array
    fps : float
    cutoff : float
        Less than half of `fps`.
    padding : int
        Frames by which the ends are continued, less than there are.

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
    """Return what of the values (frames, channels) is between two frequencies, in hertz.

    Parameters
    ----------
    values : (frames, channels) array
    fps : float
    low, high : float
        Less than half of `fps`.
    padding : int
        Frames by which the ends are continued, less than there are.
    """
    edges = _warp(low, fps), _warp(high, fps)
    width, center = edges[1] - edges[0], edges[0] * edges[1]
    half = POLES * width / 2
    root = np.sqrt(half**2 - center)
    # Each pole of the low-pass filter becomes one below the band's centre and one above it.
    poles = np.concatenate([half + root, half - root])
    # Two zeros of the band-pass lie at infinite analogue frequency: each brings a factor 4 into
    # the gain. In z there are two zeros at 1 and two at -1.
    return _filter_both_ways(
        values, _make_sections(poles, width**2 * 16, [1.0, 0.0, -1.0]), padding
    )


def _warp(frequency: float, fps: float) -> float:
    """Return the analogue frequency that the bilinear transform at 2 samples a unit puts there."""
    return 4 * float(np.tan(np.pi * frequency / fps))


def _make_sections(poles: Poles, gain: float, zeros: list[float]) -> Floats:
    """Return the digital sections (poles, 5) of analogue poles, each with its conjugate.

    ``zeros`` is the numerator of each; the gain is that of the analogue filter.
    """
    # The bilinear transform s = 4 (z - 1) / (z + 1), solved for z.
    digital = (4 + poles) / (4 - poles)
    gain /= float(np.prod(np.abs(4 - poles) ** 2))
    sections = np.empty((len(poles), 5))
    sections[:, :3] = zeros
    # The gain of the whole chain, in one section.
    sections[0, :3] *= gain
    # (1 - p / z) (1 - p* / z) of a pole and its conjugate.
    sections[:, 3], sections[:, 4] = -2 * digital.real, np.abs(digital) ** 2
    return sections


def _filter_both_ways(values: Floats, sections: Floats, padding: int) -> Floats:
    """Return the values filtered forwards and backwards, their ends mirrored at their points."""
    from kineme.features._filter_kernels import filter_sections

    found = np.empty(values.shape)
    for start in range(0, values.shape[1], FILTERED):
        some = values[:, start : start + FILTERED]
        # Odd continuation: value and slope run on at the ends, so the filter starts without a jump.
        before = 2 * some[:1] - some[padding:0:-1]
        after = 2 * some[-1:] - some[-2 : -padding - 2 : -1]
        longer = np.ascontiguousarray(np.concatenate([before, some, after]))
        filter_sections(longer, sections)
        longer = np.ascontiguousarray(longer[::-1])
        filter_sections(longer, sections)
        found[:, start : start + FILTERED] = longer[::-1][padding : padding + len(some)]
    return found
