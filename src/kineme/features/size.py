"""How large a body is, so that distances can be given in body sizes and not in metres."""

from __future__ import annotations

import numpy as np

from kineme.errors import MotionError
from kineme.features.effectors import EndEffectors, remedy
from kineme.recordings import Motion


def body_size(motion: Motion, effectors: EndEffectors) -> float:
    """Length of the chain of bones from the ankles to the head, in metres.

    The legs' mean plus the trunk's, at rest: close to the height of the person.
    In a motion without rotations a bone is as long as the distance of its ends
    in the median frame.

    Raises
    ------
    MotionError
        The bones have no length.

    Examples
    --------
    >>> import kineme
    >>> from kineme.features import body_size
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> round(body_size(motion, kineme.end_effectors(motion)), 2)
    1.72
    """
    legs = [_chain(motion, joint) for joint in (effectors.left_ankle, effectors.right_ankle)]
    size = float(np.mean(legs)) + _chain(motion, effectors.head)
    if not size > 0:
        lacking = "" if max(motion.skeleton.parents) >= 0 else f": {remedy(motion.skeleton)}"
        raise MotionError(
            "the bones between ankles and head have no length, as among markers without a pelvis"
            + lacking
        )
    return size


def _chain(motion: Motion, joint: int) -> float:
    """Return the length of the bones from a joint up to the hips."""
    length = 0.0
    parent = motion.skeleton.parents[joint]
    # The carrier is the hips, where the chain ends.
    while parent >= 0 and joint != motion.skeleton.carrier:
        if motion.rotations is None:
            bone = motion.positions[:, joint] - motion.positions[:, parent]
            length += float(np.median(np.linalg.norm(bone, axis=-1)))
        else:
            length += float(np.linalg.norm(motion.skeleton.offsets[joint]))
        joint, parent = parent, motion.skeleton.parents[parent]
    return length
