"""Operations on arrays of unit quaternions ``(w, x, y, z)``.

scipy's ``Rotation`` is several times slower on the arrays of a recording (one quaternion per
joint and frame); tests compare these functions with it. The last axis of all arrays holds the
components; arrays that are contiguous per component are fastest.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from kineme._util.arrays import Floats

IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])


def multiply(a: Floats, b: Floats) -> Floats:
    """Return the Hamilton product: rotation ``b`` followed by ``a``."""
    aw, ax, ay, az = split_components(a)
    bw, bx, by, bz = split_components(b)
    return join_components(
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


def conjugate(q: Floats) -> Floats:
    """Return the inverse rotations."""
    inverse: Floats = q * np.array([1.0, -1.0, -1.0, -1.0])
    return inverse


def rotate(q: Floats, v: Floats) -> Floats:
    """Rotate vectors ``v`` by ``q``: v + 2 u x (u x v + w v), with q = (w, u)."""
    # Twice the cross product of the vector part with v, as in the docstring.
    w, x, y, z = split_components(q)
    vx, vy, vz = split_components(v)
    tx = 2 * (y * vz - z * vy)
    ty = 2 * (z * vx - x * vz)
    tz = 2 * (x * vy - y * vx)
    return join_components(
        vx + w * tx + y * tz - z * ty,
        vy + w * ty + z * tx - x * tz,
        vz + w * tz + x * ty - y * tx,
    )


def from_euler(angles: Floats, axes: str) -> Floats:
    """Return the product of rotations about ``axes``, the last one applied first.

    ``axes`` are any of the letters x, y and z, ``angles`` (frames, len(axes)) are in radians.
    ``from_euler(angles, "zyx")`` is Rz(angles[:, 0]) Ry(angles[:, 1]) Rx(angles[:, 2]).
    """
    half = np.asarray(angles, dtype=np.float64).T / 2
    product = np.zeros((4, half.shape[1]))
    product[0] = 1.0
    for number, (angle, axis) in enumerate(zip(half, axes, strict=True)):
        cos, sin = np.cos(angle), np.sin(angle)
        # Place of the axis in the quaternion, after w.
        i = 1 + "xyz".index(axis)
        if number == 0:
            product[0], product[i] = cos, sin
            continue
        # The two other axes, in cyclic order.
        j, k = 1 + i % 3, 1 + (i + 1) % 3
        w, x, y, z = product[[0, i, j, k]]  # the axis first, as x
        product[0], product[i] = w * cos - x * sin, w * sin + x * cos
        product[j], product[k] = y * cos + z * sin, z * cos - y * sin
    return product.T


def to_euler(q: Floats, axes: str) -> Floats:
    """Return angles in radians (..., len(axes)), the inverse of `from_euler` for distinct axes.

    Each angle is computed from the rotation that the previous ones leave. So the product is exact
    even at 90 degrees about the second of three axes, where the others are not unique. With fewer
    axes, rotations about the missing ones are lost.
    """
    # A missing axis is put second, since the angle about the second one is at most 90 degrees.
    order = axes[:1] + "".join(axis for axis in "xyz" if axis not in axes) + axes[1:]
    last, middle, first = ("xyz".index(axis) for axis in order[::-1])
    # Rename the axes, so that the product is Rz Ry Rx. A left-handed order reverses all rotations.
    sign = 1.0 if (middle - last) % 3 == 1 else -1.0
    w, *vector = split_components(q)
    x, y, z = (sign * vector[axis] for axis in (last, middle, first))
    cz_cy, sz_cy = 1 - 2 * (y * y + z * z), 2 * (x * y + w * z)
    about_z = np.arctan2(sz_cy, cz_cy)
    # After removing the rotation about z, these entries contain only cos y and sin y.
    sin, cos = np.sin(about_z), np.cos(about_z)
    about_y = np.arctan2(2 * (w * y - x * z), cos * cz_cy + sin * sz_cy)
    about_x = np.arctan2(
        sin * 2 * (x * z + w * y) - cos * 2 * (y * z - w * x),
        cos * (1 - 2 * (x * x + z * z)) - sin * 2 * (x * y - w * z),
    )
    angles = sign * join_components(about_z, about_y, about_x)
    return angles[..., [order.index(axis) for axis in axes]]


def unwrap_euler(angles: Floats) -> Floats:
    """Return angles (frames, ..., n) of the same rotations, each nearest to the frame before.

    Angles are in radians, about distinct axes, in the order of their product.
    """
    if angles.shape[-1] == 3:
        # (a, b, c) and (a + pi, pi - b, c + pi) are the same rotation. The step between two frames
        # is as long if both are exchanged, so only changes from one to the other are decided.
        other = np.array([1.0, -1.0, 1.0]) * angles + np.pi
        stay, change = (
            (((each[1:] - angles[:-1] + np.pi) % (2 * np.pi) - np.pi) ** 2).sum(axis=-1)
            for each in (angles, other)
        )
        is_other = np.zeros(angles.shape[:-1], np.bool_)
        is_other[1:] = np.logical_xor.accumulate(change < stay, axis=0)
        angles = np.where(is_other[..., None], other, angles)
    unwrapped: Floats = np.unwrap(angles, axis=0)
    return unwrapped


def rotate_about_y(angle: ArrayLike) -> Floats:
    """Return rotations about the vertical by angles in radians."""
    half = np.asarray(angle, np.float64) / 2
    zero = np.zeros_like(half)
    return join_components(np.cos(half), zero, np.sin(half), zero)


def to_rotation_vectors(q: Floats) -> Floats:
    """Return rotation vectors: axis times radians, along the shorter arc (the logarithm)."""
    # q and -q are the same rotation; w >= 0 selects the shorter arc.
    q = np.where(q[..., :1] < 0, -q, q)
    norm = np.linalg.norm(q[..., 1:], axis=-1, keepdims=True)
    # The arctangent is exact for small angles, where an arccosine of w is not.
    angle = 2 * np.arctan2(norm, q[..., :1])
    # Towards the identity the ratio of angle and sine tends to 2.
    vectors: Floats = q[..., 1:] * np.where(norm > 0, angle / np.maximum(norm, 1e-300), 2.0)
    return vectors


def from_rotation_vectors(vectors: Floats) -> Floats:
    """Return the rotations of rotation vectors; inverse of `to_rotation_vectors`."""
    half = np.linalg.norm(vectors, axis=-1, keepdims=True) / 2
    # `sinc(half / pi)` is sin(half) / half, which is 1 at the identity: no division by 0.
    return np.concatenate([np.cos(half), vectors * np.sinc(half / np.pi) / 2], axis=-1)


def slerp(a: Floats, b: Floats, share: Floats) -> Floats:
    """Interpolate rotations from ``a`` (share 0) to ``b`` (share 1) along the shorter arc."""
    return multiply(
        a, from_rotation_vectors(share * to_rotation_vectors(multiply(conjugate(a), b)))
    )


def normalize(q: Floats) -> Floats:
    """Return unit quaternions; those of length 0 become the identity."""
    norm = np.linalg.norm(q, axis=-1, keepdims=True)
    return np.where(norm > 0, q / np.where(norm > 0, norm, 1.0), IDENTITY)


def to_matrices(rotations: Floats) -> Floats:
    """Convert unit quaternions (..., 4) to matrices (..., 3, 3)."""
    # The rotated unit vectors are the columns.
    axes = [rotate(rotations, axis) for axis in np.eye(3)]
    return np.stack(axes, axis=-1)


def from_matrices(axes: Floats) -> Floats:
    """Convert rotation matrices (frames, 3, 3) to unit quaternions.

    Source: S. W. Shepperd, "Quaternion from rotation matrix", J. Guidance and Control 1, 1978.
    """
    # Four times the squares of the components follow from trace and diagonal.
    trace = np.trace(axes, axis1=1, axis2=2)
    diagonal = np.diagonal(axes, axis1=1, axis2=2)
    squares = np.column_stack([1 + trace, *(1 + 2 * diagonal - trace[:, None]).T])
    # Divide by the largest component: small ones would lose digits.
    largest = squares.argmax(axis=1)
    x = axes[:, 2, 1] - axes[:, 1, 2], axes[:, 0, 2] - axes[:, 2, 0], axes[:, 1, 0] - axes[:, 0, 1]
    xy, yz, zx = (axes[:, i, j] + axes[:, j, i] for i, j in ((0, 1), (1, 2), (2, 0)))
    w2, x2, y2, z2 = squares.T
    rows = np.stack(
        [
            np.column_stack([w2, *x]),
            np.column_stack([x[0], x2, xy, zx]),
            np.column_stack([x[1], xy, y2, yz]),
            np.column_stack([x[2], zx, yz, z2]),
        ]
    )
    # Select the row for the largest component of each rotation.
    chosen = rows[largest, np.arange(len(axes))]
    return np.asarray(chosen / np.linalg.norm(chosen, axis=1, keepdims=True), np.float64)


def split_components(array: Floats) -> tuple[Floats, ...]:
    """Return the components along the last axis as a tuple."""
    return tuple(array[..., i] for i in range(array.shape[-1]))


def join_components(*parts: Floats) -> Floats:
    """Join components along a new last axis, contiguous per component."""
    # Store with components first, so that each is contiguous, and transpose the view.
    # For few rotations this takes half the time of `np.stack` and `np.moveaxis`.
    joined = np.empty((len(parts), *np.broadcast(*parts).shape), np.result_type(*parts))
    for number, part in enumerate(parts):
        joined[number] = part
    return joined.transpose(*range(1, joined.ndim), 0)
