"""Inserting occurrences: none is cut, and periodic activities keep their repetitions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from kineme.methods.kineme.events import Occurrences
from kineme.methods.kineme.primitives import (
    Segments,
    drop_still_clusters,
    replace_by_occurrences,
)

BORDERS = np.array([0, 100, 130, 300, 400])
LABELS = np.array([0, -1, 1, 0])


def segments() -> Segments:
    """Make an activity of two repetitions, a transition, one repetition, and the first again."""
    return Segments(
        BORDERS,
        LABELS,
        np.array([0, 50, 100, 130, 300, 400]),
        np.array([0, 0, -1, 1, 0]),
        np.empty(0, np.int64),
    )


def occurring(*spans: tuple[int, int]) -> Occurrences:
    starts, stops = np.array(spans, np.int64).reshape(-1, 2).T
    return Occurrences(starts, stops, np.zeros(len(spans), np.int64), np.full(len(spans), 0.5))


FREE = np.array([False, True, True, False])


def test_occurrences_and_what_lies_between_are_the_primitives() -> None:
    found = replace_by_occurrences(segments(), occurring((140, 180), (220, 260)), FREE)
    assert found.primitives.tolist() == [0, 50, 100, 130, 140, 180, 220, 260, 300, 400]
    assert found.clusters.tolist() == [0, 0, -1, -1, 2, -1, 2, -1, 0]
    assert found.repeats.tolist() == [True, True] + 6 * [False] + [True]
    assert found.borders.tolist() == BORDERS.tolist()
    assert found.not_periodic.tolist() == [1]


def test_numbers_go_on_after_repetitions_that_are_another_movement() -> None:
    parts = replace(segments(), clusters=np.array([0, 3, -1, 2, 0]))
    found = replace_by_occurrences(parts, occurring((140, 180), (220, 260)), FREE)
    assert found.clusters.tolist() == [0, 2, -1, -1, 3, -1, 3, -1, 0]
    untouched = replace_by_occurrences(parts, occurring(), np.zeros(4, np.bool_))
    assert untouched.clusters.tolist() == [0, 2, -1, 3, 0]
    assert untouched.not_periodic.size == 0


@pytest.mark.parametrize(
    ("spans", "borders", "labels"),
    [
        (((120, 180), (220, 260)), [0, 100, 120, 300, 400], [0, -1, 1, 0]),  # the nearer end
        (((100, 135), (220, 260)), [0, 100, 135, 300, 400], [0, -1, 1, 0]),
        (((100, 270), (280, 300)), [0, 100, 300, 400], [0, 1, 0]),  # the transition is taken
    ],
)
def test_no_border_cuts_an_occurrence(spans, borders, labels) -> None:
    found = replace_by_occurrences(segments(), occurring(*spans), FREE)
    assert found.borders.tolist() == borders
    assert found.labels.tolist() == labels


def alone() -> Segments:
    """Make activities: one repetition of 30 frames, one that repeats, and one with occurrences."""
    return Segments(
        np.array([0, 30, 100, 300]),
        np.array([0, 1, 2]),
        np.array([0, 30, 65, 100, 180, 220, 300]),
        np.array([0, 1, 1, -1, 3, -1]),
        np.array([2]),
    )


@pytest.mark.parametrize(("near", "kept"), [(14, True), (15, False), (1000, False)])
def test_a_single_repetition_that_hardly_moves_is_none(near, kept) -> None:
    rows = np.arange(300, dtype=np.float32)[:, None]  # 14.5 from the mean of 30 at most
    given = alone()
    found = drop_still_clusters(given, rows, near)
    if kept:
        assert found is given
    assert found.clusters.tolist() == [0 if kept else -1, 1, 1, -1, 3, -1]
    assert found.not_periodic.tolist() == ([2] if kept else [0, 2])
    assert found.counts.tolist() == [int(kept), 2, 0]
