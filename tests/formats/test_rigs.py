"""The rig of a file survives writing: nodes, rest pose, positions."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import kineme
from kineme._util import rotations as rot
from kineme.errors import MotionError
from kineme.formats.read_write import list_takes, read_motion
from kineme.formats.scenes.fbx_writer import write_takes
from kineme.recordings import Motion
from kineme.recordings.operations import scale
from kineme.recordings.posing import align_to_rest, get_rig, pose_rig
from kineme.recordings.rig import Rig

pytestmark = pytest.mark.filterwarnings("ignore::kineme.errors.KinemeWarning")
RIGGED = [
    "rigs/Xbot.glb", "rigs/RobotExpressive.glb", "rigs/samba.fbx",
    "rigs/bandai_namco/dataset-1_dash_normal_001.bvh", "cmu_formats/02_01.amc",
    "formats/PyMO_AV_8Walk.bvh",
]  # fmt: skip
NEAR = 1e-5
"""Metres: a hundredth of a millimetre."""


def read(data_dir: Path, name: str) -> Motion:
    motion = read_motion(data_dir / name)
    return motion[: min(motion.n_frames, 40)]


def match_joints(one: Motion, other: Motion) -> tuple[list[int], list[int]]:
    names = other.skeleton.names
    pairs = [(j, names.index(n)) for j, n in enumerate(one.skeleton.names) if n in names]
    return [j for j, _ in pairs], [j for _, j in pairs]


@pytest.mark.parametrize("suffix", [".glb", ".bvh", ".fbx", ".usda"])
@pytest.mark.parametrize("name", RIGGED)
def test_places_and_rest_pose_come_back(data_dir, tmp_path, name, suffix) -> None:
    motion = read(data_dir, name)
    if suffix == ".usda":
        pytest.importorskip("pxr")
    kineme.write(motion, tmp_path / f"clip{suffix}")
    again = read_motion(tmp_path / f"clip{suffix}")
    here, there = match_joints(motion, again)
    # Ends of limbs have other names in a BVH.
    assert len(here) >= motion.skeleton.n_joints - 5 * (suffix == ".bvh")
    assert again.fps == pytest.approx(motion.fps)
    np.testing.assert_allclose(again.positions[:, there], motion.positions[:, here], atol=NEAR)
    rest, found = (get_rig(each.skeleton).rest()[0] for each in (motion, again))
    np.testing.assert_allclose(
        found[there], rest[here], atol=1e-9 if suffix == ".fbx" else NEAR / 10
    )


@pytest.mark.parametrize("name", [name for name in RIGGED if name.endswith((".glb", ".bvh"))])
def test_the_same_format_keeps_every_node_as_it_is(data_dir, tmp_path, name) -> None:
    motion = read(data_dir, name)
    path = tmp_path / f"clip{Path(name).suffix}"
    kineme.write(motion, path)
    rig, found = get_rig(motion.skeleton), get_rig(read_motion(path).skeleton)
    assert (found.parents, found.unit) == (rig.parents, rig.unit)
    assert found.names[: rig.above] == rig.names[: rig.above]
    np.testing.assert_allclose(found.translations, rig.translations, atol=1e-8)
    np.testing.assert_allclose(found.rotations, rig.rotations, atol=1e-12)
    np.testing.assert_allclose(found.scales, rig.scales, atol=1e-12)
    # The robot's skin is bound in another pose than its nodes are in, which Blender shows.
    assert (found.binds is None) == (rig.binds is None) == ("Robot" not in name)
    if rig.binds is not None:
        np.testing.assert_allclose(found.binds, rig.binds, atol=1e-6)


def test_a_bone_of_an_asf_keeps_its_axes(data_dir: Path, tmp_path: Path) -> None:
    """Also in a new ASF."""
    motion = read(data_dir, "cmu_formats/02_01.amc")
    without = replace(get_rig(motion.skeleton), asf="")
    skeleton = replace(motion.skeleton, rig=without)
    kineme.write(replace(motion, skeleton=skeleton), tmp_path / "clip.amc")
    again = read_motion(tmp_path / "clip.amc")
    np.testing.assert_allclose(again.positions, motion.positions, atol=NEAR)
    rig, found = get_rig(motion.skeleton), get_rig(again.skeleton)
    # A quaternion and its negative are one rotation.
    alike = np.abs(np.einsum("jc,jc->j", found.rotations, rig.rotations))
    np.testing.assert_allclose(alike, 1.0, atol=1e-12)
    assert (np.abs(rig.rotations[:, 0]) < 0.99).any()


def test_the_dancer_of_an_fbx_stands_on_its_feet_at_rest(data_dir: Path) -> None:
    motion = read(data_dir, "rigs/samba.fbx")
    for skeleton in (motion.skeleton, align_to_rest(motion).skeleton):
        rest = dict(zip(skeleton.names, get_rig(skeleton).rest()[0], strict=True))
        height = rest["mixamorig:Hips"][1] - rest["mixamorig:LeftFoot"][1]
        assert height == pytest.approx(0.9555, abs=1e-3)


@pytest.mark.parametrize("name", RIGGED)
def test_nodes_of_a_rig_are_where_the_joints_are(data_dir: Path, name: str) -> None:
    motion = scale(read(data_dir, name), 2.0)
    rig = get_rig(motion.skeleton)
    shifts, turns = pose_rig(motion, rig)
    posed = replace(
        rig,
        translations=np.concatenate([rig.translations[: rig.above], shifts[7]]),
        rotations=np.concatenate([rig.rotations[: rig.above], turns[7]]),
    )
    np.testing.assert_allclose(posed.rest()[0], motion.positions[7], atol=1e-9)


def test_a_negative_scale_is_no_rig() -> None:
    one = np.array([[1.0, 0.0, 0.0, 0.0]])
    with pytest.raises(MotionError, match="not one positive number"):
        Rig(("hips",), (-1,), np.zeros((1, 3)), one, -np.ones((1, 3)), one)


def test_no_joint_spins_between_frames_of_an_fbx(tmp_path: Path) -> None:
    motion = kineme.read(kineme.bundled_recording())[:11]
    turns = motion.rotations.copy()
    # Passes 90 degrees about the second axis, where two triples of angles meet.
    angles = np.column_stack([np.full(11, 0.1), np.linspace(0.6, 2.6, 11), np.full(11, 0.2)])
    bent = turns[:, motion.joint("LeftLeg")] = rot.from_euler(angles, "zyx")
    kineme.write(Motion.from_rotations(motion.skeleton, turns[::2], 30.0), tmp_path / "knee.fbx")
    found = read_motion(tmp_path / "knee.fbx", fps=60)
    alike = (found.rotations[:, found.joint("LeftLeg")] * bent).sum(axis=1)
    np.testing.assert_allclose(np.abs(alike), 1, atol=1e-6)


def test_an_fbx_has_a_take_for_each_motion(tmp_path: Path) -> None:
    motion = kineme.read(kineme.bundled_recording())
    path = tmp_path / "takes.fbx"
    write_takes({"walk": motion[:60], "jump": motion[300:420]}, path)
    with pytest.warns(kineme.errors.KinemeWarning, match="2 takes are in it and 'walk' is read"):
        assert read_motion(path).n_frames == 60
    jump = read_motion(path, take="jump")
    assert list_takes(path) == ("walk", "jump")
    there = [jump.joint(each) for each in motion.skeleton.names]
    np.testing.assert_allclose(jump.positions[:, there], motion.positions[300:420], atol=NEAR)
    assert jump.fps == motion.fps
