"""Find legs, arms and head of a skeleton by its shape.

Limbs are pairs of branches of one joint whose longest paths have the same bone
lengths. The two longest pairs are legs and arms; the pair that ends lower in the
given pose is the legs. The two longest bones of a limb (thigh and shin, upper arm and
forearm) end at the ankle or wrist; bones that begin at the same place on both sides
(clavicles) do not count. The head is the end of the longest other branch at the joint
where the arms begin. Left and right follow from the direction f of the feet: with y
up, left is y x f.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from kineme._util.arrays import Floats

_SAME_LENGTH = 0.15
"""Largest relative difference of the bones of a pair of limbs."""
_MAX_BRANCHES = 32
"""Largest number of branches of one joint that are compared in pairs: the longest ones."""
_MIN_FOOT = 0.1
"""Shortest foot that gives a direction, as a share of the length of the leg."""


@dataclass(frozen=True)
class _Limb:
    """A limb of a skeleton, by indices of joints."""

    parent: int
    """Joint at which the limb branches off."""
    branch: int
    """First joint of the limb."""
    top: int
    """Where its first long bone begins."""
    end: int
    """Where its second long bone ends."""
    tip: int
    """Its farthest joint."""
    length: float
    """Length of all bones."""


def find_by_shape(parents: Sequence[int], pose: Floats) -> dict[str, int]:
    """Return joints by part ("left_ankle", ..., "head"), as far as they are found by shape.

    Parameters
    ----------
    parents : sequence of int
        Index of each joint's parent, -1 for a root.
    pose : ndarray of shape (joints, 3)
        Metres, y up: a pose in which the legs are the lower limbs.
    """
    paths, lengths = _find_longest_paths(parents, pose)
    pairs = _find_limb_pairs(parents, paths, lengths, pose)[:2]
    if len(pairs) < 2:
        return {}
    # The legs end lower than the arms.
    legs, arms = sorted(pairs, key=lambda pair: float(pose[[limb.end for limb in pair], 1].sum()))
    joints = _find_head(parents, arms, paths, lengths)
    left = _find_left(legs, pose)
    if left is not None:
        for part, pair in (("ankle", legs), ("wrist", arms)):
            # Sorted along the direction to the left, the right limb comes first.
            right_limb, left_limb = sorted(pair, key=lambda limb: float(pose[limb.top] @ left))
            joints |= {f"left_{part}": left_limb.end, f"right_{part}": right_limb.end}
    return joints


def _find_longest_paths(
    parents: Sequence[int], pose: Floats
) -> tuple[list[list[int]], list[float]]:
    """Return the longest path from each joint to a leaf, and its length from the joint's parent."""
    paths: list[list[int]] = [[joint] for joint in range(len(parents))]
    below = [0.0] * len(parents)
    # A root has no parent: use index 0 instead.
    bones = np.linalg.norm(pose - pose[np.maximum(parents, 0)], axis=1).tolist()
    # Children come after parents, so iterate backwards.
    for joint in range(len(parents) - 1, -1, -1):
        parent = parents[joint]
        if parent >= 0 and bones[joint] + below[joint] > below[parent]:
            below[parent] = bones[joint] + below[joint]
            paths[parent] = [parent, *paths[joint]]
    return paths, [bone + rest for bone, rest in zip(bones, below, strict=True)]


def _find_limb_pairs(
    parents: Sequence[int], paths: list[list[int]], lengths: list[float], pose: Floats
) -> list[tuple[_Limb, _Limb]]:
    """Return the pairs of similar branches of one joint, the longest first."""
    children: dict[int, list[int]] = {}
    for joint, parent in enumerate(parents):
        # Skip branches that are a single joint.
        if parent >= 0 and len(paths[joint]) > 1:
            children.setdefault(parent, []).append(joint)
    pairs = []
    for branches in children.values():
        longest = sorted(branches, key=lambda joint: -lengths[joint])[:_MAX_BRANCHES]
        # Sort by joint again, so that the order in a pair does not depend on lengths.
        for one, other in combinations(sorted(longest), 2):
            if pair := _pair_limbs(parents, paths[one], paths[other], pose):
                pairs.append(pair)
    return sorted(pairs, key=lambda pair: -pair[0].length - pair[1].length)


def _pair_limbs(
    parents: Sequence[int], one: list[int], other: list[int], pose: Floats
) -> tuple[_Limb, _Limb] | None:
    """Return two branches as a pair of limbs, or None if their bones differ."""
    if len(one) != len(other):
        return None
    paths = np.array([one, other])
    # Joint at which each bone begins, (2, bones).
    starts = np.asarray(parents)[paths]
    bones = np.linalg.norm(pose[paths] - pose[starts], axis=2)
    # Summed differences of the bones, as a share of the length of one branch.
    if np.abs(bones[0] - bones[1]).sum() > _SAME_LENGTH * bones[0].sum():
        return None
    # Bones such as clavicles begin at the same place on both sides.
    is_separate = np.any(pose[starts[0]] != pose[starts[1]], axis=1)
    # The two longest bones, in order down the limb; at ties the upper ones.
    long_bones = np.sort(np.argsort(-(bones[0] * is_separate), kind="stable")[:2])
    first, second = (long_bones[0], long_bones[-1])
    left_and_right = [
        _Limb(parents[path[0]], path[0], parents[path[first]], path[second], path[-1], length)
        for path, length in zip((one, other), bones.sum(axis=1).tolist(), strict=True)
    ]
    return left_and_right[0], left_and_right[1]


def _find_left(legs: tuple[_Limb, _Limb], pose: Floats) -> Floats | None:
    """Return the direction to the body's left in the pose, or None if feet give no direction."""
    # Sum of both feet, from the ankle to the tip.
    feet = sum((pose[leg.tip] - pose[leg.end] for leg in legs), start=np.zeros(3))
    ahead = np.array([feet[0], 0.0, feet[2]])
    if np.linalg.norm(ahead) < _MIN_FOOT * legs[0].length:
        return None
    return np.cross([0.0, 1.0, 0.0], ahead)


def _find_head(
    parents: Sequence[int], arms: tuple[_Limb, _Limb], paths: list[list[int]], lengths: list[float]
) -> dict[str, int]:
    """Return the end of the longest branch at the chest that is not an arm."""
    chest, used = arms[0].parent, {arm.branch for arm in arms}
    others = [j for j, parent in enumerate(parents) if parent == chest and j not in used]
    return {"head": paths[max(others, key=lambda j: lengths[j])][-1]} if others else {}
