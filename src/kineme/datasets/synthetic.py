"""Motions made from formulas, of which every border and repetition is known.

A recording is a sequence of actions. Between two of them lies a transition of
half a second to a second, in which the figure slows down, changes over and
takes up the next. No two repetitions are alike: their pace and size vary by a
few per cent and the whole body sways. Everything random comes from the seed.

The truth is a segmentation like any other: activities and transitions on one
level, repetitions on the other (``cluster`` numbers the actions, ``label``
names them; standing has no repetitions and no cluster).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from scipy.ndimage import gaussian_filter1d

from kineme import _rotations as rot
from kineme.datasets.actions import ACTIONS, mirrored
from kineme.datasets.figure import ANGLES, figure, joint_rotations
from kineme.datasets.ground import root_path
from kineme.errors import ParameterError
from kineme.motion import Motion, Provenance, Skeleton
from kineme.segmentation.result import Segmentation

Floats = NDArray[np.float64]

_GRAVITY = 9.81
_TRANSITION_S = (0.5, 1.0)
_PACE_VARIES = 0.05  # standard deviations, relative
_SIZE_VARIES = 0.06
_SWAY_DEG = 1.5
_SWAY_S = 0.35
_TURN_DEG = 120.0  # standard deviation of the turn over one stretch of walking


@dataclass(frozen=True)
class Action:
    """Something to do: "walk", "run", "jump", "squat", "kick", ... (see ``ACTIONS``).

    Parameters
    ----------
    name : a key of ``ACTIONS``
    repetitions : double steps, jumps, kicks, ...; for "stand", seconds
    speed : 2 is twice as fast
    amplitude : 0.5 moves half as far
    side : "right" or "left", for kicks, punches and waves
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
    """A motion and its true segments."""

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
    """A figure doing one action after the other, and where each begins and ends.

    Parameters
    ----------
    actions : what to do, in order
    fps : frames per second
    size : height of the figure in metres
    noise : standard deviation in metres of a shake of every joint, new in every
        frame: each turns by so much that the far end of what it carries moves
        this far
    seed : of everything random; the same seed gives the same recording

    Raises
    ------
    ParameterError : no actions, or a value that makes no recording
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
    skeleton = figure(size)
    parts = _schedule(sequence, fps, rng)
    rotations, airborne = _perform(parts, skeleton, fps, rng)
    path = root_path(skeleton, rotations, airborne, fps)
    if noise:
        rotations = _shaken(skeleton, rotations, noise, rng)
        path = path + rng.normal(0, noise, path.shape)
    provenance = Provenance(format="synthetic", notes=(f"synthetic recording, seed {seed}",))
    motion = Motion.from_rotations(skeleton, rotations, fps, path, provenance=provenance)
    return SyntheticRecording(motion, _truth(parts, fps))


def random_recording(
    seed: int, *, activities: int = 6, fps: float = 120.0, noise: float = 0.0
) -> SyntheticRecording:
    """A person walking between different exercises, each repeated three to eight times.

    Parameters
    ----------
    seed : draws exercises, counts, paces, sizes, sides and the height of the person
    activities : how many, every other one walking
    fps, noise : as for `synthesize`
    """
    rng = np.random.default_rng(seed)
    exercises = [name for name in ACTIONS if name not in ("walk", "stand")]
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
class _Part:
    """An action with its place in time: first frames of its repetitions, and their end."""

    action: Action
    frames: NDArray[np.int64]
    fade_in: int
    fade_out: int


def _schedule(actions: Sequence[Action], fps: float, rng: np.random.Generator) -> list[_Part]:
    parts: list[_Part] = []
    now, fade_in = 0, 0
    for place, action in enumerate(actions):
        seconds = ACTIONS[action.name].seconds / action.speed
        lasting = seconds * (1 + rng.normal(0, _PACE_VARIES, action.repetitions))
        frames = now + np.rint(np.cumsum([0.0, *lasting]) * fps).astype(np.int64)
        last = place == len(actions) - 1
        fade_out = 0 if last else round(rng.uniform(*_TRANSITION_S) * fps)
        parts.append(_Part(action, frames, fade_in, fade_out))
        now, fade_in = int(frames[-1]) + fade_out, fade_out
    return parts


def _perform(
    parts: list[_Part], skeleton: Skeleton, fps: float, rng: np.random.Generator
) -> tuple[Floats, Floats]:
    """Joint rotations (frames, joints, 4) and metres above the floor (frames,)."""
    frames = int(parts[-1].frames[-1])
    rotations = np.zeros((frames, skeleton.n_joints, 4))
    airborne = np.zeros(frames)
    heading = _heading(parts, frames, rng)
    sway = {name: _SWAY_DEG * _slow_noise(frames, _SWAY_S * fps, rng) for name in ANGLES}
    for part in parts:
        start, stop = part.frames[0] - part.fade_in, part.frames[-1] + part.fade_out
        span = slice(start, stop)
        phase = _phase(part)
        sizes = part.action.amplitude * (1 + rng.normal(0, _SIZE_VARIES, part.action.repetitions))
        size = np.interp(phase, np.arange(len(sizes)) + 0.5, sizes)
        cycle = ACTIONS[part.action.name]
        angles = cycle.angles_at(phase, size)
        if part.action.side == "left" and not cycle.gait:
            angles = mirrored(angles)
        swaying = {name: angle + sway[name][span] for name, angle in angles.items()}
        weight = _weight(part)
        turned = joint_rotations(skeleton, swaying, heading[span])
        nearer = np.sign(np.einsum("fjc,fjc->fj", turned, rotations[span]))
        nearer[nearer == 0] = 1
        rotations[span] += weight[:, None, None] * nearer[..., None] * turned
        airborne[span] += weight * size * _flight(part, phase, fps)
    rotations /= np.linalg.norm(rotations, axis=2, keepdims=True)
    return rotations, airborne


def _phase(part: _Part) -> Floats:
    """Cycles done at each frame, fades included: they run up to and down from full pace."""
    frames = part.frames.astype(float)
    cycles = np.arange(len(frames), dtype=float)
    inside = PchipInterpolator(frames, cycles) if len(frames) > 2 else None
    at = np.arange(frames[0], frames[-1])
    between = inside(at) if inside else np.interp(at, frames, cycles)
    run_up = _run_down(part.fade_in, frames[1] - frames[0])[::-1]
    run_down = _run_down(part.fade_out, frames[-1] - frames[-2])
    return np.concatenate([-run_up, between, cycles[-1] + run_down])


def _run_down(fade: int, period: float) -> Floats:
    """Cycles gone while the pace falls evenly to nothing within half of the fade."""
    ramp = max(fade / 2, 1.0)
    gone = np.minimum(np.arange(fade), ramp)
    return np.asarray((gone - gone**2 / (2 * ramp)) / period)


def _weight(part: _Part) -> Floats:
    """1 during the action, rising and falling smoothly over the fades."""
    rise = np.linspace(0, 1, part.fade_in, endpoint=False)
    fall = np.linspace(1, 0, part.fade_out, endpoint=False)
    whole = np.concatenate([rise, np.ones(part.frames[-1] - part.frames[0]), fall])
    return np.asarray(whole * whole * (3 - 2 * whole))


def _flight(part: _Part, phase: Floats, fps: float) -> Floats:
    """Metres above the floor of a body thrown up at each take-off."""
    period = np.diff(part.frames).mean() / fps
    share = phase - np.floor(phase)
    height = np.zeros(len(phase))
    for leaves, lands in ACTIONS[part.action.name].flights:
        since, until = (share - leaves) * period, (lands - share) * period
        height += _GRAVITY / 2 * np.maximum(since, 0) * np.maximum(until, 0)
    return height


def _heading(parts: list[_Part], frames: int, rng: np.random.Generator) -> Floats:
    """Degrees: the figure turns while it walks or runs, and only then."""
    heading = np.full(frames, rng.uniform(-180, 180))
    for part in parts:
        turn = rng.normal(0, _TURN_DEG)
        if ACTIONS[part.action.name].travels:
            start, stop = part.frames[0], part.frames[-1]
            share = np.clip((np.arange(frames) - start) / (stop - start), 0, 1)
            heading += turn * share * share * (3 - 2 * share)
    return heading


def _slow_noise(frames: int, sigma: float, rng: np.random.Generator) -> Floats:
    """Smooth noise of standard deviation 1."""
    margin = int(4 * sigma)
    smooth = gaussian_filter1d(rng.normal(size=frames + 2 * margin), sigma)
    return np.asarray(smooth[margin : margin + frames] * np.sqrt(2 * np.sqrt(np.pi) * sigma))


def _shaken(
    skeleton: Skeleton, rotations: Floats, noise: float, rng: np.random.Generator
) -> Floats:
    """The rotations with a small random turn of every joint that carries something."""
    reach = np.zeros(skeleton.n_joints)
    for joint in range(skeleton.n_joints - 1, 0, -1):
        parent = skeleton.parents[joint]
        bone = float(np.linalg.norm(skeleton.offsets[joint]))
        reach[parent] = max(reach[parent], bone + reach[joint])
    angle = np.divide(noise, reach, out=np.zeros_like(reach), where=reach > 0)
    vectors = rng.normal(size=(*rotations.shape[:2], 3)) * angle[:, None] / 2
    shakes = np.concatenate([np.ones((*rotations.shape[:2], 1)), vectors], axis=2)
    shaken = rot.multiply(rotations, shakes)
    return np.asarray(shaken / np.linalg.norm(shaken, axis=2, keepdims=True))


def _truth(parts: list[_Part], fps: float) -> Segmentation:
    names = list(dict.fromkeys(part.action.name for part in parts))
    rows: list[tuple[str, str, int, int, int, str]] = []

    def add(level: str, kind: str, start: int, stop: int, label: str, cluster: int = -1) -> None:
        if stop > start:
            rows.append((level, kind, start, stop, cluster, label))

    for part in parts:
        name, frames = part.action.name, part.frames.tolist()
        cluster = -1 if name == "stand" else names.index(name)
        borders = [frames[0], frames[-1]] if name == "stand" else frames
        add("activity", "activity", frames[0], frames[-1], name, cluster)
        for start, stop in pairwise(borders):
            add("primitive", "activity", start, stop, name, cluster)
        for level in ("activity", "primitive"):
            add(level, "transition", frames[-1], frames[-1] + part.fade_out, "")
    columns = zip(*rows, strict=True)
    keys = ("level", "kind", "start_frame", "stop_frame", "cluster", "label")
    return Segmentation.from_columns(
        dict(zip(keys, map(list, columns), strict=True)),
        n_frames=int(parts[-1].frames[-1]),
        fps=fps,
        provenance={"notes": ["known by construction"]},
    )
