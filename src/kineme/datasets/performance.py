"""Compute the figure's joint rotations and path from a timeline.

The lowest contact (heels and toes) is put on the floor, and the figure moves so that supporting
contacts do not slide. In flight it follows a ballistic curve at constant horizontal speed. Contacts
are combined by soft minima, which avoids jerks when the support changes.
"""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.datasets.actions import ACTIONS, mirror_posture
from kineme.datasets.figure import ANGLES, compute_joint_rotations
from kineme.datasets.timeline import Part, compute_phase, compute_weight
from kineme.recordings import Motion, Skeleton
from kineme.recordings.kinematics import compute_world_rotations

_HEEL = np.array([1.0, 1.0, -0.4])  # heel position, relative to the vector from ankle to ball
_FLOOR_SHARED = 0.006  # metres of height within which contacts share the support
_GRIP_SHARED = 0.01
_SMOOTHING_S = 0.025


def compute_root_path(
    skeleton: Skeleton, rotations: Floats, airborne: Floats, fps: float
) -> Floats:
    """Return root positions (frames, 3) that keep the feet on the floor y = 0.

    ``airborne`` (frames,) is the height of the feet in metres; 0 during support.
    """
    contacts = _compute_contacts(skeleton, rotations, fps)
    heights = contacts[:, :, 1]
    lowest = heights.min(axis=1, keepdims=True)
    # Soft minimum of the contacts' heights, relative to the lowest to avoid overflow.
    bearing = np.exp((lowest - heights) / _FLOOR_SHARED).mean(axis=1)
    floor = lowest[:, 0] - _FLOOR_SHARED * np.log(bearing)
    # Weights of the supporting contacts, which sum to 1.
    grip = np.exp((lowest - heights) / _GRIP_SHARED)
    grip /= grip.sum(axis=1, keepdims=True)
    # The root moves opposite to the supporting contacts, so that these stay in place.
    velocity = -np.einsum("fc,fcx->fx", grip, np.gradient(contacts, axis=0))
    on_floor = np.flatnonzero(airborne <= 0)
    path = np.empty((len(airborne), 3))
    for axis in (0, 2):
        # Interpolate the speed in flight between take-off and landing.
        speed = np.interp(np.arange(len(airborne)), on_floor, velocity[on_floor, axis])
        path[:, axis] = np.cumsum(gaussian_filter1d(speed, _SMOOTHING_S * fps))
    # Raise the body until its lowest contact is on the floor.
    path[:, 1] = airborne - gaussian_filter1d(floor, _SMOOTHING_S / 2 * fps)
    return path


def _compute_contacts(skeleton: Skeleton, rotations: Floats, fps: float) -> Floats:
    """Return heels, balls and tips of the feet relative to the root, (frames, 6, 3)."""
    at_origin = np.zeros((len(rotations), 3))
    motion = Motion.from_rotations(skeleton, rotations, fps, at_origin)
    world = compute_world_rotations(motion.skeleton, motion.rotations)
    points = []
    for side in ("Left", "Right"):
        ankle, ball = skeleton.joint(f"{side}Foot"), skeleton.joint(f"{side}ToeBase")
        # The heel lies behind the ankle, by a fraction of the distance to the ball of the foot.
        heel = skeleton.offsets[ball] * _HEEL
        points.append(motion.positions[:, ankle] + rot.rotate(world[:, ankle], heel))
        points.append(motion.positions[:, ball])
        points.append(motion.positions[:, skeleton.joint(f"{side}ToeBase_end")])
    return np.stack(points, axis=1)


_GRAVITY = 9.81
_SIZE_VARIES = 0.06  # standard deviation, relative
_SWAY_DEG = 1.5
_SWAY_S = 0.35
_TURN_DEG = 120.0  # standard deviation of the turn over one bout of walking


def perform(
    parts: list[Part], skeleton: Skeleton, fps: float, rng: np.random.Generator
) -> tuple[Floats, Floats]:
    """Return joint rotations (frames, joints, 4) and heights in flight (frames,), metres."""
    frames = int(parts[-1].frames[-1])
    rotations = np.zeros((frames, skeleton.n_joints, 4))
    airborne = np.zeros(frames)
    heading = _draw_heading(parts, frames, rng)
    sway = {name: _SWAY_DEG * _make_slow_noise(frames, _SWAY_S * fps, rng) for name in ANGLES}
    for part in parts:
        # Fades overlap with those of the neighbouring actions.
        start, stop = part.frames[0] - part.fade_in, part.frames[-1] + part.fade_out
        span = slice(start, stop)
        phase = compute_phase(part)
        sizes = part.action.amplitude * (1 + rng.normal(0, _SIZE_VARIES, part.action.repetitions))
        # The size changes from the middle of one repetition to the middle of the next.
        size = np.interp(phase, np.arange(len(sizes)) + 0.5, sizes)
        cycle = ACTIONS[part.action.name]
        angles = cycle.angles_at(phase, size)
        if part.action.side == "left" and not cycle.gait:
            angles = mirror_posture(angles)
        posture = {name: angle + sway[name][span] for name, angle in angles.items()}
        weight = compute_weight(part)
        turned = compute_joint_rotations(skeleton, posture, heading[span])
        # q and -q are the same rotation: choose the sign nearer to the sum so far.
        nearer = np.sign(np.einsum("fjc,fjc->fj", turned, rotations[span]))
        nearer[nearer == 0] = 1
        rotations[span] += weight[:, None, None] * nearer[..., None] * turned
        airborne[span] += weight * size * _compute_flight_height(part, phase, fps)
    # Normalise the weighted sum of quaternions, which blends the actions.
    rotations /= np.linalg.norm(rotations, axis=2, keepdims=True)
    return rotations, airborne


def add_noise(
    skeleton: Skeleton, rotations: Floats, noise: float, rng: np.random.Generator
) -> Floats:
    """Return the rotations with a small random turn of every joint that has children."""
    reach = np.zeros(skeleton.n_joints)
    # Children before parents: how far the longest chain below each joint reaches.
    for joint in range(skeleton.n_joints - 1, 0, -1):
        parent = skeleton.parents[joint]
        bone = float(np.linalg.norm(skeleton.offsets[joint]))
        reach[parent] = max(reach[parent], bone + reach[joint])
    # By this angle the far end moves by about the noise.
    angle = np.divide(noise, reach, out=np.zeros_like(reach), where=reach > 0)
    vectors = rng.normal(size=(*rotations.shape[:2], 3)) * angle[:, None] / 2
    # A small rotation as (1, half its vector), normalised below.
    shakes = np.concatenate([np.ones((*rotations.shape[:2], 1)), vectors], axis=2)
    turned = rot.multiply(rotations, shakes)
    return np.asarray(turned / np.linalg.norm(turned, axis=2, keepdims=True))


def _compute_flight_height(part: Part, phase: Floats, fps: float) -> Floats:
    """Return the height in metres of the ballistic flights of an action."""
    period = np.diff(part.frames).mean() / fps
    share = phase - np.floor(phase)
    height = np.zeros(len(phase))
    for leaves, lands in ACTIONS[part.action.name].flights:
        # Height of a throw: g/2 times the time since take-off times the time until landing.
        since, until = (share - leaves) * period, (lands - share) * period
        height += _GRAVITY / 2 * np.maximum(since, 0) * np.maximum(until, 0)
    return height


def _draw_heading(parts: list[Part], frames: int, rng: np.random.Generator) -> Floats:
    """Return the heading in degrees, which changes only while the figure walks or runs."""
    heading = np.full(frames, rng.uniform(-180, 180))
    for part in parts:
        # Drawn for every part, so that the others do not depend on it.
        turn = rng.normal(0, _TURN_DEG)
        if ACTIONS[part.action.name].travels:
            start, stop = part.frames[0], part.frames[-1]
            share = np.clip((np.arange(frames) - start) / (stop - start), 0, 1)
            heading += turn * share * share * (3 - 2 * share)  # smooth start and stop
    return heading


def _make_slow_noise(frames: int, sigma: float, rng: np.random.Generator) -> Floats:
    """Return smooth noise with standard deviation 1."""
    # The filter needs a margin on both sides, which is cut off again.
    margin = int(4 * sigma)
    smooth = gaussian_filter1d(rng.normal(size=frames + 2 * margin), sigma)
    # A Gaussian filter divides the standard deviation of white noise by this root.
    return np.asarray(smooth[margin : margin + frames] * np.sqrt(2 * np.sqrt(np.pi) * sigma))
