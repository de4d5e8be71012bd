"""Mirroring: left and right exchanged, of motions and of pose features.

The sagittal mirror: x turns its sign, and what the left limbs did the right ones
do. A person who steps out with the left foot then steps out with the right.
Both forms agree: the features of the mirrored motion are the mirrored features.
Mirroring twice changes nothing.

Source: Krueger et al. 2017, section V.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Floats
from kineme._util.checks import as_floats
from kineme.errors import MotionError, ParameterError
from kineme.features.effectors import PARTS
from kineme.recordings import Motion, Skeleton
from kineme.recordings.motion import check_motion

FLIP = np.array([-1.0, 1.0, 1.0])
FLIP_QUATERNION = np.array([1.0, 1.0, -1.0, -1.0])  # conjugation by that flip
EXCHANGED = [1, 0, 2, 4, 3]  # ankles and wrists in the order of PARTS

_SIDES = {"left": "right", "right": "left", "l": "r", "r": "l"}
# At the start of a word: "lhand", "hand_l", "WristLeft", "mixamorig:LeftHand".
_SIDE = re.compile(r"(?:(?<![a-zA-Z])|(?<=[a-z])(?=[A-Z]))((?i:left|right|l|r))")


def mirror(motion: Motion) -> Motion:
    """Return the motion in a mirror that stands in the plane x = 0, left and right exchanged.

    The skeleton keeps its names and is mirrored, too: each left limb gets the
    lengths of the right one.

    Raises
    ------
    MotionError
        No joint has a counterpart on the other side by name, or a limb has no equal there.

    Examples
    --------
    >>> import kineme
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> bool(kineme.mirror(motion).positions[0, 0, 0] == -motion.positions[0, 0, 0])
    True
    """
    check_motion(motion, "mirror")
    partners = _partners(motion.skeleton)
    skeleton = replace(motion.skeleton, offsets=motion.skeleton.offsets[partners] * FLIP)
    rotations = motion.rotations
    return replace(
        motion,
        skeleton=skeleton,
        positions=motion.positions[:, partners] * FLIP,
        # The rotation conjugated by the flip: y and z of the axis change their sign.
        rotations=None if rotations is None else rotations[:, partners] * FLIP_QUATERNION,
        provenance=motion.provenance.noted("mirrored"),
    )


def mirror_features(features: ArrayLike) -> Floats:
    """Pose features of the mirrored motion, stacked or not.

    Parameters
    ----------
    features : array_like of shape (frames, 15 * blocks)
        As `pose_features` and `stack` give them.

    Raises
    ------
    ParameterError
        No such features.

    Examples
    --------
    >>> import kineme
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> features = kineme.pose_features(motion)
    >>> mirrored = kineme.mirror_features(features)
    >>> bool((kineme.mirror_features(mirrored) == features).all())
    True
    """
    values = as_floats(features, "features")
    block = 3 * len(PARTS)
    if values.ndim != 2 or values.shape[1] == 0 or values.shape[1] % block:
        raise ParameterError(
            f"only pose features have a mirror image: frames x a multiple of {block}, "
            f"not {values.shape}"
        )
    # Frames, stacked blocks, parts, axes.
    parts = values.reshape(len(values), -1, len(PARTS), 3)
    mirrored: Floats = parts[:, :, EXCHANGED] * FLIP
    return mirrored.reshape(values.shape)


def _partners(skeleton: Skeleton) -> list[int]:
    """Return for each joint that of the other side; itself on the midline."""
    names = skeleton.names
    index = {name: joint for joint, name in enumerate(names)}
    partners = [
        next((index[other] for other in _swap_side(name) if other in index), joint)
        for joint, name in enumerate(names)
    ]
    if partners == list(range(len(names))):
        raise MotionError(
            f"no two joints are named as left and right of each other: {', '.join(names)}"
        )
    for joint, parent in enumerate(skeleton.parents):
        other = partners[joint]
        beside = skeleton.parents[other]
        # Both sides must hang on partners, or the mirrored limbs would tear.
        if partners[other] != joint or beside != (partners[parent] if parent >= 0 else -1):
            raise MotionError(
                f"joint {names[joint]!r} has no counterpart on the other side of the body"
            )
    return partners


def _swap_side(name: str) -> Iterator[str]:
    """Yield the name with one word for a side turned into the other, each way to do so."""
    # A name may hold several letters that look like a side, as in `l_hand_r`.
    for found in _SIDE.finditer(name):
        side = found[1]
        other = _SIDES[side.lower()]
        if side.isupper():
            other = other.upper()
        elif side[0].isupper():
            other = other.capitalize()
        yield name[: found.start()] + other + name[found.end() :]
