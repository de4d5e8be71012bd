"""Features of channels: at another rate, with equal deviations, and their statistics.

Statistics are the posture and the energy of movement, some times a second. An accelerometer
seldom shows the same values twice, however regular the movement. What stays is where it hangs (the
mean over a second) and how strongly it is shaken, slowly and fast (the root mean square in bands of
frequency). So two samples are similar if these are.
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
"""Share of the rate up to which a band of frequency can be told."""


class Reduction(NamedTuple):
    """A linear map that shrinks some directions of the space of channels, then scales channels.

    It is kept as these directions, since the matrix would have channels² entries.

    Attributes
    ----------
    directions : (channels, shrunk) array
        Orthonormal columns.
    factors : (shrunk,) array
        What each direction is multiplied by; the others stay.
    scales : (channels,) array
        What each channel is multiplied by afterwards.
    """

    directions: Floats
    factors: Floats
    scales: Floats

    def apply(self, rows: Floats) -> Floats:
        """Return the rows (samples, channels), each mapped."""
        # Only the shrunk directions change: add what their factors differ from 1.
        shrunk = (rows @ self.directions) * (self.factors - 1)
        return np.asarray((rows + shrunk @ self.directions.T) * self.scales, np.float64)


class Mixture(NamedTuple):
    """Some channels, as they are or with what they share reduced."""

    channels: Ints
    reduction: Reduction | None = None

    def of(self, rows: Floats) -> Floats:
        """Return the mixture of the columns of an array."""
        chosen = rows if len(self.channels) == rows.shape[1] else rows[:, self.channels]
        return chosen if self.reduction is None else self.reduction.apply(chosen)


def resample_channels(values: ArrayLike, fps: float, new: float, *, smoothing: float) -> Floats:
    """Return the channels at the times 0, 1/new, 2/new, … up to their last frame.

    Each value is the mean over `smoothing` seconds around its time, or over a frame of the old or
    new rate where that is longer. So nothing folds back from above the new rate. A lower rate is
    interpolated in a line. At the ends the mean is over what is there.

    Parameters
    ----------
    values : (frames, channels) array
    fps : float
        Their rate.
    new : float
        The rate wanted.
    smoothing : float
        Seconds.

    Returns
    -------
    (samples, channels) array

    Raises
    ------
    ParameterError
        The rate wanted is beyond all measure.
    """
    check_rates(fps, new)
    array = np.asarray(values, np.float64)
    middle: Floats = array.mean(axis=0)  # sums of what is left lose no digits to a large offset
    # `sums[k]` is the sum of the first k frames, so any mean is a difference of two sums.
    sums = np.concatenate([np.zeros((1, array.shape[1])), np.cumsum(array - middle, axis=0)])
    # The small number keeps a last frame that rounding would lose.
    n = int((len(array) - 1) * new / fps + 1e-9) + 1
    times = np.arange(n) / new
    half = max(smoothing, 1 / fps, 1 / new) / 2
    # Frame k stands for k - 0.5 to k + 0.5, so the sums at its edges are half a frame later.
    starts = np.clip((times - half) * fps + 0.5, 0, len(array))
    stops = np.clip((times + half) * fps + 0.5, 0, len(array))
    # Sums between frames are interpolated, so windows need not end at a frame.
    means = (interpolate_frames(sums, stops) - interpolate_frames(sums, starts)) / (stops - starts)[
        :, None
    ]
    return np.asarray(means + middle, np.float64)


def standardize_channels(values: ArrayLike) -> Floats:
    """Return the channels with mean 0 and standard deviation 1; those that never change are 0."""
    centred = np.asarray(values, np.float64)
    centred = centred - centred.mean(axis=0)
    largest = np.abs(centred).max(axis=0)
    # Rounding of a constant with a large offset is no variation.
    steady = largest <= 1e-12 * np.abs(values).max(axis=0)
    scaled: Floats = centred / np.where(steady, 1.0, largest)  # squares of tiny numbers vanish
    scaled /= np.where(steady, 1.0, scaled.std(axis=0))
    # Rounding errors of constant channels must not be scaled up.
    scaled[:, steady] = 0.0
    return scaled


def compute_channel_statistics(
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
    >>> compute_channel_statistics(still, 50.0, rate=5.0, window=1.0, bands=(1.0, 4.0, 16.0)).shape
    (50, 6)
    """
    every = Mixture(np.arange(channels.shape[1]))
    return compute_statistics(channels, [every], fps, rate=rate, window=window, bands=bands)[0]


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

    A band at a time: all bands of a long recording are many times as large as itself.
    """
    # Windows of this width about each sample, cut at the ends.
    at, width = choose_frames(len(channels), fps, rate), max(1, round(window * fps))
    first = np.clip(at - width // 2, 0, len(channels))
    last = np.clip(at - width // 2 + width, 0, len(channels))
    # None stands for the unfiltered channels, of which means are taken.
    edges = [None, *(edge for edge in pairwise(bands) if edge[0] < NYQUIST * fps)]
    groups = []
    for edge in edges:
        band = channels if edge is None else _filter_band(channels, fps, *edge)
        mixed = (mixture.of(band) for mixture in mixtures)
        groups.append(
            [_compute_means(each, first, last, squared=edge is not None) for each in mixed]
        )
    # One array for each mixture: its means and bands side by side.
    return [np.hstack(each) for each in zip(*groups, strict=True)]


def choose_frames(frames: int, fps: float, rate: float) -> Ints:
    """Return the frames that are looked at, `rate` times a second."""
    # The small number keeps a last sample that rounding would lose.
    n = int((frames - 1) / fps * rate + 1e-9) + 1
    at: Ints = np.minimum(np.rint(np.arange(n) * fps / rate).astype(np.int64), frames - 1)
    return at


def _compute_means(values: Floats, first: Ints, last: Ints, *, squared: bool) -> Floats:
    """Return the means over the frames from first to last, at the ends over what is there.

    Of squares, the root of it.
    """
    sums = np.zeros((len(values) + 1, values.shape[1]))
    # Squared into the sums' own memory: a long recording needs no second copy.
    np.multiply(values, values if squared else 1.0, out=sums[1:])
    np.cumsum(sums[1:], axis=0, out=sums[1:])
    means: Floats = (sums[last] - sums[first]) / (last - first)[:, None]
    # Differences of sums can be negative by rounding.
    return np.sqrt(np.maximum(means, 0.0)) if squared else means


def _filter_band(channels: Floats, fps: float, low: float, high: float) -> Floats:
    """Return the channels between two frequencies, without delay (Butterworth, both ways)."""
    high = min(high, NYQUIST * fps)
    if low >= high:
        # The whole band is above what the rate can show.
        return np.zeros_like(channels)
    # Padded by three periods of the lowest frequency, but less than the recording.
    return filter_band(channels, fps, low, high, min(len(channels) - 1, int(3 * fps / low)))
