"""What channels are like, sample by sample, so that recordings of one collection can be compared.

Five times a second and per channel: the mean over a second, and the logarithm of the deviation
within it. A recording alone is divided by its own deviations. Here all of a collection are divided
by those of the collection: what lies still in one must not look like what runs in another.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from hashlib import sha256

import numpy as np

from kineme._util.arrays import Float32s, Floats, Ints
from kineme.errors import ParameterError
from kineme.recordings import Signals

RATE = 5.0
"""Samples per second."""
WINDOW = 1.0
"""Seconds around each."""
STILL = 0.05
"""Movement of less than this share of how much a channel's means vary in the collection is none."""


@dataclass(frozen=True, eq=False)
class ChannelSamples:
    """What the channels of a recording are like, in samples at `RATE` a second.

    Parameters
    ----------
    names : tuple of str
        Of the channels.
    frames : (samples,) array
        Where they are.
    means, deviations : (samples, channels) array
        In the units of the channels, over `WINDOW`.
    """

    names: tuple[str, ...]
    frames: Ints
    means: Float32s
    deviations: Float32s


def channel_samples(signals: Signals) -> ChannelSamples:
    """Return the samples of a recording, `RATE` a second outside of its gaps.

    Examples
    --------
    >>> from kineme import Signals
    >>> channel_samples(Signals([[0.0], [2.0]] * 20, fps=20)).deviations[4].tolist()
    [1.0]
    """
    half = max(1, round(WINDOW / 2 * signals.fps))
    parts = []
    for first, stop in signals.spans():
        values = signals.values[first:stop]
        n = len(values)
        at = np.arange(0, n, signals.fps / RATE).astype(np.int64)
        spans = np.maximum(at - half, 0), np.minimum(at + half, n)
        middle = values.mean(axis=0)
        means = _means(values - middle, *spans)
        squares = _means((values - middle) ** 2, *spans)
        deviations = np.sqrt(np.maximum(squares - means**2, 0.0))
        parts.append((first + at, means + middle, deviations))
    frames, means, deviations = (np.concatenate(part) for part in zip(*parts, strict=True))
    return ChannelSamples(
        tuple(signals.names), frames, means.astype(np.float32), deviations.astype(np.float32)
    )


@dataclass(frozen=True, eq=False)
class Units:
    """Those of a collection, in which the samples of its recordings are compared.

    Parameters
    ----------
    varies : (channels,) array
        How much the means of each channel vary in the collection.
    means, energies : (2, channels) array
        What is taken off these features, and what they are divided by.
    """

    varies: Floats
    means: Floats
    energies: Floats

    @classmethod
    def of(cls, means: Float32s, deviations: Float32s) -> Units:
        """Return the units of these samples, (samples, channels) each."""
        values, within = means.astype(np.float64), deviations.astype(np.float64)
        varies = values.std(axis=0)
        varies = np.where(varies > 0, varies, np.sqrt((within**2).mean(axis=0)))
        return cls(varies, _scale(values), _scale(_energies(within, varies)))

    def features(self, means: Float32s, deviations: Float32s) -> Float32s:
        """Samples as they are compared, (samples, 2 · channels)."""
        values = means.astype(np.float64)
        energies = _energies(deviations.astype(np.float64), self.varies)
        parts = [
            (part - centre) / scale
            for part, (centre, scale) in ((values, self.means), (energies, self.energies))
        ]
        return np.hstack(parts).astype(np.float32)


def in_common_units(recordings: Sequence[ChannelSamples]) -> list[Float32s]:
    """Features (samples, 2 · channels) of each recording, in units of all of these."""
    for one in recordings:
        if one.names != recordings[0].names:
            raise ParameterError(
                "clusters are shared over recordings of the same channels, not of "
                f"{', '.join(recordings[0].names):.80} and of {', '.join(one.names):.80}"
            )
    drawn = [recordings[i] for i in by_content(recordings)]
    units = Units.of(
        np.concatenate([one.means for one in drawn]),
        np.concatenate([one.deviations for one in drawn]),
    )
    return [units.features(one.means, one.deviations) for one in recordings]


def by_content(recordings: Sequence[ChannelSamples]) -> list[int]:
    """Recordings by their numbers, in an order that is the same whatever they are called.

    Sums, and samples at equal steps, depend on the order; what they are taken for must not.
    """

    def digest(number: int) -> bytes:
        one = recordings[number]
        parts = (one.frames, one.means, one.deviations)
        return sha256(b"".join(np.ascontiguousarray(part).tobytes() for part in parts)).digest()

    return sorted(range(len(recordings)), key=digest)


def _means(values: Floats, first: Ints, last: Ints) -> Floats:
    sums = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values, axis=0)])
    means: Floats = (sums[last] - sums[first]) / (last - first)[:, None]
    return means


def _energies(deviations: Floats, varies: Floats) -> Floats:
    energies: Floats = np.log(deviations / np.where(varies > 0, varies, 1.0) + STILL)
    return energies


def _scale(values: Floats) -> Floats:
    """Mean and deviation of each column; infinite where it does not vary."""
    centre = values.mean(axis=0)
    deviation = (values - centre).std(axis=0)
    varies = deviation > 1e-9 * np.abs(values).max()
    return np.stack([centre, np.where(varies, deviation, np.inf)])
