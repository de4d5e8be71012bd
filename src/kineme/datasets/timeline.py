"""Schedule the actions, repetitions and transitions of a synthetic recording."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from kineme._util.arrays import Floats
from kineme.datasets.actions import ACTIONS
from kineme.errors import ParameterError
from kineme.segments.segmentation import Segmentation

Row = tuple[str, str, int, int, int, str]
"""Level, kind, first frame, one past the last frame, cluster and label."""

_TRANSITION_S = (0.5, 1.0)
_PACE_VARIES = 0.05  # standard deviation, relative


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


def make_segmentation(rows: Sequence[Row], n_frames: int, fps: float) -> Segmentation:
    """Return rows of known truth as a segmentation."""
    keys = ("level", "kind", "start_frame", "stop_frame", "cluster", "label")
    return Segmentation.from_columns(
        dict(zip(keys, map(list, zip(*rows, strict=True)), strict=True)),
        n_frames=n_frames,
        fps=fps,
        provenance={"notes": ["known by construction"]},
    )


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


def compute_weight(part: Part) -> Floats:
    """Return the weight of an action at each frame: 1, rising and falling during the fades."""
    rise = np.linspace(0, 1, part.fade_in, endpoint=False)
    fall = np.linspace(1, 0, part.fade_out, endpoint=False)
    weight = np.concatenate([rise, np.ones(part.frames[-1] - part.frames[0]), fall])
    # Smoothstep: no slope at either end.
    return np.asarray(weight * weight * (3 - 2 * weight))


def _slow_down(fade: int, period: float) -> Floats:
    """Return cycles completed while the pace falls linearly to 0 in the first half of the fade."""
    ramp = max(fade / 2, 1.0)
    # After half of the fade the figure stands still.
    elapsed = np.minimum(np.arange(fade), ramp)
    # Integral of a pace that falls linearly to 0.
    return np.asarray((elapsed - elapsed**2 / (2 * ramp)) / period)


def _get_kind(part: Part) -> tuple[str, str]:
    """Return what identifies the movement of an action: name, and side if relevant."""
    name = part.action.name
    return name, part.action.side if ACTIONS[name].one_sided else ""
