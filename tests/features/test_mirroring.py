"""Mirroring: an involution, consistent for motions and features."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import kineme
import naive
from kineme.datasets import Action, bundled_recording, random_recording, synthesize
from kineme.errors import MotionError, ParameterError
from kineme.features import end_effectors, mirror, mirror_features, pose_features, stack
from kineme.recordings import Motion, Skeleton
from kineme.recordings.kinematics import forward_kinematics

KICKS = synthesize([Action("walk", 2), Action("kick", 3, side="left")], fps=30, seed=4).motion
few = settings(max_examples=10)


def drop_rotations(motion: Motion) -> Motion:
    return Motion(motion.skeleton, motion.positions, motion.fps)


def assert_same_motion(found: Motion, expected: Motion) -> None:
    np.testing.assert_allclose(found.positions, expected.positions, atol=1e-9)
    assert found.skeleton is expected.skeleton
    if expected.rotations is not None:
        np.testing.assert_allclose(found.rotations, expected.rotations, atol=1e-9)


@given(st.integers(0, 50))
@few
def test_mirroring_twice_is_the_identity(seed: int) -> None:
    motion = random_recording(seed, activities=2, fps=30).motion
    assert_same_motion(mirror(mirror(motion)), motion)


@given(st.integers(0, 50), st.booleans())
@few
def test_features_of_the_mirrored_motion_are_the_mirrored_features(seed, with_rotations) -> None:
    motion = random_recording(seed, activities=2, fps=30).motion
    motion = motion if with_rotations else drop_rotations(motion)
    features = stack(pose_features(motion), (-5, 0, 5))
    found = stack(pose_features(mirror(motion)), (-5, 0, 5))
    np.testing.assert_allclose(found, mirror_features(features), atol=1e-12)


@pytest.mark.parametrize(
    "name",
    ["cmu86/86_01.amc", "cmu_formats/02_01.bvh", "formats/aitviewer_sample.bvh",
     "formats/PyMO_AV_8Walk.bvh", "formats/cmu_131_01_bvh11.bvh"],
)  # fmt: skip
def test_recorded_bodies_have_two_sides(data_dir: Path, name: str) -> None:
    motion = kineme.read(data_dir / name)
    mirrored = mirror(motion)
    assert_same_motion(mirror(mirrored), motion)
    names = motion.skeleton.names
    for joint, name in enumerate(names):
        if any(side in name.lower() for side in ("left", "right")):
            assert not np.array_equal(mirrored.positions[:, joint], motion.positions[:, joint])
    # The sides of a recorded body differ by some centimetres, and it keeps them.
    np.testing.assert_allclose(
        pose_features(mirrored), mirror_features(pose_features(motion)), atol=0.08
    )


@pytest.mark.filterwarnings("ignore::kineme.errors.KinemeWarning")
@pytest.mark.parametrize(
    "name",
    ["bandai_namco/dataset-1_dash_normal_001.bvh", "samba.fbx", "Xbot.glb"],
)
def test_bones_along_any_axis_are_mirrored_on_the_same_rig(data_dir: Path, name: str) -> None:
    motion = kineme.read(data_dir / "rigs" / name)[:60]
    mirrored = mirror(motion)
    assert_same_motion(mirror(mirrored), motion)
    swap = {"left": "right", "right": "left", "_l": "_r", "_r": "_l"}
    names = [each.lower() for each in motion.skeleton.names]
    partners = [
        next(
            (
                names.index(o)
                for s in swap
                if (o := each.replace(s, swap[s])) in names and o != each
            ),
            j,
        )
        for j, each in enumerate(names)
    ]
    assert sum(j != k for j, k in enumerate(partners)) >= 16
    # No farther than its own sides differ.
    expected = motion.positions[:, partners] * [-1, 1, 1]
    np.testing.assert_allclose(mirrored.positions, expected, atol=0.003)


def test_the_right_leg_kicks_in_the_mirror() -> None:
    def height(motion: Motion, joint: int) -> float:
        return float(np.ptp(motion.positions[60:, joint, 1]))

    left, right, *_ = end_effectors(KICKS).indices
    mirrored = mirror(KICKS)
    assert height(KICKS, left) > 1.5 * height(KICKS, right)
    assert height(mirrored, right) == pytest.approx(height(KICKS, left), abs=1e-9)
    np.testing.assert_array_equal(mirrored.positions[:, 0], KICKS.positions[:, 0] * [-1, 1, 1])
    assert mirrored.provenance.notes[-1] == "mirrored"


def test_rotations_of_the_mirrored_motion_give_its_positions() -> None:
    mirrored = mirror(kineme.read(bundled_recording()))
    positions = forward_kinematics(mirrored.skeleton, mirrored.rotations, mirrored.positions[:, 0])
    np.testing.assert_allclose(positions, mirrored.positions, atol=1e-9)


def test_features_equal_to_the_naive_version() -> None:
    rows = np.random.default_rng(0).normal(size=(6, 45))
    expected = [
        [number for block in np.split(row, 3) for number in naive.mirror_pose(block)]
        for row in rows
    ]
    np.testing.assert_array_equal(mirror_features(rows), expected)
    np.testing.assert_array_equal(mirror_features(mirror_features(rows)), rows)


@pytest.mark.parametrize("shape", [(4, 16), (4, 0), (15,)])
def test_only_pose_features_have_a_mirror_image(shape: tuple[int, ...]) -> None:
    with pytest.raises(ParameterError, match="multiple of 15"):
        mirror_features(np.zeros(shape))


def make_body(*names: str) -> Motion:
    """Make a skeleton whose joints are all children of the first."""
    skeleton = Skeleton(names, (-1,) + (0,) * (len(names) - 1), np.ones((len(names), 3)))
    return Motion(skeleton, np.zeros((2, len(names), 3)), 30.0)


@pytest.mark.parametrize(
    ("left", "right"),
    [("LeftHand", "RightHand"), ("hand.L", "hand.R"), ("Bip01 L Hand", "Bip01 R Hand"),
     ("lfoot", "rfoot"), ("WristLeft", "WristRight"), ("mixamorig:LeftArm", "mixamorig:RightArm"),
     ("lower_l", "lower_r"), ("LEFT_KNEE", "RIGHT_KNEE"), ("l_finger2", "r_finger2")],
)  # fmt: skip
def test_names_of_all_programs_tell_the_side(left: str, right: str) -> None:
    motion = make_body("hips", left, "middle", right)
    positions = np.arange(24.0).reshape(2, 4, 3)
    found = mirror(Motion(motion.skeleton, positions, 30.0)).positions
    np.testing.assert_array_equal(found, positions[:, [0, 3, 2, 1]] * [-1, 1, 1])


def test_a_body_without_sides_is_refused() -> None:
    with pytest.raises(MotionError, match="no joint names form a pair"):
        mirror(make_body("hips", "a", "b"))


def test_limbs_that_hang_elsewhere_are_refused() -> None:
    skeleton = Skeleton(("hips", "lhand", "chest", "rhand"), (-1, 0, 0, 2), np.ones((4, 3)))
    with pytest.raises(MotionError, match="'lhand' has no counterpart"):
        mirror(Motion(skeleton, np.zeros((1, 4, 3)), 30.0))
