"""Statistics of channels: the posture and the energy of movement, some times a second.

An accelerometer seldom shows the same values twice, however regular the
movement: what stays is where it hangs (the mean over a second) and how strongly
it is shaken, slowly and fast (the root mean square in bands of frequency). So
two samples are similar if these are.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

NYQUIST = 0.45
"""Share of the rate up to which a band of frequency can be told."""


def channel_statistics(
    channels: Floats, fps: float, *, rate: float, window: float, bands: tuple[float, ...]
) -> Floats:
    """Means and energies of channels.

    Parameters
    ----------
    channels : (frames, channels) array
        With equal deviations.
    fps : float
        Frames per second.
    rate : float
        Samples per second wanted.
    window : float
        Seconds over which means and energies are taken.
    bands : tuple of float
        Edges of the bands of frequency, hertz, ascending; those beyond the rate are left out.

    Returns
    -------
    (samples, channels * groups) array
        One group of means, and one for each band.

    Examples
    --------
    >>> import numpy as np
    >>> still = np.zeros((500, 2))
    >>> channel_statistics(still, 50.0, rate=5.0, window=1.0, bands=(1.0, 4.0, 16.0)).shape
    (50, 6)
    """
    return means_and_energies(in_bands(channels, fps, bands), fps, rate=rate, window=window)


def in_bands(channels: Floats, fps: float, bands: tuple[float, ...]) -> list[Floats]:
    """The channels as they are, and in each band of frequency."""
    return [channels] + [
        _band(channels, fps, low, high) for low, high in pairwise(bands) if low < NYQUIST * fps
    ]


def means_and_energies(
    parts: Sequence[Floats], fps: float, *, rate: float, window: float
) -> Floats:
    """The statistics of what `in_bands` gives, or of its mixtures, `rate` times a second."""
    frames = len(parts[0])
    at = sampled_at(frames, fps, rate)
    width = max(1, round(window * fps))
    first = np.clip(at - width // 2, 0, frames)
    last = np.clip(at - width // 2 + width, 0, frames)
    groups = [_means(parts[0], first, last)]
    groups += [np.sqrt(np.maximum(_means(band**2, first, last), 0.0)) for band in parts[1:]]
    return np.hstack(groups)


def sampled_at(frames: int, fps: float, rate: float) -> Ints:
    """The frames that are looked at, `rate` times a second."""
    n = int((frames - 1) / fps * rate + 1e-9) + 1
    at: Ints = np.minimum(np.rint(np.arange(n) * fps / rate).astype(np.int64), frames - 1)
    return at


def _means(values: Floats, first: Ints, last: Ints) -> Floats:
    """The means over the frames from first to last, at the ends over what is there."""
    sums = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values, axis=0)])
    means: Floats = (sums[last] - sums[first]) / (last - first)[:, None]
    return means


def _band(channels: Floats, fps: float, low: float, high: float) -> Floats:
    """The channels between two frequencies, without delay (Butterworth, both ways)."""
    from scipy.signal import butter, sosfiltfilt

    edges = [low, min(high, NYQUIST * fps)]
    if edges[0] >= edges[1]:
        return np.zeros_like(channels)
    sections = butter(2, edges, "bandpass", fs=fps, output="sos")
    padding = min(len(channels) - 1, int(3 * fps / low))
    return np.asarray(sosfiltfilt(sections, channels, axis=0, padlen=padding), np.float64)
