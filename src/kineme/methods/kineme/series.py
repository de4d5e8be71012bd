"""Time series of any kind, segmented at their own pace: the preset ``series``.

The constants of the method are seconds of a moving body. Other series have another pace, and often
no seconds at all. So the preset decides how many samples count as a second. It takes the geometric
mean of two answers: with the first, the dominant period of the series lasts `PERIOD` seconds; with
the second, the whole series lasts `LENGTH` seconds.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np

from kineme._util.arrays import Floats
from kineme.methods.kineme.preset import OF_SENSORS, KinemePreset

PERIOD = 0.4
"""Seconds that the dominant period is taken to last."""
LENGTH = 30.0
"""Seconds that the whole series is taken to last."""
SHORTEST = 10
"""Samples of the shortest period: what repeats faster is taken for noise."""
CYCLES = 4
"""Times that the longest period fits into the series."""


@dataclass(frozen=True, kw_only=True)
class SeriesPreset(KinemePreset):
    """Segments signals of any kind, at the pace of the signals."""

    def rate_of(self, values: Floats, fps: float) -> float:  # noqa: ARG002
        """Return how many samples (samples, channels) count as a second, whatever their rate."""
        of_length = max(len(values) / LENGTH, 1.0)
        period = estimate_period(values)
        return sqrt(period / PERIOD * of_length) if period else of_length


def estimate_period(values: Floats) -> int | None:
    """Return the dominant period of a series: the shift at which it is most like itself.

    Parameters
    ----------
    values : (samples, channels) array

    Returns
    -------
    int or None
        Samples of the highest local maximum of the autocorrelation, summed over the channels;
        None where there is none.

    Examples
    --------
    >>> estimate_period(np.sin(np.arange(600) * 2 * np.pi / 25)[:, None])
    25
    """
    n = len(values)
    centred = np.nan_to_num(values - np.nanmean(values, axis=0))
    centred /= np.maximum(centred.std(axis=0), 1e-12)
    # By the Fourier transform of twice the length, where nothing wraps around.
    spectrum = np.abs(np.fft.rfft(centred, 2 * n, axis=0)) ** 2
    correlation = np.fft.irfft(spectrum.sum(axis=1))[: n // CYCLES]
    inner = correlation[1:-1]
    peaks = 1 + np.flatnonzero((inner > correlation[:-2]) & (inner >= correlation[2:]))
    peaks = peaks[peaks >= SHORTEST]
    return int(peaks[correlation[peaks].argmax()]) if len(peaks) else None


SERIES = SeriesPreset(
    name="series",
    help="The same at the pace of the series: for time series that are no movement.",
    **OF_SENSORS,
)
