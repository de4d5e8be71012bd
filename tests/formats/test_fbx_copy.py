"""Takes in a copy of their FBX file: joints are correct, everything else is unchanged."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from fbx_scenes import Bones, animate_turn

import kineme
from _fbx import Keys, Name, make_node, make_walker
from kineme.errors import KinemeWarning, WriteError
from kineme.formats.files import load
from kineme.formats.scenes.fbx_file import get_head_struct, parse_fbx
from kineme.formats.scenes.fbx_writer import copy_takes
from kineme.recordings.kinematics import compute_world_rotations
from kineme.recordings.posing import add_root

NEW = {"AnimationStack", "AnimationLayer", "AnimationCurveNode", "AnimationCurve"}


def read_stored(path: Path) -> dict[int, bytes]:
    """Return the bytes of each object that is no animation, with ends counted from its start."""
    content = load(path)
    version, root = parse_fbx(content)
    head, objects = get_head_struct(version), {}
    group = root.child("Objects")
    assert group is not None
    for each in group.children:
        raw, at = bytearray(content.data[each.start : each.stop]), 0
        while at < len(raw):
            end, *rest = head.unpack_from(raw, at)
            head.pack_into(raw, at, end and end - each.start, *rest)
            at += head.size + rest[1] + rest[2]
        if each.name not in NEW:
            objects[each.values[0]] = bytes(raw)
    return objects


def count_objects(path: Path) -> tuple[dict[str, int], dict[str, int]]:
    """Return how many objects of each kind there are, and how many the file says."""
    _, root = parse_fbx(load(path))
    group, table = root.child("Objects"), root.child("Definitions")
    assert group
    assert table
    kinds = [each.name for each in group.children]
    told = {k.text(0): int(c.number(0)) for k in table.all("ObjectType") if (c := k.child("Count"))}
    return {kind: kinds.count(kind) for kind in kinds}, told


def make_transform(scale: float, rng: np.random.Generator, **more: object) -> dict[str, object]:
    """Return what a model may have between its parent and its keys."""
    turns = ("LclRotation", "PreRotation", "PostRotation")
    shifts = ("RotationPivot", "ScalingPivot", "RotationOffset", "ScalingOffset", "LclTranslation")
    said = {name: rng.normal(0, 60, 3).tolist() for name in turns}
    said |= {name: rng.normal(0, 0.3, 3).tolist() for name in shifts}
    return {**said, "LclScaling": [scale] * 3, **more}


@pytest.mark.parametrize("rooted", [False, True])
@pytest.mark.parametrize(
    ("inherit", "order", "version"), [(0, 1, 7400), (1, 3, 7500), (2, 5, 7700)]
)
def test_joints_are_where_the_clip_has_them(tmp_path, inherit, order, version, rooted) -> None:
    rng = np.random.default_rng(order)
    more = {"InheritType": inherit, "RotationOrder": order}
    scales = zip(("top", *"abc"), (2, 0.5, 3, 1))
    scene = Bones(
        {name: make_transform(scale, rng, **more) for name, scale in scales},
        UnitScaleFactor=2.54, UpAxis=2, FrontAxis=1, FrontAxisSign=-1,
    )  # fmt: skip
    layer = scene.layer(scene.take("old", 0, 1))
    for what, names in (("R", "abc"), ("T", "a")):
        for name in names:
            axes = {axis: Keys([0, 0.5, 1], rng.normal(0, 50, 3).tolist()) for axis in "XYZ"}
            scene.animate(layer, scene.models[name], what, **axes)
    source, path = tmp_path / "source.fbx", tmp_path / "copy.fbx"
    source.write_bytes(scene.binary(version))
    motion = kineme.read(source)
    clip = (add_root(motion) if rooted else motion)[5:25]
    copy_takes({"one": clip, "two": clip[3:]}, source, path)
    before, after = read_stored(source), read_stored(path)
    assert {number: after[number] for number in before} == before
    assert len(after) - len(before) == 2 * rooted
    found, told = count_objects(path)
    assert {kind: told[kind] for kind in NEW & found.keys()} == {
        kind: found[kind] for kind in NEW & found.keys()
    }
    for take, expected in (("one", motion[5:25]), ("two", motion[8:25])):
        back = kineme.read(path, take=take)
        joints = [back.joint(name) for name in motion.skeleton.names]
        np.testing.assert_allclose(back.positions[:, joints], expected.positions, atol=1e-5)
        axes = compute_world_rotations(back.skeleton, back.rotations)[:, joints]
        same = np.abs(
            (axes * compute_world_rotations(expected.skeleton, expected.rotations)).sum(axis=2)
        )
        np.testing.assert_allclose(same, 1.0, atol=1e-9)
        assert (back.fps, back.provenance.takes) == (motion.fps, ("one", "two"))


def test_a_source_of_text_gives_the_skeleton_and_a_warning(tmp_path: Path) -> None:
    source, path = tmp_path / "a.fbx", tmp_path / "b.fbx"
    source.write_bytes(make_walker().text())
    motion = kineme.read(source, take=0)
    with pytest.warns(KinemeWarning, match=r"a\.fbx is a text FBX, so b\.fbx has no mesh"):
        copy_takes({"clip": motion}, source, path)
    np.testing.assert_allclose(kineme.read(path).positions, motion.positions, atol=1e-5)


@pytest.mark.parametrize("scale", [[1.0, 2.0, 1.0], [-1.0, 1.0, 1.0]])
def test_bones_that_no_keys_can_place_are_refused(tmp_path: Path, scale: list[float]) -> None:
    scene = Bones({"b": {"LclScaling": scale}, "c": {"LclTranslation": [0.0, 0.0, 0.5]}})
    animate_turn(scene, scene.models["a"])
    source, path = tmp_path / "a.fbx", tmp_path / "b.fbx"
    source.write_bytes(scene.binary())
    with pytest.warns(KinemeWarning):
        motion = kineme.read(source)
    with pytest.raises(WriteError, match=re.escape("the bones of a.fbx are mirrored or scaled")):
        copy_takes({"clip": motion}, source, path)
    assert not path.exists()


def test_mesh_and_skin_of_a_character_stay_byte_for_byte(data_dir: Path, tmp_path: Path) -> None:
    source, path = data_dir / "rigs" / "samba.fbx", tmp_path / "copy.fbx"
    clip = kineme.read(source, take="mixamo.com")[:9]
    for motion in (clip, add_root(clip)):
        copy_takes({"clip": motion}, source, path)
        before, after = read_stored(source), read_stored(path)
        changed = [number for number in before if after[number] != before[number]]
        # Both bind poses have the new root, too.
        assert len(changed) == (2 if motion is not clip else 0)


def test_a_texture_that_the_copy_will_not_find_is_told(tmp_path: Path) -> None:
    scene = make_walker()
    scene._object(
        "Video", Name("skin", "Video"), "Clip", {}, make_node("RelativeFilename", "a.png")
    )
    source, path = tmp_path / "a.fbx", tmp_path / "elsewhere" / "b.fbx"
    path.parent.mkdir()
    source.write_bytes(scene.binary())
    (tmp_path / "a.png").write_bytes(b"")
    motion = kineme.read(source, take=0)
    with pytest.warns(KinemeWarning, match=re.escape("b.fbx needs the texture 'a.png'")):
        copy_takes({"clip": motion}, source, path)


def test_a_source_that_has_changed_is_refused(tmp_path: Path) -> None:
    source = tmp_path / "a.fbx"
    source.write_bytes(make_walker().binary())
    motion = kineme.read(source, take=0)
    source.write_bytes(Bones({}).binary())
    with pytest.raises(WriteError, match="has changed since it was read"):
        copy_takes({"clip": motion}, source, tmp_path / "b.fbx")
