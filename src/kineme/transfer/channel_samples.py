"""Compute samples of channels that can be compared across the recordings of a collection.

A sample holds the mean of each channel over one second, and the logarithm of its deviation within
this second, five times a second. All recordings are scaled by the deviations of the collection,
and not each by its own: a sensor at rest in one recording must not look like one that moves in
another.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Float32s, Floats, Ints
from kineme.recordings import Signals

RATE = 5.0
"""Samples per second."""
WINDOW = 1.0
"""Window around each sample, s."""
STILL = 0.05
"""Smallest movement that counts, as a share of the deviation of a channel in the collection."""


class ChannelSamples(NamedTuple):
    """Samples of the channels of a recording, at `RATE`.

    ``rows[i]`` holds the time of a sample in seconds, then the means and then the deviations of all
    channels over `WINDOW`, in their units.
    """

    names: tuple[str, ...]
    rows: Floats


def compute_channel_samples(signals: Signals) -> ChannelSamples:
    """Compute the samples of a recording at `RATE`, outside of its gaps.

    Examples
    --------
    >>> from kineme import Signals
    >>> compute_channel_samples(Signals([[0.0], [2.0]] * 20, fps=20)).rows[4].tolist()
    [0.8, 1.0, 1.0]
    """
    half = max(1, round(WINDOW / 2 * signals.fps))
    parts = []
    for first, stop in signals.spans():
        values = signals.values[first:stop]
        n = len(values)
        frames = np.arange(0, n, signals.fps / RATE).astype(np.int64)
        spans = np.maximum(frames - half, 0), np.minimum(frames + half, n)
        # Centre first: cumulative sums of a large offset would lose precision.
        middle = values.mean(axis=0)
        means = _compute_means(values - middle, *spans)
        squares = _compute_means((values - middle) ** 2, *spans)
        deviations = np.sqrt(np.maximum(squares - means**2, 0.0))
        parts.append(np.column_stack([(first + frames) / signals.fps, means + middle, deviations]))
    return ChannelSamples(tuple(signals.names), np.concatenate(parts))


def fit_units(rows: NDArray[Any]) -> Callable[[NDArray[Any]], Float32s]:
    """Return a function that converts rows of any recording to features, scaled by these rows.

    Features are (samples, 2 · channels): means, and logarithms of the movement of each channel.
    """
    values, within = _split_means_and_deviations(rows)
    varies = values.std(axis=0)
    varies = np.where(varies > 0, varies, np.sqrt((within**2).mean(axis=0)))

    def compute_numbers(rows: NDArray[Any]) -> Floats:
        values, within = _split_means_and_deviations(rows)
        return np.hstack([values, np.log(within / np.where(varies > 0, varies, 1.0) + STILL)])

    fitted = compute_numbers(rows)
    centre, deviation = fitted.mean(axis=0), fitted.std(axis=0)
    # Constant channels, apart from rounding errors, become 0.
    largest = np.abs(fitted.reshape(len(rows), 2, -1)).max(axis=(0, 2)).repeat(len(varies))
    deviation = np.where(deviation > 1e-9 * largest, deviation, np.inf)
    return lambda rows: ((compute_numbers(rows) - centre) / deviation).astype(np.float32)


def thin_samples(rows: NDArray[Any], step: int) -> NDArray[Any]:
    """Return every n-th row, starting in the middle of the first n, as recordings begin at rest."""
    return rows[min(step, len(rows)) // 2 :: step]


def _split_means_and_deviations(rows: NDArray[Any]) -> tuple[Floats, Floats]:
    n = rows.shape[1] // 2
    return rows[:, 1 : 1 + n].astype(np.float64), rows[:, 1 + n :].astype(np.float64)


def _compute_means(values: Floats, first: Ints, last: Ints) -> Floats:
    # Cumulative sums: the sum of a span is the difference of two.
    sums = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values, axis=0)])
    means: Floats = (sums[last] - sums[first]) / (last - first)[:, None]
    return means
