"""Compute joint positions from rotations, and back.

The conventions are those of `kineme.recordings.skeleton`::

    G[j] = G[parent] * R[j]
    p[j] = p[parent] + G[parent] @ offset[j]

Loop over the joints once, parents first, with all frames in each step.
Quaternions are faster here than 3 x 3 matrices.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.errors import MotionError
from kineme.recordings.skeleton import Skeleton


def forward_kinematics(
    skeleton: Skeleton,
    rotations: ArrayLike,
    root_positions: ArrayLike | None = None,
    *,
    translations: ArrayLike | None = None,
) -> Floats:
    """Return joint positions (frames, joints, 3) from local rotations.

    ``rotations`` (frames, joints, 4) are unit quaternions (w, x, y, z), local to the parent; those
    of end sites are ignored. ``root_positions`` (frames, 3) are the root's offset by default.
    ``translations`` (frames, joints, 3) replace the skeleton's offsets, for joints that also
    translate (for a root, its position).

    Examples
    --------
    >>> arm = Skeleton(("shoulder", "hand"), (-1, 0), [[0, 1.4, 0], [0.6, 0, 0]])
    >>> forward_kinematics(arm, [[[1, 0, 0, 0], [1, 0, 0, 0]]]).tolist()
    [[[0.0, 1.4, 0.0], [0.6, 1.4, 0.0]]]
    """
    # One contiguous row per joint and component: the loop below is then bound
    # by arithmetic and not by memory.
    local = np.ascontiguousarray(np.asarray(rotations, float).transpose(1, 2, 0))
    n = local.shape[2]
    if translations is not None:
        shift = np.ascontiguousarray(np.asarray(translations, float).transpose(1, 2, 0))
    else:
        # Frames last: each component is one contiguous row.
        shift = np.broadcast_to(skeleton.offsets[:, :, None], (skeleton.n_joints, 3, n)).copy()
    if root_positions is not None:
        # Roots have a position instead of an offset.
        shift[[p < 0 for p in skeleton.parents]] = np.asarray(root_positions, float).T
    positions = np.empty((skeleton.n_joints, 3, n))
    world: list[Floats] = []
    for j, parent in enumerate(skeleton.parents):
        if parent < 0:
            positions[j] = shift[j]
            world.append(local[j].T)
            continue
        bone = skeleton.offsets[j] if translations is None else shift[j].T
        positions[j] = positions[parent] + rot.rotate(world[parent], bone).T
        leaf = j in skeleton.end_sites
        # An end site has no rotation of its own: use its parent's.
        world.append(world[parent] if leaf else rot.multiply(world[parent], local[j].T))
    return positions.transpose(2, 0, 1)


def place_at_rest(skeleton: Skeleton) -> Floats:
    """Return the joint positions (joints, 3) without rotations, the root at its offset."""
    standing = np.broadcast_to(rot.IDENTITY, (1, skeleton.n_joints, 4))
    (places,) = forward_kinematics(skeleton, standing)
    return np.asarray(places)


def compute_world_rotations(skeleton: Skeleton, rotations: ArrayLike | None) -> Floats:
    """Return the world rotation of each joint (frames, joints, 4); end sites take their parent's.

    ``rotations`` are local to the parent; raise MotionError if there are none.
    """
    if rotations is None:
        raise MotionError("this needs rotations, but the motion has positions only")
    world = np.array(rotations, np.float64)
    for j, parent in enumerate(skeleton.parents):
        if parent >= 0:
            world[:, j] = rot.multiply(world[:, parent], world[:, j])
    return world


def compute_local_translations(
    skeleton: Skeleton, positions: Floats, rotations: ArrayLike | None
) -> Floats:
    """Return vectors from parent to joint in the parent's axes (frames, joints, 3).

    They equal the skeleton's offsets if bones are rigid; for a root it is the position.
    ``rotations`` are local to the parent; raise MotionError if there are none.
    """
    world = compute_world_rotations(skeleton, rotations)
    local = np.array(positions)
    for j, parent in enumerate(skeleton.parents):
        if parent >= 0:
            step = positions[:, j] - positions[:, parent]
            # The inverse of the parent's rotation brings the step into the parent's frame.
            local[:, j] = rot.rotate(rot.conjugate(world[:, parent]), step)
    return local
