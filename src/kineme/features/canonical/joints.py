"""Find hips, knees, ankles, shoulders, elbows, wrists and head of any body.

Ankles, wrists and head are found as everywhere (see `kineme.features.effectors`). The joints
between come from the skeleton, where it has limbs. A leg goes from the pelvis to an ankle, an arm
from where the arms part to a wrist. In each, the longest and most equal pair of bones begins at hip
and knee, or at shoulder and elbow. Markers and keypoints, which hang on nothing, are found by their
usual names (see `kineme.recordings.joint_names`).
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
"""Top, middle and end of a leg and of an arm."""
_NAMED = (
    ("*_hip", "*_hip_centre", "*_thigh"),
    ("*_knee", "*_shank"),
    ("*_ankle", "*_foot"),
    ("*_shoulder", "*_upper_arm"),
    ("*_elbow", "*_forearm"),
    ("*_wrist", "*_hand"),
)


def match_canonical_joints(motion: Motion, *, effectors: Names | None = None) -> dict[str, Points]:
    """Return for each of `JOINTS` the points of the motion whose middle it is.

    Knees, elbows and shoulders that were not found are not there.

    Parameters
    ----------
    motion : Motion
    effectors : joints, optional
        To take for head, hands and feet where names do not tell.

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
    found = find_limbs(motion.skeleton, dict(zip(PARTS, ends.indices, strict=True)))
    found["head"] = (ends.head,)
    for side in SIDES:
        if f"{side}_hip" not in found:
            raise MotionError(f"the {side} leg has no hip: nothing joins it to a pelvis")
    return {joint: found[joint] for joint in JOINTS if joint in found}


def find_limbs(
    skeleton: Skeleton, ends: Mapping[str, int], *, single: bool = False
) -> dict[str, Points]:
    """Return the joints of arms and legs; those that are not found are left out.

    Parameters
    ----------
    skeleton : Skeleton
    ends : mapping of str to int
        The ankles and wrists; those that are not there are looked for by name.
    single : bool
        Return one point for each joint, and none that is the middle of several.
    """
    named = find_joints(skeleton.names, _NAMED, single=single)
    found: dict[str, Points] = {}
    for top, middle, end in LIMBS:
        tips = [
            ends.get(joint, named.get(joint, (-1,))[0]) for joint in (f"left_{end}", f"right_{end}")
        ]
        chains = [skeleton.ancestry(tip) for tip in tips]
        # Equal joints from the root on: the limbs part below the last of these.
        shared = sum(1 for a, b in zip(*chains, strict=False) if a == b)
        for side, tip, chain in zip(SIDES, tips, chains, strict=True):
            places = (*_find_top_and_middle(skeleton, chain[shared:]), tip)
            for part, place in zip((top, middle, end), places, strict=True):
                joint = f"{side}_{part}"
                points = (place,) if place >= 0 else named.get(joint)
                if points:
                    found[joint] = points
    return found


def _find_top_and_middle(skeleton: Skeleton, chain: list[int]) -> tuple[int, int]:
    """Return where the two long bones of a chain begin, -1 where it has no such joint.

    They are the longest pair, and the most equal one. Where the limbs part, left and right are one:
    that joint is none of them.
    """
    # Length of the chain from where the limbs part down to each joint.
    below = np.cumsum(np.linalg.norm(skeleton.offsets[chain], axis=1))
    inner = [
        place
        for place, joint in enumerate(chain[:-1])
        # Joints with a bone of some length above and below, unless they only turn a bone.
        if 0 < below[place] < below[place + 1] and not has_word(skeleton.names[joint], TWIST)
    ]
    if len(inner) < 2:
        return (chain[inner[0]] if inner else -1), -1

    def unlikely(pair: tuple[int, int]) -> float:
        upper, lower = below[pair[1]] - below[pair[0]], below[-1] - below[pair[1]]
        # Both terms are logarithms, so the choice does not depend on the unit of length.
        return float(abs(np.log(upper / lower)) - np.log(upper + lower))

    top, middle = min(combinations(inner, 2), key=unlikely)
    return chain[top], chain[middle]
