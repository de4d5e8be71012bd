"""Movements that hardly repeat, with gestures inserted, at 30 frames per second."""

from __future__ import annotations

import numpy as np

from kineme.methods.kineme.preset import KINEME


def make_wandering(rng: np.random.Generator, n: int) -> np.ndarray:
    """Make a movement that hardly repeats: body sizes, 30 frames per second."""
    noise = rng.normal(0, 1, (n + 60, 6))
    window = np.hanning(45)
    smooth = [np.convolve(column, window / np.linalg.norm(window), "valid") for column in noise.T]
    return 0.3 * np.column_stack(smooth)[:n]


def insert_gestures(seed: int, places: list[int]) -> np.ndarray:
    """Insert a gesture of 40 frames at some frames of such a movement, with equal end poses."""
    rows = make_wandering(np.random.default_rng(seed), 900)
    angle = np.linspace(0, 2 * np.pi, 40)
    gesture = 0.3 * np.column_stack([np.sin(k * angle) for k in (1, 2, 1, 3, 1, 2)])
    away = np.ones((len(rows), 1))
    for place in places:
        far = np.abs(np.arange(len(rows)) - place - 19.5) - 19.5
        away = np.minimum(away, np.clip(far / 15, 0, 1)[:, None])
    rows *= away
    for place in places:
        rows[place : place + 40] = gesture
    return rows


def stack_features(rows: np.ndarray) -> np.ndarray:
    """Stack poses with those before and after, scaled as in the method."""
    shifts = [round(offset * KINEME.working_fps) for offset in KINEME.offsets]
    places = np.arange(len(rows)) + np.array(shifts)[:, None]
    return np.hstack(rows[places.clip(0, len(rows) - 1)]) / len(shifts) ** 0.5
