"""A clip as a cycle: its end blended into its beginning.

Played in a circle, the frame after the last is the first again, but further on and turned. A
`Carry` says how: a turn about the vertical and a shift on the floor, as in a player with root
motion. What remains between the two (joints that are bent differently, another height) is spread
evenly over the clip: frame f of n gets the share f/n - 1/2 of it. So the ends move least, no joint
changes its speed by more than a constant, and the frame rate and the number of frames stay.

1. Where the recording goes on after the last frame is estimated from the steps
   on both sides of the seam: half the last step of the clip, half its first.
   That keeps the step over the seam within those inside.
2. The carry is the rigid motion on the floor that brings the first pose closest
   to that frame: Kovar, Gleicher, Pighin, Motion Graphs, SIGGRAPH 2002,
   section 3.1, all joints weighing the same.
3. Rotations close along the shorter arc, roots after the carry; translations
   and positions without rotations in a line.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import atan2, cos, sin

import numpy as np
from numpy.typing import NDArray

from kineme import _rotations as rot
from kineme.recordings import Motion
from kineme.recordings.kinematics import forward_kinematics, local_translations

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Carry:
    """From one round to the next: turn about the vertical axis, then shift, on the floor.

    ``turn`` in radians, ``x`` and ``z`` in metres, as `kineme.recordings.operations.turn`
    and `kineme.recordings.operations.move` take them.
    """

    turn: float
    x: float
    z: float

    @property
    def rotation(self) -> Floats:
        """The turn as a quaternion."""
        return np.array([cos(self.turn / 2), 0.0, sin(self.turn / 2), 0.0])

    @property
    def shift(self) -> Floats:
        return np.array([self.x, 0.0, self.z])

    def apply(self, positions: Floats) -> Floats:
        """Positions one round later."""
        return rot.rotate(self.rotation, positions) + self.shift


def loop(motion: Motion) -> tuple[Motion, Carry]:
    """The motion as a seamless cycle, and what carries one round to the next.

    A motion of fewer than two frames stays as it is.
    """
    if motion.n_frames < 2:
        return motion, Carry(0.0, 0.0, 0.0)
    carry = _carry(motion.positions)
    note = "ends blended into a loop"
    provenance = motion.provenance.noted(note)
    if motion.rotations is None:
        positions = _closed_places(
            motion.positions, carry, np.ones(motion.positions.shape[1], bool)
        )
        return replace(motion, positions=positions, provenance=provenance), carry
    roots = np.array(motion.skeleton.parents) < 0
    rotations = _closed_rotations(motion.rotations, carry, roots)
    translations = _closed_places(
        local_translations(motion.skeleton, motion.positions, motion.rotations), carry, roots
    )
    positions = forward_kinematics(motion.skeleton, rotations, translations=translations)
    return Motion(motion.skeleton, positions, motion.fps, rotations, provenance), carry


def _carry(positions: Floats) -> Carry:
    """What brings the first pose closest to the one expected after the last."""
    first, last = positions[0], 2 * positions[-1] - positions[-2]
    (x, _, z), (u, _, w) = (pose.mean(axis=0) for pose in (first, last))
    a, b = first - first.mean(axis=0), last - last.mean(axis=0)
    across = float(a[:, 2] @ b[:, 0] - a[:, 0] @ b[:, 2])
    turn = atan2(across, float(a[:, 0] @ b[:, 0] + a[:, 2] @ b[:, 2]))
    to_x = float(u - x * cos(turn) - z * sin(turn))
    return Carry(turn, to_x, float(w + x * sin(turn) - z * cos(turn)))


def _closed_rotations(rotations: Floats, carry: Carry, roots: NDArray[np.bool_]) -> Floats:
    """R[f] * gap ** (f/n - 1/2), where R[n] * gap is the first frame carried on."""
    inverse = rot.conjugate(rotations)
    last_step = rot.multiply(inverse[-2], rotations[-1])
    first_step = rot.multiply(inverse[0], rotations[1])
    between = _power(rot.multiply(rot.conjugate(last_step), first_step), 0.5)
    after = rot.multiply(rotations[-1], rot.multiply(last_step, between))
    first = np.array(rotations[0])
    first[roots] = rot.multiply(carry.rotation, first[roots])
    gap = rot.multiply(rot.conjugate(after), first)
    closed = rot.multiply(rotations, _power(gap, _shares(len(rotations))[:, None]))
    unit: Floats = closed / np.linalg.norm(closed, axis=-1, keepdims=True)
    return unit


def _closed_places(places: Floats, carry: Carry, free: NDArray[np.bool_]) -> Floats:
    """The same for places; those that are ``free`` are carried on, the others hang on a parent.

    What is added to the free ones turns with the carry, so that it fits at both ends.
    """
    first_step, first = places[1] - places[0], np.array(places[0])
    first_step[free] = rot.rotate(carry.rotation, first_step[free])
    first[free] = carry.apply(first[free])
    after = places[-1] + (places[-1] - places[-2] + first_step) / 2
    shares = _shares(len(places))[:, None]
    added = shares[..., None] * (first - after)
    added[:, free] = rot.rotate(_power(carry.rotation, shares - 0.5), added[:, free])
    closed: Floats = places + added
    return closed


def _shares(n: int) -> Floats:
    shares: Floats = np.arange(n) / n - 0.5
    return shares


def _power(q: Floats, exponent: Floats | float) -> Floats:
    """The rotation ``exponent`` times as far, along the shorter arc."""
    q = np.where(q[..., :1] < 0, -q, q)
    norm = np.linalg.norm(q[..., 1:], axis=-1)
    angle = np.arctan2(norm, q[..., 0]) * exponent
    axis = q[..., 1:] / np.maximum(norm, 1e-300)[..., None]
    return np.concatenate([np.cos(angle)[..., None], np.sin(angle)[..., None] * axis], axis=-1)
