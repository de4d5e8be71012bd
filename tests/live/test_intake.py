"""Rows become the frames that the file of them would have, however they come."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pytest

from kineme.live.intake import Frames, Hole, Intake

FPS = 50.0
N = 500
EVEN = np.arange(N) / FPS
ROWS = np.column_stack([np.sin(EVEN), EVEN])


def intake(
    rows: np.ndarray, times: np.ndarray | None, size: int
) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """Values and missing of all frames, and what was said."""
    taken = Intake(FPS, ["x", "y"])
    pieces = []
    for start in range(0, len(rows), size):
        part = slice(start, start + size)
        pieces += taken.add(rows[part], None if times is None else times[part])
    pieces += taken.finish()
    values, missing = [np.empty((0, rows.shape[1]))], [np.empty(0, bool)]
    for piece in pieces:
        if isinstance(piece, Frames):
            values.append(piece.values)
            missing.append(piece.missing)
        elif isinstance(piece, Hole):
            values.append(np.zeros((piece.n_frames, rows.shape[1])))
            missing.append(np.ones(piece.n_frames, bool))
    said = [piece for piece in pieces if isinstance(piece, str)]
    return np.concatenate(values), np.concatenate(missing), said


def set_back(at: float, by: float) -> np.ndarray:
    return np.where(at <= EVEN, EVEN - by, EVEN)


def only_at(rows: Iterable[int]) -> np.ndarray:
    """Return the rows, with a value of the second channel in these only."""
    return np.column_stack(
        [ROWS[:, 0], np.where(np.isin(np.arange(N), [*rows]), ROWS[:, 1], np.nan)]
    )


CASES = {
    "without times": (ROWS, None, N, 0, ""),
    "nanoseconds since boot": (ROWS, EVEN * 1e9 + 8.1e10, N, 0, ""),
    "milliseconds since 1970": (ROWS, np.round(EVEN * 1e3) + 1.7e12, N, 0, ""),
    "jitter": (ROWS, EVEN + np.random.default_rng(0).uniform(-0.004, 0.004, N), N, 0, ""),
    "pause before the second row": (ROWS, np.append(-0.7, EVEN[1:]), N + 35, 35, ""),
    "microseconds, two rows at once": (ROWS, np.append([0, 200], EVEN[2:] * 1e6), N, 0, ""),
    "whole seconds": (ROWS, np.floor(EVEN), N, 0, ""),
    "every row twice": (ROWS.repeat(2, 0), EVEN.repeat(2), N, 0, "rows come at about 100 Hz"),
    "packets of ten": (ROWS, EVEN[np.arange(N) // 10 * 10], N, 0, ""),
    "one row lost": (np.delete(ROWS, 99, 0), np.delete(EVEN, 99), N, 0, ""),
    "a hole": (np.delete(ROWS, slice(99, 199), 0), np.delete(EVEN, slice(99, 199)), N, 100, ""),
    "set back": (ROWS, set_back(5, 3), N + 11, 11, "the clock goes back by 2.98 s"),
    "summer time": (ROWS, set_back(5, 3600) + 1.7e9, N, 0, "an hour or a day"),
    "summer time begins": (ROWS, set_back(5, -3600) + 1_699_999_195, N, 0, "an hour or a day"),
    "a pause of an hour": (ROWS, set_back(5, -3600) + 1.7e9, N + 180_000, 180_000, ""),
    "a single wrong time": (ROWS, np.where(np.arange(N) == 99, 1e6, EVEN), N, 0, "single rows"),
    "no time": (ROWS, np.where(np.arange(N) == 99, np.nan, EVEN), N, 0, "without a time"),
    "twice the rate": (ROWS, EVEN / 2, N // 2, 0, "instead of 50 Hz"),
    "some NaN": (np.where(np.arange(2 * N).reshape(N, 2) % 3 == 1, np.nan, ROWS), None, N, 0, ""),
    "NaN for a second": (np.where((EVEN // 1 == 3)[:, None], np.nan, ROWS), None, N, 50, ""),
    "a channel of NaN": (ROWS * [1, np.nan], EVEN, N, 100, "channel y has no value"),
    "one value a second": (only_at(range(25, N, 50)), EVEN, N, 10, ""),
    "slow until second 6": (only_at(range(0, 300, 25)), EVEN, N, 42, "channel y has no value"),
    "off at second 6": (only_at(range(300)), EVEN, N, 105, "channel y has no value"),
    "off for 3 s": (only_at([*range(200), *range(350, N)]), EVEN, N, 105, "y has no value"),
    "values in few rows": (only_at([0, 3, 240, 300, 301]), EVEN, N, 0, ""),
    "off after a few values": (only_at([0, 3, 5]), EVEN, N, 0, "channel y has no value"),
    "NaN throughout": (np.full((N, 2), np.nan), EVEN, N, N, ""),
    "one row": (ROWS[:1], EVEN[:1], 1, 0, ""),
}


@pytest.mark.parametrize("case", CASES)
def test_rows_become_even_frames_whatever_their_times_and_pieces(case):
    rows, times, n_frames, n_missing, remark = CASES[case]
    values, missing, said = intake(rows, times, len(rows))
    assert abs(len(values) - n_frames) <= 1
    assert missing.sum() == n_missing
    assert np.isfinite(values).all()
    assert remark in " ".join(said)
    if not remark:
        assert not said
    for size in (1, 7, 100):
        other, hidden, heard = intake(rows, times, size)
        np.testing.assert_array_equal(values, other)
        np.testing.assert_array_equal(missing, hidden)
        assert said == heard


@pytest.mark.parametrize("case", ["milliseconds since 1970", "set back", "summer time"])
def test_the_clock_shows_the_times_of_the_rows(case):
    rows, times, *_ = CASES[case]
    taken = Intake(FPS, ["x", "y"])
    for row, time in zip(rows, times, strict=True):
        taken.add(row[None], np.array([time]))
    taken.finish()
    shown = taken.make_clock().time([0, (taken.emitted - 1) / FPS])
    np.testing.assert_allclose(shown, times[[0, -1]] / taken.per_second, atol=0.5 / FPS, rtol=0)


@pytest.mark.parametrize("case", ["packets of ten", "one row lost", "some NaN", "every row twice"])
def test_a_straight_line_stays_one(case):
    rows, times, *_ = CASES[case]
    values, _, _ = intake(rows, times, 13)
    # there is nothing before the first value and after the last
    np.testing.assert_allclose(values[1:-1, 1], EVEN[1 : len(values) - 1], atol=1e-9)
