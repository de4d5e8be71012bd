"""Pose features: the authors' values, naive versions, and invariances."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial.transform import Rotation

import kineme.formats
import naive
from kineme.datasets import Action, synthesize
from kineme.errors import EndEffectorError, MotionError, ParameterError
from kineme.features import (
    compute_body_frame,
    end_effectors,
    pose_features,
    round_offsets,
    stack,
)
from kineme.recordings import Motion, Skeleton
from kineme.recordings.operations import move, scale, turn

RECORDING = synthesize([Action("walk", 2), Action("kick", 2)], fps=30, seed=3).motion
OFFSETS = st.lists(st.integers(-40, 40), min_size=1, max_size=6, unique=True)


@pytest.mark.parametrize(("trial", "tolerance"), [
    ("01", 0.001), ("09", 0.001), ("10", 0.05), ("11", 0.05), ("14", 0.05),
])  # fmt: skip
def test_equal_to_the_authors_program(data_dir: Path, trial: str, tolerance: float) -> None:
    source = kineme.formats.read(data_dir / "cmu86" / f"86_{trial}.amc")
    motion = Motion(source.skeleton, source.positions[::4], 30.0, source.rotations[::4])
    features = pose_features(motion)
    for reference, offsets in (("2017_plain", (-10, -5, 0, 5, 10)), ("2014_paper", (-5, 0, 5))):
        with np.load(data_dir / "cmu86" / "reference" / f"{reference}_86_{trial}.npz") as stored:
            expected_cm = stored["features"].T
        np.testing.assert_allclose(100 * stack(features, offsets), expected_cm, atol=tolerance)


def test_equal_to_the_naive_version() -> None:
    joints = end_effectors(RECORDING).indices
    expected = naive.pose_features(RECORDING, joints)
    np.testing.assert_allclose(pose_features(RECORDING), expected, atol=1e-12)


@given(
    st.floats(-7, 7),
    st.tuples(*[st.floats(-100, 100)] * 3),
    st.floats(0.01, 100),
    st.sampled_from([True, False]),
)
@settings(max_examples=40)
def test_moving_and_turning_change_nothing_and_scaling_scales(
    angle: float, shift: tuple[float, float, float], factor: float, with_rotations: bool
) -> None:
    still = RECORDING if with_rotations else replace(RECORDING, rotations=None)
    expected = pose_features(still)
    moved = move(turn(still, angle), shift)
    np.testing.assert_allclose(pose_features(moved), expected, atol=1e-10)
    larger = pose_features(scale(still, factor))
    np.testing.assert_allclose(larger, factor * expected, rtol=1e-9, atol=1e-9)


def test_left_is_x_up_is_y_ahead_is_z() -> None:
    local = compute_body_frame(RECORDING)
    joint = RECORDING.joint
    assert (local[:, joint("LeftUpLeg"), 0] > 0.05).all()
    assert (local[:, joint("RightUpLeg"), 0] < -0.05).all()
    assert (local[:, joint("Head_end"), 1] > 0.3).all()
    foot = local[:, joint("RightToeBase_end")] - local[:, joint("RightFoot")]
    assert foot[:, 2].mean() > 0.05


@pytest.mark.parametrize("axis", ["x", "y", "z"])
@pytest.mark.parametrize("quarter_turns", [1, 2, 3])
def test_a_root_frame_turned_by_the_exporter_changes_nothing(axis: str, quarter_turns: int) -> None:
    """Return the same motion with permuted axes of the root."""
    turn = Rotation.from_euler(axis, 90 * quarter_turns, degrees=True)
    skeleton = RECORDING.skeleton
    offsets = skeleton.offsets.copy()
    rotations = RECORDING.rotations.copy()
    first = Rotation.from_quat(rotations[:, 0], scalar_first=True)
    rotations[:, 0] = (first * turn.inv()).as_quat(scalar_first=True)
    for joint, parent in enumerate(skeleton.parents):
        if parent == 0:
            offsets[joint] = turn.apply(offsets[joint])
    other = replace(RECORDING, skeleton=replace(skeleton, offsets=offsets), rotations=rotations)
    np.testing.assert_allclose(pose_features(other), pose_features(RECORDING), atol=1e-12)


def test_a_node_above_the_pelvis_changes_nothing() -> None:
    skeleton = RECORDING.skeleton
    tall = Skeleton(
        ("Armature", *skeleton.names),
        (-1, *(parent + 1 for parent in skeleton.parents)),
        np.concatenate([np.zeros((1, 3)), skeleton.offsets]),
        frozenset(joint + 1 for joint in skeleton.end_sites),
    )
    quarter = np.array([np.sqrt(0.5), 0.0, np.sqrt(0.5), 0.0])
    first = Rotation.from_quat(RECORDING.rotations[:, 0], scalar_first=True)
    below = (Rotation.from_quat(quarter, scalar_first=True).inv() * first).as_quat(
        scalar_first=True
    )
    rotations = np.concatenate(
        [np.tile(quarter, (RECORDING.n_frames, 1, 1)), below[:, None], RECORDING.rotations[:, 1:]],
        axis=1,
    )
    positions = np.concatenate([np.zeros((RECORDING.n_frames, 1, 3)), RECORDING.positions], axis=1)
    other = Motion(tall, positions, 30.0, rotations)
    np.testing.assert_allclose(pose_features(other), pose_features(RECORDING), atol=1e-12)


def test_lying_on_the_side_keeps_the_last_facing() -> None:
    quaternions = RECORDING.rotations[:9].copy()
    on_the_side = Rotation.from_euler("z", 90, degrees=True).as_quat(scalar_first=True)
    quaternions[:, 0] = Rotation.from_euler("y", 30, degrees=True).as_quat(scalar_first=True)
    quaternions[3:7, 0] = on_the_side
    motion = Motion.from_rotations(RECORDING.skeleton, quaternions, 30.0, np.zeros((9, 3)))
    local = compute_body_frame(motion)
    relative = motion.positions - motion.positions[:, :1]
    back = Rotation.from_euler("y", -30, degrees=True)
    for frame in range(9):
        np.testing.assert_allclose(local[frame], back.apply(relative[frame]), atol=1e-12)
    never = Motion.from_rotations(RECORDING.skeleton, quaternions[3:7], 30.0, np.zeros((4, 3)))
    np.testing.assert_array_equal(compute_body_frame(never), never.positions)


def test_legs_without_hips_are_refused() -> None:
    names = ("root", "LeftFoot", "RightFoot", "Head", "LeftHand", "RightHand")
    flat = Skeleton(names, (-1, 0, 0, 0, 0, 0), np.zeros((6, 3)))
    with pytest.raises(MotionError, match="coincide below 'root'"):
        pose_features(Motion(flat, np.zeros((2, 6, 3)), 30.0))


def test_effectors_can_be_named() -> None:
    named = pose_features(RECORDING, effectors={"left_wrist": "LeftHand_end"})
    plain = pose_features(RECORDING)
    np.testing.assert_array_equal(named[:, :9], plain[:, :9])
    assert np.linalg.norm(named[:, 9:12] - plain[:, 9:12], axis=1).min() > 0.1
    with pytest.raises(EndEffectorError):
        pose_features(RECORDING, effectors=["Head"])


@given(
    arrays(float, st.tuples(st.integers(1, 12), st.integers(1, 4)), elements=st.floats(-9, 9)),
    OFFSETS,
)
def test_stacking_equals_the_naive_version(features: np.ndarray, offsets: list[int]) -> None:
    np.testing.assert_allclose(stack(features, offsets), naive.stack(features, offsets), atol=1e-9)


def test_offsets_become_frames() -> None:
    assert round_offsets((1 / 3, 0, -1 / 3, 1 / 6, -1 / 6), 30.0) == (-10, -5, 0, 5, 10)
    with pytest.raises(ParameterError, match="same frame at 10 Hz"):
        round_offsets((0, 0.01), 10.0)
    with pytest.raises(ParameterError, match="finite"):
        round_offsets((0, float("nan")), 10.0)
    with pytest.raises(ParameterError, match="fps"):
        round_offsets((0,), 0.0)


@pytest.mark.parametrize(
    ("features", "offsets"), [(np.zeros(3), (0,)), (np.zeros((0, 3)), (0,)), (np.zeros((3, 2)), ()),
                              (np.zeros((3, 2)), (1, 1))],
)  # fmt: skip
def test_stacking_refuses_what_makes_no_sense(features: np.ndarray, offsets: tuple) -> None:
    with pytest.raises(ParameterError):
        stack(features, offsets)
