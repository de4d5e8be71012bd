"""How a clip moves over the floor, told apart from how it moves in place.

The root motion of a clip is the even one: from the first frame to the one after the last the body
goes at one speed and turns at one rate, so that its path is a line or an arc. What a clip does
beyond it, such as the sway of the hips in walking, stays in the poses. So a loop in place closes,
and is put back on its path by two speeds and a rate.

Source: the exponential map of rigid motions of the plane, as in Murray, Li, Sastry, "A
Mathematical Introduction to Robotic Manipulation", 1994, section 3.2.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import atan2, cos, hypot, sin

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.clips.loops import Carry
from kineme.errors import EndEffectorError, MotionError
from kineme.features import compute_heading
from kineme.recordings import Motion
from kineme.recordings.kinematics import compute_world_rotations
from kineme.recordings.posing import add_root, get_rig

STILL = 1e-9
"""Radians a round below which a path is a line."""


@dataclass(frozen=True)
class RootMotion:
    """How a body goes and turns: metres per second in its own axes, radians per second.

    ``x`` is to its left and ``z`` ahead where the clip faces +z, as clips in place do.

    Examples
    --------
    >>> walk = RootMotion(0.0, 1.5, 0.5)
    >>> walk.speed
    1.5
    """

    x: float
    z: float
    turn: float

    @property
    def speed(self) -> float:
        return hypot(self.x, self.z)


def measure_root_motion(motion: Motion, carry: Carry) -> RootMotion:
    """Return the even motion of the body with this carry, in the axes of the recording."""
    # Seen from where the hips begin, the carry holds only what the body itself does.
    shift, seconds = (
        _solve_even_shift(_move_origin(carry, _find_start(motion))),
        motion.n_frames / motion.fps,
    )
    return RootMotion(shift[0] / seconds, shift[2] / seconds, carry.turn / seconds)


def remove_root_motion(motion: Motion, carry: Carry) -> tuple[Motion, RootMotion]:
    """Return motion in place, at the origin and facing +z, and what was taken out, in its axes."""
    start = measure_root_motion(motion, carry)
    unmoved = _follow_path(motion, carry, np.zeros(3))
    x, _, z = unmoved.positions[:, motion.skeleton.carrier].mean(axis=0)
    facing, center = _measure_facing(unmoved), np.array([x, 0.0, z])
    # Turn the mean facing to +z about the mean place of the hips, which goes to the origin.
    settled = _turn_frames(unmoved, np.full(motion.n_frames, -facing), center, np.zeros(3))
    # The speed of the point that comes to lie at the origin, not that of the root in frame 0.
    arm = center - _find_start(motion)
    # Velocity of a point off the axis: rotation adds turn times arm, at right angles.
    across, ahead = start.x + start.turn * arm[2], start.z - start.turn * arm[0]
    # The same velocity in the axes of the clip in place.
    removed = RootMotion(
        across * cos(facing) - ahead * sin(facing),
        across * sin(facing) + ahead * cos(facing),
        start.turn,
    )
    return _add_note(settled, "root motion taken out, put to the origin"), removed


def extract_root_motion(motion: Motion, carry: Carry) -> Motion:
    """Return the motion with a root bone on the floor that moves as the root motion does.

    All other joints stay where they are. It is the topmost bone above the hips; one is added
    where there is none.
    """
    _, path, turns = _compute_path(motion, carry)
    places = _find_start(motion) + path
    places[:, 1] = 0.0
    facing = _measure_facing(_follow_path(motion, carry, np.zeros(3)))
    if motion.skeleton.parents[motion.skeleton.carrier] < 0:
        motion = add_root(motion)
    skeleton = motion.skeleton
    root = skeleton.ancestry(skeleton.carrier)[0]
    positions, rotations = np.array(motion.positions), motion.rotations
    positions[:, root] = places
    if rotations is not None:
        world = compute_world_rotations(skeleton, rotations)
        rotations = np.array(rotations)
        # Turned as at rest where the body faces +z.
        rest = get_rig(skeleton).rest()[1][root]
        rotations[:, root] = rot.multiply(rot.rotate_about_y(turns + facing), rest)
        for child in skeleton.children[root]:
            back = rot.conjugate(rotations[:, root])
            rotations[:, child] = rot.multiply(back, world[:, child])
    moved = replace(motion, positions=positions, rotations=rotations)
    return _add_note(moved, "root motion moved to a root bone")


def straighten(motion: Motion, carry: Carry) -> tuple[Motion, Carry]:
    """Return the motion with its turn taken out, so that the body goes on as it begins."""
    shift = _solve_even_shift(_move_origin(carry, _find_start(motion)))
    straight = _add_note(_follow_path(motion, carry, shift), "turn taken out")
    return straight, Carry(0.0, float(shift[0]), float(shift[2]))


def _follow_path(motion: Motion, carry: Carry, shift: Floats) -> Motion:
    """Without its root motion, but with an even shift instead."""
    shares, path, turns = _compute_path(motion, carry)
    start = _find_start(motion)
    target = start + shares[:, None] * shift
    return _turn_frames(motion, -turns, start + path, target)


def _compute_path(motion: Motion, carry: Carry) -> tuple[Floats, Floats, Floats]:
    """Return the share of a round (frames,), and how far the body went and turned by then.

    The shift is (frames, 3), the turn (frames,) radians.
    """
    about = _move_origin(carry, _find_start(motion))
    speed = _solve_even_shift(about)
    # The frame after the last one would be share 1, so the end is left out.
    shares = np.linspace(0.0, 1.0, motion.n_frames, endpoint=False)
    path: Floats = np.array(
        # Position along the arc: the time times the mean direction so far, times the speed.
        [share * (_compute_mean_rotation(share * about.turn) @ speed) for share in shares.tolist()]
    )
    return shares, path, shares * about.turn


def _turn_frames(motion: Motion, turns: Floats, centers: Floats, targets: Floats) -> Motion:
    """Return each frame turned about the vertical through its center, which goes to its target."""
    quaternions = rot.rotate_about_y(turns)[:, None]
    centers, targets = (np.broadcast_to(each, (motion.n_frames, 3)) for each in (centers, targets))
    positions = rot.rotate(quaternions, motion.positions - centers[:, None]) + targets[:, None]
    rotations = motion.rotations
    # Roots only: all other joints are relative to their parents.
    if rotations is not None:
        roots = [j for j, parent in enumerate(motion.skeleton.parents) if parent < 0]
        rotations = np.array(rotations)
        rotations[:, roots] = rot.multiply(quaternions, rotations[:, roots])
    return replace(motion, positions=positions, rotations=rotations)


def _move_origin(carry: Carry, place: Floats) -> Carry:
    """Return the carry as seen from a place on the floor."""
    shift = carry.apply(place) - place
    return Carry(carry.turn, float(shift[0]), float(shift[2]))


def _solve_even_shift(carry: Carry) -> Floats:
    """Return the shift, in the axes of the body, that even motion for one round consists of."""
    # Shift of one round = mean rotation over the round times the even motion.
    shift: Floats = np.asarray(
        np.linalg.solve(_compute_mean_rotation(carry.turn), carry.shift), np.float64
    )
    return shift


def _compute_mean_rotation(turn: float) -> Floats:
    """Return the mean of the rotations from 0 to ``turn`` about the vertical."""
    if abs(turn) < STILL:
        return np.eye(3)
    # Integrals of cosine and sine from 0 to the turn, divided by it.
    even, odd = sin(turn) / turn, (1 - cos(turn)) / turn
    return np.array([[even, 0.0, odd], [0.0, 1.0, 0.0], [-odd, 0.0, even]])


def _measure_facing(motion: Motion) -> float:
    """Where the body looks in the mean, radians from +z; 0 where nothing tells."""
    try:
        _, angles = compute_heading(motion)
    except (EndEffectorError, MotionError):
        return 0.0
    # Circular mean: angles near pi and -pi are neighbours.
    return atan2(float(np.sin(angles).mean()), float(np.cos(angles).mean()))


def _find_start(motion: Motion) -> Floats:
    """Return where on the floor the hips begin."""
    x, _, z = motion.positions[0, motion.skeleton.carrier]
    return np.array([x, 0.0, z])


def _add_note(motion: Motion, note: str) -> Motion:
    return replace(motion, provenance=motion.provenance.noted(note))
