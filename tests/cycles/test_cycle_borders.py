"""Borders lie at one phase, between frames, wherever a method had cut."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kineme.cycles.borders import make_run, shift_to_common_phase

RATE = 100.0
OFFSETS = st.lists(st.floats(-0.02, 0.02), min_size=6, max_size=6)


def make_swing(periods: list[float], noise: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Features of a movement with these periods, and its true borders."""
    borders = np.concatenate([[0.0], np.cumsum(periods)])
    t = np.arange(0, borders[-1], 1 / RATE)
    phase = 2 * np.pi * np.interp(t, borders, np.arange(len(borders)))
    clean = np.stack([np.cos(phase), 0.5 * np.sin(phase), 0.3 * np.cos(2 * phase + 1)], axis=1)
    return clean + noise * np.random.default_rng(0).normal(size=clean.shape), borders


@given(OFFSETS)
def test_wherever_the_grid_had_them_borders_come_to_the_same_places(offsets: list[float]) -> None:
    features, true = make_swing([1.0, 1.1, 0.95, 1.0, 1.05, 0.9, 1.0, 1.0])
    (run,) = shift_to_common_phase([make_run(0, true[1:7] + offsets)], [features], [RATE])
    apart = run.borders[1:-1] - true[2:6]
    assert np.ptp(apart) < 0.015  # at one phase, whichever that is
    (exact,) = shift_to_common_phase([make_run(0, true[1:7])], [features], [RATE])
    assert np.allclose(run.borders[1:-1], exact.borders[1:-1], atol=0.01)


def test_channels_that_only_shake_do_not_move_borders() -> None:
    features, true = make_swing(np.random.default_rng(5).uniform(0.9, 1.1, 30).tolist(), noise=0.02)
    shaking = 1.5 * np.random.default_rng(3).normal(size=(len(features), 20))
    cut = np.round(true[1:-1] * 30 + 0.3) / 30
    (run,) = shift_to_common_phase([make_run(0, cut)], [np.hstack([features, shaking])], [RATE])
    assert (np.diff(run.borders)[1:-1] - np.diff(true[1:-1])[1:-1]).std() < 0.02


def test_an_end_in_another_movement_is_where_a_usual_repetition_has_it() -> None:
    features, true = make_swing([1.0, 1.01, 0.99, 1.0, 1.01, 0.99, 1.0, 1.0])
    other = np.random.default_rng(1).normal(size=(60, 3))
    features[int(true[6] * RATE) + 40 : int(true[6] * RATE) + 100] = other
    (run,) = shift_to_common_phase([make_run(0, true[1:8])], [features], [RATE])
    assert np.diff(run.borders)[-1] == pytest.approx(1.0, abs=0.05)
    alone = shift_to_common_phase([make_run(0, true[1:4])], [features], [RATE])[0]
    assert np.isfinite(alone.borders).all()


def test_borders_lie_where_the_movement_turns_back_or_in_the_middle_of_its_rest() -> None:
    t = np.arange(0, 8, 1 / RATE)
    swings = np.cos(2 * np.pi * t)[:, None]  # turns at whole and half seconds
    (run,) = shift_to_common_phase([make_run(0, np.arange(1.0, 7) + 0.1)], [swings], [RATE])
    assert np.allclose(run.borders, np.arange(1, 7), atol=0.01)
    rests = np.where(t % 1 < 0.4, 0, np.sin(np.pi * (t % 1 - 0.4) / 0.6) ** 2)[:, None]
    (run,) = shift_to_common_phase([make_run(0, np.arange(1.0, 7) + 0.05)], [rests], [RATE])
    assert np.allclose(run.borders, np.arange(1, 7) + 0.2, atol=0.04)


def test_where_nothing_moves_nothing_is_certain() -> None:
    (run,) = shift_to_common_phase([make_run(0, np.arange(1.0, 6))], [np.zeros((800, 2))], [RATE])
    assert np.isnan(run.uncertainty).all()
