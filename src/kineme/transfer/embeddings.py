"""A segment in 32 numbers: what its poses go through, and how much they move besides.

The course of each number of a pose is brought to one length. Four numbers describe it: its mean,
two slow cosines (the first terms of a discrete cosine transform), and the root mean square of what
these leave. From these 68 numbers a fixed mean is subtracted, and fixed axes are kept. In them
copies of a segment (faster, slower, larger, smaller, mirrored, noisy) differ little, and different
segments much. The result is a unit vector, and the distance of two the chord between them.

Mean and axes are in ``axes.npz``. They were fitted to 1600 spans of 0.7 to 4 s, drawn alike from
HDM05, UTKinect, CMU's subject 86 and single takes without regard to labels, and six copies of each:
up to 2^0.5 faster or slower, 2^0.4 larger or smaller, cut by up to 10 % at either end, with uneven
time, a fifth mirrored, shifted by 0.05 and shaken by 0.025 leg lengths. The axes are those of a
linear discriminant analysis: spans vary most along them where the copies of one vary by one. Half
of the mean variance of copies is added to that of each axis.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kineme._util.arrays import Floats, interpolate_frames
from kineme._util.checks import as_features
from kineme.errors import ParameterError

DIMS = 32
"""Numbers in an embedding."""
POSE_DIMS = 17
"""Numbers in a pose."""

_TERMS = 3  # of the cosine transform, told one by one
_FINEST = 32  # terms; what varies faster is noise
_LENGTH = 64  # samples to which a course is brought
_BESIDE = 1.5  # weight of what the first terms leave
# Orthonormal, and over the root of the length: values do not depend on it.
_COSINES = np.cos(np.pi / _LENGTH * np.arange(_FINEST)[:, None] * (np.arange(_LENGTH) + 0.5))
_COSINES *= np.sqrt(np.where(np.arange(_FINEST) == 0, 1.0, 2.0))[:, None] / _LENGTH


def embedding(poses: ArrayLike) -> NDArray[np.float32]:
    """Return a unit vector (32,) for a whole segment.

    Parameters
    ----------
    poses : (n, 17) array
        Of the canonical body, as `kineme.features.canonical.matching_poses` gives them.

    Returns
    -------
    ndarray of float32

    Raises
    ------
    ParameterError
        Not poses, none, or not finite.

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
    return embed_course(array, *load_axes())


def embed_course(poses: Floats, mean: Floats, axes: Floats) -> NDArray[np.float32]:
    """Return the unit vector of where a course lies from the mean, along the axes."""
    values = (describe_course(poses) - mean) @ axes
    return np.asarray(values / max(float(np.linalg.norm(values)), 1e-9), np.float32)


def describe_course(features: Floats) -> Floats:
    """Mean, two slow cosines and what they leave (4 * dims,), of any features (n, dims)."""
    at_length = interpolate_frames(features, np.linspace(0, len(features) - 1, _LENGTH))
    terms = _COSINES @ at_length
    beside = np.sqrt((terms[_TERMS:] ** 2).sum(axis=0))
    numbers: Floats = np.concatenate([*terms[:_TERMS], _BESIDE * beside])
    return numbers


@cache
def load_axes() -> tuple[Floats, Floats]:
    """Return the mean (68,) and the axes (68, 32)."""
    with np.load(Path(__file__).with_name("axes.npz"), allow_pickle=False) as arrays:
        return arrays["mean"].astype(np.float64), arrays["axes"].astype(np.float64)
