"""What channels are like, sample by sample, so that recordings of one collection can be compared.

Five times a second and per channel: the mean over a second, and the logarithm of the deviation
within it. A recording alone is divided by its own deviations. Here all of a collection are divided
by those of the collection: what lies still in one must not look like what runs in another.
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
"""Seconds around each."""
STILL = 0.05
"""Movement of less than this share of how much a channel's means vary in the collection is none."""


class ChannelSamples(NamedTuple):
    """What the channels of a recording are like, `RATE` times a second.

    ``rows[i]`` are the second of a sample, then the means and the deviations of all channels over
    `WINDOW`, in their units.
    """

    names: tuple[str, ...]
    rows: Floats


def compute_channel_samples(signals: Signals) -> ChannelSamples:
    """Return the samples of a recording, `RATE` a second outside of its gaps.

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
        at = np.arange(0, n, signals.fps / RATE).astype(np.int64)
        spans = np.maximum(at - half, 0), np.minimum(at + half, n)
        middle = values.mean(axis=0)
        means = _compute_means(values - middle, *spans)
        squares = _compute_means((values - middle) ** 2, *spans)
        deviations = np.sqrt(np.maximum(squares - means**2, 0.0))
        parts.append(np.column_stack([(first + at) / signals.fps, means + middle, deviations]))
    return ChannelSamples(tuple(signals.names), np.concatenate(parts))


def fit_units(rows: NDArray[Any]) -> Callable[[NDArray[Any]], Float32s]:
    """Return what turns rows of any recording into features, in the units of these rows.

    Features are (samples, 2 · channels): means, and how much each channel moves.
    """
    values, within = _measure_means_and_deviations(rows)
    varies = values.std(axis=0)
    varies = np.where(varies > 0, varies, np.sqrt((within**2).mean(axis=0)))

    def numbers(rows: NDArray[Any]) -> Floats:
        values, within = _measure_means_and_deviations(rows)
        return np.hstack([values, np.log(within / np.where(varies > 0, varies, 1.0) + STILL)])

    fitted = numbers(rows)
    centre, deviation = fitted.mean(axis=0), fitted.std(axis=0)
    # A channel that does not vary, but for rounding, tells nothing.
    largest = np.abs(fitted.reshape(len(rows), 2, -1)).max(axis=(0, 2)).repeat(len(varies))
    deviation = np.where(deviation > 1e-9 * largest, deviation, np.inf)
    return lambda rows: ((numbers(rows) - centre) / deviation).astype(np.float32)


def thin_samples(rows: NDArray[Any], step: int) -> NDArray[Any]:
    """Return every n-th row, from the middle of the first n: recordings begin at rest."""
    return rows[min(step, len(rows)) // 2 :: step]


def _measure_means_and_deviations(rows: NDArray[Any]) -> tuple[Floats, Floats]:
    n = rows.shape[1] // 2
    return rows[:, 1 : 1 + n].astype(np.float64), rows[:, 1 + n :].astype(np.float64)


def _compute_means(values: Floats, first: Ints, last: Ints) -> Floats:
    sums = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values, axis=0)])
    means: Floats = (sums[last] - sums[first]) / (last - first)[:, None]
    return means
