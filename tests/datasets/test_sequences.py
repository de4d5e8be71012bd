"""Joined exercises: nothing is lost, nobody jumps, and the truth says what was joined."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import numpy as np
import pytest

from kineme.datasets import Action, synthesize
from kineme.datasets.sequences import Exercise, exercise_sequence
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
    made = exercise_sequence(exercises, 3, actions=3, runs=5, repeats=(2, 4), join=0.4)
    rows = made.truth.activities.select(made.truth.activities.kind == "activity")
    assert len(rows) == 5
    assert Counter(rows.label.tolist()).keys() == {"squat", "walk", "jump"}
    assert all(a != b for a, b in pairwise(rows.label))
    assert len({(row.label, row.cluster) for row in rows}) == 3
    counts = Counter(made.truth.primitives.activity.tolist())
    for row in rows:
        units = 2 if row.label == "walk" else 1
        assert counts[row.activity] in [units * n for n in (2, 3, 4)]
    between = made.truth.activities.select(made.truth.activities.kind == "transition")
    np.testing.assert_allclose(between.stop_s - between.start_s, 0.4, atol=2 / FPS)


def test_no_frame_is_lost_and_nobody_jumps(exercises: list[Exercise]) -> None:
    lengths = {exercise.motion.n_frames for exercise in exercises}
    made = exercise_sequence(exercises, 0, actions=3, runs=6, repeats=(1, 1), join=0.4)
    assert made.motion.n_frames == made.truth.n_frames
    assert made.motion.n_frames <= 6 * max(lengths)
    assert fastest(made.motion) < 1.5 * max(fastest(exercise.motion) for exercise in exercises)
    jerky = exercise_sequence(exercises, 0, actions=3, runs=6, repeats=(1, 1), join=0.0)
    assert fastest(jerky.motion) > 2 * fastest(made.motion)


def test_the_middle_of_an_exercise_is_the_recorded_movement(exercises: list[Exercise]) -> None:
    made = exercise_sequence(exercises, 1, actions=2, runs=2, repeats=(1, 1), join=0.2)
    first = made.truth.activities[0]
    taken = [e.motion for e in exercises if e.name == first.label]
    middle = slice(0, first.stop_frame)
    same = [
        np.allclose(made.motion.positions[middle], motion.positions[middle], atol=1e-9)
        for motion in taken
    ]
    assert any(same)


def test_bones_keep_their_length(exercises: list[Exercise]) -> None:
    motion = exercise_sequence(exercises, 5, actions=3, runs=4).motion
    for joint, parent in enumerate(motion.skeleton.parents):
        if parent >= 0:
            bone = np.linalg.norm(motion.positions[:, joint] - motion.positions[:, parent], axis=1)
            np.testing.assert_allclose(bone, np.linalg.norm(motion.skeleton.offsets[joint]))


def test_the_next_exercise_goes_on_where_the_last_one_ended(exercises: list[Exercise]) -> None:
    made = exercise_sequence(exercises, 2, actions=3, runs=6, repeats=(1, 2))
    steps = np.linalg.norm(np.diff(made.motion.positions[:, 0, [0, 2]], axis=0), axis=1)
    recorded = max(
        np.linalg.norm(np.diff(e.motion.positions[:, 0, [0, 2]], axis=0), axis=1).max()
        for e in exercises
    )
    assert steps.max() <= recorded + 1e-9


def test_one_seed_one_recording(exercises: list[Exercise]) -> None:
    one, same, other = (exercise_sequence(exercises, seed, actions=3) for seed in (7, 7, 8))
    np.testing.assert_array_equal(one.motion.positions, same.motion.positions)
    assert one.motion.n_frames != other.motion.n_frames or not np.array_equal(
        one.motion.positions, other.motion.positions
    )


def test_what_does_not_fit_is_said(exercises: list[Exercise]) -> None:
    with pytest.raises(ParameterError, match="at least two actions"):
        exercise_sequence(exercises[:1], 0)
    slower = Exercise("kick", resample(exercises[0].motion, 30))
    larger = Exercise("kick", scale(exercises[0].motion, 1.2))
    for stranger in (slower, larger):
        with pytest.raises(ParameterError, match="does not fit"):
            exercise_sequence([*exercises, stranger], 0)
    with pytest.raises(ParameterError, match="runs must be"):
        exercise_sequence(exercises, 0, repeats=(4, 2))
    with pytest.raises(ParameterError, match="repetitions"):
        Exercise("kick", exercises[0].motion, 0)
