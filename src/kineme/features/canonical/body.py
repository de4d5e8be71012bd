"""Map poses of any person to a canonical body of fixed size and shape.

The canonical body has the limb directions of the person and fixed bone lengths, so poses depend on
the movement and not on the person. A pose holds ankles, head and wrists in the body's own frame:
relative to the middle of the hips, y up, turned about the vertical so that left is +x. It also
holds the height of the pelvis above the lower foot, and its vertical speed.

Lengths are in leg lengths. Heading and forward speed are left out, as they differ more between
people than between movements.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from kineme._util.arrays import Floats
from kineme.features.body_frame import find_facing
from kineme.features.mirroring import EXCHANGED, FLIP

Joints = Mapping[str, Floats]

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


def compute_canonical_poses(joints: Joints, fps: float) -> Floats:
    """Compute canonical poses (frames, 17).

    They hold x, y, z of ankles, head and wrists, left before right, then height and rise.

    Parameters
    ----------
    joints : mapping of str to (frames, 3) array
        Metres, y up, by the names of `kineme.features.canonical.joints.JOINTS`. Without knee or
        elbow, a limb is as long as its largest reach. Without shoulders, these are parallel to
        the hips.
    fps : float
        Frames per second.

    Returns
    -------
    ndarray
    """
    pelvis = (joints["left_hip"] + joints["right_hip"]) / 2
    hips = _normalize_vectors(joints["left_hip"] - joints["right_hip"])
    shoulders, sides = hips, dict(joints)
    # Without shoulders, the chest is on the line from pelvis to head, at the canonical share.
    chest = pelvis + TRUNK / (TRUNK + NECK) * (joints["head"] - pelvis)
    if {"left_shoulder", "right_shoulder"} <= joints.keys():
        shoulders = _normalize_vectors(joints["left_shoulder"] - joints["right_shoulder"])
        chest = (joints["left_shoulder"] + joints["right_shoulder"]) / 2
    else:
        sides |= {"left_shoulder": chest, "right_shoulder": chest}
    # From here on, points are relative to the middle of the hips.
    trunk = TRUNK * _normalize_vectors(chest - pelvis)
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
        [*legs, trunk + NECK * _normalize_vectors(joints["head"] - chest), *arms], axis=1
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
    ends = poses[:, :15].reshape(len(poses), len(EXCHANGED), 3)[:, EXCHANGED] * FLIP
    return np.hstack([ends.reshape(len(poses), -1), poses[:, 15:]])


_SIDES = (("left", 1.0), ("right", -1.0))


def _compute_limb(
    joints: Joints, names: tuple[str, str, str], bones: tuple[float, float]
) -> Floats:
    """Return the vector from the top of a canonical limb to its end, (frames, 3)."""
    top, end = joints[names[0]], joints[names[2]]
    if names[1] in joints:
        middle = joints[names[1]]
        return bones[0] * _normalize_vectors(middle - top) + bones[1] * _normalize_vectors(
            end - middle
        )
    # Without a middle joint, the distance of end and top shows how far the limb is bent.
    reach = np.linalg.norm(end - top, axis=1, keepdims=True)
    # A high quantile is robust to tracking errors, unlike the maximum.
    bent = np.minimum(reach / max(float(np.quantile(reach, _STRAIGHT)), _TINY), 1.0)
    straight: Floats = sum(bones) * bent * _normalize_vectors(end - top)
    return straight


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


_TINY = 1e-9
"""Smallest divisor."""


def _normalize_vectors(vectors: Floats) -> Floats:
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    unit: Floats = vectors / np.maximum(lengths, _TINY)
    return unit
