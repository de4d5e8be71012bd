"""Features of channels: resampling, standardisation, and statistics.

Statistics are the posture and the energy of movement, a few times a second. An accelerometer
seldom shows the same values twice, even if a movement is regular. Its orientation (the mean over a
second) and the strength of slow and fast movement (the root mean square in frequency bands) are
more stable, so samples are compared by these.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Floats, Ints, interpolate_frames
from kineme._util.checks import check_rates
from kineme.features.filters import filter_band

NYQUIST = 0.45
"""Highest frequency of a band, as a share of the sampling rate."""


class Reduction(NamedTuple):
    """A linear map that shrinks some directions of the space of channels, then scales channels.

    Stored by its directions, as the matrix would have channels² entries.

    Attributes
    ----------
    directions : (channels, shrunk) array
        Orthonormal columns.
    factors : (shrunk,) array
        Factor of each direction; other directions do not change.
    scales : (channels,) array
        Factor of each channel, applied afterwards.
    """

    directions: Floats
    factors: Floats
    scales: Floats

    def apply(self, rows: Floats) -> Floats:
        """Apply the map to rows (samples, channels)."""
        # Only the shrunk directions change, by their factors minus 1.
        shrunk = (rows @ self.directions) * (self.factors - 1)
        return np.asarray((rows + shrunk @ self.directions.T) * self.scales, np.float64)


class Mixture(NamedTuple):
    """Some channels, unchanged or with their shared variance reduced."""

    channels: Ints
    reduction: Reduction | None = None

    def apply(self, rows: Floats) -> Floats:
        """Return the mixture of the columns of an array."""
        chosen = rows if len(self.channels) == rows.shape[1] else rows[:, self.channels]
        return chosen if self.reduction is None else self.reduction.apply(chosen)


def resample_channels(values: ArrayLike, fps: float, new: float, *, smoothing: float) -> Floats:
    """Resample channels to the times 0, 1/new, 2/new, … up to their last frame.

    Each value is the mean over `smoothing` seconds around its time, or over one frame of the old or
    new rate if that is longer, which avoids aliasing. Values between frames are interpolated
    linearly. At the ends the window is cut.

    Parameters
    ----------
    values : (frames, channels) array
    fps : float
        Frames per second.
    new : float
        New frames per second.
    smoothing : float
        Length of the window, s.

    Returns
    -------
    (samples, channels) array

    Raises
    ------
    ParameterError
        A rate is out of range.
    """
    check_rates(fps, new)
    array = np.asarray(values, np.float64)
    middle: Floats = array.mean(axis=0)  # centre first: a large offset would cost precision
    # `sums[k]` is the sum of the first k frames, so any mean is a difference of two sums.
    sums = np.concatenate([np.zeros((1, array.shape[1])), np.cumsum(array - middle, axis=0)])
    # 1e-9 keeps a last frame that rounding would drop.
    n = int((len(array) - 1) * new / fps + 1e-9) + 1
    times = np.arange(n) / new
    half = max(smoothing, 1 / fps, 1 / new) / 2
    # Frame k covers k - 0.5 to k + 0.5, hence + 0.5.
    starts = np.clip((times - half) * fps + 0.5, 0, len(array))
    stops = np.clip((times + half) * fps + 0.5, 0, len(array))
    # Interpolate the sums, as windows need not end at a frame.
    means = (interpolate_frames(sums, stops) - interpolate_frames(sums, starts)) / (stops - starts)[
        :, None
    ]
    return np.asarray(means + middle, np.float64)


def standardize_channels(values: ArrayLike) -> Floats:
    """Return the channels with mean 0 and standard deviation 1; constant channels become 0."""
    centred = np.asarray(values, np.float64)
    centred = centred - centred.mean(axis=0)
    largest = np.abs(centred).max(axis=0)
    # Rounding errors of a constant with a large offset do not count as variation.
    is_constant = largest <= 1e-12 * np.abs(values).max(axis=0)
    # Divide by the maximum first, as squares of tiny numbers would underflow.
    scaled: Floats = centred / np.where(is_constant, 1.0, largest)
    scaled /= np.where(is_constant, 1.0, scaled.std(axis=0))
    scaled[:, is_constant] = 0.0
    return scaled


def compute_channel_statistics(
    channels: Floats, fps: float, *, rate: float, window: float, bands: tuple[float, ...]
) -> Floats:
    """Compute means and energies of channels.

    Parameters
    ----------
    channels : (frames, channels) array
        With equal deviations.
    fps : float
        Frames per second.
    rate : float
        Samples per second of the result.
    window : float
        Window of means and energies, s.
    bands : tuple of float
        Edges of the frequency bands, Hz, ascending; bands beyond the rate are left out.

    Returns
    -------
    (samples, channels * groups) array
        One group of means, then one group of energies for each band.

    Examples
    --------
    >>> import numpy as np
    >>> still = np.zeros((500, 2))
    >>> compute_channel_statistics(still, 50.0, rate=5.0, window=1.0, bands=(1.0, 4.0, 16.0)).shape
    (50, 6)
    """
    mixture = Mixture(np.arange(channels.shape[1]))
    return compute_statistics(channels, [mixture], fps, rate=rate, window=window, bands=bands)[0]


def compute_statistics(
    channels: Floats,
    mixtures: Sequence[Mixture],
    fps: float,
    *,
    rate: float,
    window: float,
    bands: tuple[float, ...],
) -> list[Floats]:
    """Return the statistics of each of these mixtures of the channels.

    Bands are filtered one at a time, to limit the memory for long recordings.
    """
    # Windows around each sample, cut at the ends.
    at, width = choose_frames(len(channels), fps, rate), max(1, round(window * fps))
    first = np.clip(at - width // 2, 0, len(channels))
    last = np.clip(at - width // 2 + width, 0, len(channels))
    # None stands for the unfiltered channels, whose means are taken.
    edges = [None, *(edge for edge in pairwise(bands) if edge[0] < NYQUIST * fps)]
    groups = []
    for edge in edges:
        band = channels if edge is None else _filter_band(channels, fps, *edge)
        mixed = (mixture.apply(band) for mixture in mixtures)
        groups.append(
            [_compute_means(each, first, last, squared=edge is not None) for each in mixed]
        )
    # One array per mixture, with means and bands side by side.
    return [np.hstack(each) for each in zip(*groups, strict=True)]


def choose_frames(frames: int, fps: float, rate: float) -> Ints:
    """Return the frames of samples at `rate`."""
    # 1e-9 keeps a last sample that rounding would drop.
    n = int((frames - 1) / fps * rate + 1e-9) + 1
    at: Ints = np.minimum(np.rint(np.arange(n) * fps / rate).astype(np.int64), frames - 1)
    return at


def _compute_means(values: Floats, first: Ints, last: Ints, *, squared: bool) -> Floats:
    """Return the means, or root mean squares, over the frames from first to last."""
    sums = np.zeros((len(values) + 1, values.shape[1]))
    # Square in place, to avoid a second copy of a long recording.
    np.multiply(values, values if squared else 1.0, out=sums[1:])
    np.cumsum(sums[1:], axis=0, out=sums[1:])
    means: Floats = (sums[last] - sums[first]) / (last - first)[:, None]
    # Differences of sums can be negative by rounding.
    return np.sqrt(np.maximum(means, 0.0)) if squared else means


def _filter_band(channels: Floats, fps: float, low: float, high: float) -> Floats:
    """Filter channels to the band between two frequencies, without delay (Butterworth)."""
    high = min(high, NYQUIST * fps)
    if low >= high:
        # The whole band is above the Nyquist frequency.
        return np.zeros_like(channels)
    # Padding: three periods of the lowest frequency, but less than the recording.
    return filter_band(channels, fps, low, high, min(len(channels) - 1, int(3 * fps / low)))
