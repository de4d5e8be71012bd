"""The table of joint names, and what is found by it."""

from __future__ import annotations

import pytest

from kineme.recordings.joint_names import find_body, find_joints, find_rig_joints, mentions


@pytest.mark.parametrize("usual", ["LeftFoot", "foot.L", "lfoot", "leftfoot", "FOOT_LEFT"])
@pytest.mark.parametrize("name", ["{}", "rig:{}", "|a|b:{}", "{}_035", "Bip01 {}"])
def test_namespaces_numbers_and_words_before_do_not_count(usual: str, name: str) -> None:
    names = ["Hips", "LeftToeBase", name.format(usual)]
    assert find_joints(names, [("*_ankle", "*_foot")]) == {"left_ankle": (2,)}


def test_an_equal_name_precedes_one_with_words_before() -> None:
    names = ["weapon_hand_l", "ik_hand_l", "a_b_hand_l", "hand_l", "hand_r"]
    assert find_joints(names[:3], [("*_hand",)]) == {"left_hand": (0,)}
    assert find_joints(names, [("*_hand",)]) == {"left_hand": (3,), "right_hand": (4,)}


def test_other_parts_of_a_limb_are_not_the_joint() -> None:
    names = ["Rig_LeftUpLeg", "Rig_LeftForeArm", "Rig_LeftLegRoll", "Rig_LeftLegIK"]
    names += ["LeftHandIndex1", "LeftHandRoll"]
    assert find_joints(names, [("*_shank",), ("*_upper_arm",), ("*_hand",)]) == {}
    assert find_joints(names, [("*_thigh",), ("*_forearm",)]) == {
        "left_thigh": (0,),
        "left_forearm": (1,),
    }


def test_markers_of_others_and_numbered_ones_are_not_those_of_the_body() -> None:
    names = ["Bob:LANK", "LANK2", "Top_LANK", "RANK"]
    assert find_body(names, range(4)) == {"right_ankle": (3,)}


def test_a_single_point_is_none_of_the_middle_of_several() -> None:
    names = ["LFHD", "RFHD", "LKneeLat", "LKneeMed"]
    wanted = [("head",), ("*_knee",)]
    assert find_joints(names, wanted) == {"head": (0, 1), "left_knee": (2, 3)}
    assert find_joints(names, wanted, single=True) == {"left_knee": (2,)}


def test_a_rig_may_say_which_joints_it_means() -> None:
    bones = ["ltibia", "rtibia", "head", "lradius", "lwrist", "rwrist", "lhand", "head_end"]
    assert find_rig_joints(bones) == ("ASF", {"head": 7, "left_wrist": 6})
    assert find_rig_joints(bones[1:]) == ("", {})


def test_a_part_is_mentioned_on_either_side_or_none() -> None:
    for name in ("LeftToeBase_End", "toe", "RTOE", "toes.L", "rig:L_Toe0"):
        assert mentions(name, "*_toe"), name
    assert not any(mentions(name, "*_toe") for name in ("LeftFoot", "tiptoed", "Shoe"))
