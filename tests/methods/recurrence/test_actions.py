"""Moments given to the action that they are most like, or to none."""

from __future__ import annotations

import numpy as np

from kineme.methods.recurrence.actions import refine
from loops import measured, swing

COSTS = {
    "least_similarity": 0.2,
    "least_own": 0.05,
    "rounds": 2,
    "switch_cost": 6.0,
    "no_action_cost": 0.55,
    "min_length": 10,
}


WALK, TURN = swing(8, period=1), swing(10, period=1.2, axis=2)


def leap(seconds: float) -> np.ndarray:
    """Away and back, never through the same place."""
    angle = np.pi * np.arange(round(30 * seconds))[:, None] / round(30 * seconds)
    return np.hstack([np.zeros((len(angle), 4)), 2 * np.sin(angle), 1 - np.cos(angle)])


def test_borders_move_to_where_the_evidence_turns() -> None:
    found = refine(np.array([0, 88, 200]), np.array([0, 1]), measured(WALK, TURN), **COSTS)
    np.testing.assert_allclose(found.borders, [0, 80, 200], atol=2)
    assert found.labels.tolist() == [0, 1]
    assert (found.confidence > 0.8).all()


def test_neighbours_of_one_action_become_one_stretch() -> None:
    found = refine(np.array([0, 40, 80, 200]), np.array([0, 0, 1]), measured(WALK, TURN), **COSTS)
    assert found.labels.tolist() == [0, 1]
    assert len(found.borders) == 3


def test_what_is_like_no_action_belongs_to_none() -> None:
    recording = measured(WALK, leap(3), TURN)
    found = refine(np.array([0, 90, 230]), np.array([0, 1]), recording, **COSTS)
    assert found.labels.tolist() == [0, -1, 1]
    np.testing.assert_allclose(found.borders, [0, 80, 110, 230], atol=3)
    assert found.confidence[1] == 0


def test_labels_count_anew_once_an_action_is_given_up() -> None:
    found = refine(np.array([0, 80, 200]), np.array([-1, 0]), measured(WALK, TURN), **COSTS)
    assert found.labels.tolist() == [-1, 0]


def test_with_no_action_at_all_there_is_one_stretch() -> None:
    found = refine(np.array([0, 200]), np.array([-1]), measured(WALK, TURN), **COSTS)
    assert (found.borders.tolist(), found.labels.tolist()) == ([0, 200], [-1])
    assert found.confidence.tolist() == [0]


def test_actions_out_of_reach_of_each_other_share_the_work_and_not_the_result() -> None:
    """In a narrow band four actions have two columns, and each moment its own action still."""
    parts = [swing(8, period=1, axis=axis) for axis in (0, 2, 4, 1)]
    borders, labels = np.array([0, 83, 158, 241, 320]), np.arange(4)
    wide = refine(borders, labels, measured(*parts), **COSTS)
    narrow = refine(borders, labels, measured(*parts, width=50), **COSTS)
    assert wide.labels.tolist() == narrow.labels.tolist() == [0, 1, 2, 3]
    np.testing.assert_allclose(narrow.borders, wide.borders, atol=2)
