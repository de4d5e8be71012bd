"""Filters: equality with those of scipy."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import butter, sosfiltfilt

from kineme.features.channels import filter_band, filter_low


def make_random_walk(frames: int, channels: int) -> np.ndarray:
    return np.random.default_rng(frames).standard_normal((frames, channels)).cumsum(axis=0)


@given(
    frames=st.integers(1, 400),
    channels=st.integers(1, 40),
    fps=st.floats(10.0, 1000.0),
    low=st.floats(0.005, 0.2),
    ratio=st.floats(1.2, 20.0),
)
def test_a_band_is_that_of_scipy(frames, channels, fps, low, ratio) -> None:
    edges = low * fps, min(low * ratio, 0.45) * fps
    values, padding = make_random_walk(frames, channels), min(frames - 1, int(3 * fps / edges[0]))
    sections = butter(2, edges, "bandpass", fs=fps, output="sos")
    expected = sosfiltfilt(sections, values, axis=0, padlen=padding)
    found = filter_band(values, fps, *edges, padding)
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(values).max())


@given(frames=st.integers(1, 400), channels=st.integers(1, 40), cutoff=st.floats(0.01, 0.45))
def test_a_low_pass_is_that_of_scipy(frames, channels, cutoff) -> None:
    values, padding = make_random_walk(frames, channels), min(frames - 1, int(1 / cutoff))
    sections = butter(2, cutoff, fs=1.0, output="sos")
    expected = sosfiltfilt(sections, values, axis=0, padlen=padding)
    found = filter_low(values, 1.0, cutoff, padding)
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(values).max())
