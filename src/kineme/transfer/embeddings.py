"""Compute embeddings of segments of bodies, and comparable samples of channels.

An embedding describes a whole segment by a unit vector of 32 numbers. The curve of each number of a
pose is resampled to a fixed length and described by four numbers: its mean, two slow cosines (the
first terms of a discrete cosine transform), and the root mean square of the residual. A fixed mean
is subtracted from the 68 numbers, and they are projected on fixed axes. In these axes, variants of
a segment (faster, slower, larger, smaller, mirrored, noisy) differ little, and different segments
differ much. The result is normalised to length 1. Embeddings are compared by Euclidean distance.

Mean and axes are stored in ``axes.npz``. They were fitted to 1600 spans of 0.7 to 4 s, drawn in
equal parts from HDM05, UTKinect, CMU's subject 86 and single takes without regard to labels, and to
six variants of each: up to 2^0.5 faster or slower, 2^0.4 larger or smaller, cut by up to 10 % at
each end, with uneven time, a fifth mirrored, with a shift of 0.05 and noise of 0.025 leg lengths.
The axes are those of a linear discriminant analysis: the variance of spans is largest relative to
that of variants. Half of the mean variance of variants is added to that of each axis.

Channels are sampled five times a second. A sample holds the mean of each channel over one second,
and the logarithm of its deviation within this second. All recordings are scaled by the deviations
of the collection, and not each by its own: a sensor at rest in one recording must not look like one
that moves in another.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Float32s, Floats, interpolate_frames
from kineme._util.checks import as_features
from kineme.errors import ParameterError
from kineme.features.canonical import POSE_DIMS, load_basis
from kineme.features.channels import compute_means
from kineme.recordings import Signals

RATE = 5.0
"""Samples per second."""
WINDOW = 1.0
"""Window around each sample, s."""
STILL = 0.05
"""Smallest movement that counts, as a share of the deviation of a channel in the collection."""
DIMS = 32
"""Numbers in an embedding."""
AXES = Path(__file__).with_name("axes.npz")
"""Mean (68,) and axes (68, 32) of the numbers that describe a segment."""
_N_TERMS = 3
"""Number of terms of the cosine transform that are used directly."""
_MAX_TERMS = 32
"""Number of terms in total; faster variation is noise."""
_LENGTH = 64
"""Number of samples to which a curve is resampled."""
_RESIDUAL_WEIGHT = 1.5
"""Weight of the root mean square of the further terms."""
# Orthonormal, and divided by the root of the length, so that values do not depend on it.
_COSINES = np.cos(np.pi / _LENGTH * np.arange(_MAX_TERMS)[:, None] * (np.arange(_LENGTH) + 0.5))
_COSINES *= np.sqrt(np.where(np.arange(_MAX_TERMS) == 0, 1.0, 2.0))[:, None] / _LENGTH


def embedding(poses: ArrayLike) -> NDArray[np.float32]:
    """Compute the embedding of a whole segment: a unit vector (32,).

    Parameters
    ----------
    poses : (n, 17) array
        Poses of the canonical body, as returned by `kineme.features.canonical.matching_poses`.

    Raises
    ------
    ParameterError
        The array is empty, not finite, or does not hold poses.

    Examples
    --------
    >>> import kineme
    >>> from kineme.features.canonical import matching_poses
    >>> poses = matching_poses(kineme.read(kineme.bundled_recording()))
    >>> embedding(poses[:60]).shape
    (32,)
    """
    array = as_features(poses, "poses")
    if array.shape[1] != POSE_DIMS:
        raise ParameterError(
            f"poses have {POSE_DIMS} numbers each, not {array.shape[1]}: matching_poses(motion) "
            "gives them"
        )
    mean, axes = load_basis(AXES)
    values = (describe_curve(array) - mean) @ axes
    return np.asarray(values / max(float(np.linalg.norm(values)), 1e-9), np.float32)


def describe_curve(features: Floats) -> Floats:
    """Return mean, two slow cosines and residual (4 * dims,) of any features (n, dims)."""
    resampled = interpolate_frames(features, np.linspace(0, len(features) - 1, _LENGTH))
    terms = _COSINES @ resampled
    residual = np.sqrt((terms[_N_TERMS:] ** 2).sum(axis=0))
    numbers: Floats = np.concatenate([*terms[:_N_TERMS], _RESIDUAL_WEIGHT * residual])
    return numbers


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
        means = compute_means(values - middle, *spans)
        squares = compute_means((values - middle) ** 2, *spans)
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
        """Return the features of rows before they are centred and scaled."""
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
