"""Compute poses of a rig's nodes from the motion of its skeleton; see `kineme.recordings.rig`."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.recordings.kinematics import compute_world_rotations
from kineme.recordings.motion import Motion
from kineme.recordings.rig import Rig, make_rig
from kineme.recordings.skeleton import Skeleton


def get_rig(skeleton: Skeleton) -> Rig:
    """Return the rig of a skeleton, or one made of its joints without rest rotations."""
    return skeleton.rig or make_rig(skeleton.names, skeleton.parents, skeleton.offsets)


def pose_rig(motion: Motion, rig: Rig) -> tuple[Floats, Floats]:
    """Return translations (frames, joints, 3) and rotations (frames, joints, 4) of joints' nodes.

    The motion must have rotations, and the rig be that of its skeleton. Nodes above the joints are
    at rest, and end sites keep their rest rotation. All are in the parent's frame, in the units of
    the rig's file.
    """
    skeleton, above, back = motion.skeleton, rig.above, rot.conjugate(rig.turn)
    # Invert G = turn * W * axes to get W, the node's rotation in the axes of the file.
    turns = rot.multiply(back, compute_world_rotations(skeleton, motion.rotations))
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
    """Return the motion with joint axes that match the world axes in the rig's rest pose.

    Needed for formats without rest rotations. Positions stay; offsets become those at rest.
    """
    skeleton = motion.skeleton
    if skeleton.rig is None or motion.rotations is None:
        return motion
    places, turns = skeleton.rig.rest()
    offsets, inverse = np.array(places), rot.conjugate(turns)
    rotations = rot.multiply(compute_world_rotations(skeleton, motion.rotations), inverse)
    local = np.array(rotations)
    for joint, parent in enumerate(skeleton.parents):
        if parent >= 0:
            offsets[joint] -= places[parent]
            local[:, joint] = rot.multiply(rot.conjugate(rotations[:, parent]), rotations[:, joint])
    local[:, list(skeleton.end_sites)] = rot.IDENTITY
    # Rounding errors must not turn a bone of length 0 into a bone.
    offsets[np.abs(offsets) < 1e-12] = 0.0
    return replace(motion, skeleton=replace(skeleton, offsets=offsets), rotations=local)


def add_root(motion: Motion) -> Motion:
    """Return the motion with a joint ``root`` above its roots that stays at the origin."""
    skeleton, n = motion.skeleton, motion.n_frames
    name = "root"
    while name in skeleton.names:
        name += "_"
    rig = get_rig(skeleton)
    at = rig.above
    # Joints whose parent was above the body, or that had none, become children of the new one.
    parents = [p + 1 if p >= at else at if node >= at else p for node, p in enumerate(rig.parents)]
    turn = rig.turn if at == 0 else rot.multiply(rig.turn, rig.world[1][at - 1])
    rig = replace(
        rig,
        names=(*rig.names[:at], name, *rig.names[at:]),
        parents=(*parents[:at], at - 1, *parents[at:]),
        translations=np.insert(rig.translations, at, 0.0, axis=0),
        rotations=np.insert(rig.rotations, at, rot.IDENTITY, axis=0),
        scales=np.insert(rig.scales, at, 1.0, axis=0),
        # At rest its axes are those of the world.
        axes=np.concatenate([rot.conjugate(turn)[None], rig.axes]),
        numbers=(*rig.numbers[:at], -1, *rig.numbers[at:]) if rig.numbers else (),
        binds=None,
    )
    rooted = Skeleton(
        (name, *skeleton.names),
        (-1, *(parent + 1 for parent in skeleton.parents)),
        np.insert(skeleton.offsets, 0, 0.0, axis=0),
        frozenset(end + 1 for end in skeleton.end_sites),
        rig,
    )
    rotations = motion.rotations
    if rotations is not None:
        rotations = np.concatenate([np.broadcast_to(rot.IDENTITY, (n, 1, 4)), rotations], axis=1)
    positions = np.concatenate([np.zeros((n, 1, 3)), motion.positions], axis=1)
    return replace(motion, skeleton=rooted, positions=positions, rotations=rotations)
