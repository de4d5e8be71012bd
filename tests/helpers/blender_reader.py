"""Read clips in Blender. ``KINEME_BPY`` names a Python that has the package ``bpy`` (5.0)."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

BPY = os.environ.get("KINEME_BPY", "")
FRAMES = (1, 5, 9, 14)
"""Frames at 30 Hz at which poses are compared."""
IN_BLENDER = """
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

Pose = dict[str, list[float]]


def read_in_blender(path: Path, folder: Path, action: str = "") -> list[Pose]:
    """Return the heads of the bones at rest and in `FRAMES`, in metres."""
    target = folder / f"{path.name}.json"
    arguments = ["-c", IN_BLENDER, str(path), action, json.dumps(FRAMES), str(target)]
    subprocess.run([BPY, *arguments], check=True, capture_output=True, timeout=300)
    found: list[Pose] = json.loads(target.read_text())
    return found
