"""Repetitions of one action that are two movements get clusters of their own."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

import kineme
from kineme.datasets import Action, synthesize
from kineme.methods.recurrence.preset import KINEME
from kineme.methods.recurrence.repeating.parts import clusters_of_repetitions
from loops import nod

FRAMES = 30


def clusters(heights: list[float], actions: list[int], seed: int = 0, turn: int = 0) -> list[int]:
    """Of nods so high, each activity's from another phase on; a new activity per change of height.

    Every frame and every height is a little different.
    """
    rng = np.random.default_rng(seed)
    rows = [nod(1, period=1, height=height * rng.normal(1, 0.05)) for height in heights]
    activities = np.cumsum(np.diff(heights, prepend=heights[0]) != 0)
    rows = [np.roll(row, turn * at, axis=0) for row, at in zip(rows, activities, strict=True)]
    poses = np.concatenate(rows) + rng.normal(0, 0.01, (FRAMES * len(heights), 6))
    borders = FRAMES * np.arange(len(heights) + 1)
    found = clusters_of_repetitions(
        poses.astype(np.float32), borders, np.array(actions), activities, KINEME
    )
    return found.tolist()


def test_deep_and_shallow_are_two_clusters_of_one_action() -> None:
    """The most frequent keeps the number of the action, the other is counted on."""
    heights = [0.2] * 4 + [0.6] * 6
    assert clusters(heights, [0] * 10) == [1] * 4 + [0] * 6
    assert clusters(heights[::-1], [0] * 10, turn=7) == [0] * 6 + [1] * 4
    assert clusters([*heights, *heights], [0] * 10 + [1] * 10)[10:] == [3] * 4 + [1] * 6


def test_what_differs_little_or_by_phase_alone_is_one_cluster() -> None:
    assert clusters([0.4] * 6 + [0.41] * 6, [0] * 12, turn=9) == [0] * 12
    assert clusters([0.4] * 8 + [0.9], [0] * 9) == [0] * 9  # one of its kind is an exception


def test_what_is_no_repetition_is_in_no_cluster() -> None:
    assert clusters([0.2] * 4 + [0.6] * 4, [-1] * 8) == [-1] * 8
    assert clusters([0.4] * 4 + [0.6], [0, 0, 0, 0, -1]) == [0, 0, 0, 0, -1]


@given(st.integers(0, 10_000), st.integers(1, 40))
@settings(max_examples=60)
def test_repetitions_that_differ_by_chance_are_not_divided(seed, count) -> None:
    assert clusters([0.4] * count, [0] * count, seed) == [0] * count


def test_squats_of_two_depths_are_told_apart_in_a_recording() -> None:
    acts = [Action("walk", 4), *(Action("squat", 5, amplitude=size) for size in (1, 0.5))]
    found = kineme.segment(synthesize([*acts, Action("walk", 4)], fps=60, seed=0).motion)
    rows = found.primitives.select(found.primitives.kind == "activity")
    assert sorted(found.repetitions().values()) == [5, 5, 8]
    squats = rows.cluster[rows.action == 1]
    assert len(squats) == 10
    assert squats[:5].tolist() == squats[:1].tolist() * 5
    assert squats[5:].tolist() == squats[5:6].tolist() * 5
    assert squats[0] != squats[5]
