"""Borders to the frame: they move towards where a segment ends, and nothing else changes."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from kineme.methods.kineme.borders import to_the_frame
from kineme.methods.kineme.preset import SENSORS

FPS = round(SENSORS.working_fps)
SECOND = round(SENSORS.averaging * FPS)


def quiet_and_loud(seed: int, ends: list[int]) -> np.ndarray:
    """Four channels that are quiet, then loud, in turn up to each end."""
    rng = np.random.default_rng(seed)
    lengths = np.diff([0, *ends])
    deviations = np.repeat(np.where(np.arange(len(ends)) % 2, 1.0, 0.1), lengths)
    return deviations[:, None] * rng.standard_normal((ends[-1], 4))


@given(seed=st.integers(0, 99), late=st.integers(-SECOND // 2, SECOND // 2))
@settings(max_examples=30)
def test_a_border_moves_towards_where_quiet_ends(seed, late) -> None:
    true = 6 * FPS
    channels = quiet_and_loud(seed, [true, 12 * FPS])
    borders = np.array([0, true + late, 12 * FPS])
    moved = to_the_frame(channels, borders, SENSORS)
    assert abs(moved[1] - (true + (1 - SENSORS.border_shift) * late)) <= 2


@given(seed=st.integers(0, 99), lengths=st.lists(st.integers(1, 200), min_size=1, max_size=8))
@settings(max_examples=60)
def test_no_segment_comes_or_goes(seed, lengths) -> None:
    ends = np.cumsum(lengths).tolist()
    borders = np.array([0, *ends])
    channels = quiet_and_loud(seed, ends)
    moved = to_the_frame(channels, borders, SENSORS)
    assert (moved[[0, -1]] == borders[[0, -1]]).all()
    assert (np.diff(moved) > 0).all()
    assert (np.abs(moved - borders) <= SECOND).all()
    assert (moved == to_the_frame(-8 * channels[:, ::-1] + 64, borders, SENSORS)).all()


def test_too_short_a_side_tells_nothing() -> None:
    ends = [3 * FPS, 3 * FPS + SECOND, 7 * FPS]
    borders = np.array([0, *ends])
    borders[1] += 10
    assert (to_the_frame(quiet_and_loud(0, ends), borders, SENSORS) == borders).all()
