"""End effectors: all naming schemes, shapes without names, and given names."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from kineme.datasets import Action, synthesize
from kineme.datasets.figure import make_figure
from kineme.errors import EndEffectorError, MotionError
from kineme.features import end_effectors, measure_body_size
from kineme.recordings import Motion, Skeleton
from kineme.recordings.operations import move, scale, turn

PLAIN = ("LeftFoot", "RightFoot", "Head", "LeftHand", "RightHand")
PREFIXES = ("mixamorig:", "mixamorig1_", "Character1_", "Robot_", "|rig|ns:")
"""Of Mixamo, MotionBuilder, Perception Neuron and Maya."""
SCHEMES = [
    *(",".join(prefix + name for name in PLAIN) for prefix in PREFIXES),
    "LeftAnkle,RightAnkle,Head,LeftWrist,RightWrist",  # Xsens
    "Left_Foot,Right_Foot,Head,Left_Hand,Right_Hand",  # segments of Xsens
    "L_Ankle,R_Ankle,Head,L_Wrist,R_Wrist",  # SMPL
    "left_ankle,right_ankle,head,left_wrist,right_wrist",  # SMPL-X
    "m_avg_L_Ankle,m_avg_R_Ankle,m_avg_Head,m_avg_L_Wrist,m_avg_R_Wrist",  # SMPL as FBX
    "Bip01 L Foot,Bip01 R Foot,Bip01 Head,Bip01 L Hand,Bip01 R Hand",
    "foot_l,foot_r,head,hand_l,hand_r",  # Unreal
    "DEF-foot.L,DEF-foot.R,DEF-head,DEF-hand.L,DEF-hand.R",  # Rigify
    "J_Bip_L_Foot,J_Bip_R_Foot,J_Bip_C_Head,J_Bip_L_Hand,J_Bip_R_Hand",  # VRM
    "AnkleLeft,AnkleRight,Head,WristLeft,WristRight",  # Kinect
    "lFoot,rFoot,head,lHand,rHand",  # Daz
    "LFoot,RFoot,Head,LHand,RHand",  # OptiTrack
    "leftfoot,rightfoot,head,lefthand,righthand",
    "LEFT_FOOT,RIGHT_FOOT,HEAD,LEFT_HAND,RIGHT_HAND",
]
"""Left ankle, right ankle, head, left wrist, right wrist."""


def rename_joints(names: dict[str, str]) -> Skeleton:
    """Rename some joints of the figure; give the others meaningless names."""
    plain = make_figure()
    new = tuple(names.get(name, f"node{i}") for i, name in enumerate(plain.names))
    return Skeleton(new, plain.parents, plain.offsets, plain.end_sites)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_usual_names_are_found(scheme: str) -> None:
    skeleton = rename_joints(dict(zip(PLAIN, scheme.split(","), strict=True)))
    found = end_effectors(skeleton)
    plain = make_figure()
    assert found.how == ("by name",) * 5
    joints = ("LeftFoot", "RightFoot", "Head_end", "LeftHand", "RightHand")
    assert found.indices == tuple(map(plain.joint, joints))


@pytest.mark.parametrize("facing", [1.0, -1.0])
@pytest.mark.parametrize("action", ["walk", "arm circles", "squat"])
def test_without_names_the_shape_tells(action: str, facing: float) -> None:
    motion = synthesize([Action(action, 2)], fps=30, seed=1).motion
    turned = motion.positions * [facing, 1.0, facing]
    found = end_effectors(Motion(rename_joints({}), turned, motion.fps))
    assert found.how == ("by shape",) * 5
    assert found.indices == end_effectors(motion).indices


def test_names_given_come_first() -> None:
    skeleton = make_figure()
    found = end_effectors(skeleton, names={"left_wrist": "LeftHand_end", "head": "Head"})
    assert skeleton.names[found.left_wrist] == "LeftHand_end"
    assert skeleton.names[found.head] == "Head"
    assert found.how == ("by name", "by name", "as named", "as named", "by name")
    assert end_effectors(skeleton, names=PLAIN).how == ("as named",) * 5


def test_a_missing_one_is_named_with_the_joints_there_are() -> None:
    arm = Skeleton(
        ("shoulder", "LeftArm", "LeftHand"), (-1, 0, 1), np.array([[0, 0, 0], [1, 0, 0], [1, 0, 0]])
    )
    with pytest.raises(EndEffectorError, match="left ankle, right ankle, head and right"):
        end_effectors(arm)
    with pytest.raises(EndEffectorError, match="shoulder, LeftArm, LeftHand.*--effectors"):
        end_effectors(arm)


def test_feet_without_toes_do_not_make_up_a_left() -> None:
    plain = make_figure()
    keep = [i for i, name in enumerate(plain.names) if "Toe" not in name]
    stump = Skeleton(
        tuple(f"node{i}" for i in keep),
        tuple(-1 if plain.parents[i] < 0 else keep.index(plain.parents[i]) for i in keep),
        plain.offsets[keep],
    )
    with pytest.raises(EndEffectorError, match="left ankle, right ankle, left wrist and"):
        end_effectors(stump)


@pytest.mark.parametrize(
    ("names", "message"),
    [
        ({"nose": "Head"}, "no part is called 'nose'"),
        ({"head": "Skull"}, "no joint is called 'Skull'"),
        (["Head"], "five joint names are needed"),
        ("Head", "five joint names are needed"),
        ({"head": "LeftHand"}, "'LeftHand' is used for two"),
    ],
)
def test_wrong_names_are_refused(names: object, message: str) -> None:
    with pytest.raises(EndEffectorError, match=re.escape(message)):
        end_effectors(make_figure(), names=names)  # type: ignore[arg-type]


def perform(name: str, size: float = 1.75) -> Motion:
    return synthesize([Action(name, repetitions=3)], fps=30, size=size).motion


def measure_size(motion: Motion) -> float:
    return measure_body_size(motion, end_effectors(motion))


def test_it_is_close_to_the_height_and_follows_it() -> None:
    sizes = [measure_size(perform("walk", size)) for size in (1.0, 1.5, 2.0)]
    assert 1.5 * 0.8 < sizes[1] < 1.5
    np.testing.assert_allclose(sizes, sizes[1] * np.array([1.0, 1.5, 2.0]) / 1.5)


def test_what_the_body_does_and_where_does_not_matter() -> None:
    walk = perform("walk")
    for motion in (perform("squat"), turn(walk, 1.0), move(walk, (5, 0, -3))):
        assert measure_size(motion) == pytest.approx(measure_size(walk), rel=1e-6)
    assert measure_size(scale(walk, 2.5)) == pytest.approx(2.5 * measure_size(walk), rel=1e-6)


def test_a_few_wild_frames_do_not_change_it() -> None:
    walk = perform("walk")
    positions = walk.positions.copy()
    positions[10:20] *= 100
    wild = replace(walk, rotations=None, positions=positions)
    assert measure_size(wild) == pytest.approx(measure_size(walk), rel=1e-6)


def test_a_body_without_extent_is_refused() -> None:
    walk = perform("walk")
    point = replace(walk, rotations=None, positions=np.zeros_like(walk.positions))
    with pytest.raises(MotionError, match="no length"):
        measure_body_size(point, end_effectors(walk))
