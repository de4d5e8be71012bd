"""Clips as programs want them: names, rate, root bone; and what is written beside them."""

from __future__ import annotations

import struct
from dataclasses import replace

import numpy as np
import pytest

import kineme
from kineme.clips.motion_matching import LAYOUT
from kineme.clips.split import split, split_all
from kineme.errors import ParameterError, WriteError
from kineme.formats import list_takes
from kineme.recordings.operations import cut
from manifests import read_manifest

pytestmark = pytest.mark.filterwarnings("ignore::kineme.errors.KinemeWarning")


def test_names_follow_a_template(tmp_path, motion, truth) -> None:
    paths = split(motion, truth, tmp_path / "clips", name="{label}@{direction}_{n:02}")
    assert [path.name for path in paths[:2]] == [
        "walk@forwards_00.bvh",
        "transition@in_place_01.bvh",
    ]
    assert read_manifest(tmp_path / "clips")[0]["name"] == "walk_forwards_00"
    with pytest.raises(ParameterError, match=r"would have the name transition: put \{n\}"):
        split(motion, truth, tmp_path / "more", name="{label}")
    for wrong in ("walk", "{frame}", "{n.real}", "{n:q}", "{n"):
        with pytest.raises(ParameterError, match="name is "):
            split(motion, truth, tmp_path / "more", name=wrong)
    assert not (tmp_path / "more").exists()


def test_a_rate_puts_borders_on_whole_frames_and_loops_still_close(tmp_path, motion, truth) -> None:
    options = {"level": "primitive", "loops": True, "cluster": 0, "fps": 25.0}
    split(motion, truth, tmp_path / "clips", **options, close=True)
    for clip in read_manifest(tmp_path / "clips"):
        loop = kineme.read(tmp_path / "clips" / clip["file"])
        assert loop.fps == clip["fps"] == 25.0
        assert clip["round_s"] == pytest.approx((loop.n_frames - 1) / 25.0)
        recorded = (clip["stop_frame"] - clip["start_frame"]) / motion.fps
        assert abs(recorded - clip["round_s"]) <= 1 / 25.0
        assert clip["quality"]["step"] < 1.5


@pytest.mark.parametrize(
    ("target", "file", "root"),
    [
        ("unreal", "AS_exercises_walk_00.fbx", True),
        ("unity", "exercises@walk_00.fbx", True),
        ("blender", "exercises.glb", False),
        ("godot", "exercises.glb", True),
    ],
)
def test_targets_set_format_root_bone_and_names(
    tmp_path, motion, truth, target, file, root
) -> None:
    split(motion, truth, tmp_path / "clips", cluster=0, target=target, loops=True)
    (clip, *_) = [each for each in read_manifest(tmp_path / "clips") if each["start_frame"] == 0]
    assert clip["file"] == file
    assert ("close" in clip["changes"]) == (target != "blender")
    assert clip["name"].endswith("_loop") == (target == "godot")
    back = kineme.read(tmp_path / "clips" / file, take=clip["take"])
    assert (back.skeleton.names[0] == "root") == root
    with pytest.raises(ParameterError, match="choose from unreal, unity, blender, godot"):
        split(motion, truth, tmp_path / "more", target="maya")  # type: ignore[arg-type]


def test_all_takes_of_a_character_are_animations_of_one_copy(data_dir, tmp_path) -> None:
    source, target = data_dir / "rigs" / "Xbot.glb", tmp_path / "clips.glb"
    found = []
    for take in list_takes(source)[:3]:
        motion = kineme.read(source, take=take)
        found.append((motion, kineme.segment(motion)))
    split_all(found, target)
    clips = read_manifest(tmp_path, "clips.manifest.json")
    assert {clip["take"].split("_")[0] for clip in clips} == {"agree", "headShake", "idle"}
    assert {*list_takes(target)} == {clip["take"] for clip in clips}
    assert {clip["source_take"] for clip in clips} == {"agree", "headShake", "idle"}
    assert "source_take" in (tmp_path / "clips.manifest.csv").read_text().splitlines()[0]
    split_all(found, target)  # its own file is replaced
    (tmp_path / "mine.glb").write_bytes(b"mine")
    with pytest.raises(WriteError, match="exists already without a manifest"):
        split_all(found, tmp_path / "mine.glb")
    assert (tmp_path / "mine.glb").read_bytes() == b"mine"


def test_a_sheet_is_a_picture_and_its_place_is_checked_first(tmp_path, motion, truth) -> None:
    split(motion, truth, tmp_path / "clips", cluster=0, sheet=tmp_path / "clips.png")
    assert (tmp_path / "clips.png").read_bytes().startswith(b"\x89PNG")
    for name in ("clips.txt", "no/clips.png"):
        with pytest.raises(WriteError, match="suffix must be|there is no folder"):
            split(motion, truth, tmp_path / "more.glb", sheet=tmp_path / name)
    assert not (tmp_path / "more.glb").exists()


def test_a_database_has_features_as_published(tmp_path, motion, truth) -> None:
    split(motion, truth, tmp_path / "clips", motion_matching=tmp_path / "db.npz")
    with np.load(tmp_path / "db.npz") as found:
        database = dict(found)
    features, starts = database["features"], database["range_starts"]
    assert features.shape == (motion.n_frames, 27)
    assert database["range_names"][0] == "exercises_0000_walk"
    walk = slice(starts[0], database["range_stops"][0])
    # In a walk the body goes ahead, and its trajectory at 20, 40 and 60 frames farther and farther.
    hips = database["feature_names"].tolist().index("hips_velocity_0")
    left, up, ahead = features[walk, hips : hips + 3].mean(axis=0)
    assert ahead == pytest.approx(1.2, abs=0.3)
    assert max(abs(left), abs(up)) < 0.1
    (near, _, far) = features[walk, 16:21:2].mean(axis=0)
    assert 0 < 2 * near < far
    normal = (features - database["features_offset"]) / database["features_scale"]
    assert np.abs(normal.mean(axis=0)).max() < 1e-3
    # In the mirror the right foot is where the left one was, on the other side.
    split(kineme.mirror(motion), truth, tmp_path / "other", motion_matching=tmp_path / "m.npz")
    with np.load(tmp_path / "m.npz") as mirrored:
        np.testing.assert_allclose(mirrored["features"][:, 3], -features[:, 0], atol=0.02)


def test_the_binary_is_laid_out_as_its_reader_expects(tmp_path, motion, truth) -> None:
    split(motion, truth, tmp_path / "clips", cluster=0, motion_matching=tmp_path / "db.bin")
    data, at, found = (tmp_path / "db.bin").read_bytes(), 0, {}
    sizes = {"bone_rotations": 4, "bone_parents": 1, "range_starts": 1, "range_stops": 1}
    for key in LAYOUT:
        dims = 1 if key in ("bone_parents", "range_starts", "range_stops") else 2
        shape = struct.unpack_from(f"<{dims}I", data, at)
        vector = sizes.get(key, 1 if key == "contact_states" else 3)
        kind = "u1" if key == "contact_states" else "<i4" if dims == 1 else "<f4"
        count = int(np.prod(shape)) * vector
        found[key] = np.frombuffer(data, kind, count, at + 4 * dims).reshape(*shape, -1)
        at += 4 * dims + found[key].nbytes
    assert at == len(data)
    assert found["bone_parents"][0] == -1
    assert found["range_stops"][-1] == len(found["bone_positions"])
    np.testing.assert_allclose(np.linalg.norm(found["bone_rotations"], axis=-1), 1, atol=1e-5)


def test_what_has_no_rotations_has_no_database(tmp_path, motion, truth) -> None:
    points = replace(cut(motion, 0, motion.n_frames), rotations=None)
    with pytest.raises(ParameterError, match="motion_matching needs rotations"):
        split(points, truth, tmp_path / "clips", motion_matching=tmp_path / "db.npz")
    assert [*tmp_path.iterdir()] == []
