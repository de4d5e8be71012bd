"""Presets of the method: ``kineme`` for bodies, ``sensors`` for signals, ``series`` for any series.

The constants of the method are in seconds of a moving body. Other series have another pace, and
often no times at all. So ``series`` chooses the number of samples per second: the geometric mean
of the rate at which the dominant period lasts `SERIES_PERIOD`, and the rate at which the whole
series lasts `SERIES_LENGTH`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from kineme._util.arrays import Floats
from kineme.methods.base import Mirror, Progress
from kineme.methods.kineme.constants import KinemeConstants

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from kineme.methods.kineme.pipeline import KinemeFound

OF_SENSORS: Mapping[str, Any] = {
    "unit": "any",
    "working_fps": 50.0,
    "view_margin": 0.0,
    "half_views": True,  # a sensor may be loose, or on a limb that does not take part
    "chance_count": 8.0,
    "chance_duration": 32.0,  # so that sitting down twice is not an exercise
    "centering": 0.5,
    "event_scale": 0.0,
    "transition_cost": 1000.0,  # labels of sensor data have no transitions between activities
}
"""Constants that differ for signals: lengths have no meaning, and a few channels say less."""
SERIES_PERIOD = 0.4
"""Assumed duration of the dominant period, s."""
SERIES_LENGTH = 30.0
"""Assumed duration of the whole series, s."""
MIN_PERIOD = 10
"""Shortest period in samples: faster repetition counts as noise."""
MIN_CYCLES = 4
"""Number of times that the longest period fits into the series."""


@dataclass(frozen=True, kw_only=True)
class KinemePreset(KinemeConstants):
    """Preset of the method."""

    def analyze(
        self,
        features: ArrayLike,
        *,
        mirror: Mirror | None = None,  # noqa: ARG002 (left and right differ)
        progress: Progress | None = None,
        joints: bool = False,
    ) -> KinemeFound:
        """Run the method on features; see :func:`kineme.methods.kineme.pipeline.analyze`."""
        # Imported here: it loads compiled code.
        from kineme.methods.kineme.pipeline import analyze

        return analyze(features, self, joints=joints, progress=progress)


KINEME = KinemePreset(
    name="kineme", help="Finds activities and counts their repetitions; the default."
)


SENSORS = KinemePreset(
    name="sensors",
    help="The same by posture and energy of channels; the default for signals.",
    **OF_SENSORS,
)


@dataclass(frozen=True, kw_only=True)
class SeriesPreset(KinemePreset):
    """Segments signals of any kind, at the pace of the signals."""

    def rate_of(self, values: Floats, fps: float) -> float:  # noqa: ARG002
        """Return the number of samples (samples, channels) that count as a second; ignore fps."""
        by_length = max(len(values) / SERIES_LENGTH, 1.0)
        period = estimate_period(values)
        return sqrt(period / SERIES_PERIOD * by_length) if period else by_length


def estimate_period(values: Floats) -> int | None:
    """Return the dominant period of a series: the shift with the highest autocorrelation.

    Parameters
    ----------
    values : (samples, channels) array

    Returns
    -------
    int or None
        Samples; the autocorrelation is summed over channels. None without a local maximum.

    Examples
    --------
    >>> estimate_period(np.sin(np.arange(600) * 2 * np.pi / 25)[:, None])
    25
    """
    n = len(values)
    centred = np.nan_to_num(values - np.nanmean(values, axis=0))
    centred /= np.maximum(centred.std(axis=0), 1e-12)
    # Autocorrelation by Fourier transform, padded to twice the length against wrap-around.
    spectrum = np.abs(np.fft.rfft(centred, 2 * n, axis=0)) ** 2
    correlation = np.fft.irfft(spectrum.sum(axis=1))[: n // MIN_CYCLES]
    # Local maxima, without the ends.
    inner = correlation[1:-1]
    peaks = 1 + np.flatnonzero((inner > correlation[:-2]) & (inner >= correlation[2:]))
    peaks = peaks[peaks >= MIN_PERIOD]
    return int(peaks[correlation[peaks].argmax()]) if len(peaks) else None


SERIES = SeriesPreset(
    name="series",
    help="The same at the pace of the series; for time series other than movement.",
    # Two states of a series may repeat one shape, so that similar repetitions are no reason to
    # merge clusters or neighbours.
    min_similarity=1.0,
    same_set=2.0,
    **OF_SENSORS,
)
