"""Where activities end and begin, and what lies between them."""

from __future__ import annotations

import numpy as np

from kineme.methods.recurrence.actions import Actions
from kineme.methods.recurrence.recurrence import Recurrence
from kineme.methods.recurrence.transitions import activity_ends, leading
from loops import measured, swing

ENDS = {"factor": 1.15, "spread": 0.3, "usual": 0.9, "largest_share": 0.25}
WALK, TURN = swing(8, period=1), swing(10, period=1.2, axis=2)


def leap(seconds: float) -> np.ndarray:
    """Away and back, never through the same place."""
    angle = np.pi * np.arange(round(30 * seconds))[:, None] / round(30 * seconds)
    return np.hstack([np.zeros((len(angle), 4)), 2 * np.sin(angle), 1 - np.cos(angle)])


def actions(*borders: int, labels: tuple[int, ...] = (0, 1)) -> Actions:
    return Actions(np.array(borders), np.array(labels), np.ones(len(labels)))


def ends(found: Actions, recording: Recurrence, longest: int) -> tuple[int, int]:
    (end,), (begin,) = activity_ends(found, recording, longest=longest, **ENDS)
    return int(end), int(begin)


def test_what_recurs_in_neither_activity_is_transition() -> None:
    recording = measured(WALK, leap(1), TURN)
    end, begin = ends(actions(0, 85, 210), recording, longest=8)
    # The leap begins in a pose of the first action.
    assert abs(end - 244) <= 4
    assert abs(begin - 270) <= 4


def test_a_transition_is_no_longer_than_asked() -> None:
    recording = measured(WALK, leap(1), TURN)
    assert ends(actions(0, 85, 210), recording, longest=2) == (249, 261)
    assert ends(actions(0, 85, 210), recording, longest=0) == (255, 255)


def test_activities_that_touch_have_no_transition_wherever_their_border_was_put() -> None:
    for border in (76, 80, 84):
        end, begin = ends(actions(0, border, 200), measured(WALK, TURN), longest=8)
        assert abs(end - 240) <= 6
        assert 0 <= begin - end <= 6


def test_a_rest_that_both_explain_is_cut_where_it_is_stillest() -> None:
    """Both rest in one pose between their bouts; from the one to the other the rest sways."""
    pose, still = WALK[:1], 20
    sway = np.repeat(pose, 2 * still, axis=0)
    sway[:, 3] += 0.004 * np.linspace(-1, 1, 2 * still) ** 3
    rest = np.repeat(pose, 2 * still, axis=0)
    rng = np.random.default_rng(0)
    bouts = [part + rng.normal(0, 0.02, part.shape) for part in 3 * [WALK] + 3 * [TURN]]
    gaps = [rest, rest, sway, rest, rest, rest[:0]]
    rows = np.concatenate([part for pair in zip(bouts, gaps, strict=True) for part in pair])
    stillest = 3 * len(WALK) + 5 * still
    for off in (-3, 3):
        found = actions(0, stillest // 3 + off, -(-len(rows) // 3))
        end, begin = ends(found, measured(rows), longest=8)
        assert end == begin
        assert abs(end - stillest) <= 6


def test_a_stretch_of_no_action_has_the_ends_its_neighbours_leave_it() -> None:
    recording = measured(WALK, leap(3), TURN)
    found = actions(0, 84, 106, 230, labels=(0, -1, 1))
    stops, starts = activity_ends(found, recording, longest=8, **ENDS)
    np.testing.assert_array_equal(stops, starts)
    np.testing.assert_allclose(stops, [244, 328], atol=6)


def test_what_is_known_of_no_activity_leaves_its_border() -> None:
    """Two stretches too short to recur."""
    recording = measured(swing(1, period=1), swing(1, period=1, axis=2))
    assert ends(actions(0, 10, 20), recording, longest=8) == (30, 30)


def test_leading_counts_the_first_true_values() -> None:
    masks = ([], [True, True], [False, True], [True, False, True])
    assert [leading(np.array(mask, bool)) for mask in masks] == [0, 2, 0, 1]
