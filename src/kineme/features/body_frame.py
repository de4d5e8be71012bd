"""Body's own frame: at the pelvis, upright, facing +z with the left at +x.

Positions relative to the pelvis, turned about the vertical frame by frame so
that the body always faces the same way. Height differences, pitch and roll
stay; limbs are not scaled.

The facing comes from one axis of the pelvis, the one that points from the right hip to the left at
rest. The authors' program uses the root's +x, which is that axis in CMU's files. Other exporters
turn their root frames. So the axis is looked up in the skeleton: the nearest of +-x, +-y, +-z. A
motion without rotations uses the line through the hips instead.

Where that axis stands upright (a body on its side, in a cartwheel) there is no facing. Then the
frame takes that of the nearest frame that has one, the earlier of two equally near. A motion
without any is left unturned.
"""

from __future__ import annotations

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.errors import MotionError
from kineme.features.effectors import EndEffectors, end_effectors
from kineme.recordings import Motion, Skeleton

_UPRIGHT = 1e-6  # horizontal part of the unit axis below which it has no direction


def compute_body_frame(
    motion: Motion, joints: tuple[int, ...] | None = None, *, effectors: EndEffectors | None = None
) -> Floats:
    """Positions (frames, joints, 3) relative to the pelvis, heading removed, in metres.

    x points to the body's left, y up, z ahead.

    Parameters
    ----------
    motion : Motion
    joints : tuple of int, optional
        Indices of the joints wanted, all by default.
    effectors : EndEffectors, optional
        Where the legs end, which tells pelvis and hips; found by name or shape by default.

    Raises
    ------
    EndEffectorError
        The legs were not found.
    MotionError
        The legs have no hips, so nothing tells left from right.

    References
    ----------
    Voegele et al. 2014, section 3.1; heading as in the authors' program.

    Examples
    --------
    >>> import kineme
    >>> from kineme.features import compute_body_frame
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> compute_body_frame(motion).shape == motion.positions.shape
    True
    """
    pelvis, cos, sin = _compute_turns(motion, effectors or end_effectors(motion))
    positions = motion.positions if joints is None else motion.positions[:, joints]
    relative = positions - motion.positions[:, pelvis, None]
    # A copy of x, since its column is overwritten before z needs it.
    x, z = relative[:, :, 0].copy(), relative[:, :, 2]
    relative[:, :, 0] = cos * x + sin * z
    relative[:, :, 2] = cos * z - sin * x
    return relative


def compute_heading(motion: Motion, *, effectors: EndEffectors | None = None) -> tuple[int, Floats]:
    """Return the pelvis's joint, and the angles (frames,) by which the body looks away from +z.

    Radians about the vertical, positive towards +x: what ``compute_body_frame`` takes
    away. Arguments and errors are those of ``compute_body_frame``.

    Examples
    --------
    >>> import kineme
    >>> from kineme.features import compute_heading
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> pelvis, angles = compute_heading(motion)
    >>> motion.skeleton.names[pelvis], angles.shape
    ('Hips', (2898,))
    """
    pelvis, cos, sin = _compute_turns(motion, effectors or end_effectors(motion))
    # `_compute_turns` gives the turn back to +z, which is the opposite of the heading.
    return pelvis, np.arctan2(-sin, cos)[:, 0]


def _compute_turns(motion: Motion, effectors: EndEffectors) -> tuple[int, Floats, Floats]:
    """Return the pelvis, and cosine and sine (frames, 1) of the turns that face the body to +z."""
    ankles = effectors.left_ankle, effectors.right_ankle
    pelvis, left_hip, right_hip = find_parting(motion.skeleton, *ankles)
    if motion.rotations is None:
        to_left = motion.positions[:, left_hip] - motion.positions[:, right_hip]
        # A line shorter than the threshold stays shorter than a unit vector and counts as upright.
        to_left /= np.maximum(np.linalg.norm(to_left, axis=1, keepdims=True), _UPRIGHT)
    else:
        to_left = _compute_turned_axis(
            motion.skeleton, motion.rotations, pelvis, left_hip, right_hip
        )
    return pelvis, *find_facing(to_left, _UPRIGHT)


def find_parting(
    skeleton: Skeleton, left_end: int, right_end: int, limbs: str = "legs"
) -> tuple[int, int, int]:
    """Return the joint where limbs part, and the left and right joint where they first lie apart.

    Legs part at the pelvis, arms at the chest. MotionError where nothing joins them.
    """
    left, right = skeleton.ancestry(left_end), skeleton.ancestry(right_end)
    # Both chains begin at the root and are equal down to the joint where the limbs part.
    shared = sum(1 for a, b in zip(left, right, strict=False) if a == b)
    if shared == 0:
        raise MotionError(f"the {limbs} hang on different roots: nothing joins them")
    pelvis = left[shared - 1]
    # Some skeletons have several joints at the same place before the legs are apart.
    for left_hip, right_hip in zip(left[shared:], right[shared:], strict=False):
        if np.linalg.norm(_measure_hip_axis(skeleton, pelvis, left_hip, right_hip)) > 0:
            return pelvis, left_hip, right_hip
    raise MotionError(
        f"left and right {limbs} coincide below {skeleton.names[pelvis]!r}, so nothing tells the "
        "facing"
    )


def _measure_hip_axis(skeleton: Skeleton, pelvis: int, left_hip: int, right_hip: int) -> Floats:
    """From the right hip to the left, in the pelvis's own frame, at rest."""

    def from_pelvis(joint: int) -> Floats:
        chain = skeleton.ancestry(joint)
        # Offsets below the pelvis only: they are in the pelvis's own axes at rest.
        return np.asarray(skeleton.offsets[chain[chain.index(pelvis) + 1 :]].sum(axis=0))

    return from_pelvis(left_hip) - from_pelvis(right_hip)


def _compute_turned_axis(
    skeleton: Skeleton, rotations: Floats, pelvis: int, left_hip: int, right_hip: int
) -> Floats:
    """(frames, 3): the pelvis's axis to the left, in the world."""
    rest = _measure_hip_axis(skeleton, pelvis, left_hip, right_hip)
    axis = np.zeros(3)
    # The coordinate axis nearest to the line of the hips, with its sign.
    axis[np.argmax(np.abs(rest))] = np.sign(rest[np.argmax(np.abs(rest))])
    # Local rotations from the pelvis up to the root bring the axis into the world.
    for joint in reversed(skeleton.ancestry(pelvis)):
        axis = rot.rotate(rotations[:, joint], axis)
    return axis


def find_facing(to_left: Floats, least: float | Floats) -> tuple[Floats, Floats]:
    """Cosine and sine, (frames, 1) each, of the turn that brings what points to the left to +x.

    Where no more than ``least`` of it lies flat, it is that of the nearest frame that has one.
    """
    # Length of the horizontal part.
    length = np.hypot(to_left[:, 0], to_left[:, 2])
    level = np.flatnonzero(length > least)
    if len(level) == 0:
        return np.ones((len(length), 1)), np.zeros((len(length), 1))
    # `searchsorted` among the middles gives the nearest frame; at a tie the earlier one.
    middles = (level[:-1] + level[1:]) / 2
    nearest = level[np.searchsorted(middles, np.arange(len(length)))]
    to_left, length = to_left[nearest], length[nearest]
    return (to_left[:, 0] / length)[:, None], (to_left[:, 2] / length)[:, None]
