"""The angles that made a recording come out of it again, whatever its joints are called."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from posed_figures import pose_figure

import kineme
from kineme._util import rotations as rot
from kineme.cycles import bend, cardan, channels_of, landmarks
from kineme.errors import ParameterError
from kineme.recordings import Motion, Signals, Skeleton
from kineme.recordings.operations import move, scale, turn

T = np.linspace(0, 2 * np.pi, 121)
ANGLES = {
    "left_knee": 40 - 40 * np.cos(T),
    "right_knee": 30 + 20 * np.sin(T),
    "left_hip": 35 * np.sin(T) + 10,
    "right_hip": -25 * np.sin(T),
    "left_spread": 8 + 5 * np.cos(T),
    "left_elbow": 45 + 30 * np.sin(T),
    "tilt": 10 * np.sin(T),
    "heading": 20 * T,
}


def measure(motion: Motion | Signals, name: str) -> np.ndarray:
    return channels_of(motion, [name])[0].values()


@pytest.fixture(scope="module")
def motion() -> Motion:
    return pose_figure(**ANGLES)


@pytest.mark.parametrize(
    ("name", "angle"),
    [
        ("knee_l", "left_knee"),
        ("knee_r", "right_knee"),
        ("hip_l", "left_hip"),
        ("hip_r", "right_hip"),
        ("elbow_l", "left_elbow"),
        ("trunk_lean", "tilt"),
        ("LeftLeg.rx", "left_knee"),
        ("LeftUpLeg.rz", "left_spread"),
        ("Hips.rx", "tilt"),
    ],
)
def test_angles_are_those_that_made_the_recording(motion: Motion, name: str, angle: str) -> None:
    if name == "Hips.rx":
        motion = pose_figure(tilt=ANGLES["tilt"])
    np.testing.assert_allclose(measure(motion, name), ANGLES[angle], atol=0.1)


@pytest.mark.parametrize("name", ["knee_l", "knee_r", "elbow_l", "hip_l", "hip_r", "trunk_lean"])
def test_positions_alone_tell_them_within_three_degrees(motion: Motion, name: str) -> None:
    bare = replace(motion, rotations=None)
    assert np.abs(measure(bare, name) - measure(motion, name)).max() < 3
    assert "against" not in channels_of(motion, ["knee_l"])[0].source


@pytest.mark.parametrize("right", [90.0, -90.0])
def test_hips_do_not_depend_on_the_axes_of_bones(motion: Motion, right: float) -> None:
    skeleton = motion.skeleton
    # Without rotations, the trunk and the left thigh point along +x, the right one along -x or +x.
    axes = np.tile(rot.IDENTITY, (skeleton.n_joints, 1))
    for joint, angle in (("Hips", 90.0), ("LeftUpLeg", -90.0), ("RightUpLeg", right)):
        axes[motion.joint(joint)] = rot.from_euler(np.radians([[angle]]), "z")[0]
    above = np.array([rot.IDENTITY if p < 0 else axes[p] for p in skeleton.parents])
    offsets = rot.rotate(rot.conjugate(above), skeleton.offsets)
    assert motion.rotations is not None
    rotations = rot.multiply(rot.multiply(rot.conjugate(above), motion.rotations), axes)
    other = Motion.from_rotations(
        replace(skeleton, offsets=offsets), rotations, motion.fps, motion.positions[:, 0]
    )
    np.testing.assert_allclose(other.positions, motion.positions, atol=1e-9)
    for name in ("hip_l", "hip_r"):
        np.testing.assert_allclose(measure(other, name), measure(motion, name), atol=0.1)


def test_where_a_body_stands_and_how_large_it_is_changes_no_angle(motion: Motion) -> None:
    other = scale(move(turn(motion, 1.0), [3.0, 0.0, -2.0]), 0.8)
    for before, after in zip(channels_of(motion), channels_of(other), strict=True):
        np.testing.assert_allclose(before.values(), after.values(), atol=1e-6)
    turned = measure(other, "heading") - measure(motion, "heading")
    np.testing.assert_allclose(turned, np.degrees(1.0), atol=1e-6)


def test_a_mirror_exchanges_left_and_right(motion: Motion) -> None:
    mirrored = kineme.mirror(motion)
    for name in ("knee", "hip", "elbow", "shoulder"):
        np.testing.assert_allclose(
            measure(motion, f"{name}_l"), measure(mirrored, f"{name}_r"), atol=1e-6
        )
    side = pose_figure(list=10 * np.sin(T), lean=5 * np.sin(T))
    np.testing.assert_allclose(
        measure(side, "trunk_side"), -measure(kineme.mirror(side), "trunk_side"), atol=1e-6
    )
    assert measure(side, "trunk_side")[30] > 10  # to the right


def test_heading_has_no_jumps(motion: Motion) -> None:
    heading = measure(motion, "heading")
    np.testing.assert_allclose(
        heading - heading[0], ANGLES["heading"] - ANGLES["heading"][0], atol=0.1
    )


def test_positions_and_speeds(motion: Motion) -> None:
    moving = replace(
        motion, positions=motion.positions + np.arange(121)[:, None, None] * [0.02, 0, 0]
    )
    assert np.allclose(measure(moving, "Hips.speed"), 0.02 * 60)
    foot = motion.joint("LeftFoot")
    assert np.array_equal(measure(motion, "LeftFoot.y"), motion.positions[:, foot, 1])
    assert (measure(motion, "LeftFoot.left") > 0).all()
    assert np.allclose(measure(motion, "LeftFoot.up"), measure(moving, "LeftFoot.up"))


NAMES = {
    "Mixamo": "mixamorig:{s}UpLeg mixamorig:{s}Leg mixamorig:{s}Foot mixamorig:{s}ToeBase",
    "Unreal": "thigh_{l} calf_{l} foot_{l} ball_{l}",
    "Biped": "Bip01 {S} Thigh,Bip01 {S} Calf,Bip01 {S} Foot,Bip01 {S} Toe0",
    "ASF": "{l}femur {l}tibia {l}foot {l}toes",
}


@pytest.mark.parametrize("names", NAMES.values(), ids=NAMES)
def test_legs_are_found_whatever_they_are_called(motion: Motion, names: str) -> None:
    renamed = dict(zip(motion.skeleton.names, motion.skeleton.names, strict=True))
    for side in ("Left", "Right"):
        texts = names.format(s=side, S=side[0], l=side[0].lower())
        texts = texts.split("," if "," in texts else " ")
        parts = ("UpLeg", "Leg", "Foot", "ToeBase")
        renamed |= {side + part: text for part, text in zip(parts, texts, strict=True)}
    skeleton = replace(motion.skeleton, names=tuple(renamed.values()))
    other = replace(motion, skeleton=skeleton)
    assert [*landmarks(other).values()] == [*landmarks(motion).values()]


def test_channels_of_signals_are_its_channels_and_gaps_are_missing() -> None:
    signals = Signals(np.ones((10, 2)), 10.0, ["a", "b"], gaps=[(2, 4)])
    a, b = channels_of(signals)
    assert (a.name, b.name, a.group) == ("a", "b", "channel")
    assert np.isnan(a.values()).tolist() == [False] * 2 + [True] * 2 + [False] * 6
    beside = channels_of(signals, ["b", "fz"], beside=[Signals([[1.0]] * 100, 100.0, ["fz"])])
    assert [(each.name, each.fps) for each in beside] == [("b", 10.0), ("fz", 100.0)]


def test_a_channel_that_is_not_there_is_named(motion: Motion) -> None:
    with pytest.raises(ParameterError, match="no channel 'kne_l'; there are knee_l, knee_r"):
        channels_of(motion, ["kne_l"])


def test_points_that_nobody_named_are_measured_by_their_speed() -> None:
    skeleton = Skeleton(("a", "b"), (-1, 0), [[0, 0, 0], [1, 0, 0]])
    motion = Motion(skeleton, np.zeros((5, 2, 3)), 10.0)
    assert [each.name for each in channels_of(motion)] == ["a.speed", "b.speed"]


points = arrays(np.float64, (4, 3), elements=st.floats(-2, 2).map(lambda x: round(x, 3)))
turns = arrays(np.float64, (1, 3), elements=st.floats(-3, 3))


@given(points, points, points, turns, st.floats(0.1, 10))
def test_a_bend_stays_however_the_limb_is_turned_moved_and_scaled(a, b, c, turn, size) -> None:
    q = rot.from_euler(turn, "xyz")
    once = bend(a, b, c)
    again = bend(*(size * rot.rotate(q, each) + 0.3 for each in (a, b, c)))
    apart = (np.linalg.norm(a - b, axis=1) > 1e-3) & (np.linalg.norm(c - b, axis=1) > 1e-3)
    np.testing.assert_allclose(once[apart], again[apart], atol=1e-3)


def test_a_straight_limb_is_not_bent_and_one_without_length_is_unknown() -> None:
    a, b, c = (np.array([[0.0, y, 0.0]]) for y in (2, 1, 0))
    assert bend(a, b, c).tolist() == [0]
    assert np.isnan(bend(a, a, c)).all()


@given(arrays(np.float64, (5, 3), elements=st.floats(-np.pi, np.pi)))
def test_cardan_angles_make_the_rotation_again(angles) -> None:
    q = rot.from_euler(angles, "xzy")
    again = rot.from_euler(np.radians(cardan(q)), "xzy")
    np.testing.assert_allclose(np.abs((q * again).sum(axis=1)), 1, atol=1e-9)
