"""Mirror motions and pose features: exchange left and right.

The mirror plane is x = 0: x changes its sign, and left and right limbs exchange their
movements. If both sides have the same bone lengths, the features of the mirrored motion
equal the mirrored features. Mirroring twice restores the motion.

The skeleton does not change. Let G be the rotation of a joint in the world, M the
mirror, k the partner of the joint on the other side, and X the reflection of the
partner's axes onto the joint's own. Then the mirrored rotation is M G[k] X^-1, for any
orientation of bones in their axes.

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
"""Diagonal of the mirror."""
HALF_TURN = np.array([0.0, 1.0, 0.0, 0.0])
"""Quaternion of the rotation whose negative is the mirror."""
FLIPS = np.array([[-1, -1, -1], [-1, 1, 1], [1, -1, 1], [1, 1, -1]], np.float64)
"""Diagonals of the reflections of axes onto those of the other side that rigs use."""

SYMMETRIC = 0.1
"""Largest difference of both sides at rest, as a share of the size of the body."""

UPRIGHT = 0.98
"""Cosine of the angle (11 degrees) between the normal of the body's plane and a coordinate axis
within which the axis is used as normal."""

SLIDES = 0.01
"""Metres by which a sliding joint leaves its mean position in its parent's frame."""

FIT, TWIST, TINY = 4.0, 1e-3, 1e-9
"""Weight of the children's offsets relative to the mean rotations, weight of the default
reflection relative to both, and smallest divisor."""

EXCHANGED = [1, 0, 2, 4, 3]
"""Indices into PARTS with left and right exchanged."""

_SIDES = {"left": "right", "right": "left", "l": "r", "r": "l"}
_SIDE = re.compile(r"(?:(?<![a-zA-Z])|(?<=[a-z])(?=[A-Z]))((?i:left|right|l|r))")
"""A side at the start of a word: "lhand", "hand_l", "WristLeft", "mixamorig:LeftHand"."""


def mirror(motion: Motion) -> Motion:
    """Mirror a motion in the plane x = 0, with left and right exchanged.

    The skeleton and its rig do not change; rotations are mirrored. So a left limb that is longer
    than the right one stays longer, and positions are exactly mirrored only if both sides have the
    same lengths.

    Raises
    ------
    MotionError
        No two joints are named as left and right, or a joint has no counterpart.

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
    # A reflection is the negative of a rotation; in a product of two the signs cancel.
    flips = _reflect_axes(skeleton, motion.rotations, partners)
    parent_flips = np.array([HALF_TURN if p < 0 else flips[p] for p in skeleton.parents])
    rotations = rot.multiply(parent_flips, motion.rotations[:, partners])
    rotations = rot.multiply(rotations, rot.conjugate(flips))
    shifts = compute_local_translations(skeleton, motion.positions, motion.rotations)
    deviations = np.linalg.norm(shifts - shifts.mean(axis=0), axis=2).max(axis=0)
    # Rigid bones keep their offset, and only deviations from it are mirrored. For sliding joints
    # and joints above the hips, the whole translation is mirrored.
    kept_offsets = np.array(skeleton.offsets)
    kept_offsets[np.maximum(deviations, deviations[partners]) > SLIDES] = 0.0
    kept_offsets[skeleton.ancestry(skeleton.carrier)] = 0.0
    moved = kept_offsets - rot.rotate(parent_flips, shifts[:, partners] - kept_offsets[partners])
    roots = [joint for joint, parent in enumerate(skeleton.parents) if parent < 0]
    moved[:, roots] = positions[:, roots]
    return replace(
        motion,
        positions=forward_kinematics(skeleton, rotations, translations=moved),
        rotations=rotations,
        provenance=provenance,
    )


def _reflect_axes(skeleton: Skeleton, rotations: Floats, partners: list[int]) -> Floats:
    """Return rotations (joints, 4) whose negatives reflect the axes of each partner onto its own.

    If o is the offset of a child of the partner, the reflection X o is the offset of the child's
    partner. X of the partner is the inverse.
    """
    places, turns = get_rig(skeleton).rest()
    frames = to_matrices(turns)
    means = [to_matrices(rotations[:, joint]).mean(0) for joint in range(len(turns))]
    image = _reflect_rest(skeleton, places, partners)
    reflections = np.empty((skeleton.n_joints, 3, 3))
    for joint, (partner, parent) in enumerate(zip(partners, skeleton.parents, strict=True)):
        parent_reflection = np.diag(FLIP) if parent < 0 else reflections[parent]
        if partner < joint:
            reflections[joint] = reflections[partner].T
            continue
        if joint in skeleton.end_sites:
            reflections[joint] = parent_reflection
            continue
        children = list(skeleton.children[joint])
        own_offsets = skeleton.offsets[children]
        fit = own_offsets.T @ skeleton.offsets[[partners[child] for child in children]]
        size = np.sum(own_offsets**2)
        if image is not None:
            default = frames[joint].T @ image @ frames[partner]
        else:
            # Mean rotations determine the twist about the bone, which offsets do not.
            estimate = (
                FIT * fit / max(size, TINY) + means[joint].T @ parent_reflection @ means[partner]
            )
            default = np.diag(max(FLIPS, key=lambda flip: float(flip @ np.diag(estimate))))
        # Nearest reflection to the fit of the children, or to the default if that is ambiguous.
        u, _, v = np.linalg.svd(fit + max(TWIST * size, TINY) * default)
        reflections[joint] = u @ np.diag([1.0, 1.0, -np.linalg.det(u @ v)]) @ v
    flips = from_matrices(-reflections)
    for joint, partner in enumerate(partners):
        if partner > joint:  # exact inverse, so that mirroring twice restores the signs
            flips[partner] = -rot.conjugate(flips[joint])
    ends = sorted(skeleton.end_sites)
    flips[ends] = flips[[skeleton.parents[end] for end in ends]]
    return flips


def _reflect_rest(skeleton: Skeleton, places: Floats, partners: list[int]) -> Floats | None:
    """Return the reflection (3, 3) of a body at rest; None if the rest pose is not symmetric.

    This happens in BVH files whose bones lie along their local axes.
    """
    differences = places - places[partners]
    # Normal of the mirror plane: the principal direction of the lines from left to right.
    normal = np.linalg.eigh(differences.T @ differences)[1][:, -1]
    if np.abs(normal).max() > UPRIGHT:
        # Bodies are modelled along an axis, apart from small differences of their sides.
        normal = np.eye(3)[np.abs(normal).argmax()]
    image = np.eye(3) - 2 * np.outer(normal, normal)
    from_hips = (places - places[skeleton.carrier])[list(skeleton.body)]
    mirrored = (places[partners] - places[skeleton.carrier])[list(skeleton.body)] @ image
    off = np.linalg.norm(mirrored - from_hips, axis=1).max()
    return image if off <= SYMMETRIC * np.ptp(from_hips, axis=0).max() else None


def mirror_features(features: ArrayLike) -> Floats:
    """Mirror pose features, stacked or not.

    Parameters
    ----------
    features : array_like of shape (frames, 15 * blocks)
        As returned by `pose_features` and `stack`.

    Raises
    ------
    ParameterError
        They are not pose features.

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
    """Return the counterpart of each joint on the other side; itself on the midline."""
    names = skeleton.names
    index = {name: joint for joint, name in enumerate(names)}
    partners = [
        next((index[partner] for partner in _swap_side(name) if partner in index), joint)
        for joint, name in enumerate(names)
    ]
    if partners == list(range(len(names))):
        raise MotionError(f"no joint names form a pair of left and right: {', '.join(names)}")
    for joint, parent in enumerate(skeleton.parents):
        partner = partners[joint]
        beside = skeleton.parents[partner]
        # Parents of partners must be partners, too, or mirrored limbs would be torn apart.
        if partners[partner] != joint or beside != (partners[parent] if parent >= 0 else -1):
            raise MotionError(
                f"joint {names[joint]!r} has no counterpart on the other side of the body"
            )
    return partners


def _swap_side(name: str) -> Iterator[str]:
    """Yield the name with one word for a side replaced by the other side, for each such word."""
    # A name may have several matches, as `l_hand_r`.
    for match in _SIDE.finditer(name):
        side = match[1]
        other = _SIDES[side.lower()]
        if side.isupper():
            other = other.upper()
        elif side[0].isupper():
            other = other.capitalize()
        yield name[: match.start()] + other + name[match.end() :]
