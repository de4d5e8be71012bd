"""Joined exercises: nothing is lost, nobody jumps, and the truth says what was joined."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from kineme.datasets import Action, synthesize
from kineme.datasets.sequences import Exercise, join_exercises
from kineme.errors import ParameterError
from kineme.recordings import Motion
from kineme.recordings.operations import resample, scale

FPS = 60.0


@pytest.fixture(scope="module")
def exercises() -> list[Exercise]:
    return [
        Exercise(name, synthesize([Action(name, times)], fps=FPS, seed=seed).motion, times)
        for name, times in (("squat", 1), ("walk", 2), ("jump", 1))
        for seed in (1, 2)
    ]


def fastest(motion: Motion) -> float:
    """Metres per second of the fastest joint at any time."""
    steps = np.linalg.norm(np.diff(motion.positions, axis=0), axis=2)
    return float(steps.max() * motion.fps)


def test_truth_tells_what_was_joined(exercises: list[Exercise]) -> None:
    squat, walk, jump = exercises[:2], exercises[2:4], exercises[4:]
    runs = [[*squat, squat[0]], walk, [*jump, *jump], squat, [*walk, walk[1], walk[0]]]
    made = join_exercises([each for run in runs for each in run], join=0.4)
    rows = made.truth.activities.select(made.truth.activities.kind == "activity")
    assert rows.label.tolist() == ["squat", "walk", "jump", "squat", "walk"]
    assert len({(row.label, row.cluster) for row in rows}) == 3
    counts = Counter(made.truth.primitives.activity.tolist())
    assert [counts[row.activity] for row in rows] == [3, 4, 4, 2, 8]  # a walk is two of them
    between = made.truth.activities.select(made.truth.activities.kind == "transition")
    np.testing.assert_allclose(between.stop_s - between.start_s, 0.4, atol=2 / FPS)


def test_no_frame_is_lost_and_nobody_jumps(exercises: list[Exercise]) -> None:
    turns = [exercises[i] for i in (0, 5, 3, 0, 2, 4)]  # no exercise follows itself
    made = join_exercises(turns, join=0.4)
    assert made.motion.n_frames == made.truth.n_frames
    assert made.motion.n_frames == sum(exercise.motion.n_frames for exercise in turns)
    assert fastest(made.motion) < 1.5 * max(fastest(exercise.motion) for exercise in exercises)
    jerky = join_exercises(turns, join=0.0)
    assert fastest(jerky.motion) > 2 * fastest(made.motion)


def test_the_middle_of_an_exercise_is_the_recorded_movement(exercises: list[Exercise]) -> None:
    made = join_exercises([exercises[0], exercises[2]], join=0.2)
    middle = slice(0, made.truth.activities[0].stop_frame)
    np.testing.assert_allclose(
        made.motion.positions[middle], exercises[0].motion.positions[middle], atol=1e-9
    )


def test_bones_keep_their_length(exercises: list[Exercise]) -> None:
    motion = join_exercises(exercises).motion
    for joint, parent in enumerate(motion.skeleton.parents):
        if parent >= 0:
            bone = np.linalg.norm(motion.positions[:, joint] - motion.positions[:, parent], axis=1)
            np.testing.assert_allclose(bone, np.linalg.norm(motion.skeleton.offsets[joint]))


def test_the_next_exercise_goes_on_where_the_last_one_ended(exercises: list[Exercise]) -> None:
    made = join_exercises([*exercises, *exercises[::-1]])
    steps = np.linalg.norm(np.diff(made.motion.positions[:, 0, [0, 2]], axis=0), axis=1)
    recorded = max(
        np.linalg.norm(np.diff(e.motion.positions[:, 0, [0, 2]], axis=0), axis=1).max()
        for e in exercises
    )
    assert steps.max() <= recorded + 1e-9


def test_what_does_not_fit_is_said(exercises: list[Exercise]) -> None:
    slower = Exercise("kick", resample(exercises[0].motion, 30))
    larger = Exercise("kick", scale(exercises[0].motion, 1.2))
    for stranger in (slower, larger):
        with pytest.raises(ParameterError, match="does not fit"):
            join_exercises([*exercises, stranger])
    with pytest.raises(ParameterError, match="repetitions"):
        Exercise("kick", exercises[0].motion, 0)
