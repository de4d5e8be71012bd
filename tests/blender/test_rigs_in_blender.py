"""Rest pose and poses of what is written, in Blender beside its own import of the source.

Needs the environment variable KINEME_BPY: a Python that has the package ``bpy`` (5.0).
"""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import kineme

BPY = os.environ.get("KINEME_BPY", "")
pytestmark = [
    pytest.mark.skipif(not BPY, reason="KINEME_BPY names no Python with bpy"),
    pytest.mark.filterwarnings("ignore::kineme.errors.KinemeWarning"),
]
FRAMES = (1, 5, 9, 14)
WORST = 1e-4
"""Metres: a tenth of a millimetre."""

SCRIPT = """
import bpy, json, sys
path, action, frames, target = sys.argv[1], sys.argv[2], json.loads(sys.argv[3]), sys.argv[4]
bpy.ops.wm.read_factory_settings(use_empty=True)
load = {"glb": lambda: bpy.ops.import_scene.gltf(filepath=path),
        "fbx": lambda: bpy.ops.import_scene.fbx(filepath=path),
        "bvh": lambda: bpy.ops.import_anim.bvh(filepath=path, global_scale=0.01,
                                               update_scene_fps=True)}
load[path.rsplit(".", 1)[1]]()
body = next(each for each in bpy.data.objects if each.type == "ARMATURE")
found = next(each for each in bpy.data.actions if action in each.name)
rest = {bone.name: list(body.matrix_world @ bone.head_local) for bone in body.data.bones}
data = body.animation_data_create()
for track in list(data.nla_tracks):
    data.nla_tracks.remove(track)
data.action = found
data.action_slot = found.slots[0]
scene, poses = bpy.context.scene, []
rate = scene.render.fps / scene.render.fps_base
for frame in frames:
    at = found.frame_range[0] + frame / 30 * rate
    scene.frame_set(int(at), subframe=at - int(at))
    poses.append({b.name: list(body.matrix_world @ b.head) for b in body.pose.bones})
json.dump([rest, *poses], open(target, "w"))
"""


def in_blender(path: Path, folder: Path, action: str = "") -> list[dict[str, Any]]:
    """Heads of the bones at rest and in some frames, metres."""
    target = folder / f"{path.name}.json"
    arguments = ["-c", SCRIPT, str(path), action, json.dumps(FRAMES), str(target)]
    subprocess.run([BPY, *arguments], check=True, capture_output=True, timeout=300)
    found: list[dict[str, Any]] = json.loads(target.read_text())
    return found


@pytest.mark.parametrize("suffix", [".fbx", ".glb", ".bvh"])
@pytest.mark.parametrize(
    ("name", "take"),
    [
        ("samba.fbx", None),
        ("Xbot.glb", "walk"),
        ("bandai_namco/dataset-1_dash_normal_001.bvh", None),
    ],
)
def test_bones_are_as_in_the_source(data_dir, tmp_path, name, take, suffix) -> None:
    source = data_dir / "rigs" / name
    motion = kineme.read(source, take=take)[:20]
    path = tmp_path / f"clip{suffix}"
    kineme.write(motion, path)
    expected, found = in_blender(source, tmp_path, take or ""), in_blender(path, tmp_path)
    shared = [bone for bone in expected[0] if bone in found[0]]
    assert len(shared) >= 0.9 * len(expected[0])
    for one, other in zip(expected, found, strict=True):
        off = [np.subtract(one[bone], other[bone]) for bone in shared]
        assert np.abs(off).max() < WORST
