"""Legs, arms and head of a skeleton whose names say nothing.

Limbs come in pairs: two branches of one joint whose longest paths have the same
bones. The two longest such pairs are the legs and the arms; the pair that
hangs lower in the given pose is the legs. In each limb the two longest bones
(thigh and shin, upper arm and forearm) end at the ankle or wrist; bones that
begin where both limbs begin (clavicles) do not count. The head is the end of
the longest branch left where the arms begin. Left is told from right by where
the feet point: with y up and the toes along f, left is y x f.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from kineme._util.arrays import Floats

_SAME_LENGTH = 0.15  # relative difference at which two branches still make a pair
_MOST_BRANCHES = 32  # of one joint, the longest; a hand has five, and pairs grow with the square
_SHORTEST_FOOT = 0.1  # of the leg's length; less does not tell where the foot points


@dataclass(frozen=True)
class _Limb:
    """Where its first long bone begins, where its second one ends, and its farthest joint."""

    parent: int
    branch: int
    top: int
    end: int
    tip: int
    length: float


def find_by_shape(parents: Sequence[int], pose: Floats) -> dict[str, int]:
    """Joints by part ("left_ankle", ..., "head"), as far as the shape tells them.

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
    # Both limbs of the lower pair end lower.
    legs, arms = sorted(pairs, key=lambda pair: float(pose[[limb.end for limb in pair], 1].sum()))
    found = _find_head(parents, arms, paths, lengths)
    left = _find_left(legs, pose)
    if left is not None:
        for part, pair in (("ankle", legs), ("wrist", arms)):
            # Along the direction of the left, the right limb comes first.
            right_limb, left_limb = sorted(pair, key=lambda limb: float(pose[limb.top] @ left))
            found |= {f"left_{part}": left_limb.end, f"right_{part}": right_limb.end}
    return found


def _find_longest_paths(
    parents: Sequence[int], pose: Floats
) -> tuple[list[list[int]], list[float]]:
    """For each joint the longest way down to a leaf, and its length from the joint's parent."""
    paths: list[list[int]] = [[joint] for joint in range(len(parents))]
    below = [0.0] * len(parents)
    # A root has no parent: index 0 stands in for it.
    bones = np.linalg.norm(pose - pose[np.maximum(parents, 0)], axis=1).tolist()
    # Children before parents, so what hangs below a joint is known when it is reached.
    for joint in range(len(parents) - 1, -1, -1):
        parent = parents[joint]
        if parent >= 0 and bones[joint] + below[joint] > below[parent]:
            below[parent] = bones[joint] + below[joint]
            paths[parent] = [parent, *paths[joint]]
    return paths, [bone + rest for bone, rest in zip(bones, below, strict=True)]


def _find_limb_pairs(
    parents: Sequence[int], paths: list[list[int]], lengths: list[float], pose: Floats
) -> list[tuple[_Limb, _Limb]]:
    """Pairs of like branches of one joint, the longest first."""
    children: dict[int, list[int]] = {}
    for joint, parent in enumerate(parents):
        # A branch of one joint has no bone below it.
        if parent >= 0 and len(paths[joint]) > 1:
            children.setdefault(parent, []).append(joint)
    pairs = []
    for branches in children.values():
        longest = sorted(branches, key=lambda joint: -lengths[joint])[:_MOST_BRANCHES]
        # Sorted by joint again, so that the order in a pair does not depend on lengths.
        for one, other in combinations(sorted(longest), 2):
            if pair := _pair_limbs(parents, paths[one], paths[other], pose):
                pairs.append(pair)
    return sorted(pairs, key=lambda pair: -pair[0].length - pair[1].length)


def _pair_limbs(
    parents: Sequence[int], one: list[int], other: list[int], pose: Floats
) -> tuple[_Limb, _Limb] | None:
    """Return the two branches as a pair of limbs, or None where their bones differ."""
    if len(one) != len(other):
        return None
    paths = np.array([one, other])
    # The joint at which each bone begins, (2, bones).
    starts = np.asarray(parents)[paths]
    bones = np.linalg.norm(pose[paths] - pose[starts], axis=2)
    # Summed differences of the bones, as a share of the length of one branch.
    if np.abs(bones[0] - bones[1]).sum() > _SAME_LENGTH * bones[0].sum():
        return None
    # Clavicles and the like begin at the same place on both sides.
    apart = np.any(pose[starts[0]] != pose[starts[1]], axis=1)
    # The two longest bones, in order down the limb; at ties the upper ones.
    long_bones = np.sort(np.argsort(-(bones[0] * apart), kind="stable")[:2])
    first, second = (long_bones[0], long_bones[-1])
    left_and_right = [
        _Limb(parents[path[0]], path[0], parents[path[first]], path[second], path[-1], length)
        for path, length in zip((one, other), bones.sum(axis=1).tolist(), strict=True)
    ]
    return left_and_right[0], left_and_right[1]


def _find_left(legs: tuple[_Limb, _Limb], pose: Floats) -> Floats | None:
    """Direction of the body's left in the pose, or None where the feet do not tell."""
    # From the ankles to the tips of the toes, both feet together.
    feet = sum((pose[leg.tip] - pose[leg.end] for leg in legs), start=np.zeros(3))
    ahead = np.array([feet[0], 0.0, feet[2]])
    if np.linalg.norm(ahead) < _SHORTEST_FOOT * legs[0].length:
        return None
    return np.cross([0.0, 1.0, 0.0], ahead)


def _find_head(
    parents: Sequence[int], arms: tuple[_Limb, _Limb], paths: list[list[int]], lengths: list[float]
) -> dict[str, int]:
    """Return the end of the longest branch beside the arms."""
    # The joint at which the arms begin.
    chest, used = arms[0].parent, {arm.branch for arm in arms}
    others = [j for j, parent in enumerate(parents) if parent == chest and j not in used]
    return {"head": paths[max(others, key=lambda j: lengths[j])][-1]} if others else {}
