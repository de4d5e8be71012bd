"""Where a figure is, from how it moves its legs.

The figure is put on the floor at its lowest contact (heels and toes) and moved
so that what bears it does not slide. In the air it rises and falls as a thrown
body does and keeps the speed it had. Both rules are soft minima over the
contacts, so that changing feet makes no jerk.
"""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.recordings import Motion, Skeleton
from kineme.recordings.kinematics import world_rotations

_HEEL = np.array([1.0, 1.0, -0.4])  # where it is, in units of the way from ankle to ball
_FLOOR_SHARED = 0.006  # metres of height within which contacts bear together
_GRIP_SHARED = 0.01
_SMOOTHING_S = 0.025


def root_path(skeleton: Skeleton, rotations: Floats, airborne: Floats, fps: float) -> Floats:
    """Positions (frames, 3) of the root that keep the feet on the floor y = 0.

    ``airborne`` (frames,) are metres between the feet and the floor; 0 while they bear.
    """
    contacts = _contacts(skeleton, rotations, fps)
    heights = contacts[:, :, 1]
    lowest = heights.min(axis=1, keepdims=True)
    # Soft minimum of the contacts' heights, taken from the lowest for the sake of the exponential.
    bearing = np.exp((lowest - heights) / _FLOOR_SHARED).mean(axis=1)
    floor = lowest[:, 0] - _FLOOR_SHARED * np.log(bearing)
    # Weights of the contacts that bear, which sum to 1.
    grip = np.exp((lowest - heights) / _GRIP_SHARED)
    grip /= grip.sum(axis=1, keepdims=True)
    # The root moves against the contacts that bear, so that these stay.
    velocity = -np.einsum("fc,fcx->fx", grip, np.gradient(contacts, axis=0))
    on_floor = np.flatnonzero(airborne <= 0)
    path = np.empty((len(airborne), 3))
    for axis in (0, 2):
        # In the air the speed goes on from take-off to landing.
        speed = np.interp(np.arange(len(airborne)), on_floor, velocity[on_floor, axis])
        path[:, axis] = np.cumsum(gaussian_filter1d(speed, _SMOOTHING_S * fps))
    # The body is raised until its lowest contact is on the floor.
    path[:, 1] = airborne - gaussian_filter1d(floor, _SMOOTHING_S / 2 * fps)
    return path


def _contacts(skeleton: Skeleton, rotations: Floats, fps: float) -> Floats:
    """(frames, 6, 3): heels, balls and tips of the feet, from a root at the origin."""
    at_origin = np.zeros((len(rotations), 3))
    motion = Motion.from_rotations(skeleton, rotations, fps, at_origin)
    world = world_rotations(motion.skeleton, motion.rotations)
    points = []
    for side in ("Left", "Right"):
        ankle, ball = skeleton.joint(f"{side}Foot"), skeleton.joint(f"{side}ToeBase")
        # The heel lies behind the ankle, as a share of the way to the ball of the foot.
        heel = skeleton.offsets[ball] * _HEEL
        points.append(motion.positions[:, ankle] + rot.rotate(world[:, ankle], heel))
        points.append(motion.positions[:, ball])
        points.append(motion.positions[:, skeleton.joint(f"{side}ToeBase_end")])
    return np.stack(points, axis=1)
