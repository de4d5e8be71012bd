"""Compute rotations of joints, for presets whose features are rotations.

Barbič et al. (2004) chose 14 joints without the root, and Zhou et al. (2013) use the same. Their
program maps the raw Euler angles of AMC files. ``Motion.rotations`` are the same rotations in other
axes, constant per joint. This rotates each log map as a whole and does not change distances.
"""

from __future__ import annotations

import numpy as np

from kineme._util.arrays import Floats
from kineme.errors import MotionError
from kineme.recordings import Motion

JOINTS = (
    *("lowerback", "upperback", "thorax", "lowerneck", "upperneck", "head"),
    *("rhumerus", "rradius", "lhumerus", "lradius"),
    *("rfemur", "rtibia", "lfemur", "ltibia"),
)


def compute_joint_quaternions(motion: Motion) -> Floats:
    """Return the local rotations of the 14 joints: unit quaternions (w, x, y, z) with w >= 0.

    Parameters
    ----------
    motion : Motion

    Returns
    -------
    (frames, 14, 4) array

    Raises
    ------
    MotionError
        The motion has no rotations, or lacks one of these joints.
    """
    if motion.rotations is None:
        raise MotionError("these methods need rotations, but the motion has positions only")
    names = motion.skeleton.names
    missing = [joint for joint in JOINTS if joint not in names]
    if missing:
        raise MotionError(
            f"no joint {missing[0]!r} in the skeleton; these methods need the joints of CMU's "
            f"ASF files: {', '.join(JOINTS)}"
        )
    q = motion.rotations[:, [names.index(joint) for joint in JOINTS]]
    # q and -q are the same rotation; w >= 0 selects the shorter one.
    return np.where(q[..., :1] < 0, -q, q)


def compute_log_maps(quaternions: Floats) -> Floats:
    """Return half of the rotation vector of each quaternion.

    Parameters
    ----------
    quaternions : (frames, joints, 4) array
        With w >= 0.

    Returns
    -------
    (frames, 3 * joints) array
    """
    half = np.arccos(np.clip(quaternions[..., :1], -1, 1))
    # `sinc(half / pi)` is sin(half) / half, and 1 at the identity, which avoids a division by 0.
    logs = quaternions[..., 1:] / np.sinc(half / np.pi)
    return logs.reshape(len(logs), -1)
