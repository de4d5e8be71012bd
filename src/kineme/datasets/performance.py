"""A timeline carried out: the figure's joint rotations and where it goes.

The figure is put on the floor at its lowest contact (heels and toes) and moved so that what bears
it does not slide. In the air it rises and falls as a thrown body does and keeps the speed it had.
Both rules are soft minima over the contacts, so that changing feet makes no jerk.
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

_HEEL = np.array([1.0, 1.0, -0.4])  # where it is, in units of the way from ankle to ball
_FLOOR_SHARED = 0.006  # metres of height within which contacts bear together
_GRIP_SHARED = 0.01
_SMOOTHING_S = 0.025


def compute_root_path(
    skeleton: Skeleton, rotations: Floats, airborne: Floats, fps: float
) -> Floats:
    """Positions (frames, 3) of the root that keep the feet on the floor y = 0.

    ``airborne`` (frames,) are metres between the feet and the floor; 0 while they bear.
    """
    contacts = _compute_contacts(skeleton, rotations, fps)
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


def _compute_contacts(skeleton: Skeleton, rotations: Floats, fps: float) -> Floats:
    """(frames, 6, 3): heels, balls and tips of the feet, from a root at the origin."""
    at_origin = np.zeros((len(rotations), 3))
    motion = Motion.from_rotations(skeleton, rotations, fps, at_origin)
    world = compute_world_rotations(motion.skeleton, motion.rotations)
    points = []
    for side in ("Left", "Right"):
        ankle, ball = skeleton.joint(f"{side}Foot"), skeleton.joint(f"{side}ToeBase")
        # The heel lies behind the ankle, as a share of the way to the ball of the foot.
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
    """Joint rotations (frames, joints, 4) and metres above the floor (frames,)."""
    frames = int(parts[-1].frames[-1])
    rotations = np.zeros((frames, skeleton.n_joints, 4))
    airborne = np.zeros(frames)
    heading = _draw_heading(parts, frames, rng)
    sway = {name: _SWAY_DEG * _make_slow_noise(frames, _SWAY_S * fps, rng) for name in ANGLES}
    for part in parts:
        # An action begins with its fade-in and ends with its fade-out, in which others overlap.
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
        swaying = {name: angle + sway[name][span] for name, angle in angles.items()}
        weight = compute_weight(part)
        turned = compute_joint_rotations(skeleton, swaying, heading[span])
        # As q and -q are one rotation: the sign that is nearer to what is there already.
        nearer = np.sign(np.einsum("fjc,fjc->fj", turned, rotations[span]))
        nearer[nearer == 0] = 1
        rotations[span] += weight[:, None, None] * nearer[..., None] * turned
        airborne[span] += weight * size * _compute_flight_height(part, phase, fps)
    # A weighted sum of quaternions, normalised, blends the actions.
    rotations /= np.linalg.norm(rotations, axis=2, keepdims=True)
    return rotations, airborne


def add_noise(
    skeleton: Skeleton, rotations: Floats, noise: float, rng: np.random.Generator
) -> Floats:
    """Return the rotations with a small random turn of every joint that carries something."""
    reach = np.zeros(skeleton.n_joints)
    # Children before parents: how far the longest chain below each joint reaches.
    for joint in range(skeleton.n_joints - 1, 0, -1):
        parent = skeleton.parents[joint]
        bone = float(np.linalg.norm(skeleton.offsets[joint]))
        reach[parent] = max(reach[parent], bone + reach[joint])
    # Turned by this angle, the far end moves by about the noise.
    angle = np.divide(noise, reach, out=np.zeros_like(reach), where=reach > 0)
    vectors = rng.normal(size=(*rotations.shape[:2], 3)) * angle[:, None] / 2
    # A small rotation as (1, half its vector), normalised below.
    shakes = np.concatenate([np.ones((*rotations.shape[:2], 1)), vectors], axis=2)
    turned = rot.multiply(rotations, shakes)
    return np.asarray(turned / np.linalg.norm(turned, axis=2, keepdims=True))


def _compute_flight_height(part: Part, phase: Floats, fps: float) -> Floats:
    """Metres above the floor of a body thrown up at each take-off."""
    period = np.diff(part.frames).mean() / fps
    share = phase - np.floor(phase)
    height = np.zeros(len(phase))
    for leaves, lands in ACTIONS[part.action.name].flights:
        # Height of a throw between take-off and landing: g/2 times time since and time until.
        since, until = (share - leaves) * period, (lands - share) * period
        height += _GRAVITY / 2 * np.maximum(since, 0) * np.maximum(until, 0)
    return height


def _draw_heading(parts: list[Part], frames: int, rng: np.random.Generator) -> Floats:
    """Degrees: the figure turns while it walks or runs, and only then."""
    heading = np.full(frames, rng.uniform(-180, 180))
    for part in parts:
        turn = rng.normal(0, _TURN_DEG)
        if ACTIONS[part.action.name].travels:
            start, stop = part.frames[0], part.frames[-1]
            share = np.clip((np.arange(frames) - start) / (stop - start), 0, 1)
            heading += turn * share * share * (3 - 2 * share)
    return heading


def _make_slow_noise(frames: int, sigma: float, rng: np.random.Generator) -> Floats:
    """Smooth noise of standard deviation 1."""
    # The filter needs values on both sides; they are cut off again.
    margin = int(4 * sigma)
    smooth = gaussian_filter1d(rng.normal(size=frames + 2 * margin), sigma)
    # A normal filter divides the deviation of white noise by this root.
    return np.asarray(smooth[margin : margin + frames] * np.sqrt(2 * np.sqrt(np.pi) * sigma))
