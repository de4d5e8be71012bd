"""Tag clips with the direction of travel, turns, starts and stops.

Velocities are those of the hips over the floor. The direction is that of the mean velocity relative
to the gaze: someone who walks sideways to the left while looking ahead moves left, even with turned
hips and shoulders. The gaze follows from the head's axis that points left at rest; without
rotations it is the heading of the hips, which also defines turns.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, degrees, hypot
from typing import Literal, get_args

import numpy as np

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.errors import EndEffectorError, MotionError
from kineme.features import EndEffectors, compute_heading, end_effectors
from kineme.features.body_frame import find_facing, find_parting
from kineme.recordings import Motion
from kineme.recordings.kinematics import compute_world_rotations
from kineme.recordings.posing import get_rig

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


@dataclass(frozen=True, eq=False)
class Travel:
    """Motion of the body of a recording over the floor.

    Parameters
    ----------
    velocities : ndarray of shape (frames, 2)
        Velocity of the hips along +x and +z, metres per second.
    looks, headings : ndarray of shape (frames,)
        Directions of gaze and hips, radians from +z towards +x; headings are unwrapped.
    fps : float
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
        looks = (
            headings if motion.rotations is None else _measure_looks(motion, motion.rotations, ends)
        )
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


def _measure_looks(motion: Motion, rotations: Floats, ends: EndEffectors) -> Floats:
    """Return the direction of gaze in each frame, radians from +z towards +x."""
    skeleton = motion.skeleton
    _, left, right = find_parting(skeleton, ends.left_wrist, ends.right_wrist, "arms")
    places, turns = get_rig(skeleton).rest()
    # The left axis at rest, from the branches of the arms: head and chest face the same way.
    to_left = places[left] - places[right]
    to_left /= max(float(np.linalg.norm(to_left)), 1e-12)
    axis = rot.rotate(rot.conjugate(turns[ends.head]), to_left)
    turned = rot.rotate(compute_world_rotations(skeleton, rotations)[:, ends.head], axis)
    cos, sin = find_facing(turned, _LEAST)
    return np.arctan2(-sin, cos)[:, 0]
