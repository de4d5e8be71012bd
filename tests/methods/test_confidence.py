"""Probabilities of results, and notes on low ones."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.distance import cdist

import kineme
from kineme.datasets import random_recording
from kineme.methods.kineme.confidence import (
    compute_changes,
    compute_mean_correlation,
    compute_sharpness,
)
from kineme.methods.kineme.pipeline import analyze
from kineme.methods.kineme.preset import KINEME
from kineme.methods.segments import list_doubts
from loops import make_swings

# --- what is sure and what is not -------------------------------------------------------------


@pytest.mark.parametrize("period", [0.8, 1.2, 2.0])
def test_a_clearly_periodic_activity_is_sure(period: float) -> None:
    rows = np.concatenate([make_swings(10, period=period), make_swings(10, period=1, axis=2)])
    found = analyze(rows, KINEME)
    assert found.segments.labels.tolist() == [0, 1]
    sure = found.confidence
    assert (sure.clusters > 0.8).all()
    assert sure.borders[1] > 0.7
    assert (sure.cuts[1:] > 0.7).all()


@given(st.integers(2, 8), st.floats(0.0, 0.5), st.integers(0, 99))
def test_more_similar_repetitions_are_surer(count: int, noise: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    shape = rng.standard_normal((16, 6)).cumsum(axis=0)
    shaken = rng.standard_normal((count, 16, 6))
    clear, less = (compute_mean_correlation(shape + more * shaken) for more in (noise, noise + 3))
    assert less <= clear


@given(st.integers(2, 30), st.integers(1, 8), st.integers(0, 99))
def test_changes_are_energy_distances(n: int, side: int, seed: int) -> None:
    view = np.random.default_rng(seed).standard_normal((n, 3)).astype(np.float32)
    at = np.arange(1, n)
    plain = []
    for middle in at:
        before, after = view[max(middle - side, 0) : middle], view[middle : middle + side]
        within = cdist(before, before).mean() + cdist(after, after).mean()
        plain.append(cdist(before, after).mean() - within / 2)
    np.testing.assert_allclose(compute_changes(view, at, side), plain, atol=1e-9)


def test_a_border_at_a_step_is_surer_than_one_in_a_slow_change() -> None:
    at = np.array([30])
    step = np.repeat(np.float32([0, 1]), 30)[:, None]
    slope = np.linspace(0, 1, 60, dtype=np.float32)[:, None]
    assert compute_sharpness(step, at, 10) > 2 * compute_sharpness(slope, at, 10)


def test_borders_have_a_confidence_at_the_slowest_rate() -> None:
    rows = np.random.default_rng(0).standard_normal((6000, 3)).cumsum(axis=0)
    with np.errstate(all="raise"):
        found = analyze(rows, KINEME.replace(working_fps=10.0, rate=0.1)).confidence
    assert np.isfinite(found.borders[1:]).all()


# --- the columns ------------------------------------------------------------------------------


def test_every_score_and_border_confidence_is_a_probability() -> None:
    motion = random_recording(3).motion
    signals = kineme.Signals(motion.positions[:, ::5, 1], motion.fps)
    for recording in (motion, signals):
        table = kineme.segment(recording).table
        has_cluster = (table.level == "activity") & (table.kind == "activity")
        assert np.isfinite(table.confidence).tolist() == has_cluster.tolist()
        for column in (table.confidence, table.border_confidence):
            known = column[np.isfinite(column)]
            assert ((known >= 0) & (known <= 1)).all()
        inner = (table.level == "activity") & (table.start_frame > 0)
        has_border = inner & isinstance(recording, kineme.Motion)  # signals have none
        of_activities = table.border_confidence[table.level == "activity"]
        assert np.isfinite(of_activities).tolist() == has_border[table.level == "activity"].tolist()


def test_a_border_at_a_gap_has_no_confidence() -> None:
    motion = random_recording(3).motion
    gapped = replace(motion, gaps=[(500, 560)])
    table = kineme.segment(gapped).table
    assert np.isnan(table.border_confidence[np.isin(table.start_frame, (500, 560))]).all()
    assert np.isfinite(table.border_confidence).any()


def test_the_first_repetition_begins_as_surely_as_its_activity() -> None:
    segments = kineme.segment(random_recording(3).motion)
    of_activities = dict(
        zip(
            segments.activities.start_frame.tolist(),
            segments.activities.border_confidence.tolist(),
            strict=True,
        )
    )
    first = [row for row in segments.primitives if row.start_frame in of_activities]
    assert len(first) == len(of_activities)
    for row in first[1:]:
        assert row.border_confidence == of_activities[row.start_frame]


# --- notes ------------------------------------------------------------------------------------


def columns(clusters: list[float], borders: list[float]) -> dict[str, np.ndarray]:
    """Make activities of ten frames with two repetitions each."""
    n = len(clusters)
    starts, halves = 10 * np.arange(n), 5 * np.arange(2 * n)
    return {
        "level": np.repeat(["activity", "primitive"], [n, 2 * n]),
        "kind": np.full(3 * n, "activity"),
        "start_frame": np.append(starts, halves),
        "stop_frame": np.append(starts + 10, halves + 5),
        "cluster": np.zeros(3 * n, np.int64),
        "confidence": np.append(clusters, np.full(2 * n, np.nan)),
        "border_confidence": np.append(borders, np.full(2 * n, 0.01)),
    }


shares = st.lists(st.floats(0, 1), min_size=12, max_size=12)


@given(shares, shares)
def test_notes_are_five_at_most_and_the_worst_comes_first(clusters, borders) -> None:
    borders[0] = np.nan
    said = list_doubts(columns(clusters, borders), 10.0)
    told = [int(re.search(r"\((\d+) % sure\)", note)[1]) for note in said]
    below = sorted(each for each in (*clusters, *borders[1:]) if each < 0.5)
    assert told == [round(100 * each) for each in below[:5]]


def test_notes_say_what_to_look_at_and_where() -> None:
    known = columns([0.9, 0.4], [np.nan, 0.3])
    assert list_doubts(known, 10.0) == [
        "check the border at 1.00 s (30 % sure)",
        "check the cluster of the activity at 1.00 to 2.00 s (40 % sure)",
    ]
