"""How large a body is, so that distances can be told in bodies and not in metres."""

from __future__ import annotations

import numpy as np

from kineme.errors import MotionError
from kineme.features.effectors import EndEffectors
from kineme.motion import Motion, Skeleton


def body_size(motion: Motion, effectors: EndEffectors) -> float:
    """Length of the chain of bones from the ankles to the head, in metres.

    The legs' mean plus the trunk's, at rest: close to the height of the person.

    Raises
    ------
    MotionError : the bones have no length
    """
    skeleton = motion.skeleton
    legs = [_chain(skeleton, joint) for joint in (effectors.left_ankle, effectors.right_ankle)]
    size = float(np.mean(legs)) + _chain(skeleton, effectors.head)
    if not size > 0:
        raise MotionError("the bones between ankles and head have no length")
    return size


def _chain(skeleton: Skeleton, joint: int) -> float:
    """Length of the bones from a joint up to its root."""
    length = 0.0
    while skeleton.parents[joint] >= 0:
        length += float(np.linalg.norm(skeleton.offsets[joint]))
        joint = skeleton.parents[joint]
    return length
