"""glTF: written files read back, and variants of other programs are understood."""

from __future__ import annotations

import base64
import json
import os
import struct
import tempfile
import warnings
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from format_samples import motions
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import kineme
from kineme.errors import KinemeWarning, ReadError, SeveralPeopleError, WriteError
from kineme.formats import read_motion, read_quietly, write
from kineme.formats.files import load
from kineme.formats.scenes.gltf_file import GLTFFile
from kineme.formats.scenes.gltf_writer import write_animations
from kineme.recordings import Motion, Skeleton
from kineme.recordings.kinematics import compute_world_rotations

TYPES = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}
ANSWERS = {"<f4": 5126, "<i2": 5122, "<i1": 5120, "<u2": 5123}


class File:
    """A glTF as another program writes it: nodes with a skin, and animations."""

    def __init__(self, nodes: Sequence[dict[str, Any]], joints: Sequence[int] | None) -> None:
        self.data = b""
        self.tree: dict[str, Any] = {
            "asset": {"version": "2.0"}, "nodes": list(nodes), "animations": [],
            "accessors": [], "bufferViews": [],
        }  # fmt: skip
        if joints is not None:
            self.tree["skins"] = [{"joints": list(joints)}]

    def array(self, values: Any, code: str = "<f4", **more: Any) -> int:
        stored = np.array(values, code)
        stored = stored.reshape(len(stored), -1)
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": stored.nbytes}
        self.tree["bufferViews"].append(view)
        self.data += stored.tobytes() + bytes(-stored.nbytes % 4)
        accessor = {
            "bufferView": len(self.tree["bufferViews"]) - 1, "componentType": ANSWERS[code],
            "count": len(stored), "type": TYPES[stored.shape[1]], **more,
        }  # fmt: skip
        self.tree["accessors"].append(accessor)
        return len(self.tree["accessors"]) - 1

    def animate(self, name: str, *tracks: tuple[int, str, Any, Any, str]) -> File:
        channels, samplers = [], []
        for node, what, times, values, how in tracks:
            channels.append({"sampler": len(samplers), "target": {"node": node, "path": what}})
            output = values if isinstance(values, int) else self.array(values)
            samplers.append({"input": self.array(times), "output": output, "interpolation": how})
        self.tree["animations"].append({"name": name, "channels": channels, "samplers": samplers})
        return self

    def turn(self, *nodes: int) -> File:
        """Turn nodes by 90 degrees in a second."""
        return self.animate(
            "a", *((node, "rotation", [0, 1], [NONE, TURN], "LINEAR") for node in nodes)
        )

    def save(self, path: Path) -> Path:
        text = json.dumps({**self.tree, "buffers": [{"byteLength": len(self.data)}]}).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
        chunks += struct.pack("<II", len(self.data), 0x4E4942) + self.data
        path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
        return path


LEG = [
    {"name": "Armature", "children": [1], "scale": [0.01] * 3},
    {"name": "Hips", "children": [2], "translation": [0, 90, 0]},
    {"name": "Knee", "children": [3], "translation": [0, -40, 0]},
    {"name": "Toe_end", "translation": [0, -40, 10]},
]
TURN = [0, 0, 0.5**0.5, 0.5**0.5]  # by 90 degrees about z; w last
NONE = [0, 0, 0, 1]
TENTHS = np.arange(11) / 10


def make_leg() -> File:
    return File(LEG, (1, 2, 3))


def measure_turn(motion: Motion, name: str = "Knee") -> np.ndarray:
    turns = compute_world_rotations(motion.skeleton, motion.rotations)[:, motion.joint(name)]
    return np.degrees(2 * np.arctan2(turns[:, 3], turns[:, 0]))


@given(motions(), st.sampled_from([".glb", ".gltf"]))
def test_what_is_written_is_read_again(motion: Motion, suffix: str) -> None:
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore", KinemeWarning)
        write(motion, Path(folder) / f"a{suffix}")
        again = read_motion(Path(folder) / f"a{suffix}")
    names, ends = motion.skeleton.names, motion.skeleton.end_sites
    joints = [again.joint(name.strip()) for name in names]
    size = np.abs(motion.positions).max() + 1
    assert np.abs(again.positions[:, joints] - motion.positions).max() < 1e-5 * size
    assert {again.skeleton.names[j] for j in again.skeleton.end_sites} == {names[j] for j in ends}
    ours, theirs = (compute_world_rotations(m.skeleton, m.rotations) for m in (motion, again))
    turned = [j for j in range(len(joints)) if j not in ends]
    same = np.einsum("fjc,fjc->fj", ours[:, turned], theirs[:, [joints[j] for j in turned]])
    assert np.abs(same).min() > 1 - 1e-5
    assert (again.fps, again.provenance.format) == (motion.fps, "glTF")


def test_several_motions_in_a_file(tmp_path: Path) -> None:
    motion = read_motion(kineme.bundled_recording())
    clips = {"walk": motion[:100], "jump": motion[100:130]}
    write_animations(clips, tmp_path / "clips.glb")
    for name, clip in clips.items():
        again = kineme.read(tmp_path / "clips.glb", take=name)
        assert again.n_frames == clip.n_frames
        assert np.abs(again.positions - clip.positions).max() < 1e-5
    with pytest.warns(KinemeWarning, match="2 takes are in it and 'walk' is read"):
        kineme.read(tmp_path / "clips.glb")
    other = replace(motion, skeleton=replace(motion.skeleton, offsets=motion.skeleton.offsets * 2))
    with pytest.raises(WriteError, match="have different skeletons"):
        write_animations({"a": motion, "b": other}, tmp_path / "b.glb")
    bare = Motion(motion.skeleton, motion.positions, 60)
    with pytest.raises(WriteError, match="a glTF needs rotations"):
        write(bare, tmp_path / "b.glb")
    assert not (tmp_path / "b.glb").exists()


def test_other_programs_see_a_mesh_on_a_skeleton(tmp_path: Path) -> None:
    write(read_motion(kineme.bundled_recording()), tmp_path / "a.glb")
    file = GLTFFile(load(tmp_path / "a.glb"))
    (skin,) = file.tree.skins
    assert len(skin.joints) == 26
    data = (tmp_path / "a.glb").read_bytes()
    text = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
    (primitive,) = text["meshes"][0]["primitives"]
    places, bound = (file.read_array(primitive["attributes"][n]) for n in ("POSITION", "JOINTS_0"))
    inverse = file.read_array(text["skins"][0]["inverseBindMatrices"]).reshape(-1, 4, 4)
    for place, joint in zip(places, bound[:, 0].astype(int)):
        at = np.append(place, 1) @ inverse[joint]  # in the joint's frame: within its bone
        assert np.linalg.norm(at[:3]) < 0.6


def test_keys_in_a_line_held_and_cubic(tmp_path: Path) -> None:
    for how, values, expected in (
        ("LINEAR", [NONE, TURN], 90 * TENTHS),
        ("LINEAR", [NONE, [-x for x in TURN]], 90 * TENTHS),  # the same turn, the shorter arc
        ("STEP", [NONE, TURN], np.r_[np.zeros(10), 90]),
    ):
        file = make_leg().animate("a", (2, "rotation", [0, 1], values, how))
        motion = read_motion(file.save(tmp_path / "a.glb"), fps=10)
        assert measure_turn(motion) == pytest.approx(expected, abs=1e-4)
    values = [[0, 0, 0], [0, 90, 0], [0, 0, 0], [0, 30, 0], [0, 190, 0], [0, 0, 0]]
    file = make_leg().animate("a", (1, "translation", [0, 2], values, "CUBICSPLINE"))
    height = read_motion(file.save(tmp_path / "a.glb"), fps=5).positions[:, 0, 1]
    s = TENTHS
    expected = 90 + (3 * s**2 - 2 * s**3) * 100 + (s**3 - s**2) * 2 * 30
    assert height == pytest.approx(0.01 * expected)


def test_scales_ends_and_the_rate_of_keys(tmp_path: Path) -> None:
    turns = Rotation.from_euler("z", 90 * TENTHS[:, None], degrees=True).as_quat()
    file = make_leg().animate("a", (2, "rotation", TENTHS, turns, "LINEAR"))
    motion = read_motion(file.save(tmp_path / "a.glb"))
    assert (motion.fps, motion.n_frames) == (10, 11)
    assert motion.skeleton.names == ("Hips", "Knee", "Toe_end")
    assert motion.skeleton.end_sites == {2}
    assert motion.positions[0] == pytest.approx(np.array([[0, 0.9, 0], [0, 0.5, 0], [0, 0.1, 0.1]]))
    assert motion.positions[-1, 2] == pytest.approx([0.4, 0.5, 0.1], abs=1e-6)
    assert "frame rate 10 Hz, from its keys" in motion.provenance.notes
    ntsc = np.arange(900) * 1.001 / 30
    file = make_leg().animate("a", (2, "rotation", ntsc, [TURN] * 900, "LINEAR"))
    motion = read_motion(file.save(tmp_path / "a.glb"))
    assert (motion.fps, motion.n_frames) == (29.97, 900)
    file = make_leg().animate("a", (2, "rotation", [0, 0.4, 1], [TURN] * 3, "LINEAR"))
    with pytest.warns(KinemeWarning, match="not evenly spaced: 30 Hz assumed; give fps="):
        assert kineme.read(file.save(tmp_path / "a.glb")).n_frames == 31


def test_motion_above_the_bones_is_that_of_the_root(tmp_path: Path) -> None:
    still = read_motion(make_leg().turn(2).save(tmp_path / "a.glb"), fps=10)
    assert "above" not in " ".join(still.provenance.notes)
    walked = (0, "translation", [0, 1], [[0, 0, 0], [0, 0, 1.5]], "LINEAR")
    file = make_leg().animate("a", walked, (2, "rotation", [0, 1], [NONE, TURN], "LINEAR"))
    motion = read_motion(file.save(tmp_path / "a.glb"), fps=10)
    assert motion.positions[-1, 0] == pytest.approx([0, 0.9, 1.5])
    note = "motion of Armature, above the bones, is that of Hips in clips"
    assert note in motion.provenance.notes


def test_whole_numbers_matrices_and_buffers_beside(tmp_path: Path) -> None:
    nodes = [dict(node) for node in LEG]
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.from_euler("x", 30, degrees=True).as_matrix() * 2
    matrix[:3, 3] = [0, -40, 0]
    nodes[2] = {"name": "Knee", "children": [3], "matrix": matrix.T.ravel().tolist()}
    file = File(nodes, (1, 2, 3))
    packed = file.array(np.round(32767 * np.array([NONE, TURN])), "<i2", normalized=True)
    file.animate("a", (1, "rotation", [0, 1], packed, "LINEAR"))
    motion = read_motion(file.save(tmp_path / "a.glb"), fps=10)
    assert measure_turn(motion, "Hips")[-1] == pytest.approx(90, abs=0.01)
    toe = [0, 90, 0] + matrix[:3, 3] + matrix[:3, :3] @ [0, -40, 10]
    assert motion.positions[0, 2] == pytest.approx(0.01 * toe)
    tree = {**file.tree, "buffers": [{"uri": "a%20b.bin"}]}
    (tmp_path / "a b.bin").write_bytes(file.data)
    (tmp_path / "a.gltf").write_text(json.dumps(tree))
    again = read_motion(tmp_path / "a.gltf", fps=10)
    assert (again.positions == motion.positions).all()
    tree["buffers"] = [{"uri": "data:;base64," + base64.b64encode(file.data).decode()}]
    (tmp_path / "a.gltf").write_text(json.dumps(tree))
    assert (read_motion(tmp_path / "a.gltf", fps=10).positions == motion.positions).all()


def test_a_skeleton_without_a_skin_and_several_characters(tmp_path: Path) -> None:
    file = File(LEG, None).turn(1)
    assert read_motion(file.save(tmp_path / "a.glb"), fps=10).skeleton.names[0] == "Hips"
    nodes = [*LEG, {"name": "Other", "children": [5]}, {"name": "Hips", "children": [6]}, {}]
    file = File(nodes, (1, 2, 3, 5, 6)).turn(1, 5)
    with pytest.raises(SeveralPeopleError, match=r": Armature \(3 joints\), Other \(2 joints\)"):
        read_motion(file.save(tmp_path / "a.glb"), fps=10)
    motion = read_motion(file.save(tmp_path / "a.glb"), fps=10, person="Other")
    assert motion.skeleton.names == ("Hips", "node6")


@pytest.mark.parametrize(("moved", "warned"), [((5,), False), ((5, 6), True)])
def test_a_character_without_a_skin_beside_one_with_it_is_told(tmp_path, moved, warned) -> None:
    nodes = [*LEG, {"name": "Other", "children": [5]}, {"name": "Spine", "children": [6]}, {}]
    file = File(nodes, (1, 2, 3)).turn(1, *moved)
    said = read_quietly(file.save(tmp_path / "a.glb")).provenance.warnings
    expected = "left out, since the nodes are not bones (perhaps another character): Spine"
    assert any(each.startswith(expected) for each in said) == warned


def test_bones_of_one_name_are_told(tmp_path: Path) -> None:
    nodes = [*LEG[:2], {**LEG[2], "name": "Hips"}, LEG[3]]
    file = File(nodes, (1, 2, 3)).turn(1)
    with pytest.warns(KinemeWarning, match="several bones have the same name: renamed to Hips_2"):
        motion = kineme.read(file.save(tmp_path / "a.glb"), fps=10)
    assert motion.skeleton.names == ("Hips", "Hips_2", "Toe_end")


def make_overrun() -> File:
    file = make_leg().turn(2)
    file.tree["accessors"][0]["count"] = 10**9
    return file


def make_changed(**more: Any) -> File:
    file = make_leg().turn(2)
    file.tree |= more
    return file


def make_endless() -> File:
    return make_leg().animate("a", (2, "rotation", [0, 1e9], [NONE, TURN], "LINEAR"))


@pytest.mark.parametrize(
    ("file", "reason"),
    [
        (make_leg(), "holds no animation of its skeleton"),
        (make_overrun(), "accessor 0 is longer than its buffer: truncated"),
        (make_changed(asset={"version": "1.0"}), "is glTF of version 1.0: export glTF 2.0"),
        (make_changed(asset={"version": "1.0"}, nodes={"a": {}}), "is glTF of version 1.0: export"),
        (make_changed(asset={"version": 1}, accessors={"a": {}}), "is glTF of version 1: export"),
        (make_changed(asset={}, accessors={"a": {}}), "is glTF of version 1.0: export"),
        (make_changed(accessors=[]), "accessor 1 is not in the file|accessor 0 is not in the file"),
        (make_changed(nodes=[{"children": [0]}]), "has no skeleton"),
        (make_endless(), "claims 3 joints in"),
    ],
)
def test_what_cannot_be_read_says_why(tmp_path: Path, file: File, reason: str) -> None:
    with pytest.raises(ReadError, match=reason):
        read_quietly(file.save(tmp_path / "a.glb"))


def test_buffers_elsewhere_are_not_opened(tmp_path: Path) -> None:
    for place in ("../a.bin", "/etc/a.bin", "https://a.b/c.bin"):
        tree = make_changed(buffers=[{"uri": place}]).tree
        (tmp_path / "a.gltf").write_text(json.dumps(tree))
        with pytest.raises(ReadError, match=f"has a buffer in '{place}': put that file next to it"):
            read_quietly(tmp_path / "a.gltf")
    (tmp_path / "a.gltf").write_text(json.dumps(make_changed(buffers=[{"uri": "a.bin"}]).tree))
    with pytest.raises(ReadError, match=r"a\.bin: cannot be opened"):
        read_quietly(tmp_path / "a.gltf")


def test_buffers_that_are_links_or_pipes_are_not_opened(tmp_path: Path) -> None:
    folder = tmp_path / "scene"
    folder.mkdir()
    file = make_leg().animate("a", (2, "rotation", TENTHS, [TURN] * 11, "LINEAR"))
    (tmp_path / "a.bin").write_bytes(file.data)
    (folder / "a.bin").symlink_to(tmp_path / "a.bin")
    (folder / "a.gltf").write_text(json.dumps({**file.tree, "buffers": [{"uri": "a.bin"}]}))
    with pytest.raises(ReadError, match=r"names 'a\.bin', which is outside its folder"):
        read_quietly(folder / "a.gltf")
    (folder / "a.bin").rename(folder / "link")
    (folder / "b.bin").write_bytes(file.data)
    (folder / "a.bin").symlink_to("b.bin")
    assert read_quietly(folder / "a.gltf").n_frames == 11
    if hasattr(os, "mkfifo"):
        (folder / "a.bin").unlink()
        os.mkfifo(folder / "a.bin")
        with pytest.raises(ReadError, match="is a pipe or a device"):
            read_quietly(folder / "a.gltf")


def test_accessors_without_a_view_are_zeros(tmp_path: Path) -> None:
    file = make_leg().animate("a", (1, "translation", TENTHS, [[0, 90, 0]] * 11, "LINEAR"))
    output = file.tree["accessors"][file.tree["animations"][0]["samplers"][0]["output"]]

    def locate_root() -> np.ndarray:
        return 100 * read_quietly(file.save(tmp_path / "a.glb")).positions[:, 0]

    dense = np.tile([0.0, 90.0, 0.0], (11, 1))
    assert locate_root() == pytest.approx(dense)
    del output["bufferView"]
    assert locate_root() == pytest.approx(0 * dense)
    rows, values = file.array([3, 10], "<u2"), file.array([[1, 2, 3], [4, 5, 6]])
    views = [file.tree["accessors"][number]["bufferView"] for number in (rows, values)]
    output["sparse"] = {
        "count": 2,
        "indices": {"bufferView": views[0], "componentType": 5123},
        "values": {"bufferView": views[1]},
    }
    # In place of zeros, and of values that are stored.
    for view, expected in ((None, 0 * dense), (0, dense.copy())):
        output["bufferView"] = view
        expected[[3, 10]] = [[1, 2, 3], [4, 5, 6]]
        assert locate_root() == pytest.approx(expected)
    for count, view, reason in (
        (10**9, 0, "longer than its buffer"),
        (10**9, None, "claims an accessor of 1000000000"),
        (10, None, "has values outside of it"),
    ):
        output |= {"count": count, "bufferView": view}
        with pytest.raises(ReadError, match=reason):
            locate_root()


def test_truncated_files(tmp_path: Path) -> None:
    whole = make_changed().save(tmp_path / "a.glb").read_bytes()
    for data, reason in (
        (whole[:8], "ends in its header"),
        (whole[:-9], f"has {len(whole) - 9} bytes instead of {len(whole)}: it is truncated"),
        (b"glTF\1\0\0\0" + whole[8:], "is a GLB of version 1"),
        (b"glTF\2\0\0\0\x0c\0\0\0", "has no JSON in it"),
    ):
        (tmp_path / "b.glb").write_bytes(data)
        with pytest.raises(ReadError, match=reason):
            read_quietly(tmp_path / "b.glb")


def test_a_body_of_one_joint(tmp_path: Path) -> None:
    skeleton = Skeleton(("a",), (-1,), np.zeros((1, 3)))
    motion = Motion.from_rotations(skeleton, [[[1, 0, 0, 0]]], 30, [[1, 2, 3]])
    write(motion, tmp_path / "a.glb")
    assert read_quietly(tmp_path / "a.glb").positions.tolist() == [[[1, 2, 3]]]


def test_gaps_are_told_since_the_format_has_none(tmp_path: Path) -> None:
    skeleton = Skeleton(("a",), (-1,), np.zeros((1, 3)))
    motion = Motion.from_rotations(skeleton, [[[1, 0, 0, 0]]] * 60, 30, [[1, 2, 3]] * 60)
    motion = replace(motion, gaps=[(15, 30)])
    with pytest.warns(KinemeWarning, match=r"a\.glb: gaps of 0\.5 s become movement"):
        write(motion, tmp_path / "a.glb")
