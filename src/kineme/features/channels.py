"""Features of channels: filters, envelopes, resampling, standardisation, and statistics.

Statistics are the posture and the energy of movement, a few times a second. An accelerometer
seldom shows the same values twice, even if a movement is regular. Its orientation (the mean over a
second) and the strength of slow and fast movement (the root mean square in frequency bands) are
more stable, so samples are compared by these.

Filters are Butterworth filters without delay: run forwards, then backwards. They are equal to
`scipy.signal.butter` and ``sosfiltfilt``, whose import takes longer than the segmentation of a
recording. Sources: T. W. Parks and C. S. Burrus, Digital Filter Design, 1987, chapter 7; for the
padding and the initial state: F. Gustafsson, Determining the initial states in forward-backward
filtering, IEEE Transactions on Signal Processing 44(4), 1996.

Electrodes on a muscle measure noise of both signs, whose strength shows its activity. The rectified
and low-passed signal is the envelope, which repeats with the movement. Source: Krüger et al. 2017,
section VII-B (rectified, resampled, low-passed). Here the low-pass filter comes before the
resampling, to avoid aliasing. Its cutoff and order are those usual for linear envelopes in
biomechanics.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Floats, Ints, interpolate_frames
from kineme._util.checks import check_rates
from kineme.errors import ParameterError

Poles = NDArray[np.complex128]
NYQUIST = 0.45
"""Highest frequency of a band, as a share of the sampling rate."""
BLOCK = 16
"""Number of channels that are filtered at a time, to limit memory."""
POLES: Poles = np.array([np.exp(0.75j * np.pi)])
"""One of the two conjugate poles of the low-pass filter of second order, at frequency 1."""
CUTOFF = 6.0
"""Default cutoff of the low-pass filter, Hz."""


class Reduction(NamedTuple):
    """A linear map that shrinks some directions of the space of channels, then scales channels.

    Stored by its directions, as the matrix would have channels² entries.
    """

    directions: Floats
    """Orthonormal columns, (channels, shrunk)."""
    factors: Floats
    """Factor of each direction; other directions do not change."""
    scales: Floats
    """Factor of each channel, applied afterwards."""

    def apply(self, rows: Floats) -> Floats:
        """Apply the map to rows (samples, channels)."""
        # Only the shrunk directions change, by their factors minus 1.
        shrunk = (rows @ self.directions) * (self.factors - 1)
        return np.asarray((rows + shrunk @ self.directions.T) * self.scales, np.float64)


class Mixture(NamedTuple):
    """Some channels, unchanged or with their shared variance reduced."""

    channels: Ints
    reduction: Reduction | None = None


def resample_channels(values: ArrayLike, fps: float, new: float, *, smoothing: float) -> Floats:
    """Resample channels (frames, channels) to the times 0, 1/new, 2/new, … up to the last frame.

    Each value is the mean over `smoothing` seconds around its time, or over one frame of the old or
    new rate if that is longer, which avoids aliasing. Values between frames are interpolated
    linearly. At the ends the window is cut. Raise ParameterError if a rate is out of range.
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
    """Compute means and energies of channels (frames, channels) with equal deviations.

    Return `rate` samples per second: one group of means over a window of so many seconds, then one
    group of energies for each band. The edges of the frequency bands are ascending, in Hz; bands
    beyond the rate are left out.

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
    """Return `compute_channel_statistics` of each mixture of the channels.

    Bands are filtered one at a time, to limit the memory for long recordings.
    """
    # Windows around each sample, cut at the ends.
    centres, width = choose_frames(len(channels), fps, rate), max(1, round(window * fps))
    starts = np.clip(centres - width // 2, 0, len(channels))
    stops = np.clip(centres - width // 2 + width, 0, len(channels))
    # `bands` holds edges: each pair of neighbours is a passband. None: unfiltered, for the means.
    highest = NYQUIST * fps
    passbands = [
        None,
        *((low, min(high, highest)) for low, high in pairwise(bands) if low < highest),
    ]
    statistics = []
    for passband in passbands:
        filtered = channels
        if passband is not None:
            # Padding: three periods of the lowest frequency, but less than the recording.
            padding = min(len(channels) - 1, int(3 * fps / passband[0]))
            filtered = filter_band(channels, fps, *passband, padding)
        of_mixtures = []
        for chosen, reduction in mixtures:
            mixed = filtered if len(chosen) == channels.shape[1] else filtered[:, chosen]
            mixed = mixed if reduction is None else reduction.apply(mixed)
            of_mixtures.append(compute_means(mixed, starts, stops, squared=passband is not None))
        statistics.append(of_mixtures)
    # One array per mixture, with means and bands side by side.
    return [np.hstack(each) for each in zip(*statistics, strict=True)]


def choose_frames(frames: int, fps: float, rate: float) -> Ints:
    """Return the frames of samples at `rate`."""
    # 1e-9 keeps a last sample that rounding would drop.
    n = int((frames - 1) / fps * rate + 1e-9) + 1
    at: Ints = np.minimum(np.rint(np.arange(n) * fps / rate).astype(np.int64), frames - 1)
    return at


def compute_means(values: Floats, starts: Ints, stops: Ints, *, squared: bool = False) -> Floats:
    """Return the means, or root mean squares, over each span of frames [start, stop)."""
    sums = np.zeros((len(values) + 1, values.shape[1]))
    # Square in place, to avoid a second copy of a long recording.
    np.multiply(values, values if squared else 1.0, out=sums[1:])
    np.cumsum(sums[1:], axis=0, out=sums[1:])
    means: Floats = (sums[stops] - sums[starts]) / (stops - starts)[:, None]
    # Differences of sums can be negative by rounding.
    return np.sqrt(np.maximum(means, 0.0)) if squared else means


def filter_low(values: Floats, fps: float, cutoff: float, padding: int) -> Floats:
    """Remove frequencies above the cutoff, in Hz, from values (frames, channels).

    The cutoff is less than half of `fps`. The ends are extended by `padding` frames, fewer than
    there are.

    Examples
    --------
    >>> slow, fast = np.sin(np.arange(300) / 20), np.sin(np.arange(300) * 2)
    >>> left = filter_low((slow + fast)[:, None], 100.0, 5.0, 60)[:, 0]
    >>> bool(np.abs(left - slow)[20:-20].max() < 0.03)
    True
    """
    # Analogue frequency that the bilinear transform (rate 2) maps to the cutoff.
    edge = 4 * float(np.tan(np.pi * cutoff / fps))
    poles = POLES * edge
    return _filter_both_ways(values, _make_sections(poles, edge**2, [1.0, 2.0, 1.0]), padding)


def filter_band(values: Floats, fps: float, low: float, high: float, padding: int) -> Floats:
    """Keep only frequencies between two limits, in Hz, of values (frames, channels).

    The limits are less than half of `fps`; the result is 0 if the band is empty. The ends are
    extended by `padding` frames, fewer than there are.
    """
    if low >= high:
        return np.zeros_like(values)
    # Analogue frequencies, as in `filter_low`.
    edges = [4 * float(np.tan(np.pi * edge / fps)) for edge in (low, high)]
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
        The cutoff is not between 0 and half of the sampling rate.

    Examples
    --------
    >>> import numpy as np
    >>> import kineme
    >>> burst = np.sin(np.arange(2000.0)) * (np.arange(2000) > 1000)
    >>> envelope = kineme.emg_envelope(burst, 1000.0)
    >>> bool(envelope[1500] > 10 * envelope[500])
    True
    """
    if not cutoff > 0:
        raise ParameterError(f"the cutoff must be above 0 Hz, not {cutoff:g} Hz")
    if not cutoff < fps / 2:
        raise ParameterError(
            f"a cutoff of {cutoff:g} Hz needs a rate above {2 * cutoff:g} Hz, not {fps:g} Hz"
        )
    raw = np.asarray(values, np.float64)
    rectified = np.abs(raw - raw.mean(axis=0))
    # One period of the cutoff, but less than the recording.
    padding = min(len(raw) - 1, int(fps / cutoff))
    smooth = filter_low(rectified.reshape(len(raw), -1), fps, cutoff, padding)
    # The filter overshoots below 0 after strong bursts.
    return np.asarray(np.maximum(smooth, 0.0), np.float64).reshape(raw.shape)
