"""Features in which the movements of different people match: directions on a sphere.

Poses of the canonical body (see `kineme.features.canonical.body`) are taken at 30 Hz, each stacked
with those 0.1 and 0.2 s before and after it. A fixed mean is subtracted. What is left is projected
on fixed main axes of many people's movements, divided by a shrunk deviation of each, and made a
unit vector. So it counts how a pose departs from the mean one, not how far. The distance of two is
the chord between them: 0 is equal, 1.41 has nothing in common, 2 is opposite.

Mean and axes are in ``basis.npz``. They were fitted to poses of HDM05, UTKinect, CMU's subject 86
and single takes, each corpus with the same weight: the eigenvectors of the mean covariance, each
divided by the root of its variance plus 0.3 of the largest one.
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
"""Seconds between a frame and those it is stacked with."""
DIMS = 40
"""Numbers in a feature."""
POSE_FPS = 30.0
"""Poses per second, of which every second one becomes a feature."""

_SMOOTHING = np.array([0.25, 0.75, 1.0, 0.75, 0.25]) / 3.0  # of positions, over 0.17 s


def matching_features(
    motion: Motion, *, effectors: Names | None = None, mirrored: bool = False
) -> NDArray[np.float32]:
    """Unit vectors (n, 40), 15 a second; zero where the body is not seen.

    Parameters
    ----------
    motion : Motion
    effectors : joints, optional
        To take for head, hands and feet where names do not tell.
    mirrored : bool
        Of the motion in a mirror, left and right exchanged.

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
    """Poses of the canonical body (n, 17), 15 a second: what a whole segment is described by.

    Parameters
    ----------
    motion : Motion
    effectors : joints, optional
        To take for head, hands and feet where names do not tell.

    Returns
    -------
    ndarray
        See `kineme.features.canonical.body.compute_canonical_poses`.

    Raises
    ------
    EndEffectorError, MotionError
        As `matching_features`.

    Examples
    --------
    >>> import kineme
    >>> from kineme.features.canonical import matching_poses
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> matching_poses(motion).shape
    (725, 17)
    """
    # Every second one: 30 Hz to 15 Hz.
    return compute_poses(resample(motion, POSE_FPS), effectors=effectors)[::2]


def compute_features_and_poses(
    motion: Motion, *, effectors: Names | None = None, mirrored: bool = False
) -> tuple[NDArray[np.float32], Floats]:
    """Return what `matching_features` and `matching_poses` give, of one look at the body."""
    at_rate = resample(motion, POSE_FPS)
    poses = compute_poses(at_rate, effectors=effectors)
    stacked = stack_poses(mirror_poses(poses) if mirrored else poses)
    features = compute_directions(stacked, *load_basis())
    for start, stop in at_rate.gaps:
        # Gaps are in frames at 30 Hz: half as many, rounded up to the first kept frame inside.
        features[(start + 1) // 2 : (stop + 1) // 2] = 0.0
    return features, poses[::2]


def compute_poses(motion: Motion, *, effectors: Names | None = None) -> Floats:
    """Poses of the canonical body (frames, 17) at the rate of the motion, which is smoothed."""
    joints = {
        joint: _smooth(motion.positions[:, list(points)].mean(axis=1))
        for joint, points in match_canonical_joints(motion, effectors=effectors).items()
    }
    return compute_canonical_poses(joints, motion.fps)


def stack_poses(poses: Floats) -> Floats:
    """(n, 85): every second one of poses at 30 Hz, stacked with its neighbours."""
    # Stacked at 30 Hz, where neighbours are 3 and 6 frames away, and thinned afterwards.
    return stack(poses, round_offsets(OFFSETS_S, POSE_FPS))[::2]


def compute_directions(stacked: Floats, mean: Floats, axes: Floats) -> NDArray[np.float32]:
    """Unit vectors (frames, 40): where stacked poses lie from the mean, along the axes."""
    return _normalize((stacked - mean) @ axes)


def mirror_features(features: NDArray[np.floating]) -> NDArray[np.float32]:
    """Matching features (n, 40) of the body in a mirror, estimated from those of the body.

    The axes hold nearly, not exactly, what a mirror shows of them: the median error is about 0.1.

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
    return _normalize(features @ _mirror())


@cache
def _mirror() -> Floats:
    """(40, 40): by least squares, what features along the axes become in a mirror."""
    _, axes = load_basis()
    # Numbers in one pose: the rows of the axes are those of five stacked poses.
    poses = len(axes) // len(OFFSETS_S)
    # The mirror of a pose is linear: its matrix, once on the diagonal for each stacked pose.
    exchange = np.kron(np.eye(len(OFFSETS_S)), mirror_poses(np.eye(poses)))
    # From features back to poses (pseudoinverse), mirrored, and to features again.
    matrix: Floats = np.linalg.pinv(axes) @ exchange @ axes
    return matrix


@cache
def load_basis() -> tuple[Floats, Floats]:
    """Return the mean (85,) and the axes (85, 40), each over its shrunk deviation."""
    with np.load(Path(__file__).with_name("basis.npz"), allow_pickle=False) as arrays:
        return arrays["mean"].astype(np.float64), arrays["axes"].astype(np.float64)


def _normalize(values: NDArray[np.floating]) -> NDArray[np.float32]:
    lengths = np.linalg.norm(values, axis=1, keepdims=True)
    return np.asarray(values / np.maximum(lengths, 1e-9), np.float32)


def _smooth(positions: Floats) -> Floats:
    """Return a weighted mean over five frames; at the ends the outermost frame is repeated."""
    # Two frames more at either end, as the five weights need.
    longer = np.concatenate([positions[:1]] * 2 + [positions] + [positions[-1:]] * 2)
    smoothed = np.zeros_like(positions)
    for k, weight in enumerate(_SMOOTHING):
        smoothed += weight * longer[k : k + len(positions)]
    return smoothed
