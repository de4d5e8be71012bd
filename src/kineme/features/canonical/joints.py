"""Find hips, knees, ankles, shoulders, elbows, wrists and head of any body.

Ankles, wrists and head are found as in `kineme.features.effectors`. The other joints are found by
the bones of the skeleton. A leg runs from the pelvis to an ankle, an arm from the joint where the
arms branch to a wrist. The pair of bones in it that is longest and most equal begins at hip and
knee, or at shoulder and elbow. Markers and keypoints, which have no bones, are found by their usual
names (see `kineme.recordings.joint_names`).
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

import numpy as np

from kineme.errors import MotionError
from kineme.features.effectors import PARTS, Names, end_effectors
from kineme.recordings import Motion, Skeleton
from kineme.recordings.joint_names import SIDES, TWIST, find_joints, has_word
from kineme.recordings.motion import check_motion

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


def match_canonical_joints(motion: Motion, *, effectors: Names | None = None) -> dict[str, Points]:
    """Return the points of the motion whose mean is each of `JOINTS`.

    Knees, elbows and shoulders that were not found are left out.

    Parameters
    ----------
    motion : Motion
    effectors : joints, optional
        Joints to use as head, hands and feet if their names are not recognised.

    Returns
    -------
    dict of str to tuple of int

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

    Parameters
    ----------
    skeleton : Skeleton
    ends : mapping of str to int
        Ankles and wrists; missing ones are searched by name.
    single : bool
        Return only joints that are a single point, not the mean of several.
    """
    named = find_joints(skeleton.names, _NAMED, single=single)
    joints: dict[str, Points] = {}
    for top, middle, end in LIMBS:
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
    inner = [
        place
        for place, joint in enumerate(chain[:-1])
        # Joints between two bones of some length, except joints that only twist a bone.
        if 0 < below[place] < below[place + 1] and not has_word(skeleton.names[joint], TWIST)
    ]
    if len(inner) < 2:
        return (chain[inner[0]] if inner else -1), -1

    def compute_penalty(pair: tuple[int, int]) -> float:
        upper, lower = below[pair[1]] - below[pair[0]], below[-1] - below[pair[1]]
        # Logarithms, so that the choice does not depend on the unit of length.
        return float(abs(np.log(upper / lower)) - np.log(upper + lower))

    top, middle = min(combinations(inner, 2), key=compute_penalty)
    return chain[top], chain[middle]
