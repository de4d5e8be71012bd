"""Matching features, in which the movements of different people are similar: unit vectors.

Poses of the canonical body (see `kineme.features.canonical.body`) are computed at 30 Hz, and each
is stacked with those 0.1 and 0.2 s before and after it. A fixed mean is subtracted. The rest is
projected on fixed principal axes, each divided by its shrunk deviation, and normalised to length 1.
So a feature describes the direction in which a pose differs from the mean, but not the amount. The
distance of two features is 0 if they are equal, 1.41 if they have nothing in common, and 2 if they
are opposite.

Mean and axes are stored in ``basis.npz``. They were fitted to poses of HDM05, UTKinect, CMU's
subject 86 and single takes, each corpus with the same weight. The axes are the eigenvectors of the
mean covariance, each divided by the root of its variance plus 0.3 of the largest variance.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme.features.canonical.body import compute_canonical_poses, mirror_poses
from kineme.features.canonical.joints import match_canonical_joints
from kineme.features.effectors import Names
from kineme.features.pose import round_offsets, stack
from kineme.recordings import Motion
from kineme.recordings.operations import resample

MATCHING_FPS = 15.0
"""Features per second."""
OFFSETS_S = (-0.2, -0.1, 0.0, 0.1, 0.2)
"""Time offsets of the stacked frames, s."""
FEATURE_DIMS = 40
"""Numbers in a feature."""
POSE_FPS = 30.0
"""Poses per second; every second pose becomes a feature."""

_SMOOTHING = np.array([0.25, 0.75, 1.0, 0.75, 0.25]) / 3.0
"""Weights of the smoothing of positions, over 0.17 s."""


def matching_features(
    motion: Motion, *, effectors: Names | None = None, mirrored: bool = False
) -> NDArray[np.float32]:
    """Compute matching features: unit vectors (n, 40), 15 per second; zeros in gaps.

    Parameters
    ----------
    motion : Motion
    effectors : joints, optional
        Joints to use as head, hands and feet if their names are not recognised.
    mirrored : bool
        Exchange left and right first.

    Returns
    -------
    ndarray of float32

    Raises
    ------
    EndEffectorError
        Head, hands or feet were not found.
    MotionError
        The legs have no hips.

    Examples
    --------
    >>> import kineme
    >>> from kineme.features.canonical import matching_features
    >>> matching_features(kineme.read(kineme.bundled_recording())).shape
    (725, 40)
    """
    return compute_features_and_poses(motion, effectors=effectors, mirrored=mirrored)[0]


def matching_poses(motion: Motion, *, effectors: Names | None = None) -> Floats:
    """Compute poses of the canonical body (n, 17), 15 per second, for embeddings of segments.

    Parameters
    ----------
    motion : Motion
    effectors : joints, optional
        Joints to use as head, hands and feet if their names are not recognised.

    Returns
    -------
    ndarray
        See `kineme.features.canonical.body.compute_canonical_poses`.

    Raises
    ------
    EndEffectorError, MotionError
        As for `matching_features`.

    Examples
    --------
    >>> import kineme
    >>> from kineme.features.canonical import matching_poses
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> matching_poses(motion).shape
    (725, 17)
    """
    # Every second pose: 30 Hz to 15 Hz.
    return compute_poses(resample(motion, POSE_FPS), effectors=effectors)[::2]


def compute_features_and_poses(
    motion: Motion, *, effectors: Names | None = None, mirrored: bool = False
) -> tuple[NDArray[np.float32], Floats]:
    """Return the results of both `matching_features` and `matching_poses`, in one pass."""
    at_rate = resample(motion, POSE_FPS)
    poses = compute_poses(at_rate, effectors=effectors)
    stacked = stack_poses(mirror_poses(poses) if mirrored else poses)
    features = compute_directions(stacked, *load_basis())
    for start, stop in at_rate.gaps:
        # Convert gaps from 30 Hz to 15 Hz, rounded up to the first kept frame inside.
        features[(start + 1) // 2 : (stop + 1) // 2] = 0.0
    return features, poses[::2]


def compute_poses(motion: Motion, *, effectors: Names | None = None) -> Floats:
    """Compute poses of the canonical body (frames, 17) from smoothed positions."""
    joints = {
        joint: _smooth(motion.positions[:, list(points)].mean(axis=1))
        for joint, points in match_canonical_joints(motion, effectors=effectors).items()
    }
    return compute_canonical_poses(joints, motion.fps)


def stack_poses(poses: Floats) -> Floats:
    """Stack poses at 30 Hz with their neighbours and return every second one, (n, 85)."""
    # Neighbours are 3 and 6 frames away, so stack first and thin out afterwards.
    return stack(poses, round_offsets(OFFSETS_S, POSE_FPS))[::2]


def compute_directions(stacked: Floats, mean: Floats, axes: Floats) -> NDArray[np.float32]:
    """Return unit vectors (frames, 40): directions of stacked poses from the mean, in the axes."""
    return _normalize((stacked - mean) @ axes)


def mirror_features(features: NDArray[np.floating]) -> NDArray[np.float32]:
    """Estimate the matching features (n, 40) of the mirrored motion from those of the motion.

    The axes are not exactly closed under mirroring: the median error is about 0.1.

    Examples
    --------
    >>> import kineme, numpy as np
    >>> from kineme.features.canonical import matching_features, mirror_features
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> mirrored = mirror_features(matching_features(motion))
    >>> errors = np.linalg.norm(mirrored - matching_features(kineme.mirror(motion)), axis=1)
    >>> bool(np.median(errors) < 0.15)
    True
    """
    return _normalize(features @ _make_mirror_matrix())


@cache
def _make_mirror_matrix() -> Floats:
    """Return the (40, 40) matrix that mirrors features, by least squares."""
    _, axes = load_basis()
    # Numbers in one pose: the rows of the axes belong to five stacked poses.
    poses = len(axes) // len(OFFSETS_S)
    # Mirroring is linear: a block-diagonal matrix with one block for each stacked pose.
    exchange = np.kron(np.eye(len(OFFSETS_S)), mirror_poses(np.eye(poses)))
    # Features to poses (pseudoinverse), mirror, poses to features.
    matrix: Floats = np.linalg.pinv(axes) @ exchange @ axes
    return matrix


@cache
def load_basis() -> tuple[Floats, Floats]:
    """Return the mean (85,) and the axes (85, 40), each divided by its shrunk deviation."""
    with np.load(Path(__file__).with_name("basis.npz"), allow_pickle=False) as arrays:
        return arrays["mean"].astype(np.float64), arrays["axes"].astype(np.float64)


def _normalize(values: NDArray[np.floating]) -> NDArray[np.float32]:
    lengths = np.linalg.norm(values, axis=1, keepdims=True)
    return np.asarray(values / np.maximum(lengths, 1e-9), np.float32)


def _smooth(positions: Floats) -> Floats:
    """Return a weighted mean over five frames; the first and last frame are repeated."""
    longer = np.concatenate([positions[:1]] * 2 + [positions] + [positions[-1:]] * 2)
    smoothed = np.zeros_like(positions)
    for k, weight in enumerate(_SMOOTHING):
        smoothed += weight * longer[k : k + len(positions)]
    return smoothed
