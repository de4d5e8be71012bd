"""Generate synthetic motions with known borders and repetitions.

A recording is a sequence of actions. Between two of them is a transition of 0.5 to 1 s, in which
the figure slows down, blends into the next action and speeds up. Repetitions vary in pace and size
by a few per cent, and the whole body sways. All random values depend on the seed only.

The truth is an ordinary segmentation: activities and transitions on one level, repetitions on the
other (``cluster`` numbers the actions, ``label`` names them; standing has no repetitions and no
cluster).

The motion follows from the schedule: joint rotations blend the actions, then the root moves. The
lowest contact (heels and toes) is put on the floor, and the figure moves so that supporting
contacts do not slide. In flight it follows a ballistic curve at constant horizontal speed. Contacts
are combined by soft minima, which avoids jerks when the support changes.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from scipy.ndimage import gaussian_filter1d

from kineme._util import rotations as rot
from kineme._util.arrays import Floats
from kineme.datasets.figure import (
    ACTIONS,
    ANGLES,
    compute_joint_rotations,
    make_figure,
    mirror_posture,
)
from kineme.errors import ParameterError
from kineme.recordings import Motion, Provenance, Skeleton
from kineme.recordings.kinematics import compute_world_rotations
from kineme.segments.segmentation import Segmentation

Row = tuple[str, str, int, int, int, str]
"""Level, kind, first frame, one past the last frame, cluster and label."""
_TRANSITION_S = (0.5, 1.0)
_PACE_VARIES = 0.05  # standard deviation, relative
_SIZE_VARIES = 0.06  # standard deviation, relative
_SWAY_DEG = 1.5
_SWAY_S = 0.35
_TURN_DEG = 120.0  # standard deviation of the turn over one bout of walking
_GRAVITY = 9.81
_HEEL = np.array([1.0, 1.0, -0.4])  # heel position, relative to the vector from ankle to ball
_FLOOR_SHARED = 0.006  # metres of height within which contacts share the support
_GRIP_SHARED = 0.01
_SMOOTHING_S = 0.025


@dataclass(frozen=True)
class Action:
    """An action: "walk", "run", "jump", "squat", "kick", ... (see ``ACTIONS``).

    Parameters
    ----------
    name : str
        A key of ``ACTIONS``.
    repetitions : int, optional
        Number of strides, jumps, kicks, ...; for "stand", seconds.
    speed : float, optional
        Relative speed; 2 is twice as fast.
    amplitude : float, optional
        Relative amplitude; 0.5 moves half as far.
    side : str, optional
        "right" or "left", for kicks, punches and waves.

    Examples
    --------
    >>> from kineme.datasets import Action, synthesize
    >>> actions = Action("walk", 2), Action("jump", 3, amplitude=0.5)
    >>> synthesize(actions, fps=30).truth.repetitions()
    {0: 2, 1: 3}
    """

    name: str
    repetitions: int = 4
    speed: float = 1.0
    amplitude: float = 1.0
    side: str = "right"

    def __post_init__(self) -> None:
        if self.name not in ACTIONS:
            raise ParameterError(f"no action {self.name!r}; there are {', '.join(ACTIONS)}")
        if self.repetitions < 1:
            raise ParameterError(f"repetitions must be at least 1, not {self.repetitions}")
        if not self.speed > 0 or not self.amplitude > 0:
            raise ParameterError(
                f"speed and amplitude must be positive, not {self.speed} and {self.amplitude}"
            )
        if self.side not in ("left", "right"):
            raise ParameterError(f"side must be 'left' or 'right', not {self.side!r}")


@dataclass(frozen=True)
class SyntheticRecording:
    """A motion and its true segments.

    Examples
    --------
    >>> from kineme.datasets import random_recording
    >>> made = random_recording(1, activities=3, fps=30)
    >>> made.motion.n_frames == made.truth.n_frames
    True
    """

    motion: Motion
    truth: Segmentation


def synthesize(
    actions: Iterable[Action],
    *,
    fps: float = 120.0,
    size: float = 1.75,
    noise: float = 0.0,
    seed: int = 0,
) -> SyntheticRecording:
    """Return the motion of a figure that performs actions in order, and its true segments.

    Parameters
    ----------
    actions : iterable of Action
        Actions in order.
    fps : float, optional
        Frames per second.
    size : float, optional
        Height of the figure in metres.
    noise : float, optional
        Standard deviation in metres of random noise in every frame: each joint turns so that the
        far end of its chain moves by about this distance.
    seed : int, optional
        Random seed; the same seed gives the same recording.

    Raises
    ------
    ParameterError
        No actions, or an invalid value.

    Examples
    --------
    >>> from kineme.datasets import Action, synthesize
    >>> synthesize([Action("walk", 2), Action("squat", 3)], fps=30).motion.n_frames
    289
    """
    sequence = tuple(actions)
    if not sequence:
        raise ParameterError("at least one action is needed")
    if not fps >= 10 or not size > 0 or not noise >= 0:
        raise ParameterError(
            f"fps must be at least 10, size positive and noise not negative, "
            f"not {fps}, {size} and {noise}"
        )
    rng = np.random.default_rng(seed)
    skeleton = make_figure(size)
    parts = schedule_actions(sequence, fps, rng)
    rotations, airborne = perform(parts, skeleton, fps, rng)
    path = compute_root_path(skeleton, rotations, airborne, fps)
    if noise:
        rotations = add_noise(skeleton, rotations, noise, rng)
        path = path + rng.normal(0, noise, path.shape)
    provenance = Provenance(format="synthetic").noted(f"synthetic recording, seed {seed}")
    motion = Motion.from_rotations(skeleton, rotations, fps, path, provenance=provenance)
    return SyntheticRecording(motion, make_true_segments(parts, fps))


def random_recording(
    seed: int, *, activities: int = 6, fps: float = 120.0, noise: float = 0.0
) -> SyntheticRecording:
    """Return a person who walks between exercises, each repeated three to eight times.

    Parameters
    ----------
    seed : int
        Random seed of exercises, counts, paces, sizes, sides and the height of the person.
    activities : int, optional
        Number of activities; every other one is walking.
    fps, noise : float, optional
        As for `synthesize`.

    Raises
    ------
    ParameterError
        More activities than there are exercises.

    Examples
    --------
    >>> from kineme.datasets import random_recording
    >>> random_recording(1, activities=3, fps=30).truth.activities.label.tolist()
    ['punch', '', 'walk', '', 'run']
    """
    rng = np.random.default_rng(seed)
    exercises = [name for name in ACTIONS if name not in ("walk", "stand")]
    # Every other activity is an exercise, and no exercise occurs twice.
    if not 1 <= activities <= 2 * len(exercises):
        raise ParameterError(f"activities must be 1 to {2 * len(exercises)}, not {activities}")
    drawn = iter(rng.permutation(exercises).tolist())
    first = int(rng.integers(2))
    sequence = []
    for place in range(activities):
        name = "walk" if place % 2 == first else next(drawn)
        sequence.append(
            Action(
                name,
                repetitions=int(rng.integers(3, 9)),
                speed=float(rng.uniform(0.85, 1.15)),
                amplitude=float(rng.uniform(0.85, 1.1)),
                side=("left", "right")[rng.integers(2)],
            )
        )
    size = float(rng.uniform(1.55, 1.95))
    return synthesize(sequence, fps=fps, size=size, noise=noise, seed=seed)


@dataclass(frozen=True)
class Part:
    """A scheduled action: first frames of its repetitions, their end, and fades in frames."""

    action: Action
    frames: NDArray[np.int64]
    fade_in: int
    fade_out: int


def schedule_actions(actions: Sequence[Action], fps: float, rng: np.random.Generator) -> list[Part]:
    """Schedule actions in order, with random variation of each repetition's duration."""
    parts: list[Part] = []
    now, fade_in = 0, 0
    for place, action in enumerate(actions):
        seconds = ACTIONS[action.name].seconds / action.speed
        # Random durations around the usual one.
        durations = seconds * (1 + rng.normal(0, _PACE_VARIES, action.repetitions))
        # Round cumulative sums, so that rounding errors do not add up.
        frames = now + np.rint(np.cumsum([0.0, *durations]) * fps).astype(np.int64)
        if np.diff(frames).min() < 3:
            raise ParameterError(
                f"{action.name!r} at speed {action.speed:g} is too fast for {fps:g} Hz"
            )
        last = place == len(actions) - 1
        fade_out = 0 if last else round(rng.uniform(*_TRANSITION_S) * fps)
        parts.append(Part(action, frames, fade_in, fade_out))
        # The next action fades in while this one fades out.
        now, fade_in = int(frames[-1]) + fade_out, fade_out
    return parts


def make_true_segments(parts: list[Part], fps: float) -> Segmentation:
    """Return activities, transitions and repetitions as a segmentation."""
    kinds = list(dict.fromkeys(map(_get_kind, parts)))
    rows: list[Row] = []

    def add(level: str, kind: str, start: int, stop: int, label: str, cluster: int = -1) -> None:
        if stop > start:
            rows.append((level, kind, start, stop, cluster, label))

    for part in parts:
        name, frames = part.action.name, part.frames.tolist()
        cluster = -1 if name == "stand" else kinds.index(_get_kind(part))
        borders = [frames[0], frames[-1]] if name == "stand" else frames
        add("activity", "activity", frames[0], frames[-1], name, cluster)
        for start, stop in pairwise(borders):
            add("primitive", "primitive", start, stop, name, cluster)
        for level in ("activity", "primitive"):
            add(level, "transition", frames[-1], frames[-1] + part.fade_out, "")
    return make_segmentation(rows, int(parts[-1].frames[-1]), fps)


def _get_kind(part: Part) -> tuple[str, str]:
    """Return what identifies the movement of an action: name, and side if relevant."""
    name = part.action.name
    return name, part.action.side if ACTIONS[name].one_sided else ""


def make_segmentation(rows: Sequence[Row], n_frames: int, fps: float) -> Segmentation:
    """Return rows of known truth as a segmentation."""
    keys = ("level", "kind", "start_frame", "stop_frame", "cluster", "label")
    return Segmentation.from_columns(
        dict(zip(keys, map(list, zip(*rows, strict=True)), strict=True)),
        n_frames=n_frames,
        fps=fps,
        provenance={"notes": ["known by construction"]},
    )


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


def compute_phase(part: Part) -> Floats:
    """Return the phase in cycles at each frame; pace rises and falls during the fades."""
    frames = part.frames.astype(float)
    cycles = np.arange(len(frames), dtype=float)
    # Monotone cubic through the borders: the pace changes smoothly and is never negative.
    inside = PchipInterpolator(frames, cycles) if len(frames) > 2 else None
    at = np.arange(frames[0], frames[-1])
    between = inside(at) if inside else np.interp(at, frames, cycles)
    # The run-up is a reversed run-down before the first cycle.
    run_up = _slow_down(part.fade_in, frames[1] - frames[0])[::-1]
    run_down = _slow_down(part.fade_out, frames[-1] - frames[-2])
    return np.concatenate([-run_up, between, cycles[-1] + run_down])


def _slow_down(fade: int, period: float) -> Floats:
    """Return cycles completed while the pace falls linearly to 0 in the first half of the fade."""
    ramp = max(fade / 2, 1.0)
    # After half of the fade the figure stands still.
    elapsed = np.minimum(np.arange(fade), ramp)
    # Integral of a pace that falls linearly to 0.
    return np.asarray((elapsed - elapsed**2 / (2 * ramp)) / period)


def compute_weight(part: Part) -> Floats:
    """Return the weight of an action at each frame: 1, rising and falling during the fades."""
    rise = np.linspace(0, 1, part.fade_in, endpoint=False)
    fall = np.linspace(1, 0, part.fade_out, endpoint=False)
    weight = np.concatenate([rise, np.ones(part.frames[-1] - part.frames[0]), fall])
    # Smoothstep: no slope at either end.
    return np.asarray(weight * weight * (3 - 2 * weight))


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
