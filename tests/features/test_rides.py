"""Rides: a lift is found by what accelerometers feel, and nothing else is."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import kineme
from kineme.features.rides import rides
from kineme.recordings import Signals

FPS = 50.0
UP, DOWN = (20.0, 32.0), (60.0, 72.0)
"""Seconds of a ride upwards and one downwards."""


def pulses(seconds: float = 90.0) -> np.ndarray:
    """The acceleration of a lift: two seconds to gather speed, and to lose it."""
    t = np.arange(0, seconds, 1 / FPS)
    felt = np.zeros(len(t))
    for (start, stop), way in ((UP, 1), (DOWN, -1)):
        felt += way * 0.5 * ((start <= t) & (t < start + 2))
        felt -= way * 0.5 * ((stop - 2 <= t) & (t < stop))
    return felt


def worn(felt: np.ndarray, sensors: int = 2, seed: int = 0) -> np.ndarray:
    """Accelerometers that hang in any way, on somebody who stands."""
    rng = np.random.default_rng(seed)
    hang = Rotation.random(sensors, random_state=seed).as_matrix()[:, 2].ravel()
    return (9.81 + felt)[:, None] * hang + 0.03 * rng.standard_normal((len(felt), 3 * sensors))


@given(seed=st.integers(0, 99), sensors=st.integers(2, 5), unit=st.sampled_from([1e-3, 1, 1670]))
@settings(max_examples=20)
def test_a_lift_is_found_however_sensors_hang_and_in_any_unit(seed, sensors, unit) -> None:
    found = rides(unit * worn(pulses(), sensors, seed), FPS)
    times = [(ride.start / FPS, ride.stop / FPS, ride.speed) for ride in found]
    assert np.allclose(times, [(*UP, 1), (*DOWN, -1)], atol=0.4)


def test_gyroscopes_beside_them_play_no_part() -> None:
    rng = np.random.default_rng(1)
    felt = worn(pulses())
    turns = 3 * rng.standard_normal((len(felt), 3))
    beside = np.hstack([felt[:, :3], turns, felt[:, 3:], turns])
    assert np.allclose(rides(beside, FPS), rides(felt, FPS))


def test_one_sensor_does_not_tell_a_lift_from_sitting_down() -> None:
    assert rides(worn(pulses(), sensors=1), FPS) == []


def test_what_only_one_sensor_feels_carries_nobody() -> None:
    felt = worn(np.zeros(len(pulses())))
    felt[:, :3] = worn(pulses())[:, :3]
    assert rides(felt, FPS) == []


def test_walking_and_places_in_a_room_are_no_rides() -> None:
    t = np.arange(0, 90, 1 / FPS)
    standing = worn(np.zeros(len(t)))
    steps = 3 * np.sin(2 * np.pi * 1.8 * t)[:, None] * np.where(t < 45, 0, 1)[:, None]
    assert rides(standing + steps, FPS) == []
    towards = np.interp(t, [0, 20, 25, 50, 55, 90], [3.0, 3.0, 2.0, 2.0, 3.0, 3.0])
    noise = 0.003 * np.random.default_rng(2).standard_normal((len(t), 6))
    assert rides(towards[:, None] * [0.1, 0.2, 1, -0.1, 0.5, 1] + noise, FPS) == []


@pytest.mark.parametrize("values", [np.zeros((2000, 6)), np.ones((3, 6)), np.ones((2000, 2))])
def test_nothing_moves_nothing_rides(values) -> None:
    assert rides(values, FPS) == []


def test_who_rides_is_told_from_who_stands() -> None:
    signals = Signals(worn(pulses()), FPS)

    def done(**constants: float) -> list[int]:
        """What is done before, on the way up, between, on the way down and after."""
        rows = kineme.segment(signals, **constants).activities
        at = [np.searchsorted(rows.stop_s, moment, "right") for moment in (10, 26, 46, 66, 82)]
        return rows.cluster[at].tolist()

    before, up, between, down, after = done()
    assert before == between == after
    assert len({before, up, down}) == 3
    assert len(set(done(ride_weight=0.0))) == 1
    notes = kineme.segment(signals).provenance["notes"]
    assert any("carried for 25 s, as by a lift" in note for note in notes)
