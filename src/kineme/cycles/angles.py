"""Angles of joints in degrees, from where points are and from how joints are turned.

From positions of joints an angle is the one between two limbs, by which a straight limb is bent: a
knee is 0 degrees when thigh and shank are in line, whatever plane it bends in. Markers on the skin
are beside the joints, so that a straight leg has an angle between its limbs, too. There a knee is
bent about its axis, and below 0 degrees if it is bent the other way. From rotations it is how far
a joint is turned from the pose of rest, as the skeleton has it.
"""

from __future__ import annotations

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats

MOVES = 0.1
"""Radians by which a hinge deviates from its mean, at least, for its axis to be seen."""


def bend(before: Floats, joint: Floats, after: Floats) -> Floats:
    """By how much a chain of three points is bent at the middle one: 0 where they are in line.

    Parameters
    ----------
    before, joint, after : (frames, 3) array

    Returns
    -------
    (frames,) array
        Degrees, 0 to 180: 180 less the angle between the two limbs.

    Examples
    --------
    >>> bend(np.array([[0, 2.0, 0]]), np.array([[0, 1.0, 0]]), np.array([[0, 1.0, 1]])).round(6)
    array([90.])
    """
    return measure_angle(joint - before, after - joint)


def measure_angle(first: Floats, second: Floats) -> Floats:
    """Return the angle between vectors, degrees from 0 to 180; nan where one has no length.

    Parameters
    ----------
    first, second : (frames, 3) array

    Returns
    -------
    (frames,) array

    Examples
    --------
    >>> measure_angle(np.array([[0, 1.0, 0]]), np.array([[0, 0, 2.0]])).round(6)
    array([90.])
    """
    # The arctangent is exact near 0 and 180 degrees, where an arccosine loses precision.
    cross = np.linalg.norm(np.cross(first, second), axis=-1)
    dot = (first * second).sum(axis=-1)
    angle = np.degrees(np.arctan2(cross, dot))
    # `arctan2(0, 0)` is 0, but a vector without length has no direction.
    return np.where((cross == 0) & (dot == 0), np.nan, angle)


def measure_turn(axis: Floats, first: Floats, second: Floats) -> Floats:
    """By how much a vector is turned about an axis to lie in the direction of another.

    Degrees, -180 to 180, right-handed. What the vectors (frames, 3) have in the direction of the
    axis does not count.
    """
    flat = [remove_along(vectors, axis) for vectors in (first, second)]
    # The triple product with the unit axis: the sine with its sign.
    sine = (np.cross(flat[0], flat[1]) * normalize(axis)).sum(axis=-1)
    cosine = (flat[0] * flat[1]).sum(axis=-1)
    return np.asarray(np.degrees(np.arctan2(sine, cosine)))


def hinge_axis(upper: Floats, joint: Floats, lower: Floats, beside: Floats) -> Floats | None:
    """Return the axis (frames, 3) of a hinge such as a knee, which is fixed to the upper limb.

    The lower limb moves in a plane, as seen from the upper one. The axis is what is most at right
    angles to it in all frames, so markers need not be at the centre of the joint. ``beside`` is a
    point that tells how the upper limb is turned, such as a marker of the thigh. The axis has
    either sign; None where the hinge hardly moves.
    """
    # Directions of thigh and shank.
    along, limb = normalize(joint - upper), normalize(lower - joint)
    aside = normalize(remove_along(beside - joint, along))
    # (frames, 3, 3): rows are the axes of the upper limb; the shank is then given in them.
    frame = np.stack([aside, np.cross(along, aside), along], axis=1)
    seen = np.einsum("fij,fj->fi", frame, limb)
    # Eigenvalues ascend: the axis has least of the shank in it, the second tells how it swings.
    spreads, axes = np.linalg.eigh(seen.T @ seen / len(seen))
    if spreads[1] < MOVES**2:
        return None
    # Back to the coordinates of the recording.
    return np.asarray(np.einsum("fij,i->fj", frame, axes[:, 0]))


def remove_along(vectors: Floats, direction: Floats) -> Floats:
    """Return vectors without what they have in a direction."""
    direction = normalize(direction)
    return np.asarray(vectors - (vectors * direction).sum(axis=-1, keepdims=True) * direction)


def normalize(vectors: Floats) -> Floats:
    """Return vectors of length 1; those without a length stay 0."""
    # The floor avoids a division by 0; a vector of length 0 stays 0.
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12))


def cardan(rotations: Floats) -> Floats:
    """Angles (x, z, y) whose product Rx Rz Ry is the rotation, degrees.

    The first turns about the axis from side to side, as flexion does in a skeleton whose pose of
    rest faces +z; the second about the axis ahead; the third about the upright one.

    Parameters
    ----------
    rotations : (frames, 4) array
        Unit quaternions (w, x, y, z).

    Returns
    -------
    (frames, 3) array

    Examples
    --------
    >>> turned = rot.from_euler(np.radians([[40.0, 10.0, -5.0]]), "xzy")
    >>> cardan(turned).round(6)
    array([[40., 10., -5.]])
    """
    # Rx Rz Ry is Rz Ry Rx with the axes named anew: x for z, z for y, y for x.
    w, x, y, z = rot.components(rotations)
    renamed = rot.join(w, y, z, x)
    return np.degrees(rot.to_euler_zyx(renamed))
