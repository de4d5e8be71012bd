"""The table of joint names, and what is found by it."""

from __future__ import annotations

import pytest

from kineme.recordings.joint_names import (
    NAMES,
    find_body,
    find_joints,
    find_rig_joints,
    mentions,
    simplify_name,
)

MARKERS = ["LASI", "RASI", "LPSI", "RPSI", "LANK", "RANK", "LWRA", "LWRB", "RWRA", "RWRB", "C7"]


@pytest.mark.parametrize(
    ("names", "found"),
    [
        (["LANK", "L_Ankle", "ankle.L", "AnkleLeft"], ["LANK", "LANKLE", "LANKLE", "LANKLE"]),
        (["R.Wrist.Med", "r_wrist_med", "ASISr"], ["RWRISTMED", "RWRISTMED", "RASIS"]),
        (
            ["V.Sacral", "Top.Head", "T10", "WaistLFront"],
            ["VSACRAL", "TOPHEAD", "T10"] + ["LWAISTFRONT"],
        ),
    ],
)
def test_plain_names(names: list[str], found: list[str]) -> None:
    assert [simplify_name(name) for name in names] == found


def test_left_and_right_are_made_of_the_same_markers() -> None:
    usable = [i for i, name in enumerate(MARKERS) if name != "LWRB"]
    made = find_body(MARKERS, usable)
    assert [MARKERS[i] for i in made["left_wrist"]] == ["LWRA"]
    assert [MARKERS[i] for i in made["right_wrist"]] == ["RWRA"]


def test_each_line_of_the_marker_table_can_be_reached() -> None:
    for lines in NAMES.values():
        for i, line in enumerate(lines):
            wanted = set(line.split())
            assert not any(set(before.split()) <= wanted for before in lines[:i]), line


def test_every_part_has_sides_in_all_its_lines_or_in_none() -> None:
    for part, lines in NAMES.items():
        sided = {"*" in word for line in lines for word in line.split()}
        assert sided == {"*" in part}


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
    assert find_joints(names, [("*_shank",), ("*_upper_arm",)]) == {}
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


@pytest.mark.parametrize(
    ("name", "side", "found"),
    [
        ("lf_gyr_x", "left", True),
        ("lf_gyr_x", "right", False),
        ("GyroFootLeftX", "left", True),
        ("footr_omega_z", "right", True),
        ("Right Shank gyr x", "right", False),
        ("fl_gyr_x", "left", False),
    ],
)
def test_sensors_at_a_foot(name: str, side: str, found: bool) -> None:
    assert mentions(name, "*_foot_sensor", side=side) == found


def test_a_part_is_mentioned_on_either_side_or_none() -> None:
    for name in ("LeftToeBase_End", "toe", "RTOE", "toes.L", "rig:L_Toe0"):
        assert mentions(name, "*_toe"), name
    assert not any(mentions(name, "*_toe") for name in ("LeftFoot", "tiptoed", "Shoe"))
