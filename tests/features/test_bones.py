"""Channels are a body where they have bones, and what sensors measure has none."""

from __future__ import annotations

import numpy as np
import pytest

import kineme
from kineme.datasets import Action, synthesize
from kineme.features.distances import have_bones
from kineme.recordings import Signals


@pytest.fixture(scope="module")
def made():
    actions = [Action(name, 5) for name in ("walk", "squat", "wave", "walk")]
    return synthesize(actions, fps=30, seed=0)


def as_channels(positions: np.ndarray, *, unit: float = 1.0) -> Signals:
    """The places of joints in a table, none of which says that this is a body."""
    names = [f"p{point}_{axis}" for point in range(positions.shape[1]) for axis in "xyz"]
    return Signals(unit * positions.reshape(len(positions), -1), 30.0, names)


def test_a_body_has_bones_and_camera_noise_breaks_none(made) -> None:
    positions = made.motion.positions
    noise = 0.02 * np.random.default_rng(0).standard_normal(positions.shape)
    assert have_bones(positions)
    assert have_bones(positions + noise)


def test_what_never_bends_sensors_and_few_points_are_no_body(made) -> None:
    positions = made.motion.positions
    box = positions[:, :1] + np.random.default_rng(0).standard_normal((8, 3))
    sensors = np.random.default_rng(0).standard_normal((500, 6, 3)) + [0, 9.81, 0]
    assert not have_bones(box)
    assert not have_bones(sensors)
    assert not have_bones(positions[:, :4])
    assert not have_bones(np.ones((50, 8, 3)))


def test_where_a_person_is_and_faces_changes_nothing(made) -> None:
    positions = made.motion.positions
    turn = np.array([[0.6, 0, 0.8], [0, 1, 0], [-0.8, 0, 0.6]])
    here, there = (
        kineme.segment(as_channels(each)) for each in (positions, positions @ turn.T + [3, 0, -5])
    )
    assert len(here.activities) > 2
    assert here.activities.start_frame.tolist() == there.activities.start_frame.tolist()
    assert here.activities.cluster.tolist() == there.activities.cluster.tolist()


def test_who_walks_about_and_turns_between_exercises_does_the_same_ones(made) -> None:
    still = made.motion.positions
    angle = np.linspace(0, 4, len(still))[:, None]
    x, z = still[..., 0], still[..., 2]
    moved = np.stack(
        [
            np.cos(angle) * x + np.sin(angle) * z + angle,
            still[..., 1],
            np.cos(angle) * z - np.sin(angle) * x,
        ],
        axis=2,
    )
    here, there = (kineme.segment(as_channels(each)) for each in (still, moved))
    assert np.allclose(here.activities.start_frame, there.activities.start_frame, atol=3)
    assert here.activities.cluster.tolist() == there.activities.cluster.tolist()


def test_the_unit_plays_no_part_and_the_result_says_what_was_seen(made) -> None:
    metres, millimetres = (
        kineme.segment(as_channels(made.motion.positions, unit=unit)) for unit in (1, 1000)
    )
    assert metres.activities.start_frame.tolist() == millimetres.activities.start_frame.tolist()
    assert any("points with bones" in note for note in metres.provenance["notes"])


def test_other_channels_beside_a_body_are_seen_as_well(made) -> None:
    body = as_channels(made.motion.positions)
    half = (np.arange(body.n_frames) < body.n_frames // 2).astype(float)
    both = Signals(np.column_stack([body.values, half]), 30.0, [*body.names, "handle"])
    alone, beside = (kineme.segment(each).activities.cluster for each in (body, both))
    assert alone[0] == alone[-1]
    assert beside[0] != beside[-1]


def test_what_counts_for_joints_counts_for_nothing_else(made) -> None:
    constants = {"velocity_weight": 9.0}
    body = as_channels(made.motion.positions)
    sensors = Signals(body.values, body.fps)
    for channels, same in ((body, False), (sensors, True)):
        before, after = (kineme.segment(channels, **each).activities for each in ({}, constants))
        assert (before.start_frame.tolist() == after.start_frame.tolist()) is same


@pytest.mark.parametrize("constants", [{"standardize": False}, {"preset": "krueger2017"}])
def test_whoever_wants_channels_as_they_are_gets_them(made, constants) -> None:
    found = kineme.segment(as_channels(made.motion.positions), **constants)
    assert not any("points with bones" in note for note in found.provenance["notes"])
