"""Distances between points: what they are of, and what does not change them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import pdist
from scipy.spatial.transform import Rotation

from kineme.datasets import Action, synthesize
from kineme.errors import MotionError
from kineme.features import distance_features
from kineme.features.distances import MOST_POINTS, VARIATION, spread_points

WALK = synthesize([Action("walk", 6), Action("kick", 5)], fps=30, seed=1).motion.positions
SHAPE = pdist(distance_features(WALK)[0])


@given(
    st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1),
    st.tuples(*[st.floats(-50, 50)] * 3),
    st.floats(0.1, 10),
)
@settings(max_examples=10)
def test_moving_turning_and_scaling_change_nothing(quaternion, offset, scale) -> None:
    turned = WALK @ Rotation.from_quat(quaternion).as_matrix()
    features, _ = distance_features(scale * turned + offset)
    np.testing.assert_allclose(pdist(features), SHAPE, atol=1e-6)


def test_it_varies_as_a_pose_does() -> None:
    for points in (WALK, WALK[:, :4], 0.1 * WALK):
        features, _ = distance_features(points)
        assert features.shape[1] <= 15
        assert np.sqrt(features.var(axis=0).sum()) == pytest.approx(VARIATION, rel=0.05)


def test_some_points_of_many_stand_for_all() -> None:
    rng = np.random.default_rng(0)
    cloud = (WALK[:, :, None] + rng.normal(0, 0.01, (WALK.shape[1], 6, 3))).reshape(
        len(WALK), -1, 3
    )
    chosen = spread_points(cloud)
    assert len(chosen) == MOST_POINTS
    assert len({point // 6 for point in chosen}) == MOST_POINTS  # none twice


def test_points_in_one_place_and_points_of_the_lab_are_left_out() -> None:
    n = WALK.shape[1]
    lab = np.broadcast_to([[3.0, 0, 2], [3.0, 1, 2]], (len(WALK), 2, 3))
    chosen = spread_points(np.concatenate([WALK, WALK, lab], axis=1), most=100)
    assert chosen.max() < 2 * n
    assert len(chosen) == len(set(chosen % n))


def test_what_stands_still_but_carries_others_is_a_part_of_the_body() -> None:
    arm = WALK[:, 1:] - WALK[:, :1]  # seen from the pelvis, which then never moves
    assert 0 in spread_points(np.concatenate([np.zeros((len(WALK), 1, 3)), arm], axis=1), most=100)


def test_what_is_rigid_has_no_features() -> None:
    rigid = WALK[:, :1] + np.random.default_rng(0).normal(size=(5, 3))
    features, _ = distance_features(rigid + np.random.default_rng(1).normal(0, 1e-4, rigid.shape))
    assert not features.any()


def test_a_marker_taken_for_another_for_a_frame_changes_little() -> None:
    swapped = WALK.copy()
    swapped[100, 3] = swapped[100, 9]
    features, _ = distance_features(swapped)
    np.testing.assert_allclose(pdist(features), SHAPE, atol=0.05)


@pytest.mark.parametrize("frames", [1, 2, 3])
def test_few_frames_are_enough(frames: int) -> None:
    assert len(distance_features(WALK[:frames])[0]) == frames


def test_a_single_point_is_refused() -> None:
    with pytest.raises(MotionError, match="single point.*signals"):
        distance_features(WALK[:, :1])


def test_very_many_points_cost_no_more_than_many() -> None:
    """Eight thousand bones of a damaged file: all pairs of them would be a gigabyte."""
    rng = np.random.default_rng(0)
    swing = np.sin(np.linspace(0, 20, 90))[:, None, None] * rng.normal(size=(8_000, 3))
    features, points = distance_features(rng.normal(size=(8_000, 3)) + swing)
    assert features.shape == (90, 15)
    assert 2 <= len(points) <= 16
