"""Which movements are one action, and which are none, on recordings of known blocks."""

from __future__ import annotations

import numpy as np
import pytest

from kineme.methods.recurrence.linking import link, repeating
from kineme.methods.recurrence.preset import KINEME
from loops import measured, swing

OPTIONS = {
    "similarity": 0.6, "softness": 1.3, "samples": 20, "least": 0.05, "narrow": 7,
    "gap_share": 0.25, "common": 0.35, "part": 3000,
}  # fmt: skip


def test_an_action_is_known_again() -> None:
    walk, turn = swing(8, period=1), swing(10, period=1.2, axis=2)
    found = measured(walk, turn, walk, turn, turn)
    borders = np.array([0, 80, 200, 280, 400, 520])
    linked = link(borders, found, found.features, **OPTIONS, max_lag=None)
    assert linked.tolist() == [0, 1, 0, 1, 1]
    # 12 s away is too far to be compared, 0 s is not.
    near_by = link(borders, found, found.features, **OPTIONS, max_lag=60)
    assert near_by.tolist() == [0, 1, 2, 3, 3]


@pytest.mark.parametrize("part", [60, 200, 300])
@pytest.mark.parametrize("max_lag", [None, 60])
def test_what_is_linked_part_by_part_is_known_again(part: int, max_lag: int | None) -> None:
    walk, turn = swing(8, period=1), swing(10, period=1.2, axis=2)
    found = measured(walk, turn, walk, turn, turn)
    borders = np.array([0, 80, 200, 280, 400, 520])

    def linked(part: int) -> list[int]:
        options = {**OPTIONS, "part": part, "max_lag": max_lag}
        return link(borders, found, found.features, **options).tolist()

    assert linked(part) == linked(len(found))


def test_who_stands_before_two_movements_makes_them_no_one_action() -> None:
    def after_standing(axis: int) -> np.ndarray:
        rows = np.zeros((174, 6))
        rows[24:, axis] = np.linspace(0, 3, 150)
        return rows

    found = measured(after_standing(2), swing(8, period=1), after_standing(4))
    borders = np.array([0, 58, 138, 196])
    assert link(borders, found, found.features, **OPTIONS, max_lag=None).tolist() == [0, 1, 2]


def test_what_recurs_nowhere_does_not_repeat() -> None:
    away = np.linspace(0, 5, 180)[:, None] * [0, 0, 0, 0, 1, 0]
    found = measured(swing(8, period=1), away, swing(8, period=1, axis=2))
    borders, labels = np.array([0, 80, 140, 220]), np.array([0, 1, 2])
    assert repeating(borders, labels, found, KINEME).tolist() == [True, False, True]
    shared = np.array([0, 1, 1])  # the same action elsewhere is repetition enough
    assert repeating(borders, shared, found, KINEME).all()


@pytest.mark.parametrize(("times", "repeats"), [(2, True), (1, False)])
def test_what_repeats_within_the_phase_window_is_counted(times: int, repeats: bool) -> None:
    short = swing(times, period=1.5 / times, axis=2)
    found = measured(swing(8, period=1), short, swing(8, period=1.1, axis=4))
    borders = np.array([0, 80, 95, len(found)])
    assert repeating(borders, np.arange(3), found, KINEME).tolist() == [True, repeats, True]
