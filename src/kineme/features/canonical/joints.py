"""Which points of any body are its hips, knees, ankles, shoulders, elbows, wrists and head.

Ankles, wrists and head are found as everywhere (see `kineme.features.effectors`). The joints
between come from the skeleton, where it has limbs. A leg goes from the pelvis to an ankle, an arm
from where the arms part to a wrist. In each, the longest and most equal pair of bones begins at hip
and knee, or at shoulder and elbow. Markers and keypoints, which hang on nothing, are found by their
usual names.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from kineme.errors import MotionError
from kineme.features.effectors import Names, end_effectors
from kineme.features.naming import part_and_side, words_of
from kineme.recordings import Motion, Skeleton
from kineme.recordings.motion import check_motion

Points = tuple[int, ...]

JOINTS = (
    *("left_hip", "left_knee", "left_ankle", "right_hip", "right_knee", "right_ankle"),
    *("left_shoulder", "left_elbow", "left_wrist"),
    *("right_shoulder", "right_elbow", "right_wrist", "head"),
)

# Markers and keypoints without their side, the preferred ones first; a joint is their middle.
_MARKERS = {
    "hip": ("hip", "hjc"),
    "knee": ("knee", "kjc", "kneelat kneemed", "kneeout kneein", "fle fme", "kne", "kneeout"),
    "shoulder": ("shoulder", "sjc", "sho", "shouldertop", "acromion", "acromium", "acr"),
    "elbow": ("elbow", "ejc", "elbowlat elbowmed", "elbowout elbowin", "hle hme", "elb"),
}
_TWISTS = frozenset({"twist", "roll"})


def canonical_joints(motion: Motion, *, effectors: Names | None = None) -> dict[str, Points]:
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
    skeleton = motion.skeleton
    legs = _limbs(skeleton, ends.left_ankle, ends.right_ankle)
    arms = _limbs(skeleton, ends.left_wrist, ends.right_wrist)
    limbs = {
        **_named(("hip", "knee", "ankle"), legs),
        **_named(("shoulder", "elbow", "wrist"), arms),
        "head": (ends.head,),
    }
    named_points = _named_points(skeleton.names)
    found = {joint: limbs.get(joint) or named_points.get(joint) for joint in JOINTS}
    for side in ("left", "right"):
        if not found[f"{side}_hip"]:
            raise MotionError(f"the {side} leg has no hip: nothing joins it to a pelvis")
    return {joint: points for joint, points in found.items() if points}


def _named(parts: tuple[str, str, str], limbs: Sequence[Sequence[int]]) -> dict[str, Points]:
    """Return the joints of a left and a right limb by name; a limb may lack what comes first."""
    return {
        f"{side}_{part}": (joint,)
        for side, limb in zip(("left", "right"), limbs, strict=True)
        for part, joint in zip(parts, limb, strict=True)
        if joint >= 0
    }


def _limbs(skeleton: Skeleton, left: int, right: int) -> list[tuple[int, int, int]]:
    """Top, middle and end of both limbs; -1 where the skeleton has no such joint."""
    chains = [_ancestry(skeleton, end) for end in (left, right)]
    # Equal joints from the root on: the limbs part below the last of these.
    shared = sum(1 for a, b in zip(*chains, strict=False) if a == b)
    return [(*_top_and_middle(skeleton, chain[shared:]), chain[-1]) for chain in chains]


def _ancestry(skeleton: Skeleton, joint: int) -> list[int]:
    """Return the joints from the root down to ``joint``."""
    chain = [joint]
    while skeleton.parents[chain[-1]] >= 0:
        chain.append(skeleton.parents[chain[-1]])
    return chain[::-1]


def _top_and_middle(skeleton: Skeleton, chain: list[int]) -> tuple[int, int]:
    """Where the two long bones of a chain begin: the longest pair, and the most equal one.

    Not where the limbs part: there left and right are one.
    """
    # Length of the chain from where the limbs part down to each joint.
    below = np.cumsum(np.linalg.norm(skeleton.offsets[chain], axis=1))
    inner = [
        place
        for place, joint in enumerate(chain[:-1])
        # Joints with a bone of some length above and below, unless they only turn a bone.
        if 0 < below[place] < below[place + 1]
        and not _TWISTS.intersection(words_of(skeleton.names[joint]))
    ]
    if len(inner) < 2:
        return (chain[inner[0]] if inner else -1), -1

    def unlikely(pair: tuple[int, int]) -> float:
        upper, lower = below[pair[1]] - below[pair[0]], below[-1] - below[pair[1]]
        # Both terms are logarithms, so the choice does not depend on the unit of length.
        return float(abs(np.log(upper / lower)) - np.log(upper + lower))

    top, middle = min(combinations(inner, 2), key=unlikely)
    return chain[top], chain[middle]


def _named_points(names: Sequence[str]) -> dict[str, Points]:
    """Joints of the limbs that are markers or keypoints, by their names."""
    at: dict[tuple[str, str], int] = {}
    for point, name in enumerate(names):
        # The first point of a name is kept; later ones of the same name are duplicates.
        at.setdefault(part_and_side(name), point)
    found: dict[str, Points] = {}
    for part, choices in _MARKERS.items():
        for side in ("left", "right"):
            for choice in choices:
                keys = [(word, side) for word in choice.split()]
                if all(key in at for key in keys):
                    # `setdefault` keeps the preferred choice; a choice of two words is the middle
                    # of both markers.
                    found.setdefault(f"{side}_{part}", tuple(at[key] for key in keys))
    return found
