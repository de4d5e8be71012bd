"""Clips as animations in a copy of the file that they came from."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import kineme
from kineme.clips.split import split
from kineme.errors import ParameterError
from kineme.recordings import Motion
from kineme.segments.segmentation import Segmentation
from segmentations import make_activities

pytestmark = pytest.mark.filterwarnings("ignore::kineme.errors.KinemeWarning")
CHARACTERS = [("Xbot.glb", "walk"), ("RobotExpressive.glb", "Walking")]


def cut_in_halves(motion: Motion) -> Segmentation:
    n = motion.n_frames
    return make_activities(n // 2, n, fps=motion.fps, cluster=[0, 1])


def read_glb(path: Path) -> tuple[dict[str, Any], bytes]:
    data = path.read_bytes()
    (size,) = struct.unpack_from("<I", data, 12)
    return json.loads(data[20 : 20 + size]), data[28 + size :]


def get_stored(tree: dict[str, Any], data: bytes, accessor: int) -> bytes:
    view = tree["bufferViews"][tree["accessors"][accessor]["bufferView"]]
    start = view.get("byteOffset", 0)
    return data[start : start + view["byteLength"]]


@pytest.mark.parametrize("mode", ["keep", "extract", "in-place"])
@pytest.mark.parametrize(("name", "take"), CHARACTERS)
def test_a_character_keeps_its_mesh_and_skin(data_dir, tmp_path, name, take, mode) -> None:
    source, path = data_dir / "rigs" / name, tmp_path / "clips.glb"
    motion = kineme.read(source, take=take)
    assert split(motion, cut_in_halves(motion), path, root_motion=mode) == [path, path]
    (tree, data), (before, old) = read_glb(path), read_glb(source)
    assert [each["name"].rpartition("_")[2] for each in tree["animations"]] == ["0", "1"]
    for part, other in zip(tree["meshes"], before["meshes"], strict=True):
        assert part == other
        for piece in part["primitives"]:
            tables = [piece["attributes"], *piece.get("targets", ())]
            numbers = [n for table in tables for n in table.values()] + [piece["indices"]]
            for number in numbers:
                assert get_stored(tree, data, number) == get_stored(before, old, number)
    assert tree["materials"] == before["materials"]
    if mode != "extract":
        assert (tree["nodes"], tree["skins"]) == (before["nodes"], before["skins"])
    clip = kineme.read(path, take=0)
    there = [clip.joint(each) for each in motion.skeleton.names]
    if mode == "keep":
        found = clip.positions[:, there]
        np.testing.assert_allclose(found, motion.positions[: len(found)], atol=1e-5)


@pytest.mark.parametrize("mode", ["keep", "extract"])
def test_an_fbx_keeps_its_mesh_and_skin(data_dir: Path, tmp_path: Path, mode: str) -> None:
    source, path = data_dir / "rigs" / "samba.fbx", tmp_path / "clips.fbx"
    motion = kineme.read(source)
    assert split(motion, cut_in_halves(motion), path, root_motion=mode) == [path, path]  # type: ignore[arg-type]
    clip = kineme.read(path, take=0)
    assert clip.provenance.takes == ("samba_0000_cluster_0", "samba_0001_cluster_1")
    assert clip.skeleton.names[0] == ("root" if mode == "extract" else motion.skeleton.names[0])
    there = [clip.joint(each) for each in motion.skeleton.names]
    expected = motion.positions[: clip.n_frames]
    np.testing.assert_allclose(clip.positions[:, there], expected, atol=1e-6)


def test_a_root_bone_is_added_and_moves_as_the_body_does(data_dir: Path, tmp_path: Path) -> None:
    motion = kineme.read(data_dir / "rigs" / "Xbot.glb", take="walk")
    split(motion, cut_in_halves(motion), tmp_path / "clips.glb", root_motion="extract")
    clip = kineme.read(tmp_path / "clips.glb", take=0)
    assert clip.skeleton.names[:2] == ("root", "mixamorig:Hips")
    # The hips stay above it, and everything is where it was.
    there = [clip.joint(each) for each in motion.skeleton.names]
    np.testing.assert_allclose(
        clip.positions[:, there], motion.positions[: clip.n_frames], atol=1e-5
    )
    np.testing.assert_allclose(clip.positions[:, 0, 1], 0.0, atol=1e-6)
    away = np.ptp(clip.positions[:, 1] - clip.positions[:, 0], axis=0)
    assert away.max() < 0.1


def test_any_recording_becomes_one_glb(tmp_path: Path, motion, truth) -> None:
    paths = split(motion, truth, tmp_path / "clips.glb", root_motion="extract", mirror=True)
    tree, _ = read_glb(tmp_path / "clips.glb")
    assert len(tree["animations"]) == len(paths) == len(truth.level("activity"))
    assert tree["animations"][0]["name"] == "exercises_0000_walk"
    assert "root" in {node["name"] for node in tree["nodes"]}


def test_a_copy_never_takes_the_place_of_its_source(data_dir: Path, tmp_path: Path) -> None:
    source = tmp_path / "Xbot.glb"
    source.write_bytes((data_dir / "rigs" / "Xbot.glb").read_bytes())
    motion = kineme.read(source, take="walk")
    with pytest.raises(ParameterError, match="overwrite its recording"):
        split(motion, cut_in_halves(motion), source)
    with pytest.raises(ParameterError, match="choose from keep, extract, in-place"):
        split(motion, cut_in_halves(motion), tmp_path / "c.glb", root_motion="stay")  # type: ignore[arg-type]
