"""Series at their own pace: the preset ``series``."""

from __future__ import annotations

import numpy as np
import pytest

import kineme
from kineme.methods.kineme.preset import estimate_period
from kineme.recordings import Signals

PERIOD, HALF = 40, 2000


def two_states(period: float, half: int) -> np.ndarray:
    """Make a sine, then one with a second harmonic, with some noise."""
    phase = np.arange(half) * 2 * np.pi / period
    both = np.concatenate([np.sin(phase), np.sin(phase) + np.sin(2 * phase)])
    return both + 0.05 * np.random.default_rng(0).standard_normal(2 * half)


@pytest.mark.parametrize("pace", [1, 5])
def test_a_change_is_found_at_any_pace(pace: int) -> None:
    found = kineme.segment(two_states(pace * PERIOD, pace * HALF), fps=1, preset="series")
    starts = found.activities.start_frame
    assert len(starts) == 2
    assert abs(starts[1] - pace * HALF) <= 2 * pace * PERIOD


def test_the_rate_that_is_given_changes_seconds_only() -> None:
    slow, fast = (kineme.segment(two_states(PERIOD, HALF), fps=f, preset="series") for f in (1, 50))
    assert slow.table.start_frame.tolist() == fast.table.start_frame.tolist()
    assert slow.activities.stop_s[-1] == 2 * HALF
    assert fast.activities.stop_s[-1] == 2 * HALF / 50
    assert any("count as a second" in note for note in slow.provenance["notes"])


def test_gaps_and_rows_to_look_at_stay_where_they_are() -> None:
    rows = two_states(PERIOD, HALF)[:, None]
    recording = Signals(rows, 10.0, gaps=[(1000, 1100)])
    gapped = kineme.segment(recording, preset="series").table
    assert {1000, 1100} <= {*gapped.start_frame.tolist()}
    looked = kineme.segment(Signals(rows, 10.0), features=rows[::2], feature_fps=5, preset="series")
    assert looked.table.stop_frame.max() == 2 * HALF
    assert len(looked.activities) == 2


@pytest.mark.parametrize("n", [1, 2, 9, 50])
@pytest.mark.parametrize("make", [np.ones, np.arange], ids=["constant", "rising"])
def test_what_has_no_period_is_segmented_by_its_length(make, n: int) -> None:
    rows = np.asarray(make(n), float)
    assert estimate_period(rows[:, None]) is None
    assert kineme.segment(rows, fps=1, preset="series").table.stop_frame[-1] == n
