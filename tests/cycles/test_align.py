"""Curves in step: their mean is not flatter than they are, and comes when they do."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import kineme
from kineme.cycles import channels_of
from kineme.cycles.align import ALIGNMENTS, align_curves
from kineme.cycles.measure import measure_other_channels
from kineme.datasets.synthetic import SyntheticRecording
from kineme.errors import ParameterError

SHARES = np.linspace(0, 1, 101)
HIGH = 60.0


def make_movement(phase: np.ndarray) -> np.ndarray:
    """Two channels: a peak of 60 at .3 with a lower one at .7, and one turn of a sine."""
    peaks = HIGH * np.exp(-(((phase - 0.3) / 0.08) ** 2)) + 20 * np.exp(
        -(((phase - 0.7) / 0.1) ** 2)
    )
    return np.stack([peaks, 30 * np.sin(2 * np.pi * phase)])


def make_unsteady_cycles(n: int, deviation: float, seed: int = 0) -> np.ndarray:
    """Cycles whose parts last differently."""
    rng = np.random.default_rng(seed)
    marks = [[0, 0.3 + a, 0.7 + b, 1] for a, b in rng.normal(0, deviation, (n, 2))]
    return np.array([make_movement(np.interp(SHARES, each, [0, 0.3, 0.7, 1])) for each in marks])


@pytest.mark.parametrize("alignment", ["landmarks", "warp"])
def test_the_mean_is_as_high_as_the_cycles_and_as_late(alignment: str) -> None:
    curves = make_unsteady_cycles(30, 0.04)
    flat, found = curves.mean(axis=0)[0], align_curves(curves, alignment)
    mean = found.mean(axis=0)[0]
    assert flat.max() < 0.9 * HIGH
    assert mean.max() == pytest.approx(HIGH, rel=0.02)
    assert abs(SHARES[mean.argmax()] - curves[:, 0].argmax(axis=1).mean() / 100) < 0.02
    assert found[:, 0].std(axis=0).mean() < 0.5 * curves[:, 0].std(axis=0).mean()


@given(st.integers(2, 6), st.floats(0, 0.05), st.integers(0, 99), st.sampled_from(ALIGNMENTS))
@settings(max_examples=30)
def test_ends_stay_and_nothing_is_made_up(n, deviation, seed, alignment) -> None:
    curves = make_unsteady_cycles(n, deviation, seed)
    found = align_curves(curves, alignment)
    np.testing.assert_allclose(found[:, :, [0, -1]], curves[:, :, [0, -1]], atol=1e-9)
    assert (found.max(axis=2) <= curves.max(axis=2) + 1e-9).all()
    assert (found.min(axis=2) >= curves.min(axis=2) - 1e-9).all()
    np.testing.assert_allclose(align_curves(curves[::-1], alignment), found[::-1], atol=1e-6)


@pytest.mark.parametrize("alignment", ALIGNMENTS)
def test_cycles_with_gaps_and_single_ones_stay(alignment: str) -> None:
    curves = make_unsteady_cycles(5, 0.03)
    curves[2, 1, 40] = np.nan
    np.testing.assert_array_equal(align_curves(curves, alignment)[2], curves[2])
    np.testing.assert_array_equal(align_curves(curves[:1], alignment), curves[:1])
    assert align_curves(curves[:0], alignment).shape == (0, 2, 101)


def test_cycles_of_a_recording_come_in_step(walks: SyntheticRecording) -> None:
    spread = {}
    for alignment in ALIGNMENTS:
        found = kineme.cycles(walks.motion, walks.truth, channels=["knee_r"], align=alignment)
        spread[alignment] = found.layout("knee_r", "walk").std(axis=0).mean()
        assert found.provenance["align"] == alignment
        again = measure_other_channels(found, channels_of(walks.motion, ["knee_r"]))
        np.testing.assert_array_equal(again.curves, found.curves)
    assert spread["warp"] < spread["linear"]
    with pytest.raises(ParameterError, match="align must be one of linear, landmarks, warp"):
        kineme.cycles(walks.motion, walks.truth, align="dtw")
