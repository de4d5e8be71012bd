"""Features of a canonical body, in which movements of different people match.

*Joints.* Ankles, wrists and head are found as in `kineme.features.effectors`. The other joints are
found by the bones of the skeleton. A leg runs from the pelvis to an ankle, an arm from the joint
where the arms branch to a wrist. The pair of bones in it that is longest and most equal begins at
hip and knee, or at shoulder and elbow. Markers and keypoints, which have no bones, are found by
their usual names (see `kineme.recordings.joint_names`).

*Poses.* The canonical body has the limb directions of the person and fixed bone lengths, so poses
depend on the movement and not on the person. A pose holds ankles, head and wrists in the body's own
frame: relative to the middle of the hips, y up, turned about the vertical so that left is +x. It
also holds the height of the pelvis above the lower foot, and its vertical speed. Lengths are in leg
lengths. Heading and forward speed are left out, as they differ more between people than between
movements.

*Matching features* are unit vectors. Poses are computed at 30 Hz, and each is stacked with those
0.1 and 0.2 s before and after it. A fixed mean is subtracted. The rest is projected on fixed
principal axes, each divided by its shrunk deviation, and normalised to length 1. So a feature
describes the direction in which a pose differs from the mean, but not the amount. The distance of
two features is 0 if they are equal, 1.41 if they have nothing in common, and 2 if they are
opposite.

Mean and axes are stored in ``canonical_basis.npz``. They were fitted to poses of HDM05, UTKinect,
CMU's subject 86 and single takes, each corpus with the same weight. The axes are the eigenvectors
of the mean covariance, each divided by the root of its variance plus 0.3 of the largest variance.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from itertools import combinations
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Floats, normalize_vectors
from kineme.errors import MotionError
from kineme.features import mirroring
from kineme.features.effectors import PARTS, Names, end_effectors
from kineme.features.pose import find_facing, round_offsets, stack
from kineme.recordings import Motion, Skeleton
from kineme.recordings.joint_names import SIDES, TWIST, find_joints, has_word
from kineme.recordings.motion import check_motion
from kineme.recordings.operations import resample

Joints = Mapping[str, Floats]
Points = tuple[int, ...]

JOINTS = (
    *("left_hip", "left_knee", "left_ankle", "right_hip", "right_knee", "right_ankle"),
    *("left_shoulder", "left_elbow", "left_wrist"),
    *("right_shoulder", "right_elbow", "right_wrist", "head"),
)
LIMBS = (("hip", "knee", "ankle"), ("shoulder", "elbow", "wrist"))
"""Top, middle and end joint of a leg and of an arm."""
_NAMED = (
    ("*_hip", "*_hip_centre", "*_thigh"),
    ("*_knee", "*_shank"),
    ("*_ankle", "*_foot"),
    ("*_shoulder", "*_upper_arm"),
    ("*_elbow", "*_forearm"),
    ("*_wrist", "*_hand"),
)
HIP, SHOULDER = 0.11, 0.22
"""Distances from the middle of the body to a hip and to a shoulder, in leg lengths."""
TRUNK, NECK = 0.6, 0.32
"""Distances from the hips to the shoulders, and from there to the head, in leg lengths."""
LEG, ARM = (0.5, 0.5), (0.34, 0.33)
"""Lengths of thigh and shin, upper arm and forearm, in leg lengths."""
RISE = 0.5
"""Seconds; the vertical speed is given as the rise of the pelvis in this time."""
POSE_DIMS = 17
"""Numbers in a pose."""
_STRAIGHT = 0.98
"""Quantile of the length of a limb that counts as straight."""
_FLAT = 0.1
"""Share of the line through hips and shoulders that must be horizontal to give a heading."""
_SIDES = (("left", 1.0), ("right", -1.0))
_TINY = 1e-9
"""Smallest divisor."""
MATCHING_FPS = 15.0
"""Features per second."""
OFFSETS_S = (-0.2, -0.1, 0.0, 0.1, 0.2)
"""Time offsets of the stacked frames, s."""
FEATURE_DIMS = 40
"""Numbers in a feature."""
POSE_FPS = 30.0
"""Poses per second; every second pose becomes a feature."""
BASIS = Path(__file__).with_name("canonical_basis.npz")
"""Mean of stacked poses and axes, each divided by its shrunk deviation."""
_SMOOTHING = np.array([0.25, 0.75, 1.0, 0.75, 0.25]) / 3.0
"""Weights of the smoothing of positions, over 0.17 s."""


def match_canonical_joints(motion: Motion, *, effectors: Names | None = None) -> dict[str, Points]:
    """Return the points of the motion whose mean is each of `JOINTS`.

    Knees, elbows and shoulders that were not found are left out. ``effectors`` are joints to use as
    head, hands and feet if their names are not recognised.

    Raises
    ------
    EndEffectorError
        Head, hands or feet were not found.
    MotionError
        The legs have no hips.
    """
    check_motion(motion, "canonical_joints")
    ends = end_effectors(motion, names=effectors)
    joints = find_limbs(motion.skeleton, dict(zip(PARTS, ends.indices, strict=True)))
    joints["head"] = (ends.head,)
    for side in SIDES:
        if f"{side}_hip" not in joints:
            raise MotionError(f"the {side} leg has no hip joint to connect it to a pelvis")
    return {joint: joints[joint] for joint in JOINTS if joint in joints}


def find_limbs(
    skeleton: Skeleton, ends: Mapping[str, int], *, single: bool = False
) -> dict[str, Points]:
    """Return the joints of arms and legs; those that are not found are left out.

    ``ends`` are ankles and wrists; missing ones are searched by name. With ``single``, joints that
    are the mean of several points are left out, too.
    """
    named = find_joints(skeleton.names, _NAMED, single=single)
    joints: dict[str, Points] = {}
    for top, middle, end in LIMBS:
        # -1 for a tip that is neither given nor named; its chain is empty.
        tips = [
            ends.get(joint, named.get(joint, (-1,))[0]) for joint in (f"left_{end}", f"right_{end}")
        ]
        chains = [skeleton.ancestry(tip) for tip in tips]
        # The limbs branch at the last joint that both chains share.
        shared = sum(1 for a, b in zip(*chains, strict=False) if a == b)
        for side, tip, chain in zip(SIDES, tips, chains, strict=True):
            indices = (*_find_top_and_middle(skeleton, chain[shared:]), tip)
            for part, index in zip((top, middle, end), indices, strict=True):
                joint = f"{side}_{part}"
                points = (index,) if index >= 0 else named.get(joint)
                if points:
                    joints[joint] = points
    return joints


def _find_top_and_middle(skeleton: Skeleton, chain: list[int]) -> tuple[int, int]:
    """Return the joints at which the two long bones of a chain begin; -1 for missing ones.

    They are the pair of bones that is longest and most equal. ``chain`` begins below the joint at
    which the limbs branch.
    """
    # Length of the chain from the branch down to each joint.
    below = np.cumsum(np.linalg.norm(skeleton.offsets[chain], axis=1))
    candidates = [
        place
        for place, joint in enumerate(chain[:-1])
        # Joints between two bones of some length, except joints that only twist a bone.
        if 0 < below[place] < below[place + 1] and not has_word(skeleton.names[joint], TWIST)
    ]
    if len(candidates) < 2:
        return (chain[candidates[0]] if candidates else -1), -1

    def compute_penalty(pair: tuple[int, int]) -> float:
        upper, lower = below[pair[1]] - below[pair[0]], below[-1] - below[pair[1]]
        # Logarithms, so that the choice does not depend on the unit of length.
        return float(abs(np.log(upper / lower)) - np.log(upper + lower))

    top, middle = min(combinations(candidates, 2), key=compute_penalty)
    return chain[top], chain[middle]


def compute_canonical_poses(joints: Joints, fps: float) -> Floats:
    """Compute canonical poses (frames, 17).

    They hold x, y, z of ankles, head and wrists, left before right, then height and rise. The
    positions of joints (frames, 3), named as in `JOINTS`, are in metres, y up. Without knee or
    elbow, a limb is as long as its largest reach. Without shoulders, these are parallel to the
    hips.
    """
    pelvis = (joints["left_hip"] + joints["right_hip"]) / 2
    hips = normalize_vectors(joints["left_hip"] - joints["right_hip"])
    shoulders, sides = hips, dict(joints)
    # Without shoulders, the chest is on the line from pelvis to head, at the canonical share.
    chest = pelvis + TRUNK / (TRUNK + NECK) * (joints["head"] - pelvis)
    if {"left_shoulder", "right_shoulder"} <= joints.keys():
        shoulders = normalize_vectors(joints["left_shoulder"] - joints["right_shoulder"])
        chest = (joints["left_shoulder"] + joints["right_shoulder"]) / 2
    else:
        sides |= {"left_shoulder": chest, "right_shoulder": chest}
    # From here on, points are relative to the middle of the hips.
    trunk = TRUNK * normalize_vectors(chest - pelvis)
    legs = [
        sign * HIP * hips
        + _compute_limb(sides, (f"{side}_hip", f"{side}_knee", f"{side}_ankle"), LEG)
        for side, sign in _SIDES
    ]
    arms = [
        trunk
        + sign * SHOULDER * shoulders
        + _compute_limb(sides, (f"{side}_shoulder", f"{side}_elbow", f"{side}_wrist"), ARM)
        for side, sign in _SIDES
    ]
    # (frames, 5, 3) in the order of the end effectors: ankles, head, wrists.
    ends = np.stack(
        [*legs, trunk + NECK * normalize_vectors(joints["head"] - chest), *arms], axis=1
    )
    ground = np.minimum(joints["left_ankle"][:, 1], joints["right_ankle"][:, 1])
    leg = _measure_legs(joints)
    # The gradient needs two frames.
    rise = RISE * fps * np.gradient(pelvis[:, 1]) if len(pelvis) > 1 else np.zeros(1)
    vertical = np.stack([pelvis[:, 1] - ground, rise], axis=1) / leg
    # The mean direction of hips and shoulders is the body's left.
    to_left = hips + shoulders
    cos, sin = find_facing(to_left, _FLAT * np.linalg.norm(to_left, axis=1))
    x, y, z = np.moveaxis(ends, 2, 0)
    ahead = np.stack([cos * x + sin * z, y, cos * z - sin * x], axis=2)
    return np.hstack([ahead.reshape(len(ends), -1), vertical])


def mirror_poses(poses: Floats) -> Floats:
    """Mirror poses (frames, 17): exchange left and right.

    Examples
    --------
    >>> import kineme
    >>> from kineme.features.canonical import matching_poses, mirror_poses
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> poses = matching_poses(motion)
    >>> bool((mirror_poses(mirror_poses(poses)) == poses).all())
    True
    """
    # The first 15 numbers are five points; height and rise do not change.
    return np.hstack([mirroring.mirror_features(poses[:, :15]), poses[:, 15:]])


def _compute_limb(
    joints: Joints, names: tuple[str, str, str], bones: tuple[float, float]
) -> Floats:
    """Return the vector from the top of a canonical limb to its end, (frames, 3).

    ``names`` are the joints at top, middle and end, ``bones`` the lengths of the two canonical
    bones. The limb has the person's directions and these lengths.
    """
    top, end = joints[names[0]], joints[names[2]]
    if names[1] in joints:
        middle = joints[names[1]]
        return bones[0] * normalize_vectors(middle - top) + bones[1] * normalize_vectors(
            end - middle
        )
    # Without a middle joint, the distance of end and top tells how far the limb is extended (1:
    # straight).
    reach = np.linalg.norm(end - top, axis=1, keepdims=True)
    # A high quantile is robust to tracking errors, unlike the maximum.
    extension = np.minimum(reach / max(float(np.quantile(reach, _STRAIGHT)), _TINY), 1.0)
    vector: Floats = sum(bones) * extension * normalize_vectors(end - top)
    return vector


def _measure_legs(joints: Joints) -> float:
    """Return the mean length of both legs in metres."""
    lengths = []
    for side, _ in _SIDES:
        hip, ankle = joints[f"{side}_hip"], joints[f"{side}_ankle"]
        knee = joints.get(f"{side}_knee")
        if knee is None:
            reach = np.linalg.norm(ankle - hip, axis=1)
            lengths.append(float(np.quantile(reach, _STRAIGHT)))
        else:
            bones = np.linalg.norm(knee - hip, axis=1) + np.linalg.norm(ankle - knee, axis=1)
            lengths.append(float(np.median(bones)))
    return max(float(np.mean(lengths)), _TINY)


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
        See `kineme.features.canonical.compute_canonical_poses`.

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
    check_motion(motion, "transfer_features")
    at_rate = resample(motion, POSE_FPS)
    poses = compute_poses(at_rate, effectors=effectors)
    shown = mirror_poses(poses) if mirrored else poses
    # Neighbours are 3 and 6 frames away, so stack first and thin out to 15 Hz afterwards.
    stacked = stack(shown, round_offsets(OFFSETS_S, POSE_FPS))[::2]
    mean, axes = load_basis()
    # Directions of stacked poses from the mean, in the axes.
    features = normalize_vectors((stacked - mean) @ axes).astype(np.float32)
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
    return normalize_vectors(features @ _make_mirror_matrix()).astype(np.float32)


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
def load_basis(path: Path = BASIS) -> tuple[Floats, Floats]:
    """Return the mean and the axes of a file: of features, the mean (85,) and axes (85, 40)."""
    with np.load(path, allow_pickle=False) as arrays:
        return arrays["mean"].astype(np.float64), arrays["axes"].astype(np.float64)


def _smooth(positions: Floats) -> Floats:
    """Return a weighted mean over five frames; the first and last frame are repeated."""
    longer = np.concatenate([positions[:1]] * 2 + [positions] + [positions[-1:]] * 2)
    smoothed = np.zeros_like(positions)
    for k, weight in enumerate(_SMOOTHING):
        smoothed += weight * longer[k : k + len(positions)]
    return smoothed
