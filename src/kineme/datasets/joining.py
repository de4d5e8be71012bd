"""Motions of one person joined end to end into one: placed after each other, and blended.

At a join the second motion is turned about the vertical and moved along the floor to where the
first one ended. What differs then is made up on both sides. Over the join every rotation goes from
the one to the other along the sphere while both movements go on: no frame is lost, and nobody
stops.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.errors import ParameterError
from kineme.recordings import Motion
from kineme.recordings.kinematics import local_translations
from kineme.recordings.operations import move, turn


def join_recordings(
    motions: Sequence[Motion], join: float = 0.4
) -> tuple[Motion, NDArray[np.int64], list[int]]:
    """One motion of all, the first frame of each and the end, and half of each join in frames.

    Motions need one skeleton, one frame rate, and rotations. A join is blended over ``join``
    seconds, at most a third of the shorter motion.
    """
    check_fit(motions)
    fps = motions[0].fps
    placed = [motions[0]]
    for motion in motions[1:]:
        placed.append(_placed_after(placed[-1], motion))
    rotations = [np.array(motion.rotations) for motion in placed]
    translations = [
        local_translations(motion.skeleton, motion.positions, motion.rotations) for motion in placed
    ]
    halves = []
    for before, after in pairwise(range(len(placed))):
        shorter = min(len(rotations[before]), len(rotations[after]))
        # At most a third of the shorter motion in all, so that joins do not meet.
        half = min(round(join * fps / 2), shorter // 6)
        _blend(rotations[before], rotations[after], translations[before], translations[after], half)
        halves.append(half)
    motion = Motion.from_rotations(
        placed[0].skeleton,
        np.concatenate(rotations),
        fps,
        translations=np.concatenate(translations),
    )
    return motion, np.cumsum([0, *map(len, rotations)]), halves


def check_fit(motions: Sequence[Motion]) -> None:
    """ParameterError where the skeletons, frame rates or rotations of motions do not fit."""
    first = motions[0]
    for motion in motions:
        same = motion.skeleton.names == first.skeleton.names and np.allclose(
            motion.skeleton.offsets, first.skeleton.offsets, atol=1e-3
        )
        if not same or motion.fps != first.fps or motion.rotations is None:
            raise ParameterError(
                "exercises are joined if they have one skeleton, one frame rate and rotations; "
                f"{motion.provenance.path or 'one of them'} does not fit the first"
            )


def _placed_after(before: Motion, motion: Motion) -> Motion:
    """Return the motion turned and moved so that its root goes on where the one before ends."""
    # Rotation of the root where the first motion ends and the second begins.
    ended, begins = np.array(before.rotations)[-1, 0], np.array(motion.rotations)[0, 0]
    q = rot.multiply(ended, rot.conjugate(begins))
    # The part of the rotation about y: twice the angle between w and y.
    turned = turn(motion, 2 * float(np.arctan2(q[2], q[0])))
    step = before.positions[-1, 0] - turned.positions[0, 0]
    # On the floor only: heights are left to the blend.
    return move(turned, step * [1, 0, 1])


def _blend(a: Floats, b: Floats, a_shift: Floats, b_shift: Floats, half: int) -> None:
    """Bends the end of a and the start of b towards each other, in place."""
    from scipy.spatial.transform import Rotation

    if half == 0:
        return
    x = (np.arange(2 * half) + 0.5) / (2 * half)
    share = (x * x * (3 - 2 * x))[:, None, None]
    # A smooth step; the second motion starts bent back by what is left of it.
    share[half:] -= 1
    # The rotation from the end of the first motion to the start of the second.
    vectors = Rotation.from_quat(np.roll(rot.multiply(rot.conjugate(a[-1]), b[0]), -1, -1))
    angles = share * vectors.as_rotvec()
    bends = np.roll(Rotation.from_rotvec(angles.reshape(-1, 3)).as_quat(), 1, -1)
    bends = bends.reshape(*angles.shape[:2], 4)
    # Translations are made up in the same way, in a line.
    shift = share * (b_shift[0] - a_shift[-1])
    a[-half:] = rot.multiply(a[-half:], bends[:half])
    b[:half] = rot.multiply(b[:half], bends[half:])
    a_shift[-half:] += shift[:half]
    # The same share as for the rotations.
    b_shift[:half] += shift[half:]
