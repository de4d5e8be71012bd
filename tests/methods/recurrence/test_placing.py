"""Occurrences in their place: nothing is cut, periodic activities keep their repetitions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from kineme.methods.recurrence.repeating.occurrences import Occurrences
from kineme.methods.recurrence.repeating.placing import (
    Segments,
    interrupted,
    of_actions,
    placed,
    whole_activities,
    without_few,
)

BORDERS = np.array([0, 100, 130, 300, 400])
LABELS = np.array([0, -1, 1, 0])


def segments() -> Segments:
    """An activity of two repetitions, a transition, an activity of one, and the first again."""
    return Segments(
        BORDERS,
        LABELS,
        np.array([0.9, np.nan, 0.8, 0.7]),
        np.array([0, 50, 100, 130, 300, 400]),
        np.array([0, 0, -1, 1, 0]),
        np.empty(0, np.int64),
    )


def occurring(*spans: tuple[int, int]) -> Occurrences:
    starts, stops = np.array(spans, np.int64).reshape(-1, 2).T
    return Occurrences(starts, stops, np.zeros(len(spans), np.int64), np.full(len(spans), 0.5))


FREE = np.array([False, True, True, False])


def test_occurrences_and_what_lies_between_are_the_primitives() -> None:
    found = placed(segments(), occurring((140, 180), (220, 260)), FREE)
    assert found.primitives.tolist() == [0, 50, 100, 130, 140, 180, 220, 260, 300, 400]
    assert found.clusters.tolist() == [0, 0, -1, -1, 2, -1, 2, -1, 0]
    assert found.repeats.tolist() == [True, True] + 6 * [False] + [True]
    assert found.borders.tolist() == BORDERS.tolist()
    assert found.not_periodic.tolist() == [1]


def test_without_occurrences_a_free_activity_has_no_primitive() -> None:
    found = placed(segments(), occurring(), FREE)
    assert found.clusters.tolist() == [0, 0, -1, -1, 0]


def test_numbers_go_on_after_repetitions_that_are_another_movement() -> None:
    parts = replace(segments(), clusters=np.array([0, 3, -1, 2, 0]))
    found = placed(parts, occurring((140, 180), (220, 260)), FREE)
    assert found.clusters.tolist() == [0, 2, -1, -1, 3, -1, 3, -1, 0]
    untouched = placed(parts, occurring(), np.zeros(4, np.bool_))
    assert untouched.clusters.tolist() == [0, 2, -1, 3, 0]
    assert untouched.not_periodic.size == 0


def test_borders_go_to_the_nearer_end_of_an_occurrence() -> None:
    found = placed(segments(), occurring((120, 180), (220, 260)), FREE)
    assert found.borders.tolist() == [0, 100, 120, 300, 400]
    found = placed(segments(), occurring((100, 135), (220, 260)), FREE)
    assert found.borders.tolist() == [0, 100, 135, 300, 400]


def test_a_transition_that_an_occurrence_takes_is_gone() -> None:
    found = placed(segments(), occurring((100, 270), (280, 300)), FREE)
    assert found.borders.tolist() == [0, 100, 300, 400]
    assert found.labels.tolist() == [0, 1, 0]
    assert found.clusters.tolist() == [0, 0, 2, -1, 2, 0]


def test_what_recurs_nowhere_is_no_primitive_beside_what_does() -> None:
    lone = replace(segments(), labels=np.array([0, -1, 1, 2]), clusters=np.array([0, 0, -1, 1, 2]))
    time = np.arange(401.0)
    found = without_few(placed(lone, occurring((140, 180), (220, 260)), FREE), time, 1, 0)
    assert found.clusters.tolist() == [0, 0, -1, -1, 3, -1, 3, -1, -1]
    assert found.not_periodic.tolist() == [1, 2]
    assert without_few(lone, time, 1, 0).clusters.tolist() == lone.clusters.tolist()


@pytest.mark.parametrize(("few", "least", "kept"), [(2, 36, False), (2, 34, True), (1, 36, True)])
def test_few_single_repetitions_that_hardly_move_are_no_set(few, least, kept) -> None:
    twice = Segments(
        np.array([0, 30, 100, 140, 300]),
        np.array([0, -1, 0, 1]),
        np.array([0.9, np.nan, 0.9, 0.8]),
        np.array([0, 30, 100, 140, 180, 220, 260, 300]),
        np.array([0, -1, 0, -1, 2, -1, 2]),
        np.array([1]),
    )
    found = without_few(twice, np.arange(301.0), few, least)  # 30 and 40 long
    assert (found.clusters >= 0).tolist() == [kept, False, kept, False, True, False, True]


def test_an_occurrence_alone_in_an_activity_is_as_long_as_it() -> None:
    def widened(*spans: tuple[int, int]) -> list[tuple[int, int]]:
        found = whole_activities(occurring(*spans), segments(), FREE, 0.3)
        return list(zip(found.starts.tolist(), found.stops.tolist(), strict=True))

    assert widened((140, 200)) == [(130, 300)]
    assert widened((105, 120), (120, 200)) == [(105, 120), (120, 300)]
    assert widened((105, 132), (140, 200)) == [(105, 132), (132, 300)]
    assert widened((10, 20), (105, 120), (140, 200))[2] == (140, 200)  # one of three in its set
    assert widened((140, 180)) == [(140, 180)]  # too little of it
    assert widened((140, 200), (220, 280)) == [(140, 200), (220, 280)]  # not alone
    assert widened((10, 80)) == [(10, 80)]  # that activity repeats, and is not free


def test_repetitions_with_a_stand_in_every_other_one_are_not_back_to_back() -> None:
    standing = np.zeros(400, np.bool_)
    standing[100:300] = True  # in the activity of one repetition, and before and after it
    assert interrupted(segments(), standing, 20).tolist() == [False, False, True, False]
    standing[30:49] = True
    assert not interrupted(segments(), standing, 20)[0]
    standing[49] = True  # half of one stand, the other is in the next repetition
    assert not interrupted(segments(), standing, 21)[0]
    assert interrupted(segments(), standing, 20)[0]


def test_shares_are_those_of_actions() -> None:
    shares = np.array([0.8, np.nan, 0.5, 0.2])
    found = of_actions(shares, np.diff(BORDERS), LABELS)
    np.testing.assert_allclose(found, [0.5, 0, 0.5, 0.5])
    found = of_actions(shares, np.diff(BORDERS) * [True, True, False, False], LABELS)
    np.testing.assert_allclose(found, [0.8, 0, 0, 0.8])


def test_occurrences_within_some_segments_recur_there() -> None:
    found = occurring((140, 180), (220, 260), (310, 350))
    kept = found.within(BORDERS, FREE)
    assert kept.starts.tolist() == [140, 220]
    assert not len(occurring((140, 180), (310, 350)).within(BORDERS, FREE))
