"""Refined borders: they move towards the end of a segment, and nothing else changes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kineme.methods.kineme.borders import refine_borders
from kineme.methods.kineme.preset import KINEME, SENSORS

FPS = round(SENSORS.working_fps)
SECOND = round(SENSORS.averaging * FPS)


def quiet_and_loud(seed: int, ends: list[int]) -> np.ndarray:
    """Make four channels that alternate between quiet and loud, up to each end."""
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
    starts, _ = refine_borders(channels, borders, SENSORS)
    assert abs(starts[1] - (true + (1 - SENSORS.border_shift) * late)) <= 2


@given(seed=st.integers(0, 99), lengths=st.lists(st.integers(1, 200), min_size=1, max_size=8))
@settings(max_examples=60)
def test_no_segment_comes_or_goes(seed, lengths) -> None:
    ends = np.cumsum(lengths).tolist()
    borders = np.array([0, *ends])
    channels = quiet_and_loud(seed, ends)
    for preset in (SENSORS, KINEME.replace(transition_cost=1e-9)):
        starts, stops = refine_borders(channels, borders, preset)
        assert starts[0] == 0
        assert stops[-1] == borders[-1]
        assert (starts < stops).all()
        assert (stops[:-1] <= starts[1:]).all()
        assert (np.abs(starts - borders[:-1]) <= SECOND).all()
        assert (np.abs(stops - borders[1:]) <= SECOND).all()
        again = refine_borders(-8 * channels[:, ::-1] + 64, borders, preset)
        assert (starts == again[0]).all()
        assert (stops == again[1]).all()


@pytest.mark.parametrize("off", [-6, 0, 6])
def test_what_neither_side_explains_is_a_transition(off: int) -> None:
    """A change of pose over half a second is a transition; a border at a single change is not."""
    fps = round(KINEME.working_fps)
    noise = 0.05 * np.random.default_rng(0).standard_normal((12 * fps, 4))
    at = np.arange(12 * fps)
    going = np.clip((at - 5.75 * fps) / (0.5 * fps), 0, 1)[:, None]
    borders = np.array([0, 6 * fps + off, 12 * fps])
    starts, stops = refine_borders(noise + going, borders, KINEME)
    assert abs(stops[0] - 5.75 * fps) <= 4
    assert abs(starts[1] - 6.25 * fps) <= 4
    starts, stops = refine_borders(noise + (at >= 6 * fps)[:, None], borders, KINEME)
    assert starts[1] == stops[0]
