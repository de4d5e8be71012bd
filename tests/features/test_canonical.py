"""The canonical body: found in any skeleton, and independent of size and shape."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import kineme
from kineme.datasets import Action, synthesize
from kineme.errors import EndEffectorError, MotionError
from kineme.features import mirror
from kineme.features.canonical import (
    JOINTS,
    match_canonical_joints,
    matching_features,
    matching_poses,
    mirror_poses,
)
from kineme.recordings import Motion, Skeleton
from kineme.recordings.kinematics import forward_kinematics
from kineme.recordings.operations import move, resample, scale, turn

FORMATS = {
    "cmu86/86_01.amc": ("lfemur", "ltibia", "lfoot", "lhumerus", "lradius", "lhand"),
    "cmu_formats/02_01.bvh": (
        *("LeftUpLeg", "LeftLeg", "LeftFoot", "LeftArm", "LeftForeArm", "LeftHand"),
    ),
    "cmu_formats/02_01.c3d": ("left_hip", "LKNE", "left_ankle", "LSHO", "LELB", "left_wrist"),
    "formats/aitviewer_sample.bvh": (
        *("LeftHip", "LeftKnee", "LeftAnkle", "LeftShoulder", "LeftElbow", "LeftWrist"),
    ),
    "formats/subject01_walk.trc": (
        *("left_hip", None, "left_ankle", "L.Acromium", "L.Elbow", "left_wrist"),
    ),
    "sets/utkinect/recordings/s01_e01.parquet": (
        *("left_hip", "knee_l", "left_ankle", "shoulder_l", "elbow_l", "left_wrist"),
    ),
}


def perform(name: str = "walk", fps: float = 60) -> Motion:
    return synthesize([Action(name, repetitions=3)], fps=fps).motion


def measure_chords(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return np.linalg.norm(one - other, axis=1)


@pytest.mark.parametrize("path", FORMATS)
@pytest.mark.filterwarnings("ignore::kineme.errors.KinemeWarning")
def test_joints_of_skeletons_and_markers(path: str, data_dir: Path) -> None:
    motion = kineme.read(data_dir / path)
    found = match_canonical_joints(motion)
    names = {joint: motion.skeleton.names[points[0]] for joint, points in found.items()}
    parts = ("hip", "knee", "ankle", "shoulder", "elbow", "wrist")
    assert tuple(names.get(f"left_{part}") for part in parts) == FORMATS[path]
    assert {joint for joint in JOINTS if joint not in found} <= {"left_knee", "right_knee"}


def test_where_how_large_and_at_which_rate_does_not_matter() -> None:
    motion = perform()
    features = matching_features(motion)
    for other in (move(motion, (3, 0, -5)), turn(motion, 2.0), scale(motion, 1.7)):
        assert measure_chords(matching_features(other), features).max() < 1e-3
    assert measure_chords(matching_features(resample(motion, 90)), features).max() < 0.1


def test_the_shape_of_a_body_does_not_matter() -> None:
    motion = perform()
    offsets = motion.skeleton.offsets.copy()
    for joint, name in enumerate(motion.skeleton.names):
        if name in {"LeftForeArm", "RightForeArm", "LeftHand", "RightHand"}:
            offsets[joint] *= 1.4
    skeleton = replace(motion.skeleton, offsets=offsets)
    root = motion.positions[:, 0]
    longer = forward_kinematics(skeleton, motion.rotations, root)
    other = replace(motion, skeleton=skeleton, positions=longer)
    assert np.abs(longer - motion.positions).max() > 0.1
    assert measure_chords(matching_features(other), matching_features(motion)).max() < 1e-3


def test_a_cut_has_the_features_of_the_whole() -> None:
    motion = perform()
    whole, cut = matching_features(motion), matching_features(motion[60:240])
    assert np.median(measure_chords(cut[4:-4], whole[15:60][4:-4])) < 0.01


def test_frames_in_which_nobody_is_seen_are_zero() -> None:
    motion = replace(perform(), gaps=((60, 120),))
    features = matching_features(motion)
    unseen = np.flatnonzero(~features.any(axis=1))
    assert unseen.tolist() == list(range(15, 30))


def test_limbs_without_knees_elbows_and_shoulders_do() -> None:
    motion = perform()
    found = match_canonical_joints(motion)
    kept = [j for j in JOINTS if not any(part in j for part in ("knee", "elbow", "shoulder"))]
    points = np.stack([motion.positions[:, found[j][0]] for j in kept], axis=1)
    pelvis = (points[:, kept.index("left_hip")] + points[:, kept.index("right_hip")]) / 2
    positions = np.concatenate([pelvis[:, None], points], axis=1)
    skeleton = Skeleton(
        ("pelvis", *kept),
        (-1, *(0 if "ankle" not in j else kept.index(j.replace("ankle", "hip")) + 1 for j in kept)),
        positions[0] - positions[0, 0],
    )
    few = matching_features(Motion(skeleton, positions, motion.fps))
    assert measure_chords(few, matching_features(motion)).mean() < 0.6


@pytest.mark.filterwarnings("ignore::kineme.errors.KinemeWarning")
def test_what_is_no_body_is_refused(data_dir: Path) -> None:
    with pytest.raises(EndEffectorError, match="not found"):
        matching_features(kineme.read(data_dir / "formats" / "Dec_real.c3d"))


def test_legs_without_hips_are_refused() -> None:
    names = ("LeftFoot", "RightFoot", "Head", "LeftHand", "RightHand")
    points = np.random.default_rng(0).normal(size=(30, 5, 3))
    motion = Motion(Skeleton(names, (-1,) * 5, points[0]), points, 30)
    with pytest.raises(MotionError, match="left leg has no hip"):
        matching_features(motion)


def test_mirrored_features_are_those_of_the_mirrored_motion() -> None:
    motion = perform("kick")
    mirrored = matching_features(mirror(motion))
    assert measure_chords(matching_features(motion, mirrored=True), mirrored).max() < 1e-3
    poses = matching_poses(motion)
    np.testing.assert_allclose(mirror_poses(mirror_poses(poses)), poses)
    np.testing.assert_allclose(mirror_poses(poses), matching_poses(mirror(motion)), atol=1e-6)
