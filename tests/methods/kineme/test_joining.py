"""Neighbours that are one set are merged at any posture; others are not."""

from __future__ import annotations

import numpy as np
import pytest

from kineme.methods.kineme.borders import Sets, join_sets
from kineme.methods.kineme.preset import KINEME
from kineme.methods.kineme.repetitions import find_repetitions

PERIOD = 18
HALF = 6 * PERIOD


def swings(channel: int, count: int = 6) -> np.ndarray:
    """Make swings of one of four channels, each with a small one of another."""
    angle = 2 * np.pi * np.arange(count * PERIOD) / PERIOD
    rows = np.zeros((len(angle), 4))
    rows[:, channel], rows[:, channel - 1] = np.sin(angle), 0.3 * np.sin(2 * angle)
    return rows


def joined(left: np.ndarray, right: np.ndarray) -> Sets:
    """Return two halves of a recording as separate clusters."""
    rows = np.concatenate([left, right])
    rows = rows + np.random.default_rng(0).normal(0, 0.02, rows.shape)
    rows, ends = np.ascontiguousarray(rows, np.float32), np.array([0, len(left), len(rows)])
    cuts = [
        find_repetitions(rows, 0, ends[1], KINEME),
        find_repetitions(rows, ends[1], ends[2], KINEME),
    ]
    return join_sets(rows, Sets(ends[:-1], ends[1:], np.arange(2), cuts), KINEME)


@pytest.mark.parametrize("moved", [0.0, 0.5, 3.0])
def test_a_fast_set_is_one_wherever_the_hand_moves(moved: float) -> None:
    found = joined(swings(1), swings(1, 7) + moved)
    assert found.starts.tolist() == [0]
    assert found.stops.tolist() == [13 * PERIOD]
    assert found.labels.tolist() == [0]


@pytest.mark.parametrize(
    "other",
    [swings(3), -swings(1), np.zeros((HALF, 4)), swings(1)[::2]],
    ids=["other channels", "other way round", "rest", "twice as fast"],
)
def test_two_activities_stay_apart(other: np.ndarray) -> None:
    assert joined(swings(1), other).labels.tolist() == [0, 1]
