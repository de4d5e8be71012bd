"""Which joints are hip, knee, ankle, heel, toe, shoulder, elbow and wrist of each side.

Ankles and wrists are those of `kineme.features.end_effectors`. Above them a skeleton is followed
upwards to the two bones that are as long as each other: thigh and shank, upper arm and forearm.
Markers and keypoints, which hang on no such chain, are told by their names.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import log

import numpy as np

from kineme.errors import EndEffectorError
from kineme.features import end_effectors
from kineme.features.naming import part_and_side, words_of
from kineme.recordings import Motion, Skeleton

SIDES = ("left", "right")
UNEQUAL = 0.5
"""Natural logarithm of the ratio of two bones of one limb, at most."""
NAMES = {
    "hip": ("hip", "hjc", "upleg", "upperleg", "thigh", "femur"),
    "knee": (
        "knee",
        "kne",
        "kjc",
        "kneeout",
        "kneelat",
        "lek",
        "fle",
        "leg",
        "lowerleg",
        "shin",
        "calf",
    ),
    "ankle": ("ankle", "ank", "ajc", "ankleout", "anklelat", "foot"),
    "heel": ("heel", "hee", "calcaneus", "fcc"),
    "toe": ("toe", "toebase", "toes", "bigtoe", "toetip", "footindex", "mt", "mtp", "fm", "foot"),
    "shoulder": ("shoulder", "sho", "sjc", "acromium", "acr", "upperarm", "arm"),
    "elbow": ("elbow", "elb", "ejc", "elbowout", "elblat", "forearm"),
    "wrist": ("wrist", "wra", "wjc", "wristout", "hand"),
}  # fmt: skip
"""Names of points without side and numbers (``LMT5`` is ``mt``), the preferred ones first."""
_TURNS = frozenset({"twist", "roll"})
"""In the name of a joint that only turns a bone about itself."""


def landmarks(motion: Motion) -> dict[str, int]:
    """Joints by part and side, such as ``left_knee``; those that are not found are left out.

    Parameters
    ----------
    motion : Motion

    Returns
    -------
    dict of str to int

    Examples
    --------
    >>> import kineme
    >>> from kineme.cycles import landmarks
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> motion.skeleton.names[landmarks(motion)["left_knee"]]
    'LeftLeg'
    """
    skeleton = motion.skeleton
    ends: dict[str, int] = {}
    try:
        effectors = end_effectors(motion)
    except EndEffectorError:
        pass
    else:
        for side in SIDES:
            ends[f"{side}_ankle"] = getattr(effectors, f"{side}_ankle")
            ends[f"{side}_wrist"] = getattr(effectors, f"{side}_wrist")
    joints: dict[str, int] = {}
    for side in SIDES:
        for end, middle, top in (("ankle", "knee", "hip"), ("wrist", "elbow", "shoulder")):
            # What `end_effectors` found comes first; else the usual names of points.
            tip = ends.get(f"{side}_{end}", _named(skeleton.names, end, side))
            # A bool as index: the other side.
            other = ends.get(f"{SIDES[side == SIDES[0]]}_{end}")
            chain = (None, None) if tip is None else _limb(skeleton, tip, other)
            places = {end: tip, middle: chain[0], top: chain[1]}
            for part, place in places.items():
                joint = _named(skeleton.names, part, side) if place is None else place
                if joint is not None:
                    joints[f"{side}_{part}"] = joint
        ankle = joints.get(f"{side}_ankle")
        for part in ("heel", "toe"):
            # A heel or a toe must not be the ankle itself, which may be called foot.
            joint = _named(skeleton.names, part, side, but=ankle)
            if joint is None and part == "toe" and ankle is not None:
                joint = _beyond(skeleton, ankle)
            if joint is not None:
                joints[f"{side}_{part}"] = joint
    return joints


def _named(names: Sequence[str], part: str, side: str, but: int | None = None) -> int | None:
    """Return the joint of one of the names of a part, the preferred one."""
    parts = [part_and_side(name) for name in names]
    for word in NAMES[part]:
        if (word, side) in parts and parts.index((word, side)) != but:
            return parts.index((word, side))
    return None


def _limb(skeleton: Skeleton, tip: int, other: int | None) -> tuple[int | None, int | None]:
    """Return the middle and the upper joint of the limb that ends here.

    None twice where there is none.

    Neither is a joint that the limb of the other side hangs on as well.
    """
    # Joints above the other limb's end, such as the pelvis, belong to both limbs.
    both = set()
    while other is not None and other >= 0:
        both.add(other)
        other = skeleton.parents[other]
    # `far[k]` is the length of the chain from the tip up to its k-th joint.
    chain, far = [], [0.0]
    joint = tip
    while (parent := skeleton.parents[joint]) >= 0 and parent not in both:
        far.append(far[-1] + float(np.linalg.norm(skeleton.offsets[joint])))
        chain.append(parent)
        joint = parent
    # Of all pairs of joints above the tip, that with the most equal bones below them.
    best, pair = UNEQUAL, (None, None)
    for lower, middle in enumerate(chain):
        for upper in range(lower + 1, len(chain)):
            shank, thigh = far[lower + 1], far[upper + 1] - far[lower + 1]
            # Twist joints only turn a bone, so a limb does not end there.
            if min(shank, thigh) <= 0 or any(
                _TURNS.intersection(words_of(skeleton.names[j])) for j in (middle, chain[upper])
            ):
                continue
            # The logarithm treats a ratio and its inverse alike.
            unequal = abs(log(thigh / shank))
            if unequal < best:
                best, pair = unequal, (middle, chain[upper])  # type: ignore[assignment]
    return pair


def _beyond(skeleton: Skeleton, ankle: int) -> int | None:
    """Return the joint below the ankle that is farthest from it."""
    lengths = np.linalg.norm(skeleton.offsets, axis=1)
    below = [j for j, parent in enumerate(skeleton.parents) if parent == ankle and lengths[j] > 0]
    return max(below, key=lambda j: float(lengths[j]), default=None)
