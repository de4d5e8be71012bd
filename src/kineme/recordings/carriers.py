"""Find which joints carry a body, and turn and move it.

Many rigs have a bone above the hips that stays at the origin. It stands still in the world while
the body moves, so it is left alone: the topmost joints below it are turned and moved instead, in
world axes, as roots are on other rigs. A bone above the hips that moves carries the body itself.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats, Ints, Masks
from kineme.recordings.kinematics import compute_local_translations, compute_world_rotations
from kineme.recordings.motion import Motion
from kineme.recordings.skeleton import Skeleton

STILL = 1e-3
"""Largest change of a joint that stands still, in metres, and about that in radians."""


def find_still_joints(*motions: Motion) -> Masks:
    """Return a mask of the joints outside the body that never move, nor any joint above them."""
    skeleton = motions[0].skeleton
    still = np.zeros(skeleton.n_joints, bool)
    for joint in sorted({*range(skeleton.n_joints)} - {*skeleton.body}):
        parent = skeleton.parents[joint]
        moves = any(np.ptp(m.positions[:, joint], axis=0).max() > STILL for m in motions)
        # Rotations are compared by the product, since q and -q are one rotation.
        curves = [m.rotations[:, joint] for m in motions if m.rotations is not None]
        moves |= any(np.abs(curve @ curves[0][0]).min() < 1 - STILL**2 for curve in curves)
        still[joint] = not moves and (parent < 0 or still[parent])
    return still


def find_carriers(skeleton: Skeleton, still: Masks) -> Masks:
    """Return a mask of the topmost joints that do not stand still."""
    parents = np.array(skeleton.parents)
    return np.asarray(~still & ((parents < 0) | still[parents]))


def to_world_axes(motion: Motion, still: Masks) -> tuple[Floats, Floats]:
    """Return rotations and translations of joints: in the world down to the carriers.

    Those of all joints below the carriers are relative to their parents.
    """
    skeleton, outer = motion.skeleton, _find_outer(motion.skeleton, still)
    translations = compute_local_translations(skeleton, motion.positions, motion.rotations)
    translations[:, outer] = motion.positions[:, outer]
    rotations = np.array(motion.rotations)
    if len(outer):
        rotations[:, outer] = compute_world_rotations(skeleton, rotations)[:, outer]
    return rotations, translations


def to_parent_axes(
    skeleton: Skeleton, rotations: Floats, translations: Floats, still: Masks
) -> tuple[Floats, Floats]:
    """Return rotations and translations relative to the parents; reverses `to_world_axes`."""
    outer = _find_outer(skeleton, still)
    above = np.array(skeleton.parents)[outer]
    # Parents of these joints stand still, so they are in world axes as well.
    back = rot.conjugate(rotations[:, above])
    steps = translations[:, outer] - translations[:, above]
    rotations, translations = rotations.copy(), translations.copy()
    rotations[:, outer] = rot.multiply(back, rotations[:, outer])
    translations[:, outer] = rot.rotate(back, steps)
    return rotations, translations


def place_frames(
    motion: Motion, turns: Floats, centers: Floats, targets: Floats, still: Masks | None = None
) -> Motion:
    """Turn each frame about the vertical through its center, and move the center to its target.

    ``turns`` (frames,) are in radians, ``centers`` and ``targets`` (frames, 3) or (3,) in metres.
    Joints that stand ``still`` stay, by default those that do so in this motion.
    """
    still = find_still_joints(motion) if still is None else still
    quaternions = rot.rotate_about_y(turns)[:, None]
    centers, targets = (np.broadcast_to(each, (motion.n_frames, 3)) for each in (centers, targets))
    positions = rot.rotate(quaternions, motion.positions - centers[:, None]) + targets[:, None]
    positions[:, still] = motion.positions[:, still]
    rotations = motion.rotations
    if rotations is not None:
        rotations, translations = to_world_axes(motion, still)
        # Carriers only: all joints below are relative to their parents.
        carriers = find_carriers(motion.skeleton, still)
        rotations[:, carriers] = rot.multiply(quaternions, rotations[:, carriers])
        rotations, _ = to_parent_axes(motion.skeleton, rotations, translations, still)
    return replace(motion, positions=positions, rotations=rotations)


def _find_outer(skeleton: Skeleton, still: Masks) -> Ints:
    """Return the joints whose parent stands still."""
    parents = np.array(skeleton.parents)
    return np.flatnonzero((parents >= 0) & still[parents])
