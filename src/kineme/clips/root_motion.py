"""Separate the root motion of a clip from its motion in place, and tag how a body travels.

Root motion of a loop has constant speed and turning rate from the first frame to the one after the
last, so that its path is a line or an arc. The rest, such as the sway of the hips, stays in the
poses. So a loop in place closes, and two speeds and a rate restore its path.

Root motion of other clips, which have no `Carry`, is the smoothed path and heading of the hips,
since their speed varies. Its mean speeds are measured in the axes of the turning body.

Source: the exponential map of rigid motions of the plane, as in Murray, Li, Sastry, "A
Mathematical Introduction to Robotic Manipulation", 1994, section 3.2.

Tags tell the direction of travel, turns, starts and stops. Velocities are those of the hips over
the floor. The direction is that of the mean velocity relative to the gaze: someone who walks
sideways to the left while looking ahead moves left, even with turned hips and shoulders. The gaze
follows from the head's axis that points left at rest; without rotations it is the heading of the
hips, which also defines turns.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import atan2, cos, degrees, hypot, sin
from typing import Literal, get_args

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats, Masks
from kineme.clips.loops import Carry, find_carry
from kineme.errors import EndEffectorError, MotionError
from kineme.features import EndEffectors, compute_heading, end_effectors
from kineme.features.pose import find_facing, find_parting
from kineme.recordings import Motion
from kineme.recordings.carriers import find_still_joints, place_frames
from kineme.recordings.kinematics import compute_world_rotations
from kineme.recordings.posing import add_root, get_rig

STRAIGHT = 1e-9
"""Turn in radians per round below which a path is a straight line."""
SMOOTH_S = 0.4
"""Standard deviation of the Gaussian that smooths the path of the hips, seconds. It leaves 4 % of
the sway at 1 Hz in the path."""
TILT = 0.8
"""Vertical part of the line of the hips above which its heading is not used."""
Tag = Literal[
    "forwards", "backwards", "left", "right", "in place", "turn left", "turn right", "start", "stop"
]
TAGS: tuple[Tag, ...] = get_args(Tag)
"""All tags; directions come first, and each clip of a body has one of them."""
DIRECTIONS = TAGS[:5]
MOVING = 0.25
"""Speed in metres per second below which a body is in place."""
STILL, STILL_SHARE = 0.3, 0.25
"""An end is still below this speed (m/s) and below this fraction of the peak speed."""
END_S = 0.25
"""Seconds at either end of a clip over which speed and heading are averaged."""
GOING = 0.5
"""Least peak speed of a clip with a start or stop, metres per second."""
TURN = 45.0
"""Least change of heading of a turn, degrees."""
_LEAST = 0.1  # horizontal length of the head's axis below which gaze is undefined


@dataclass(frozen=True)
class RootMotion:
    """Mean root motion: metres per second in the body's axes, and radians per second.

    ``x`` is to the left and ``z`` ahead if the clip faces +z, as clips in place do.

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


def measure_root_motion(motion: Motion, carry: Carry | None) -> RootMotion:
    """Return the root motion for this carry, or of no loop, in the axes of the recording."""
    if carry is None:
        # The path ends at the last frame, not one frame later.
        turns, _, straight = (each[-1] for each in _trace_hips(motion))
        seconds = max(motion.n_frames - 1, 1) / motion.fps
        return RootMotion(straight[0] / seconds, straight[2] / seconds, float(turns) / seconds)
    # Relative to the start of the hips, the carry contains only the motion of the body.
    shift = _solve_even_shift(_move_origin(carry, _find_start(motion)))
    seconds = motion.n_frames / motion.fps
    return RootMotion(shift[0] / seconds, shift[2] / seconds, carry.turn / seconds)


def remove_root_motion(
    motion: Motion, carry: Carry | None, still: Masks | None = None
) -> tuple[Motion, RootMotion]:
    """Return the motion in place at the origin, facing +z, and the removed root motion.

    Joints that stand ``still`` stay; by default those that do so in this motion.
    """
    # Find them before the motion is removed, which makes more joints stand still.
    still = find_still_joints(motion) if still is None else still
    start = measure_root_motion(motion, carry)
    unmoved = _follow_path(motion, carry, still=still)
    x, _, z = unmoved.positions[:, motion.skeleton.carrier].mean(axis=0)
    facing, center = _measure_facing(unmoved), np.array([x, 0.0, z])
    # Turn the mean heading to +z, about the mean position of the hips, which moves to the origin.
    turns = np.full(motion.n_frames, -facing)
    settled = place_frames(unmoved, turns, center, np.zeros(3), still)
    # Velocity of the point that moves to the origin, not of the root in frame 0.
    arm = center - _find_start(motion)
    # Velocity of a point off the axis: rotation adds turn times arm, at right angles.
    across, ahead = start.x + start.turn * arm[2], start.z - start.turn * arm[0]
    # The same velocity in the axes of the clip in place.
    removed = RootMotion(
        across * cos(facing) - ahead * sin(facing),
        across * sin(facing) + ahead * cos(facing),
        start.turn,
    )
    return _add_note(settled, "root motion removed, moved to the origin"), removed


def extract_root_motion(motion: Motion, carry: Carry | None) -> Motion:
    """Return the motion with a root bone on the floor that follows the root motion.

    The root bone is the topmost bone above the hips, or a new one. Other joints do not move.
    """
    turns, path, _ = _compute_path(motion, carry)
    places = _find_start(motion) + path
    places[:, 1] = 0.0
    facing = _measure_facing(_follow_path(motion, carry))
    if motion.skeleton.parents[motion.skeleton.carrier] < 0:
        motion = add_root(motion)
    skeleton = motion.skeleton
    root = skeleton.ancestry(skeleton.carrier)[0]
    positions, rotations = np.array(motion.positions), motion.rotations
    positions[:, root] = places
    if rotations is not None:
        world = compute_world_rotations(skeleton, rotations)
        rotations = np.array(rotations)
        # Rest rotation if the body faces +z.
        rest = get_rig(skeleton).rest()[1][root]
        rotations[:, root] = rot.multiply(rot.rotate_about_y(turns + facing), rest)
        for child in skeleton.children[root]:
            back = rot.conjugate(rotations[:, root])
            rotations[:, child] = rot.multiply(back, world[:, child])
    moved = replace(motion, positions=positions, rotations=rotations)
    return _add_note(moved, "root motion moved to a root bone")


def straighten(motion: Motion, carry: Carry | None) -> tuple[Motion, Carry | None]:
    """Return the motion without its turn, so that the body keeps its initial direction."""
    straight = _add_note(_follow_path(motion, carry, straight=True), "turn removed")
    if carry is None:
        return straight, None
    shift = _solve_even_shift(_move_origin(carry, _find_start(motion)))
    return straight, Carry(0.0, float(shift[0]), float(shift[2]))


def _follow_path(
    motion: Motion, carry: Carry | None, *, straight: bool = False, still: Masks | None = None
) -> Motion:
    """Remove the root motion, or only its turn."""
    turns, path, without_turn = _compute_path(motion, carry)
    start = _find_start(motion)
    target = start + without_turn if straight else start
    return place_frames(motion, -turns, start + path, target, still)


def _compute_path(motion: Motion, carry: Carry | None) -> tuple[Floats, Floats, Floats]:
    """Return the turn and shift of each frame, and its shift without the turn.

    Shapes are (frames,), (frames, 3) and (frames, 3); the turn is in radians.
    """
    if carry is None:
        return _trace_hips(motion)
    about = _move_origin(carry, _find_start(motion))
    speed = _solve_even_shift(about)
    # The frame after the last one would be fraction 1, so the end is left out.
    shares = np.linspace(0.0, 1.0, motion.n_frames, endpoint=False)
    path: Floats = np.array(
        # Position on the arc: time times the mean rotation so far, applied to the velocity.
        [share * (_compute_mean_rotation(share * about.turn) @ speed) for share in shares.tolist()]
    )
    return shares * about.turn, path, shares[:, None] * speed


def _trace_hips(motion: Motion) -> tuple[Floats, Floats, Floats]:
    """Return turn, path and path without turn of the hips, smoothed; see `_compute_path`."""
    path = _smooth(motion.positions[:, motion.skeleton.carrier] * [1, 0, 1], motion.fps)
    path -= path[0].copy()
    turns = _smooth(_measure_turns(motion), motion.fps)
    # Turn each step back by the mean turn of its two frames.
    back = rot.rotate_about_y(-(turns[1:] + turns[:-1]) / 2)
    without_turn = np.zeros_like(path)
    np.cumsum(rot.rotate(back, np.diff(path, axis=0)), axis=0, out=without_turn[1:])
    return turns, path, without_turn


def _measure_turns(motion: Motion) -> Floats:
    """Return the turn of the hips since the first frame, radians (frames,)."""
    try:
        ends = end_effectors(motion)
        _, left, right = find_parting(motion.skeleton, ends.left_ankle, ends.right_ankle)
        _, headings = compute_heading(motion, effectors=ends)
    except (EndEffectorError, MotionError):
        return np.zeros(motion.n_frames)
    across = motion.positions[:, left] - motion.positions[:, right]
    # In a cartwheel the line of the hips turns over, so its direction does not tell a turn.
    if (np.abs(across[:, 1]) > TILT * np.linalg.norm(across, axis=1)).any():
        return np.linspace(0.0, find_carry(motion).turn, motion.n_frames, endpoint=False)
    turns: Floats = np.unwrap(headings) - headings[0]
    return turns


def _smooth(values: Floats, fps: float) -> Floats:
    """Return smoothed values (frames, ...); constant changes and the first value stay."""
    from scipy.ndimage import gaussian_filter1d  # heavy, and seldom needed

    if len(values) < 2:
        return values.copy()
    sigma = SMOOTH_S * fps
    more = int(4 * sigma) + 1  # the filter reaches 4 standard deviations
    # Mirror the curve in its end points, so that it goes on as it does there.
    widths = [(more, more), *[(0, 0)] * (values.ndim - 1)]
    padded = np.pad(values, widths, "reflect", reflect_type="odd")
    return np.asarray(gaussian_filter1d(padded, sigma, axis=0)[more:-more])


def _move_origin(carry: Carry, place: Floats) -> Carry:
    """Return the carry relative to a point on the floor."""
    shift = carry.apply(place) - place
    return Carry(carry.turn, float(shift[0]), float(shift[2]))


def _solve_even_shift(carry: Carry) -> Floats:
    """Return the constant motion, in the axes of the body, that produces the carry in one round."""
    # Shift of one round = mean rotation over the round times the constant motion.
    shift: Floats = np.asarray(
        np.linalg.solve(_compute_mean_rotation(carry.turn), carry.shift), np.float64
    )
    return shift


def _compute_mean_rotation(turn: float) -> Floats:
    """Return the mean of the rotations from 0 to ``turn`` about the vertical."""
    if abs(turn) < STRAIGHT:
        return np.eye(3)
    # Integrals of cosine and sine from 0 to the turn, divided by it.
    even, odd = sin(turn) / turn, (1 - cos(turn)) / turn
    return np.array([[even, 0.0, odd], [0.0, 1.0, 0.0], [-odd, 0.0, even]])


def _measure_facing(motion: Motion) -> float:
    """Return the mean heading in radians from +z; 0 if unknown."""
    try:
        _, angles = compute_heading(motion)
    except (EndEffectorError, MotionError):
        return 0.0
    # Circular mean: angles near pi and -pi are neighbours.
    return atan2(float(np.sin(angles).mean()), float(np.cos(angles).mean()))


def _find_start(motion: Motion) -> Floats:
    """Return the floor position of the hips in the first frame."""
    x, _, z = motion.positions[0, motion.skeleton.carrier]
    return np.array([x, 0.0, z])


def _add_note(motion: Motion, note: str) -> Motion:
    return replace(motion, provenance=motion.provenance.noted(note))


@dataclass(frozen=True, eq=False)
class Travel:
    """Motion of the body of a recording over the floor.

    ``velocities`` (frames, 2) are those of the hips along +x and +z, metres per second. ``looks``
    and ``headings`` (frames,) are the directions of gaze and hips, radians from +z towards +x;
    headings are unwrapped.
    """

    velocities: Floats
    looks: Floats
    headings: Floats
    fps: float

    def velocity(self, start: int, stop: int) -> tuple[float, float]:
        """Return the mean velocity in frames [start, stop), to the left and ahead."""
        # The head looks into a turn, so use the hips then.
        directions = self.looks if abs(self.turn(start, stop)) < TURN else self.headings
        (x, z), angles = self.velocities[start:stop].T, directions[start:stop]
        left = np.cos(angles) * x - np.sin(angles) * z
        ahead = np.sin(angles) * x + np.cos(angles) * z
        return float(left.mean()), float(ahead.mean())

    def turn(self, start: int, stop: int) -> float:
        """Return the turn of the hips in frames [start, stop), degrees, positive to the left."""
        headings, n = self.headings[start:stop], self._frames(stop - start)
        return degrees(float(headings[-n:].mean() - headings[:n].mean()))

    def tags(self, start: int, stop: int) -> tuple[Tag, ...]:
        """Return the tags of frames [start, stop), in the order of `TAGS`."""
        turn = self.turn(start, stop)
        tags: set[Tag] = {_choose_direction(*self.velocity(start, stop))}
        if abs(turn) >= TURN:
            tags.add("turn left" if turn > 0 else "turn right")
        # Speed averaged over a quarter of a second, which reduces sway.
        n = self._frames(stop - start)
        sums = np.cumsum(np.vstack([np.zeros(2), self.velocities[start:stop]]), axis=0)
        speeds = np.linalg.norm(sums[n:] - sums[:-n], axis=1) / n
        if speeds.max() >= GOING and "in place" not in tags:
            still = min(STILL, STILL_SHARE * float(speeds.max()))
            tags |= {"start"} if speeds[0] < still else set()
            tags |= {"stop"} if speeds[-1] < still else set()
        return tuple(tag for tag in TAGS if tag in tags)

    def _frames(self, most: int) -> int:
        return max(1, min(round(END_S * self.fps), most))


def measure_travel(motion: Motion) -> Travel | None:
    """Return the travel of a body; None without hips or with a single frame."""
    if motion.n_frames < 2:
        return None
    try:
        ends = end_effectors(motion)
        pelvis, headings = compute_heading(motion, effectors=ends)
        looks = headings if motion.rotations is None else _measure_looks(motion, ends)
    except (EndEffectorError, MotionError):
        return None
    # A gradient, so that every frame has a velocity.
    velocities = np.gradient(motion.positions[:, pelvis][:, [0, 2]], axis=0) * motion.fps
    return Travel(velocities, looks, np.unwrap(headings), motion.fps)


def _choose_direction(left: float, ahead: float) -> Tag:
    """Return the nearest of four directions, or "in place" at low speed."""
    if hypot(left, ahead) < MOVING:
        return "in place"
    quarter = round(degrees(atan2(left, ahead)) / 90) % 4
    directions: tuple[Tag, ...] = ("forwards", "left", "backwards", "right")
    return directions[quarter]


def _measure_looks(motion: Motion, ends: EndEffectors) -> Floats:
    """Return the direction of gaze in each frame, radians from +z towards +x."""
    skeleton = motion.skeleton
    _, left, right = find_parting(skeleton, ends.left_wrist, ends.right_wrist, "arms")
    places, turns = get_rig(skeleton).rest()
    # The left axis at rest, from the branches of the arms: head and chest face the same way.
    to_left = places[left] - places[right]
    to_left /= max(float(np.linalg.norm(to_left)), 1e-12)
    axis = rot.rotate(rot.conjugate(turns[ends.head]), to_left)
    turned = rot.rotate(compute_world_rotations(skeleton, motion.rotations)[:, ends.head], axis)
    cosine, sine = find_facing(turned, _LEAST)
    return np.arctan2(-sine, cosine)[:, 0]
