"""Poses of the nodes of a rig, from the motion of its skeleton; see `kineme.recordings.rig`."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.recordings.kinematics import world_rotations
from kineme.recordings.motion import Motion
from kineme.recordings.rig import Rig, make_rig
from kineme.recordings.skeleton import Skeleton


def rig_of(skeleton: Skeleton) -> Rig:
    """Return the rig of a skeleton; one of its joints, without rotations, where it has none."""
    return skeleton.rig or make_rig(skeleton.names, skeleton.parents, skeleton.offsets)


def pose_rig(motion: Motion, rig: Rig) -> tuple[Floats, Floats]:
    """Return the translations and rotations of the joints' nodes in a motion.

    Parameters
    ----------
    motion : Motion
        One with rotations.
    rig : Rig
        That of its skeleton. Nodes above the joints are at rest.

    Returns
    -------
    translations, rotations : ndarray of shape (frames, joints, 3), (frames, joints, 4)
        In the parent's frame, in the units of the rig's file. Joints without a rotation of their
        own (end sites) are turned as at rest.
    """
    skeleton, above, back = motion.skeleton, rig.above, rot.conjugate(rig.turn)
    turns = rot.multiply(back, world_rotations(skeleton, motion.rotations))
    turns = rot.multiply(turns, rot.conjugate(rig.axes))
    places = rot.rotate(back, motion.positions) / rig.unit
    rest_places, rest_turns, sizes = rig.world
    translations, rotations = np.empty(places.shape), np.empty(turns.shape)
    for joint in range(skeleton.n_joints):
        place, turn, size = rig.parent_world(above + joint, rest_places, rest_turns, sizes)
        # A parent that is a joint moves; one above the joints is at rest.
        if (parent := rig.parents[above + joint] - above) >= 0:
            place, turn = places[:, parent], turns[:, parent]
        inverse = rot.conjugate(turn)
        translations[:, joint] = rot.rotate(inverse, places[:, joint] - place) / size
        rotations[:, joint] = rot.multiply(inverse, turns[:, joint])
    for end in skeleton.end_sites:
        rotations[:, end] = rig.rotations[above + end]
    return translations, rotations


def align_to_rest(motion: Motion) -> Motion:
    """Return the motion with the axes of joints along those of the world in the rig's rest pose.

    Formats without rotations at rest need it. Positions stay; offsets become those at rest.
    """
    skeleton = motion.skeleton
    if skeleton.rig is None or motion.rotations is None:
        return motion
    places, turns = skeleton.rig.rest()
    offsets, inverse = np.array(places), rot.conjugate(turns)
    rotations = rot.multiply(world_rotations(skeleton, motion.rotations), inverse)
    local = np.array(rotations)
    for joint, parent in enumerate(skeleton.parents):
        if parent >= 0:
            offsets[joint] -= places[parent]
            local[:, joint] = rot.multiply(rot.conjugate(rotations[:, parent]), rotations[:, joint])
    local[:, list(skeleton.end_sites)] = rot.IDENTITY
    # What rounding leaves of a bone of no length would be a bone.
    offsets[np.abs(offsets) < 1e-12] = 0.0
    return replace(motion, skeleton=replace(skeleton, offsets=offsets), rotations=local)
