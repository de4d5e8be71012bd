"""Mirroring: left and right exchanged, of motions and of pose features.

The sagittal mirror: x turns its sign, and what the left limbs did the right ones
do. A person who steps out with the left foot then steps out with the right.
Both forms agree where left and right are of the same lengths: the features of
the mirrored motion are the mirrored features. Mirroring twice changes nothing.

The skeleton stays as it is. With G the rotation of a joint in the world, M the
mirror, k the joint's partner and X the reflection of the partner's axes onto its
own, the rotation in the mirror is M G[k] X^-1, whichever way bones lie along
their axes.

Source: Krueger et al. 2017, section V.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme._util.checks import as_floats
from kineme._util.rotations import from_matrices, to_matrices
from kineme.errors import MotionError, ParameterError
from kineme.features.effectors import PARTS
from kineme.recordings import Motion, Skeleton
from kineme.recordings.kinematics import compute_local_translations, forward_kinematics
from kineme.recordings.motion import check_motion
from kineme.recordings.posing import get_rig

FLIP = np.array([-1.0, 1.0, 1.0])
HALF_TURN = np.array([0.0, 1.0, 0.0, 0.0])  # its opposite is that flip
FLIPS = np.array([[-1, -1, -1], [-1, 1, 1], [1, -1, 1], [1, 1, -1]], np.float64)
"""Reflections of axes onto those of the other side, as programs set up rigs; diagonals."""

SYMMETRIC = 0.1
"""Share of the size of a body by which its sides may differ at rest."""

UPRIGHT = 0.98
"""Cosine of the angle to an axis, 11 degrees, below which the body's plane lies along that axis."""

SLIDES = 0.01
"""Metres by which a joint leaves its mean place in its parent's frame and counts as sliding."""

FIT, TWIST, TINY = 4.0, 1e-3, 1e-9
"""Weights of the children's offsets against the usual rotation, and of a guess against these."""

EXCHANGED = [1, 0, 2, 4, 3]  # ankles and wrists in the order of PARTS

_SIDES = {"left": "right", "right": "left", "l": "r", "r": "l"}
# At the start of a word: "lhand", "hand_l", "WristLeft", "mixamorig:LeftHand".
_SIDE = re.compile(r"(?:(?<![a-zA-Z])|(?<=[a-z])(?=[A-Z]))((?i:left|right|l|r))")


def mirror(motion: Motion) -> Motion:
    """Return the motion in a mirror that stands in the plane x = 0, left and right exchanged.

    The skeleton and its rig stay as they are: rotations are what is mirrored. So a left limb that
    is longer than the right one stays longer, and joints are where the mirror shows them only as
    far as both sides have the same lengths.

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
    skeleton, partners = motion.skeleton, _find_partners(motion.skeleton)
    provenance = motion.provenance.noted("mirrored")
    positions = motion.positions[:, partners] * FLIP
    if motion.rotations is None:
        return replace(motion, positions=positions, provenance=provenance)
    # A reflection is the opposite of a rotation; of two in a product the signs cancel.
    flips = _reflect_axes(skeleton, motion.rotations, partners)
    around = np.array([HALF_TURN if p < 0 else flips[p] for p in skeleton.parents])
    rotations = rot.multiply(around, motion.rotations[:, partners])
    rotations = rot.multiply(rotations, rot.conjugate(flips))
    shifts = compute_local_translations(skeleton, motion.positions, motion.rotations)
    spread = np.linalg.norm(shifts - shifts.mean(axis=0), axis=2).max(axis=0)
    # Rigid bones keep their offset, and what they leave it by is mirrored. Of joints that slide,
    # and of those above the hips, the whole place is.
    shared = np.array(skeleton.offsets)
    shared[np.maximum(spread, spread[partners]) > SLIDES] = 0.0
    shared[skeleton.ancestry(skeleton.carrier)] = 0.0
    moved = shared - rot.rotate(around, shifts[:, partners] - shared[partners])
    roots = [joint for joint, parent in enumerate(skeleton.parents) if parent < 0]
    moved[:, roots] = positions[:, roots]
    return replace(
        motion,
        positions=forward_kinematics(skeleton, rotations, translations=moved),
        rotations=rotations,
        provenance=provenance,
    )


def _reflect_axes(skeleton: Skeleton, rotations: Floats, partners: list[int]) -> Floats:
    """Return how the axes of each joint's partner are reflected onto its own.

    Returns
    -------
    ndarray of shape (joints, 4)
        A rotation, whose opposite is the reflection X: with o the offset of a child of the
        partner, X o is that of the child's partner. X of the partner is the inverse.
    """
    places, turns = get_rig(skeleton).rest()
    frames, means = (
        to_matrices(turns),
        [to_matrices(rotations[:, j]).mean(0) for j in range(len(turns))],
    )
    image = _reflect_rest(skeleton, places, partners)
    found = np.empty((skeleton.n_joints, 3, 3))
    for joint, (other, parent) in enumerate(zip(partners, skeleton.parents, strict=True)):
        around = np.diag(FLIP) if parent < 0 else found[parent]
        if other < joint:
            found[joint] = found[other].T
            continue
        if joint in skeleton.end_sites:
            found[joint] = around
            continue
        children = list(skeleton.children[joint])
        here = skeleton.offsets[children]
        fit, size = here.T @ skeleton.offsets[[partners[c] for c in children]], np.sum(here**2)
        if image is not None:
            near = frames[joint].T @ image @ frames[other]
        else:
            # What the joint usually does tells how it is twisted about its bone.
            usual = FIT * fit / max(size, TINY) + means[joint].T @ around @ means[other]
            near = np.diag(max(FLIPS, key=lambda flip: float(flip @ np.diag(usual))))
        # The orthogonal matrix nearest to the fit of the children, then to that guess.
        u, _, v = np.linalg.svd(fit + max(TWIST * size, TINY) * near)
        found[joint] = u @ np.diag([1.0, 1.0, -np.linalg.det(u @ v)]) @ v
    flips = from_matrices(-found)
    for joint, other in enumerate(partners):
        if other > joint:  # so that the signs of a motion mirrored twice are its own
            flips[other] = -rot.conjugate(flips[joint])
    ends = sorted(skeleton.end_sites)
    flips[ends] = flips[[skeleton.parents[end] for end in ends]]
    return flips


def _reflect_rest(skeleton: Skeleton, places: Floats, partners: list[int]) -> Floats | None:
    """Return the reflection (3, 3) of a body at rest; None where the rest pose is that of no body.

    So it is in a BVH whose bones lie along their local axes.
    """
    apart = places - places[partners]
    # The direction that most of the lines from left to right have.
    normal = np.linalg.eigh(apart.T @ apart)[1][:, -1]
    if np.abs(normal).max() > UPRIGHT:
        # Bodies are modelled along an axis, up to differences between their sides.
        normal = np.eye(3)[np.abs(normal).argmax()]
    image = np.eye(3) - 2 * np.outer(normal, normal)
    from_hips = (places - places[skeleton.carrier])[list(skeleton.body)]
    mirrored = (places[partners] - places[skeleton.carrier])[list(skeleton.body)] @ image
    off = np.linalg.norm(mirrored - from_hips, axis=1).max()
    return image if off <= SYMMETRIC * np.ptp(from_hips, axis=0).max() else None


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


def _find_partners(skeleton: Skeleton) -> list[int]:
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
