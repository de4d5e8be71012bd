"""Rows that streams of the tests are made of."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from kineme.live import Event, Stream

FPS = 25.0


def two_exercises(seconds: float = 12.0, seed: int = 0) -> np.ndarray:
    """A slow exercise, a fast one at another place, and the slow one again."""
    t = np.arange(0, seconds, 1 / FPS)
    slow = np.column_stack([np.sin(np.pi * t), 0.5 * np.cos(np.pi * t)])
    fast = np.column_stack([2 + 0.3 * np.sin(5 * t), 1.5 * np.cos(5 * t)])
    rows = np.concatenate([slow, fast, slow])
    return rows + np.random.default_rng(seed).normal(0, 0.05, rows.shape)


def make_stream(**options: object) -> Stream:
    return Stream(**{"fps": FPS, "channels": ["x", "y"], "memory": 20.0, **options})


def push_pieces(
    stream: Stream, rows: np.ndarray, sizes: Sequence[int], times: np.ndarray | None = None
) -> Iterator[Event]:
    """Events of rows that come in pieces of these sizes, again and again; the end included."""
    start, turn = 0, 0
    while start < len(rows):
        stop = start + sizes[turn % len(sizes)]
        yield from stream.push(rows[start:stop], None if times is None else times[start:stop])
        start, turn = stop, turn + 1
    yield from stream.finish()
