"""Recordings in which head, hands and feet are not all found: markers of legs, of an arm."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import kineme
from kineme.datasets import Action, SyntheticRecording, synthesize
from kineme.errors import EndEffectorError, MotionError, ParameterError
from kineme.evaluation import Truth, evaluate, make_labelling
from kineme.methods.presets import PRESETS
from kineme.methods.segmenter import segment
from kineme.recordings import Motion, Skeleton
from kineme.segments.segmentation import Segmentation

LEGS = [side + joint for side in ("Left", "Right") for joint in ("UpLeg", "Leg", "Foot", "ToeBase")]
EXERCISES = ("walk", 6), ("squat", 5), ("kick", 4), ("walk", 5)


@cache
def exercises(seed: int) -> SyntheticRecording:
    return synthesize([Action(name, n) for name, n in EXERCISES], fps=60, seed=seed)


def markers(motion: Motion, names: list[str]) -> Motion:
    """Return the positions of these joints, named by numbers."""
    n = len(names)
    skeleton = Skeleton([f"M{i}" for i in range(n)], [-1] * n, np.zeros((n, 3)))
    return Motion(skeleton, motion.positions[:, [motion.joint(name) for name in names]], motion.fps)


def legs(seed: int = 0) -> Motion:
    return markers(exercises(seed).motion, LEGS)


def assert_same_cuts(found: Segmentation, wanted: Segmentation) -> None:
    for level in ("activities", "primitives"):
        rows, others = getattr(found, level), getattr(wanted, level)
        np.testing.assert_array_equal(rows.start_frame, others.start_frame)
        np.testing.assert_array_equal(rows.cluster, others.cluster)


@pytest.mark.parametrize("names", [["Hips", *LEGS], LEGS])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_legs_alone_tell_what_legs_do(names: list[str], seed: int) -> None:
    made = exercises(seed)
    found = segment(markers(made.motion, names))
    truth = Truth.from_labelling(make_labelling(made.truth.activities, fps=made.motion.fps))
    assert evaluate(truth, found)["border_f1"] >= 0.8  # within 0.25 s
    assert found.repetitions().keys() == {0, 1, 2}  # steps of legs alone may be counted in pairs


def test_place_direction_and_which_axis_is_up_change_no_cut() -> None:
    motion = legs()
    turn = Rotation.from_euler("xyz", [90, 20, -50], degrees=True).as_matrix()
    moved = replace(motion, positions=motion.positions @ turn + 7)
    assert_same_cuts(segment(moved), segment(motion))


@pytest.mark.parametrize("preset", PRESETS)
def test_every_preset_takes_them_and_says_so(preset: str) -> None:
    told = {"n_classes": 2} if hasattr(PRESETS[preset], "n_classes") else {}
    found = segment(legs(), preset=preset, **told)
    assert (found.activities.kind == "activity").any()
    notes = " / ".join(found.provenance["notes"])
    assert "no left ankle, right ankle, head, left wrist or right wrist among the joints" in notes
    assert "by the distances between 8 of its 8 points; rename the markers of" in notes
    assert "points: M0, M1, M2, M3, M4, M5, M6, M7" in notes


def test_a_body_without_a_pelvis_is_taken_by_its_distances() -> None:
    """Its end effectors are found, but it has no heading."""
    names = ["LeftFoot", "RightFoot", "Head", "LeftHand", "RightHand"]
    held = markers(exercises(0).motion, names)
    motion = replace(held, skeleton=replace(held.skeleton, names=tuple(names)))
    found = segment(motion)
    assert found.repetitions().keys() == {0, 1, 2}  # steps of legs alone may be counted in pairs
    assert any("between 5 of its 5 points" in note for note in found.provenance["notes"])


def test_mirroring_is_refused() -> None:
    with pytest.raises(ParameterError, match="left and right are unknown: name five joints"):
        segment(legs(), preset="krueger2017", mirror=True)


def test_effectors_that_were_named_are_not_passed_over() -> None:
    with pytest.raises(EndEffectorError, match="no joint is called 'Head'"):
        segment(legs(), effectors={"head": "Head"})
    with pytest.raises(EndEffectorError, match="not found among the joints M0"):
        segment(legs(), effectors={"head": "M0"})


def test_a_single_point_is_refused() -> None:
    with pytest.raises(MotionError, match="segment its coordinates as signals"):
        segment(markers(exercises(0).motion, ["Hips"]))


@pytest.mark.parametrize(
    ("name", "least", "most"),
    [
        ("sample_propulsion.c3d", 17, 19),  # pushes of a wheelchair: peaks of a glove's path
        ("walkingOptiTrack.c3d", 9, 12),  # swings of the one foot, between standing
        ("Eb015pi.c3d", 3, 3),  # swings of the right foot
        ("Dec_real.c3d", 0, 2),  # a single cycle, the halves of which may be alike
    ],
)
@pytest.mark.filterwarnings("ignore::kineme.errors.KinemeWarning")
def test_real_recordings(data_dir: Path, name: str, least: int, most: int) -> None:
    found = segment(kineme.read(data_dir / "formats" / name))
    rows = found.primitives
    counted = Counter(rows.action[rows.cluster >= 0].tolist())
    assert least <= max(counted.values(), default=0) <= most
