"""Poses of any person as those of one canonical body of fixed size and shape.

The canonical body has the directions of the person's limbs and lengths of its own: what is left
is how somebody moves, whoever it is. Its ankles, head and wrists are told in its own frame: from
the middle of the hips, y up, turned about the vertical so that left is +x. With them goes what
these do not tell: how high the pelvis is above the lower foot, and how fast it rises.

Lengths are in leg lengths. Heading and forward speed are left out: in them, people differ more
than movements.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from kineme._util.arrays import Floats
from kineme.features.body_frame import find_facing
from kineme.features.mirroring import EXCHANGED, FLIP

Joints = Mapping[str, Floats]

HIP, SHOULDER = 0.11, 0.22
"""From the middle of the body to either side."""
TRUNK, NECK = 0.6, 0.32
"""From the hips to the shoulders, and from there to the head."""
LEG, ARM = (0.5, 0.5), (0.34, 0.33)
"""Thigh and shin, upper arm and forearm."""
RISE = 0.5
"""Seconds; the vertical speed counts as what the pelvis would rise in so long."""
DIMS = 17
"""Numbers in a pose."""

_STRAIGHT = 0.98  # of the frames show a limb shorter than it is when straight
_FLAT = 0.1  # of the line through the hips and shoulders; where less lies flat, it has no heading


def compute_canonical_poses(joints: Joints, fps: float) -> Floats:
    """Poses (frames, 17): x, y, z of ankles, head and wrists, left before right; height; rise.

    Parameters
    ----------
    joints : mapping of str to (frames, 3) array
        Metres, y up, by the names of `kineme.features.canonical.joints.JOINTS`. Without knee or
        elbow a limb is as long as it reaches; without shoulders they are as the hips.
    fps : float
        Frames per second.

    Returns
    -------
    ndarray
    """
    pelvis = (joints["left_hip"] + joints["right_hip"]) / 2
    hips = _normalize(joints["left_hip"] - joints["right_hip"])
    shoulders, sides = hips, dict(joints)
    # Without shoulders the chest is put on the line from pelvis to head, at the canonical share.
    chest = pelvis + TRUNK / (TRUNK + NECK) * (joints["head"] - pelvis)
    if {"left_shoulder", "right_shoulder"} <= joints.keys():
        shoulders = _normalize(joints["left_shoulder"] - joints["right_shoulder"])
        chest = (joints["left_shoulder"] + joints["right_shoulder"]) / 2
    else:
        sides |= {"left_shoulder": chest, "right_shoulder": chest}
    # All points are relative to the middle of the hips.
    trunk = TRUNK * _normalize(chest - pelvis)
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
    ends = np.stack([*legs, trunk + NECK * _normalize(joints["head"] - chest), *arms], axis=1)
    ground = np.minimum(joints["left_ankle"][:, 1], joints["right_ankle"][:, 1])
    leg = _measure_legs(joints)
    # The gradient needs two frames; a single one does not rise.
    rise = RISE * fps * np.gradient(pelvis[:, 1]) if len(pelvis) > 1 else np.zeros(1)
    vertical = np.stack([pelvis[:, 1] - ground, rise], axis=1) / leg
    # The mean direction of hips and shoulders is the body's left.
    to_left = hips + shoulders
    cos, sin = find_facing(to_left, _FLAT * np.linalg.norm(to_left, axis=1))
    x, y, z = np.moveaxis(ends, 2, 0)
    ahead = np.stack([cos * x + sin * z, y, cos * z - sin * x], axis=2)
    return np.hstack([ahead.reshape(len(ends), -1), vertical])


def mirror_poses(poses: Floats) -> Floats:
    """Poses (frames, 17) of the body in a mirror: left and right exchanged.

    Examples
    --------
    >>> import kineme
    >>> from kineme.features.canonical import matching_poses, mirror_poses
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> poses = matching_poses(motion)
    >>> bool((mirror_poses(mirror_poses(poses)) == poses).all())
    True
    """
    # The first 15 numbers are five points; height and rise look the same in a mirror.
    ends = poses[:, :15].reshape(len(poses), len(EXCHANGED), 3)[:, EXCHANGED] * FLIP
    return np.hstack([ends.reshape(len(poses), -1), poses[:, 15:]])


_SIDES = (("left", 1.0), ("right", -1.0))


def _compute_limb(
    joints: Joints, names: tuple[str, str, str], bones: tuple[float, float]
) -> Floats:
    """From the top of a limb of the canonical body to its end, (frames, 3)."""
    top, end = joints[names[0]], joints[names[2]]
    if names[1] in joints:
        middle = joints[names[1]]
        return bones[0] * _normalize(middle - top) + bones[1] * _normalize(end - middle)
    # Without a middle joint, bending shows only in how far the end is from the top.
    reach = np.linalg.norm(end - top, axis=1, keepdims=True)
    # A high quantile instead of the maximum, which may be a tracking error.
    bent = np.minimum(reach / max(float(np.quantile(reach, _STRAIGHT)), _TINY), 1.0)
    straight: Floats = sum(bones) * bent * _normalize(end - top)
    return straight


def _measure_legs(joints: Joints) -> float:
    """Metres, the mean of both legs."""
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


def _normalize(vectors: Floats) -> Floats:
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    unit: Floats = vectors / np.maximum(lengths, _TINY)
    return unit
