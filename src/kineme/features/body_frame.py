"""Transform positions to the body's own frame: origin at the pelvis, y up, facing +z, left at +x.

Each frame is turned about the vertical, so that the body always faces the same way.
Height differences, pitch and roll are kept; limbs are not scaled.

The heading follows from the axis of the pelvis that points from the right hip to the left at rest.
In the authors' program this is the root's +x, as in CMU's files. Other exporters rotate the root
frame, so the axis is found in the skeleton: the nearest of +-x, +-y, +-z. For a motion without
rotations it is the line through the hips.

If this axis is vertical (a body on its side, as in a cartwheel), the frame has no heading and takes
that of the nearest frame with one; at a tie the earlier frame. A motion without any heading is not
turned.
"""

from __future__ import annotations

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.errors import MotionError
from kineme.features.effectors import EndEffectors, end_effectors
from kineme.recordings import Motion, Skeleton

_UPRIGHT = 1e-6
"""Length of the horizontal part of the unit axis below which there is no heading."""


def compute_body_frame(
    motion: Motion, joints: tuple[int, ...] | None = None, *, effectors: EndEffectors | None = None
) -> Floats:
    """Return positions (frames, joints, 3) relative to the pelvis, without heading, in metres.

    x points to the body's left, y up, z ahead.

    Parameters
    ----------
    motion : Motion
    joints : tuple of int, optional
        Indices of the joints to return; by default all.
    effectors : EndEffectors, optional
        The ends of the legs, from which pelvis and hips follow; by default found by name or
        shape.

    Raises
    ------
    EndEffectorError
        The legs were not found.
    MotionError
        The legs have no hips, so left and right are unknown.

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
    # Copy x, as its column is overwritten before it is used for z.
    x, z = relative[:, :, 0].copy(), relative[:, :, 2]
    relative[:, :, 0] = cos * x + sin * z
    relative[:, :, 2] = cos * z - sin * x
    return relative


def compute_heading(motion: Motion, *, effectors: EndEffectors | None = None) -> tuple[int, Floats]:
    """Return the pelvis joint, and the heading (frames,): the angle between facing and +z.

    Radians about the vertical, positive towards +x. ``compute_body_frame`` removes this
    angle; its arguments and errors are the same.

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
    # `_compute_turns` returns the turn back to +z: the negative heading.
    return pelvis, np.arctan2(-sin, cos)[:, 0]


def _compute_turns(motion: Motion, effectors: EndEffectors) -> tuple[int, Floats, Floats]:
    """Return the pelvis, and cosine and sine (frames, 1) of the turns that remove the heading."""
    ankles = effectors.left_ankle, effectors.right_ankle
    pelvis, left_hip, right_hip = find_parting(motion.skeleton, *ankles)
    if motion.rotations is None:
        to_left = motion.positions[:, left_hip] - motion.positions[:, right_hip]
        # A line shorter than the threshold does not become a unit vector and counts as vertical.
        to_left /= np.maximum(np.linalg.norm(to_left, axis=1, keepdims=True), _UPRIGHT)
    else:
        to_left = _compute_turned_axis(
            motion.skeleton, motion.rotations, pelvis, left_hip, right_hip
        )
    return pelvis, *find_facing(to_left, _UPRIGHT)


def find_parting(
    skeleton: Skeleton, left_end: int, right_end: int, limbs: str = "legs"
) -> tuple[int, int, int]:
    """Return the joint at which two limbs branch, and the first separate left and right joint.

    Legs branch at the pelvis, arms at the chest. Raise MotionError if they are not connected.
    """
    left, right = skeleton.ancestry(left_end), skeleton.ancestry(right_end)
    # Both chains begin at the root and are equal down to the joint where the limbs branch.
    shared = sum(1 for a, b in zip(left, right, strict=False) if a == b)
    if shared == 0:
        raise MotionError(f"the {limbs} belong to different roots, so no joint connects them")
    pelvis = left[shared - 1]
    # Some skeletons have several joints at the same place below it.
    for left_hip, right_hip in zip(left[shared:], right[shared:], strict=False):
        if np.linalg.norm(_measure_hip_axis(skeleton, pelvis, left_hip, right_hip)) > 0:
            return pelvis, left_hip, right_hip
    raise MotionError(
        f"left and right {limbs} coincide below {skeleton.names[pelvis]!r}, so the facing "
        "direction is unknown"
    )


def _measure_hip_axis(skeleton: Skeleton, pelvis: int, left_hip: int, right_hip: int) -> Floats:
    """Return the vector from the right hip to the left, in the pelvis's own frame, at rest."""

    def sum_offsets(joint: int) -> Floats:
        chain = skeleton.ancestry(joint)
        # Offsets below the pelvis only: at rest they are in the pelvis's own axes.
        return np.asarray(skeleton.offsets[chain[chain.index(pelvis) + 1 :]].sum(axis=0))

    return sum_offsets(left_hip) - sum_offsets(right_hip)


def _compute_turned_axis(
    skeleton: Skeleton, rotations: Floats, pelvis: int, left_hip: int, right_hip: int
) -> Floats:
    """Return the pelvis's axis to the left in the world, (frames, 3)."""
    rest = _measure_hip_axis(skeleton, pelvis, left_hip, right_hip)
    axis = np.zeros(3)
    # Coordinate axis nearest to the line of the hips, with its sign.
    axis[np.argmax(np.abs(rest))] = np.sign(rest[np.argmax(np.abs(rest))])
    # Local rotations from the pelvis up to the root transform the axis to the world.
    for joint in reversed(skeleton.ancestry(pelvis)):
        axis = rot.rotate(rotations[:, joint], axis)
    return axis


def find_facing(to_left: Floats, least: float | Floats) -> tuple[Floats, Floats]:
    """Return cosine and sine (frames, 1) of the turn about y that brings a left axis to +x.

    Frames in which the horizontal part of the axis is at most ``least`` long take the turn of the
    nearest other frame. If there is none, nothing is turned.
    """
    length = np.hypot(to_left[:, 0], to_left[:, 2])
    with_heading = np.flatnonzero(length > least)
    if len(with_heading) == 0:
        return np.ones((len(length), 1)), np.zeros((len(length), 1))
    # `searchsorted` among midpoints finds the nearest frame; at a tie the earlier one.
    middles = (with_heading[:-1] + with_heading[1:]) / 2
    nearest = with_heading[np.searchsorted(middles, np.arange(len(length)))]
    to_left, length = to_left[nearest], length[nearest]
    return (to_left[:, 0] / length)[:, None], (to_left[:, 2] / length)[:, None]
