"""Views: the same statistics of channels in several scales, for no one scale fits all sensors.

Two questions have no one answer. What channels share is movement where sensors
are on both legs, and only where somebody stands where channels are the places
of joints. And what varies most tells activities apart for some sensors, what
changes seldom for others. The first and the last view answer both in opposite
ways; that is taken which those between them agree with more
(`kineme.methods.hierarchy.agreement`).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kineme.methods.hierarchy.constants import HierarchyConstants
from kineme.methods.hierarchy.statistics import channel_statistics

Floats = NDArray[np.float64]

STILL = 0.05
"""Least restlessness of a statistic, as a share of that of all of them."""
TINY = 1e-9
"""Deviations below it are rounding."""
SPREAD = 20_000
"""Frames that tell how channels go together."""


def views(channels: Floats, preset: HierarchyConstants) -> list[NDArray[np.float32]]:
    """The statistics of the channels in each of the scales that the preset names.

    Parameters
    ----------
    channels : (frames, channels) array
        At the working rate of the preset.
    preset : HierarchyConstants

    Returns
    -------
    list of (samples, channels * groups) array
        `preset.rate` times a second.
    """
    rescaled = {shared: without_shared(channels, shared) for shared in dict.fromkeys(preset.shared)}
    statistics = {
        shared: channel_statistics(
            each,
            preset.working_fps,
            rate=preset.rate,
            window=preset.averaging,
            bands=preset.bands,
        )
        for shared, each in rescaled.items()
    }
    found = []
    for shared, weight, over in zip(
        preset.shared, preset.weights, preset.restless_over, strict=True
    ):
        raw = statistics[shared]
        found.append(
            by_restlessness(raw, round(preset.samples(over)), weight)
            if over
            else by_deviation(raw, channels.shape[1], weight)
        )
    return found


def without_shared(channels: Floats, most: float) -> Floats:
    """The channels with what they share held down, each with a deviation of 1.

    Parameters
    ----------
    channels : (frames, channels) array
    most : float
        Largest variance along any direction, where that of a channel is 1.
    """
    centred = channels - channels.mean(axis=0)
    scaled = centred / _deviations(centred)
    if most >= scaled.shape[1]:  # they cannot share more
        return np.asarray(scaled, np.float64)
    sample = scaled[:: max(1, len(scaled) // SPREAD)]
    variances, directions = np.linalg.eigh(sample.T @ sample / len(sample))
    kept = np.sqrt(most / np.maximum(variances, most))
    left = scaled @ ((directions * kept) @ directions.T)
    return np.asarray(left / _deviations(left), np.float64)


def by_deviation(statistics: Floats, channels: int, weight: float) -> NDArray[np.float32]:
    """Means, and each band, divided by their whole deviation to the power `weight`.

    Parameters
    ----------
    statistics : (samples, groups * channels) array
    channels : int
    weight : float
        1 gives each group the same weight, 0 leaves them as they are.
    """
    centred = statistics - statistics.mean(axis=0)
    groups = centred.reshape(len(centred), -1, channels)
    deviations = np.sqrt((groups**2).mean(axis=(0, 2), keepdims=True))
    scaled = groups / np.where(deviations > TINY, deviations, 1.0) ** weight
    return np.ascontiguousarray(scaled.reshape(centred.shape), np.float32)


def by_restlessness(statistics: Floats, steps: int, weight: float) -> NDArray[np.float32]:
    """Each statistic divided by its mean change over so many samples to the power `weight`.

    Examples
    --------
    >>> restless = np.column_stack([np.arange(8) % 2, np.arange(8) // 4])
    >>> by_restlessness(restless.astype(float), 1, 1.0).std(axis=0).round(2).tolist()
    [0.5, 3.5]
    """
    centred = statistics - statistics.mean(axis=0)
    steps = max(1, min(steps, len(centred) // 3))
    changes = np.abs(centred[steps:] - centred[:-steps])
    restless = changes.mean(axis=0) if len(changes) else np.zeros(centred.shape[1])
    least = STILL * float(np.sqrt((restless**2).mean()))
    if least < TINY:
        return np.ascontiguousarray(centred, np.float32)
    return np.ascontiguousarray(centred / np.maximum(restless, least) ** weight, np.float32)


def _deviations(centred: Floats) -> Floats:
    """The standard deviation of each column; 1 where nothing changes."""
    deviations: Floats = np.sqrt((centred**2).mean(axis=0))
    return np.where(deviations > TINY, deviations, 1.0)
