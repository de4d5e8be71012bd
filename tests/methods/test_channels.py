"""Signals: invariances, resampling and envelopes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from presets import OWN

from kineme import Segmenter, Signals, segment
from kineme.errors import ParameterError
from kineme.features.channels import emg_envelope, resample_channels
from kineme.features.channels import standardize_channels as standard
from kineme.methods import resolve_preset
from kineme.methods.kineme.preset import KINEME, SENSORS
from kineme.methods.region_growing.preset import KRUEGER2017, VOEGELE2014

VALUES = arrays.arrays(
    np.float64, st.tuples(st.integers(1, 40), st.integers(1, 4)), elements=st.floats(-1e3, 1e3)
)


def naive_mean(values: np.ndarray, fps: float, at: float, width: float) -> np.ndarray:
    """Return the mean over a span of samples that are held for one period each."""
    total, weight = np.zeros(values.shape[1]), 0.0
    for i, value in enumerate(values):
        start, stop = max(i - 0.5, (at - width / 2) * fps), min(i + 0.5, (at + width / 2) * fps)
        if stop > start:
            total, weight = total + (stop - start) * value, weight + stop - start
    return total / weight


@given(VALUES, st.floats(20, 200), st.floats(20, 60), st.floats(0, 0.3))
@settings(max_examples=30)
def test_resampling_is_what_it_says(values, fps, new, smoothing) -> None:
    found = resample_channels(values, fps, new, smoothing=smoothing)
    width = max(smoothing, 1 / fps, 1 / new)
    for i in range(0, len(found), 5):
        assert np.allclose(found[i], naive_mean(values, fps, i / new, width), atol=1e-6)


@given(VALUES)
def test_standard_channels(values) -> None:
    found = standard(values)
    assert np.allclose(found.mean(axis=0), 0, atol=1e-6)
    deviation = found.std(axis=0)
    assert (np.isclose(deviation, 1) | (deviation == 0)).all()


def recording(fps: float = 60.0, seconds: float = 20) -> np.ndarray:
    t = np.arange(int(seconds * fps)) / fps
    switch = (t < seconds / 2)[:, None]
    one = np.column_stack([np.sin(6 * t), np.cos(6 * t)])
    two = np.column_stack([np.sin(11 * t) ** 3, np.cos(11 * t)])
    rng = np.random.default_rng(3)
    return np.where(switch, one, two) + 0.03 * rng.standard_normal((len(t), 2))


@given(
    gain=arrays.arrays(np.float64, 2, elements=st.floats(0.01, 100) | st.floats(-100, -0.01)),
    offset=arrays.arrays(np.float64, 2, elements=st.floats(-1e3, 1e3)),
    swap=st.booleans(),
    preset=st.sampled_from(["kineme", "krueger2017"]),
)
@settings(max_examples=10)
def test_units_zeros_signs_and_order_of_channels_change_no_cut(gain, offset, swap, preset) -> None:
    x = recording()
    other = (gain * x + offset)[:, ::-1] if swap else gain * x + offset
    a, b = (
        segment(Signals(x, 60), preset=preset),
        segment(Signals(other, 60), preset=preset),
    )
    assert a.cuts("primitive").tolist() == b.cuts("primitive").tolist()


def test_repeated_channels_change_no_cut() -> None:
    """The generalised radius does not depend on the number of channels."""
    x = recording()
    for preset in ("kineme", "voegele2014"):
        once = segment(Signals(x, 60), preset=preset)
        twice = segment(Signals(np.hstack([x, x]), 60), preset=preset)
        assert once.cuts("primitive").tolist() == twice.cuts("primitive").tolist()


def test_lengths_of_published_presets_are_those_of_a_body() -> None:
    r = resolve_preset(KRUEGER2017, signals=True).radius
    assert r * np.sqrt(5 * 15) * 0.13 == pytest.approx(KRUEGER2017.radius)
    assert resolve_preset("voegele2014", signals=True).radius == pytest.approx(0.734, abs=1e-3)
    assert resolve_preset("voegele2014", signals=True, radius=0.5).radius == 0.5
    assert resolve_preset(VOEGELE2014, signals=True).max_neighbors == VOEGELE2014.max_neighbors
    assert resolve_preset("kineme", signals=True) == SENSORS
    assert resolve_preset(KINEME, signals=True) == KINEME


@pytest.mark.parametrize("name", OWN)
def test_a_preset_made_for_signals_is_used_as_it_is(name: str) -> None:
    made = resolve_preset(name, signals=True)
    assert resolve_preset(made, signals=True) == made
    x = Signals(recording(), 60)
    by_name, passed_on = segment(x, preset=name), segment(x, preset=made)
    assert passed_on.table == by_name.table
    assert passed_on.provenance == by_name.provenance
    estimator = Segmenter(made, fps=60).fit(recording())
    assert estimator.segmentation_.provenance["parameters"] == by_name.provenance["parameters"]


def test_the_unit_of_lengths_is_in_the_provenance_and_is_not_an_option() -> None:
    x = Signals(recording(), 60)
    units = {name: segment(x, preset=name).provenance["parameters"]["unit"] for name in OWN}
    assert units == {
        "kineme": "any",
        "voegele2014": "standard deviations",
        "krueger2017": "standard deviations",
    }
    with pytest.raises(ParameterError, match="unit must be a number above 0, not 'metres'"):
        segment(x, preset="krueger2017", unit="metres")
    with pytest.raises(ParameterError, match="metres or standard deviations in krueger2017"):
        replace(KRUEGER2017, unit="inches")
    with pytest.raises(ParameterError, match="unit must be body sizes or any in kineme"):
        replace(KINEME, unit="metres")


def test_a_gap_is_a_transition_and_what_lies_around_it_is_compared() -> None:
    x = np.tile(recording(seconds=10)[:300], (4, 1))
    x[600:640] = 1e6
    found = segment(Signals(x, 60, gaps=[(600, 640)]))
    assert {600, 640} <= set(found.cuts().tolist())
    assert found.per_frame("kind")[600:640].tolist() == ["transition"] * 40
    assert found.per_frame()[300] == found.per_frame()[900]


def test_envelopes_follow_the_strength_of_a_muscle() -> None:
    fps = 1000.0
    t = np.arange(8000) / fps
    strength = np.clip(np.sin(2 * np.pi * 0.5 * t), 0, None)
    rng = np.random.default_rng(0)
    raw = strength * rng.standard_normal(len(t)) + 3.0
    envelope = emg_envelope(raw[:, None], fps)[:, 0]
    assert np.corrcoef(envelope, strength)[0, 1] > 0.97
    assert envelope.min() >= 0
    busy, quiet = envelope[250:750].mean(), envelope[1250:1750].mean()
    assert quiet < 0.1 * busy
    lag = np.argmax(np.correlate(envelope - envelope.mean(), strength - strength.mean(), "full"))
    assert abs(lag - (len(t) - 1)) < 0.02 * fps  # no delay


def test_bursts_of_a_muscle_are_repetitions() -> None:
    fps = 500.0
    t = np.arange(int(30 * fps)) / fps
    rng = np.random.default_rng(1)
    phases = [np.clip(np.sin(2 * np.pi * 0.5 * t + p), 0, None) for p in (0, 2)]
    raw = np.column_stack([s * rng.standard_normal(len(t)) for s in phases])
    found = segment(Signals(raw, fps), emg=True)
    (count,) = found.repetitions().values()
    assert count == 15
    assert "muscle signals: rectified and low-passed" in found.provenance["notes"]


def test_a_cutoff_beyond_the_samples_is_refused() -> None:
    with pytest.raises(ParameterError, match="needs a rate above 12 Hz, not 10"):
        emg_envelope(np.ones((50, 1)), 10)
    assert len(emg_envelope(np.ones((1, 1)), 100)) == 1


ONE, TWO = np.zeros(4), np.zeros((4, 2))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((np.zeros((0, 2)), 10), "frames x channels, not of shape"),
        ((np.array([0, np.nan]), 10), "first in frame 1"),
        ((ONE, 0), "frame rate is 0"),
        ((TWO, 10, ["a", "a"]), "give a different one"),
        ((ONE, 10, (), [(2, 1)]), "gap 2 to 1 must be within the 4 frames"),
        ((ONE, 10, (), [(0, 4)]), "cover the whole recording"),
        ((TWO, ["a", "b"], 10), r"frame rate is \['a', 'b'\]: it must be a positive"),
        ((TWO, 10, "ab"), "names of channels must be a list of texts, not 'ab'"),
        ((TWO, 10, [1, 2]), r"names of channels must be a list of texts, not \[1, 2\]"),
        (("imu.csv", 10), "signals must be an array of numbers, not 'imu.csv'"),
    ],
)
def test_signals_that_contradict_themselves(arguments, message) -> None:
    with pytest.raises(ParameterError, match=message):
        Signals(*arguments)


def test_channels_are_selected_by_name() -> None:
    signals = Signals(np.zeros((4, 3)), 10)
    assert signals.names == ("1", "2", "3")
    assert signals.select(["3", "1"]).names == ("3", "1")
    with pytest.raises(ParameterError, match="no channel '4'; there are 1, 2, 3"):
        signals.select(["4"])


def test_a_rate_beyond_all_measure_is_refused() -> None:
    with pytest.raises(ParameterError, match="check the frame rate"):
        segment(Signals(np.zeros((10, 1)), 1e-6))
