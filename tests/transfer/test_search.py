"""Search by example: the naive version, other speeds, and errors."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import cdist

import naive
from kineme.errors import ParameterError
from kineme.transfer.matching import BLOCK, search, warp


def make_directions(n: int, seed: int, dims: int = 6) -> np.ndarray:
    """Make a smooth random walk on the sphere."""
    values = np.cumsum(np.random.default_rng(seed).normal(size=(n, dims)), axis=0)
    return (values / np.linalg.norm(values, axis=1, keepdims=True)).astype(np.float32)


def change_speed(features: np.ndarray, speed: float) -> np.ndarray:
    at = np.arange(0, len(features) - 1, speed)
    before, share = at.astype(int), (at % 1)[:, None]
    return (1 - share) * features[before] + share * features[before + 1]


@given(st.integers(1, 12), st.integers(1, 6), st.integers(0, 99))
@settings(max_examples=60)
def test_equal_to_the_naive_version(n: int, m: int, seed: int) -> None:
    recording, example = make_directions(n, seed), make_directions(m, seed + 100)
    costs, starts = warp(example, recording)
    expected, begins = naive.find_warpings(cdist(recording, example))
    np.testing.assert_allclose(costs, expected, rtol=1e-5, atol=1e-3)  # float32
    possible = np.isfinite(expected)
    assert starts[possible].tolist() == np.array(begins)[possible].tolist()


def test_a_long_recording_is_one_whatever_the_block() -> None:
    recording = make_directions(2 * BLOCK + 50, 1)
    across = slice(BLOCK - 8, BLOCK + 12)
    found = search(recording[across], recording, threshold=0.01)
    assert (found.starts.tolist(), found.stops.tolist()) == ([across.start], [across.stop])


@pytest.mark.parametrize("speed", [0.55, 0.8, 1.0, 1.5, 1.9])
def test_found_at_half_to_twice_the_speed(speed: float) -> None:
    movement = np.stack([np.cos(np.arange(40) / 12), np.sin(np.arange(40) / 12)], axis=1)
    still = np.repeat([[-1.0, 0.0]], 30, axis=0)
    performed = change_speed(movement, speed)
    found = search(movement, np.concatenate([still, performed, still]), threshold=0.1)
    assert len(found.starts) == 1
    assert abs(found.starts[0] - 30) <= 3
    assert abs(found.stops[0] - 30 - len(performed)) <= 3


def test_matches_are_apart_within_the_threshold_and_the_best_come_first() -> None:
    angle = np.cumsum(np.random.default_rng(4).uniform(0.2, 0.4, 400))
    recording = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    found = search(recording[50:70], recording, threshold=0.2)
    assert len(found.starts) > 10
    assert (found.starts[0], found.stops[0]) == (50, 70)
    assert (np.diff(found.distances) >= 0).all()
    assert found.distances[-1] <= 0.2
    spans = sorted(zip(found.starts.tolist(), found.stops.tolist(), strict=True))
    assert all(one[1] <= other[0] for one, other in pairwise(spans))
    few = search(recording[50:70], recording, threshold=0.2, top=2)
    assert few.starts.tolist() == found.starts[:2].tolist()


def test_nothing_is_found_where_the_body_is_not_seen() -> None:
    recording = make_directions(100, 5)
    recording[40:60] = 0.0
    for start, stop in zip(*search(make_directions(10, 6), recording)[:2], strict=True):
        assert not (start < 60 and stop > 50)
    assert len(search(make_directions(10, 6), np.zeros((200, 6))).starts) == 0


@pytest.mark.parametrize(
    ("example", "options", "said"),
    [
        (np.zeros((5, 7)), {}, "same features"),
        (np.zeros((0, 6)), {}, "at least one sample"),
        (np.zeros(6), {}, "samples x dims"),
        ("walk", {}, "array of numbers"),
        (np.zeros((5, 6)), {"threshold": 0}, "above 0, not 0"),
        (np.zeros((5, 6)), {"top": 0}, "above 0, not 0"),
    ],
)
def test_what_cannot_be_searched_is_refused(example: object, options: dict, said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        search(example, make_directions(50, 8), **options)
