"""Generate synthetic motions with known borders and repetitions.

A recording is a sequence of actions. Between two of them is a transition of 0.5 to 1 s, in which
the figure slows down, blends into the next action and speeds up. Repetitions vary in pace and size
by a few per cent, and the whole body sways. All random values depend on the seed only.

The truth is an ordinary segmentation: activities and transitions on one level, repetitions on the
other (``cluster`` numbers the actions, ``label`` names them; standing has no repetitions and no
cluster).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from kineme.datasets.actions import ACTIONS
from kineme.datasets.figure import make_figure
from kineme.datasets.performance import add_noise, compute_root_path, perform
from kineme.datasets.timeline import Action, make_true_segments, schedule_actions
from kineme.errors import ParameterError
from kineme.recordings import Motion, Provenance
from kineme.segments.segmentation import Segmentation


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
