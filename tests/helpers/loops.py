"""Movements that repeat exactly, as features at 30 frames per second, in body sizes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def make_swings(
    times: int, *, period: float, rest: float = 0, height: float = 0.3, axis: int = 0
) -> Floats:
    """Make repetitions of a figure of eight in its own plane, each followed by a rest."""
    angle = 2 * np.pi * np.arange(round(30 * period)) / round(30 * period)
    return _repeat(
        {axis: height * np.sin(angle), axis + 1: height / 2 * np.sin(2 * angle)}, times, rest
    )


def make_nods(
    times: int, *, period: float, rest: float = 0, height: float = 0.3, axis: int = 0
) -> Floats:
    """Make repetitions of a movement there and back on one line, each followed by a rest."""
    angle = 2 * np.pi * np.arange(round(30 * period)) / round(30 * period)
    return _repeat({axis: height * (1 - np.cos(angle))}, times, rest)


def _repeat(columns: dict[int, Floats], times: int, rest: float) -> Floats:
    frames = len(next(iter(columns.values())))
    once = np.zeros((frames + round(30 * rest), 6))
    for column, values in columns.items():
        once[:frames, column] = values
    return np.tile(once, (times, 1))
