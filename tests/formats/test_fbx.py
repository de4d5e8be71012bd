"""FBX: joints are where the file's transforms place them; other files are refused with a reason."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest
from fbx_scenes import Bones, animate_turn, make_bone, play, read_scene
from scipy.spatial.transform import Rotation

import kineme
from _fbx import (
    CONSTANT,
    CUBIC,
    Keys,
    Name,
    Scene,
    encode_binary,
    format_text,
    make_node,
    make_walker,
)
from kineme.errors import KinemeWarning, ReadError, SeveralPeopleError
from kineme.recordings import Motion
from kineme.recordings.kinematics import compute_world_rotations


def get_axes(motion: Motion, name: str) -> np.ndarray:
    """(frames, 3, 3): the joint's axes."""
    turns = compute_world_rotations(motion.skeleton, motion.rotations)[:, motion.joint(name)]
    return Rotation.from_quat(np.roll(turns, -1, axis=1)).as_matrix()


def locate(motion: Motion, name: str) -> np.ndarray:
    return motion.positions[:, motion.joint(name)]


def compose(translation=(0, 0, 0), angles=(0, 0, 0), order="xyz", scale=(1, 1, 1)) -> np.ndarray:
    """4 x 4; angles about x, y, z in degrees, the first of ``order`` applied first."""
    by_axis = dict(zip("xyz", angles))
    found = np.eye(4)
    turn = Rotation.from_euler(order, [by_axis[axis] for axis in order], degrees=True)
    found[:3, :3] = turn.as_matrix() * np.array(scale)
    found[:3, 3] = translation
    return found


def test_a_body_that_walks(tmp_path: Path) -> None:
    motion = read_scene(make_walker().binary(), tmp_path)
    assert (motion.n_frames, motion.fps) == (121, 60)
    skeleton = motion.skeleton
    assert skeleton.names[:3] == ("Hips", "Spine", "Head")
    ends = {skeleton.names[j] for j in skeleton.end_sites}
    assert ends == {"Head_end", "LeftToe_end", "RightToe_end"}
    assert locate(motion, "Hips")[[0, 60, 120], 2] == pytest.approx([0, 1, 2])
    assert locate(motion, "Head")[0, 1] == pytest.approx(0.95 + 0.2 + 0.45 * np.cos(np.radians(9)))
    k = 30  # the thigh has turned by 30 degrees about x, and then 2.5 about y: the order is YZX
    turned = compose((10, 90, 50), (30, 2.5, 0), "yzx") @ [0, -85, 0, 1]
    assert locate(motion, "LeftFoot")[k] == pytest.approx(turned[:3] / 100)
    (take, warned, props) = (motion.provenance.notes[i] for i in (0, 1, 2))
    assert take == "FBX 7.4"
    assert warned.severity == "warning"
    assert "2 takes are in it and 'walk' is read" in warned
    assert props == "left out as props: Box"
    assert kineme.end_effectors(motion).describe(skeleton).count("by name") >= 4


@pytest.mark.parametrize("version", [7100, 7400, 7500, 7700])
@pytest.mark.parametrize("packed", [True, False])
def test_binary_versions_say_the_same(tmp_path: Path, version: int, packed: bool) -> None:
    expected = read_scene(make_walker().binary(), tmp_path)
    motion = read_scene(make_walker().binary(version, packed=packed), tmp_path)
    assert motion.provenance.notes[0] == f"FBX {version / 1000:.1f}"
    assert (motion.positions == expected.positions).all()
    assert motion.rotations is not None
    assert (motion.rotations == expected.rotations).all()


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_text_says_the_same(tmp_path: Path, encoding: str) -> None:
    expected = read_scene(make_walker().binary(), tmp_path)
    text = make_walker().text().decode().replace("\n", "\r\n")
    motion = read_scene(text.encode(encoding), tmp_path)
    assert motion.skeleton.names == expected.skeleton.names
    np.testing.assert_allclose(motion.positions, expected.positions, atol=1e-9)


@pytest.mark.parametrize("key", ["Pre-Extrapolation", "Größe", "3D.Size", "a|b", "Post-Extra "])
def test_keys_of_texts_hold_any_letters(tmp_path: Path, key: str) -> None:
    """Extrapolated curves have such keys, as Autodesk's programs write them."""
    expected = read_scene(make_walker().text(), tmp_path)
    more = f'KeyVer: 4009\n{key}: {{\n\tType: "C"\n\tRepetition: -1\n}}\n'
    text = make_walker().text().decode()
    assert "KeyVer: 4009\n" in text
    motion = read_scene(text.replace("KeyVer: 4009\n", more).encode(), tmp_path)
    assert (motion.positions == expected.positions).all()


def test_a_file_of_blender(tmp_path: Path) -> None:
    """Five bones, 13 frames at 30 Hz, by Blender 5.0 with z up; made from this motion."""
    t = np.arange(13) / 30
    skeleton = kineme.Skeleton(
        ("Hips", "Chest", "Head", "Leg", "Foot"),
        (-1, 0, 1, 0, 3),
        [[0, 0, 0], [0, 0.5, 0], [0, 0.4, 0], [0.1, -0.1, 0], [0, -0.8, 0.1]],
    )
    turns = [("y", 2), ("x", -3), ("z", 1), ("x", 4), ("x", -2)]
    rotations = [Rotation.from_euler(axis, (times * t)[:, None]).as_quat() for axis, times in turns]
    rotations = np.roll(np.stack(rotations, axis=1), 1, axis=2)
    places = np.stack([t, 0.9 + 0 * t, 2 * t], axis=1)
    expected = Motion.from_rotations(skeleton, rotations, 30, places)
    motion = kineme.read(Path(__file__).parent / "blender.fbx")
    assert motion.skeleton.names == skeleton.names
    assert motion.fps == 30
    assert np.abs(motion.positions - expected.positions).max() < 1e-5
    assert "turned upright: z is up in the file" in motion.provenance.notes


def test_takes_by_name_and_number(tmp_path: Path) -> None:
    for take in ("bow", 1, "1"):
        (tmp_path / "a.fbx").write_bytes(make_walker().binary())
        motion = kineme.read(tmp_path / "a.fbx", take=take)
        assert motion.n_frames == 31  # from 0.5 to 1 s
        turned = get_axes(motion, "Spine")[0].T @ get_axes(motion, "Spine")
        angle = np.degrees(Rotation.from_matrix(turned).magnitude())
        assert angle[[0, -1]] == pytest.approx([0, 60])
        assert "take bow of 2" in motion.provenance.notes
    others = r"'walk' is read: choose another with take= \(--take\): bow"
    with pytest.warns(KinemeWarning, match=others):
        kineme.read(tmp_path / "a.fbx")
    with pytest.raises(ReadError, match="no take 'run': choose from walk, bow"):
        kineme.read(tmp_path / "a.fbx", take="run")


def test_takes_of_an_armature_by_their_own_name(tmp_path: Path) -> None:
    scene = make_bone()
    for name in ("Armature|run", "Armature|hop"):
        layer = scene.layer(scene.take(name, 0, 1))
        scene.animate(layer, scene.models["b"], "R", X=Keys([0, 1], [0, 90]))
    motion = read_scene(scene.binary(), tmp_path, take="hop")
    assert motion.provenance.notes[1].startswith("take Armature|hop")


ORDERS = ("xyz", "xzy", "yzx", "yxz", "zxy", "zyx")


@pytest.mark.parametrize("number", range(6))
def test_rotation_orders_with_rotations_before_and_after(tmp_path: Path, number: int) -> None:
    before, after, angles = (10.0, 20.0, 30.0), (-40.0, 5.0, 60.0), (50, -70, 35)
    scene = make_bone(
        LclTranslation=[0.0, 0.4, 0.1], RotationOrder=number, PreRotation=list(before),
        PostRotation=list(after),
    )  # fmt: skip
    keys = {axis: Keys([0, 1], [0, angle]) for axis, angle in zip("XYZ", angles)}
    motion = play(scene, tmp_path, **keys)
    turn = (
        compose(angles=before)
        @ compose(angles=angles, order=ORDERS[number])
        @ np.linalg.inv(compose(angles=after))
    )
    np.testing.assert_allclose(get_axes(motion, "b")[-1], turn[:3, :3], atol=1e-7)
    assert locate(motion, "c")[-1] == pytest.approx((turn @ [0, 0, 0.5, 1])[:3] + [0, 1.4, 0.1])


def test_pivots_and_their_offsets(tmp_path: Path) -> None:
    said = {
        "RotationOffset": (0.1, 0.2, 0.3), "RotationPivot": (0.5, 0.0, -0.2),
        "ScalingOffset": (0.0, 0.3, 0.1), "ScalingPivot": (0.2, 0.2, 0.2),
    }  # fmt: skip
    scene = make_bone(**{key: list(value) for key, value in said.items()}, LclScaling=[2.0] * 3)
    motion = play(scene, tmp_path, Z=Keys([0, 1], [0, 90]))

    def shift(name: str, sign: int = 1) -> np.ndarray:
        return compose(sign * np.array(said[name]))

    whole = (
        shift("RotationOffset") @ shift("RotationPivot") @ compose(angles=(0, 0, 90))
        @ shift("RotationPivot", -1) @ shift("ScalingOffset") @ shift("ScalingPivot")
        @ compose(scale=(2, 2, 2)) @ shift("ScalingPivot", -1)
    )  # fmt: skip
    assert locate(motion, "b")[-1] == pytest.approx(whole[:3, 3] + [0, 1, 0])
    assert locate(motion, "c")[-1] == pytest.approx((whole @ [0, 0, 0.5, 1])[:3] + [0, 1, 0])


@pytest.mark.parametrize("uneven", [False, True])
@pytest.mark.parametrize(("kind", "length"), [(0, 3.0), (1, 3.0), (2, 1.5)])
def test_scales_are_inherited_as_the_file_says(tmp_path, kind, length, uneven) -> None:
    """c's end is 0.5 away, times its own scale 3 and, unless b's is left out, b's 2."""
    scene = Bones({
        "a": {"LclTranslation": [0.0, 1.0, 0.0]},
        "b": {"LclScaling": [5.0 if uneven else 2.0, 2.0, 2.0]},
        "c": {"LclTranslation": [0.0, 0.5, 0.0], "LclScaling": [3.0] * 3, "InheritType": kind},
    })  # fmt: skip
    scene.models["tip"] = scene.model("tip", scene.models["c"], LclTranslation=[0.0, 0.5, 0.0])
    motion = play(scene, tmp_path, X=Keys([0, 1], [0, 45]))
    bone = np.linalg.norm(locate(motion, "tip") - locate(motion, "c"), axis=1)
    assert bone == pytest.approx(length)
    assert np.linalg.norm(locate(motion, "c") - locate(motion, "b"), axis=1) == pytest.approx(1.0)


def test_scales_that_differ_by_axis_or_change(tmp_path: Path) -> None:
    said = {"a": {"LclScaling": [1.0, 2.0, 1.0], "LclRotation": [0.0, 0.0, 30.0]},
            "b": {"LclTranslation": [0.3, 0.5, 0.0], "InheritType": 1},
            "c": {"LclTranslation": [0.1, 0.5, 0.2], "InheritType": 1}}  # fmt: skip
    motion = play(Bones(said), tmp_path, "S", X=Keys([0, 1], [1, 3]))
    whole = compose(angles=(0, 0, 30), scale=(1, 2, 1)) @ compose((0.3, 0.5, 0), scale=(3, 1, 1))
    assert locate(motion, "c")[-1] == pytest.approx((whole @ [0.1, 0.5, 0.2, 1])[:3])
    again = kineme.recordings.kinematics.compute_local_translations(
        motion.skeleton, motion.positions, motion.rotations
    )
    assert np.ptp(again[:, motion.joint("c")], axis=0).max() > 0.1  # it slides


AXES = [
    ({}, np.eye(3)),
    ({"UpAxis": 2, "FrontAxis": 1, "FrontAxisSign": -1}, [[1, 0, 0], [0, 0, 1], [0, -1, 0]]),
    (
        {"UpAxis": 0, "FrontAxis": 2, "CoordAxis": 1, "CoordAxisSign": -1},
        [[0, -1, 0], [1, 0, 0], [0, 0, 1]],
    ),
    ({"UpAxisSign": -1, "FrontAxisSign": -1}, [[1, 0, 0], [0, -1, 0], [0, 0, -1]]),
]


@pytest.mark.parametrize(("settings", "turn"), AXES)
def test_axes_and_units_are_those_of_the_file(tmp_path: Path, settings, turn) -> None:
    said = {"a": {"LclTranslation": [1.0, 2.0, 3.0]}}
    scene = Bones(said, UnitScaleFactor=2.54, **settings)
    motion = play(scene, tmp_path, X=Keys([0, 1], [0, 90]))
    assert locate(motion, "a")[0] == pytest.approx(0.0254 * (np.array(turn) @ [1, 2, 3]))
    moved = read_scene(scene.binary(), tmp_path, unit="m", up="y")
    assert locate(moved, "a")[0] == pytest.approx([1, 2, 3])


def test_left_handed_axes_are_warned_of(tmp_path: Path) -> None:
    motion = play(Bones({}, FrontAxisSign=-1), tmp_path, X=Keys([0, 1], [0, 90]))
    assert any("left-handed" in remark for remark in motion.provenance.warnings)


def measure_angles(motion: Motion) -> np.ndarray:
    """Degrees about x of the bone b."""
    axes = get_axes(motion, "b")
    return np.degrees(np.arctan2(axes[:, 2, 1], axes[:, 1, 1]))


def test_keys_that_are_constant_linear_and_cubic(tmp_path: Path) -> None:
    times = np.arange(31) / 30
    motion = play(make_bone(), tmp_path, X=Keys([0, 0.5, 1], [10, 20, 40], [CONSTANT, 4, 4]))
    expected = np.where(times < 0.5, 10, 20 + 40 * (times - 0.5))
    assert measure_angles(motion) == pytest.approx(expected, abs=1e-5)
    motion = play(make_bone(), tmp_path, X=Keys([0, 0.5, 1], [10, 20, 40], CONSTANT | 0x100))
    expected = np.select([times == 0, times <= 0.5], [10, 20], 40)
    assert measure_angles(motion) == pytest.approx(expected, abs=1e-5)
    slopes = [(0.0, -30.0, 0, 0)] * 2  # after the first key, before the next
    motion = play(make_bone(), tmp_path, X=Keys([0, 1], [0, 10], CUBIC | 0x400, slopes))
    expected = times**2 * (3 - 2 * times) * 10 + (times**3 - times**2) * -30
    assert measure_angles(motion) == pytest.approx(expected, abs=1e-4)


def test_weights_of_cubic_keys(tmp_path: Path) -> None:
    weights = [(0.8, 0.1)] * 2
    flags = CUBIC | 0x400 | 0x3000000
    keys = Keys([0, 1], [0, 10], flags, [(20.0, 0.0, 0, 0)] * 2, weights)
    motion = play(make_bone(), tmp_path, X=keys)
    s = np.linspace(0, 1, 20_001)
    bezier = [[0, 0], [0.8, 16], [0.9, 10], [1, 10]]
    basis = [(1 - s) ** 3, 3 * s * (1 - s) ** 2, 3 * s**2 * (1 - s), s**3]
    time, value = np.einsum("kn,kc->cn", basis, np.array(bezier, float))
    expected = np.interp(np.arange(31) / 30, time, value)
    assert measure_angles(motion) == pytest.approx(expected, abs=1e-3)


def test_automatic_tangents_overshoot_nothing_where_they_are_clamped(tmp_path: Path) -> None:
    keys = Keys([0, 0.3, 0.6, 1], [0, 30, 30, 10], CUBIC | 0x100 | 0x6000)
    found = measure_angles(play(make_bone(), tmp_path, X=keys))
    assert found.max() <= 30 + 1e-5
    assert found[9:19] == pytest.approx(30, abs=1e-5)
    keys = Keys([0, 0.5, 1], [0, 10, 40], CUBIC | 0x100 | 0x2000)  # slope 40 in the middle
    found = measure_angles(play(make_bone(), tmp_path, X=keys))
    assert (found[16] - found[14]) / (2 / 30) == pytest.approx(40, rel=0.02)


def test_layers_add_and_replace(tmp_path: Path) -> None:
    def layered(**said: object) -> np.ndarray:
        scene = make_bone()
        take = scene.take("take", 0, 1)
        for layer, keys in (
            (scene.layer(take), Keys([0, 1], [0, 40])),
            (scene.layer(take, "more", **said), Keys([0, 1], [20, 20])),
        ):
            scene.animate(layer, scene.models["b"], "R", X=keys)
        return measure_angles(read_scene(scene.binary(), tmp_path))[[0, -1]]

    assert layered(BlendMode=0) == pytest.approx([20, 60])
    assert layered(BlendMode=0, Weight=50.0) == pytest.approx([10, 50])
    assert layered(BlendMode=0, RotationAccumulationMode=1) == pytest.approx([20, 60])
    assert layered(BlendMode=1) == pytest.approx([20, 20])
    assert layered(BlendMode=2, Weight=25.0) == pytest.approx([5, 35])
    assert layered(BlendMode=0, Mute=True) == pytest.approx([0, 40])


@pytest.mark.parametrize(
    ("settings", "fps"),
    [
        ({"TimeMode": 11}, 24),
        ({"TimeMode": 9}, 30 / 1.001),
        ({"TimeMode": 14, "CustomFrameRate": 90.0}, 90),
    ],
)
def test_frame_rates(tmp_path: Path, settings: dict[str, object], fps: float) -> None:
    motion = play(Bones({}, **settings), tmp_path, X=Keys([0, 1], [0, 90]))
    assert motion.fps == pytest.approx(fps)
    assert motion.n_frames == int(fps + 1e-3) + 1
    assert measure_angles(motion) == pytest.approx(90 * np.arange(motion.n_frames) / fps, abs=1e-4)


def test_a_rate_that_is_asked_for_and_one_that_keys_tell(tmp_path: Path) -> None:
    times = np.arange(101) / 100
    scene = Bones({}, TimeMode=0)
    motion = play(scene, tmp_path, X=Keys(times, 90 * times))
    assert (motion.fps, motion.n_frames) == (100, 101)
    assert "frame rate 100 Hz, from its keys" in motion.provenance.notes
    motion = read_scene(scene.binary(), tmp_path, fps=50)
    assert motion.n_frames == 51
    assert measure_angles(motion)[-1] == pytest.approx(90)
    motion = play(Bones({}, TimeMode=0), tmp_path, X=Keys([0, 1], [0, 90]))
    assert motion.fps == 30
    assert any("30 Hz assumed" in remark for remark in motion.provenance.warnings)
    motion = play(Bones({}, TimeMode=6), tmp_path, X=Keys(times, 90 * times))
    assert any("100 keys a second are sampled" in note for note in motion.provenance.notes)


def test_a_take_without_a_span_lasts_as_long_as_its_keys(tmp_path: Path) -> None:
    scene = make_bone()
    layer = scene.layer(scene.take("take"))
    scene.animate(layer, scene.models["b"], "R", X=Keys([0.5, 1.5], [0, 90]))
    motion = read_scene(scene.binary(), tmp_path)
    assert motion.n_frames == 31
    assert measure_angles(motion)[[0, -1]] == pytest.approx([0, 90], abs=1e-5)


def make_people() -> Scene:
    scene = Scene()
    layer = scene.layer(scene.take("take", 0, 1))
    for name, x in (("Ann", 0.0), ("Bob", 100.0)):
        top = scene.model(name, 0, "Null", LclTranslation=[x, 0.0, 0.0])
        bone = top
        for part in ("Hips", "Spine", "Head"):
            bone = scene.model(part, bone, LclTranslation=[0.0, 50.0, 0.0])
        scene.animate(layer, bone, "R", X=Keys([0, 1], [0, 90]))
    return scene


def test_one_of_several_characters_is_to_be_chosen(tmp_path: Path) -> None:
    data = make_people().binary()
    with pytest.raises(SeveralPeopleError, match=r"2 characters .* Ann \(3 joints\), Bob") as told:
        read_scene(data, tmp_path)
    assert told.value.people == ("Ann", "Bob")
    for person in ("Bob", "1"):
        motion = read_scene(data, tmp_path, person=person)
        assert motion.skeleton.names == ("Hips", "Spine", "Head")
        assert locate(motion, "Hips")[0, 0] == pytest.approx(1.0)
    with pytest.raises(SeveralPeopleError, match="no person 'Cyd': choose from Ann"):
        read_scene(data, tmp_path, person="Cyd")


def test_nulls_between_bones_are_joints_and_things_in_hands_are_not(tmp_path: Path) -> None:
    scene = Scene()
    hips = scene.model("Hips", 0)
    group = scene.model("group", hips, "Null", LclTranslation=[0.0, 10.0, 0.0])
    hand = scene.model("Hand", group, LclTranslation=[0.0, 10.0, 0.0])
    sword = scene.model("Sword", hand, "Null")
    scene.model("Blade", sword, "Mesh")
    animate_turn(scene, hand, sword)
    motion = read_scene(scene.binary(), tmp_path)
    assert motion.skeleton.names == ("Hips", "group", "Hand")
    assert "left out as props: Sword" in motion.provenance.notes


def test_a_skeleton_of_nulls(tmp_path: Path) -> None:
    scene = Scene()
    top = scene.model("Reference", 0, "Null")
    hips = scene.model("Hips", top, "Null", LclTranslation=[0.0, 90.0, 0.0])
    scene.model("Head", hips, "Null", LclTranslation=[0.0, 60.0, 0.0])
    animate_turn(scene, hips)
    assert read_scene(scene.binary(), tmp_path).skeleton.names == ("Hips", "Head")


def test_meshes_that_carry_a_skin_are_bones(tmp_path: Path) -> None:
    """As 3ds Max has them, whose bones are boxes."""
    scene = Scene()
    hips = scene.model("Hips", 0, "Mesh", LclTranslation=[0.0, 90.0, 0.0])
    head = scene.model("Head", hips, "Mesh", LclTranslation=[0.0, 60.0, 0.0])
    scene.model("Hat", head, "Mesh")
    for bone in (hips, head):
        scene.link("OO", bone, scene._object("Deformer", Name("", "SubDeformer"), "Cluster", {}))
    animate_turn(scene, hips)
    assert read_scene(scene.binary(), tmp_path).skeleton.names == ("Hips", "Head")


def test_names_of_namespaces_stay_and_are_unique(tmp_path: Path) -> None:
    scene = Scene()
    hips = scene.model("rig:Hips")
    scene.model("Leg", hips)
    scene.model("Leg", hips)
    animate_turn(scene, hips)
    for data in (scene.binary(), scene.text()):
        assert read_scene(data, tmp_path).skeleton.names == ("rig:Hips", "Leg", "Leg_2")


def test_keys_out_of_order_and_doubled_are_put_in_order(tmp_path: Path) -> None:
    motion = play(make_bone(), tmp_path, X=Keys([1, 0, 0], [90, 0, 0]))
    assert measure_angles(motion)[[0, 15]] == pytest.approx([0, 45], abs=1e-5)


def make_still() -> bytes:
    scene = Scene()
    scene.model("Hips")
    scene.take("empty", 0, 1)
    return scene.binary()


def make_box() -> bytes:
    scene = Scene()
    box = scene.model("Box", 0, "Mesh")
    animate_turn(scene, box)
    return scene.binary()


def make_old() -> bytes:
    header = make_node("FBXHeaderExtension", children=[make_node("FBXVersion", 6100)])
    return format_text([header], 6100)


def make_curve(stop: float = 1) -> bytes:
    scene = make_bone()
    animate_turn(scene, scene.models["b"], stop=stop)
    return scene.binary()


def make_bomb() -> bytes:
    """A curve that says that it has a quarter of a milliard of keys."""
    data = bytearray(make_curve())
    struct.pack_into("<I", data, data.index(b"KeyTimel") + len(b"KeyTimel"), 250_000_000)
    return bytes(data)


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (make_still(), "holds no animation of its skeleton: export it with"),
        (make_box(), r"has no skeleton \(bones or animated nodes\)"),
        (make_old(), "is FBX 6.1, a format of before 2011: open it .* and export FBX 2014"),
        (encode_binary([], 6100), "is FBX 6.1, a format of before 2011"),
        (b"Kaydara FBX Binary  \x00\x1a\x00\x00", "the file ends in its header"),
        (make_curve()[:-400], "truncated"),
        (make_curve()[:300], "truncated"),
        (format_text(Scene().nodes())[:-3], "the '}' of 'Connections' is missing"),
        (b"; FBX 7.4.0 project file\nObjects: {\n}}\n", "there is one '}' too many"),
        (b"; FBX 7.4.0 project file\n3, 4\n", "line 2: a name expected, found b'3'"),
        (make_bomb(), "claims an array of 250000000 numbers"),
        (make_curve(stop=1e6), "claims 3 joints in 30000001 frames"),
    ],
)
def test_what_cannot_be_read_says_why(tmp_path: Path, data: bytes, reason: str) -> None:
    with pytest.raises(ReadError, match=reason):
        read_scene(data, tmp_path)


def test_circles_among_models_and_links_to_nothing(tmp_path: Path) -> None:
    scene = make_bone()
    a, b = scene.models["a"], scene.models["b"]
    scene.link("OO", a, b)
    scene.link("OO", 77, b)
    scene.link("OO", 0, 0)
    motion = play(scene, tmp_path, X=Keys([0, 1], [0, 90]))
    assert motion.skeleton.names == ("a", "b", "c")
