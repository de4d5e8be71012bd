"""Borders lie at one phase, between frames, wherever a method had cut."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kineme.cycles.borders import Features, Run, make_run, shift_to_common_phase

RATE = 100.0
OFFSETS = st.lists(st.floats(-0.02, 0.02), min_size=6, max_size=6)


def make_swing(periods: list[float], noise: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Features of a movement with these periods, and its true borders."""
    borders = np.concatenate([[0.0], np.cumsum(periods)])
    t = np.arange(0, borders[-1], 1 / RATE)
    phase = 2 * np.pi * np.interp(t, borders, np.arange(len(borders)))
    clean = np.stack([np.cos(phase), 0.5 * np.sin(phase), 0.3 * np.cos(2 * phase + 1)], axis=1)
    return clean + noise * np.random.default_rng(0).normal(size=clean.shape), borders


def refine(features: np.ndarray, borders: np.ndarray) -> Run:
    """Return one run of these features with refined borders."""
    (run,) = shift_to_common_phase([make_run(Features(features, RATE), borders)])
    return run


@given(OFFSETS)
def test_wherever_the_grid_had_them_borders_come_to_the_same_places(offsets: list[float]) -> None:
    features, true = make_swing([1.0, 1.1, 0.95, 1.0, 1.05, 0.9, 1.0, 1.0])
    run = refine(features, true[1:7] + offsets)
    apart = run.borders[1:-1] - true[2:6]
    assert np.ptp(apart) < 0.015  # at one phase, whichever that is
    assert np.allclose(run.borders[1:-1], refine(features, true[1:7]).borders[1:-1], atol=0.01)


def test_channels_that_only_shake_do_not_move_borders() -> None:
    features, true = make_swing(np.random.default_rng(5).uniform(0.9, 1.1, 30).tolist(), noise=0.02)
    shaking = 1.5 * np.random.default_rng(3).normal(size=(len(features), 20))
    cut = np.round(true[1:-1] * 30 + 0.3) / 30
    run = refine(np.hstack([features, shaking]), cut)
    assert (np.diff(run.borders)[1:-1] - np.diff(true[1:-1])[1:-1]).std() < 0.02


def test_an_end_in_another_movement_is_where_a_usual_repetition_has_it() -> None:
    features, true = make_swing([1.0, 1.01, 0.99, 1.0, 1.01, 0.99, 1.0, 1.0])
    other = np.random.default_rng(1).normal(size=(60, 3))
    features[int(true[6] * RATE) + 40 : int(true[6] * RATE) + 100] = other
    assert np.diff(refine(features, true[1:8]).borders)[-1] == pytest.approx(1.0, abs=0.05)
    assert np.isfinite(refine(features, true[1:4]).borders).all()


def test_borders_lie_where_the_movement_turns_back_or_in_the_middle_of_its_rest() -> None:
    t = np.arange(0, 8, 1 / RATE)
    swings = np.cos(2 * np.pi * t)[:, None]  # turns at whole and half seconds
    run = refine(swings, np.arange(1.0, 7) + 0.1)
    assert np.allclose(run.borders, np.arange(1, 7), atol=0.01)
    rests = np.where(t % 1 < 0.4, 0, np.sin(np.pi * (t % 1 - 0.4) / 0.6) ** 2)[:, None]
    run = refine(rests, np.arange(1.0, 7) + 0.05)
    assert np.allclose(run.borders, np.arange(1, 7) + 0.2, atol=0.04)


def test_where_nothing_moves_nothing_is_certain() -> None:
    assert np.isnan(refine(np.zeros((800, 2)), np.arange(1.0, 6)).uncertainty).all()
