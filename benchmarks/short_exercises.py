"""Twelve short exercises in one recording, two or three repetitions each: are they told apart?

    python benchmarks/short_exercises.py [--every 4]

Cuts of HDM05 at their own pace, 0.7 to 3.7 s for a repetition, half of them mirrored, so that
most exercises last 2 to 6 s: close to what one repetition of a long exercise lasts. They
follow each other directly, or somebody stands for half a second to two seconds between
them. Means over actors in turn, 24 seeds.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import replace
from functools import cache

import numpy as np

import kineme
from _options import command_line, few
from _recordings import ACTORS, Case, annotation, exercises
from fairness import mean, show
from kineme.datasets import Exercise, join_exercises
from kineme.evaluation import evaluate_segmentation
from kineme.recordings import Motion

PROMISED = {"one_to_one": 0.90, "border_f1": 0.85}
BOTH_SIDES = ("hop", "squat", "rotateArmsBoth")
CONDITIONS = ("back to back", "standing between")
NUMBER = 12
LONGEST = 4.0
"""Seconds: longer cuts are left out."""


def cases(condition: str, seeds: int) -> Iterator[Case]:
    """Recordings of a condition, actors in turn."""
    for seed in range(few(seeds, 1)):
        actor = ACTORS[seed % len(ACTORS)]
        rng = np.random.default_rng(seed)
        by_name = _both_sides(actor)
        parts: list[Exercise] = []
        for name in rng.permutation(sorted(by_name))[:NUMBER].tolist():
            if condition == "standing between":
                parts.append(_standing(by_name["grabHighR"][0].motion, rng.uniform(0.5, 2.0)))
            takes = by_name[name]
            order = rng.permutation(len(takes))[: int(rng.integers(2, 4))]
            parts += [takes[at] for at in order]
        made = join_exercises(parts)
        yield Case(f"{actor} {seed}", made.motion, annotation(made.truth))


@cache
def _both_sides(actor: str) -> dict[str, list[Exercise]]:
    """The exercises of an actor by name, and those that have a side mirrored, too."""
    found: dict[str, list[Exercise]] = {}
    for exercise in exercises(actor):
        if exercise.motion.duration <= LONGEST:
            found.setdefault(exercise.name, []).append(exercise)
    sided = [name for name in found if not name.startswith(BOTH_SIDES)]
    for name in sided:
        other = f"{name} mirrored"
        found[other] = [
            replace(each, name=other, motion=_mirrored(each.motion)) for each in found[name]
        ]
    return found


def _mirrored(motion: Motion) -> Motion:
    """What the motion would be with left and right exchanged, done by the same body."""
    other = kineme.mirror(motion)
    return Motion.from_rotations(
        motion.skeleton, other.rotations, motion.fps, root_positions=other.positions[:, 0]
    )


def _standing(motion: Motion, seconds: float) -> Exercise:
    """Somebody stands as the motion begins: to and fro over its first tenth of a second."""
    first = round(0.1 * motion.fps)
    there = np.concatenate([np.arange(first), np.arange(first)[::-1]])
    at = np.resize(there, round(seconds * motion.fps))
    rotations = np.asarray(motion.rotations)
    return Exercise(
        "stand",
        Motion.from_rotations(
            motion.skeleton, rotations[at], motion.fps, root_positions=motion.positions[at, 0]
        ),
    )


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--every", type=int, default=1, help="one in so many seeds")
    seeds = 24 // parser.parse_args().every
    for condition in CONDITIONS:
        rows = [
            evaluate_segmentation(case.truth, kineme.segment(case.motion))
            for case in cases(condition, seeds)
        ]
        show(condition, {"kineme": mean(rows)}, PROMISED)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
