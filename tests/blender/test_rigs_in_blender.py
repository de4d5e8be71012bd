"""Rest pose and poses of what is written, in Blender beside its own import of the source.

Needs the environment variable KINEME_BPY: a Python that has the package ``bpy`` (5.0).
"""

from __future__ import annotations

import numpy as np
import pytest

import kineme
from blender_reader import BPY, read_in_blender
from kineme.formats.scenes.fbx_writer import copy_takes

pytestmark = [
    pytest.mark.skipif(not BPY, reason="KINEME_BPY names no Python with bpy"),
    pytest.mark.filterwarnings("ignore::kineme.errors.KinemeWarning"),
]
WORST = 1e-4
"""Metres: a tenth of a millimetre."""


SOURCES = [
    ("samba.fbx", None),
    ("Xbot.glb", "walk"),
    ("bandai_namco/dataset-1_dash_normal_001.bvh", None),
]
CASES = [(*source, suffix) for source in SOURCES for suffix in (".fbx", ".glb", ".bvh")]


@pytest.mark.parametrize(
    ("name", "take", "suffix"), [*CASES, ("RobotExpressive.glb", "Walking", ".glb")]
)
def test_bones_are_as_in_the_source(data_dir, tmp_path, name, take, suffix) -> None:
    source = data_dir / "rigs" / name
    motion = kineme.read(source, take=take)[:20]
    path = tmp_path / f"clip{suffix}"
    kineme.write(motion, path)
    expected, found = read_in_blender(source, tmp_path, take or ""), read_in_blender(path, tmp_path)
    shared = [bone for bone in expected[0] if bone in found[0]]
    assert len(shared) >= 0.9 * len(expected[0])
    for one, other in zip(expected, found, strict=True):
        off = [np.subtract(one[bone], other[bone]) for bone in shared]
        assert np.abs(off).max() < WORST


def test_bones_of_a_copy_are_as_in_the_source(data_dir, tmp_path) -> None:
    source, path = data_dir / "rigs" / "samba.fbx", tmp_path / "copy.fbx"
    copy_takes({"clip": kineme.read(source)[:20]}, source, path)
    expected, found = (
        read_in_blender(source, tmp_path, "mixamo"),
        read_in_blender(path, tmp_path, "clip"),
    )
    for one, other in zip(expected, found, strict=True):
        assert one.keys() == other.keys()
        assert max(np.abs(np.subtract(one[bone], other[bone])).max() for bone in one) < WORST
