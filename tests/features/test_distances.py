"""Distances between points: chosen points, and invariances."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import pdist
from scipy.spatial.transform import Rotation

import kineme
from kineme.datasets import Action, synthesize
from kineme.errors import MotionError
from kineme.features import compute_distance_features
from kineme.features.distances import choose_spread_points, have_bones
from kineme.recordings import Signals

WALK = synthesize([Action("walk", 6), Action("kick", 5)], fps=30, seed=1).motion.positions
SHAPE = pdist(compute_distance_features(WALK)[0])


@given(
    st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1),
    st.tuples(*[st.floats(-50, 50)] * 3),
    st.floats(0.1, 10),
)
@settings(max_examples=10)
def test_moving_turning_and_scaling_change_nothing(quaternion, offset, scale) -> None:
    turned = WALK @ Rotation.from_quat(quaternion).as_matrix()
    features, _ = compute_distance_features(scale * turned + offset)
    np.testing.assert_allclose(pdist(features), SHAPE, atol=1e-6)


def test_points_in_one_place_and_points_of_the_lab_are_left_out() -> None:
    n = WALK.shape[1]
    lab = np.broadcast_to([[3.0, 0, 2], [3.0, 1, 2]], (len(WALK), 2, 3))
    chosen = choose_spread_points(np.concatenate([WALK, WALK, lab], axis=1), most=100)
    assert chosen.max() < 2 * n
    assert len(chosen) == len(set(chosen % n))


def test_what_is_rigid_has_no_features() -> None:
    rigid = WALK[:, :1] + np.random.default_rng(0).normal(size=(5, 3))
    features, _ = compute_distance_features(
        rigid + np.random.default_rng(1).normal(0, 1e-4, rigid.shape)
    )
    assert not features.any()


def test_a_marker_taken_for_another_for_a_frame_changes_little() -> None:
    swapped = WALK.copy()
    swapped[100, 3] = swapped[100, 9]
    features, _ = compute_distance_features(swapped)
    np.testing.assert_allclose(pdist(features), SHAPE, atol=0.05)


@pytest.mark.parametrize("frames", [1, 2, 3])
def test_few_frames_are_enough(frames: int) -> None:
    assert len(compute_distance_features(WALK[:frames])[0]) == frames


def test_a_single_point_is_refused() -> None:
    with pytest.raises(MotionError, match="single point.*signals"):
        compute_distance_features(WALK[:, :1])


def test_very_many_points_cost_no_more_than_many() -> None:
    """Eight thousand bones of a damaged file: all pairs of them would be a gigabyte."""
    rng = np.random.default_rng(0)
    swing = np.sin(np.linspace(0, 20, 90))[:, None, None] * rng.normal(size=(8_000, 3))
    features, points = compute_distance_features(rng.normal(size=(8_000, 3)) + swing)
    assert features.shape == (90, 15)
    assert 2 <= len(points) <= 16


@pytest.fixture(scope="module")
def made():
    actions = [Action(name, 5) for name in ("walk", "squat", "wave", "walk")]
    return synthesize(actions, fps=30, seed=0)


def as_channels(positions: np.ndarray) -> Signals:
    """Positions of joints as channels without a known body."""
    names = [f"p{point}_{axis}" for point in range(positions.shape[1]) for axis in "xyz"]
    return Signals(positions.reshape(len(positions), -1), 30.0, names)


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
    assert any("points with bones" in note for note in here.provenance["notes"])


def test_other_channels_beside_a_body_are_seen_as_well(made) -> None:
    body = as_channels(made.motion.positions)
    half = (np.arange(body.n_frames) < body.n_frames // 2).astype(float)
    both = Signals(np.column_stack([body.values, half]), 30.0, [*body.names, "handle"])
    alone, beside = (kineme.segment(each).activities.cluster for each in (body, both))
    assert alone[0] == alone[-1]
    assert beside[0] != beside[-1]


@pytest.mark.parametrize("constants", [{"standardize": False}, {"preset": "krueger2017"}])
def test_whoever_wants_channels_as_they_are_gets_them(made, constants) -> None:
    found = kineme.segment(as_channels(made.motion.positions), **constants)
    assert not any("points with bones" in note for note in found.provenance["notes"])
