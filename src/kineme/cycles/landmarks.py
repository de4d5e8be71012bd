"""Find hip, knee, ankle, heel, toe, shoulder, elbow and wrist of each side.

Arms and legs are those of `kineme.features.canonical`. Heels and toes are found by their names (see
`kineme.recordings.joint_names`); a toe may also be the end of a foot.
"""

from __future__ import annotations

import numpy as np

from kineme.errors import EndEffectorError
from kineme.features import PARTS, end_effectors
from kineme.features.canonical.joints import find_limbs
from kineme.recordings import Motion, Skeleton
from kineme.recordings.joint_names import SIDES, find_joints


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
    try:
        ends = dict(zip(PARTS, end_effectors(motion).indices, strict=True))
    except EndEffectorError:
        ends = {}
    limbs = find_limbs(skeleton, ends, single=True)
    joints = {joint: points[0] for joint, points in limbs.items()}
    ankles = {side: joints[f"{side}_ankle"] for side in SIDES if f"{side}_ankle" in joints}
    # Some rigs call the ankle a foot, others the ball of the foot.
    others = {*range(skeleton.n_joints)} - {*ankles.values()}
    named = find_joints(
        skeleton.names, [("*_heel",), ("*_toe", "*_foot")], usable=others, single=True
    )
    joints |= {joint: points[0] for joint, points in named.items()}
    for side, ankle in ankles.items():
        if (toe := _beyond(skeleton, ankle)) is not None:
            joints.setdefault(f"{side}_toe", toe)
    return joints


def find_feet(motion: Motion) -> dict[str, tuple[int, ...]]:
    """Return for each foot the joints that tell whether it stands: heel or ankle, and toe."""
    joints = landmarks(motion)
    heels = {side: joints.get(f"{side}_heel", joints.get(f"{side}_ankle")) for side in SIDES}
    # The keys of a dict are unique: a foot without a toe has its heel only once.
    return {
        side: tuple(dict.fromkeys((heel, joints.get(f"{side}_toe", heel))))
        for side, heel in heels.items()
        if heel is not None
    }


def _beyond(skeleton: Skeleton, ankle: int) -> int | None:
    """Return the joint below the ankle that is farthest from it."""
    lengths = np.linalg.norm(skeleton.offsets, axis=1)
    below = [j for j in skeleton.children[ankle] if lengths[j] > 0]
    return max(below, key=lambda j: float(lengths[j]), default=None)
