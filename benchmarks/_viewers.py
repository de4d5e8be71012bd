"""Read clips in Blender, three.js and the glTF validator, if these are installed.

``KINEME_BPY`` names a Python that has the package ``bpy`` (5.0), ``KINEME_NODE`` a folder
``node_modules`` with ``three`` and ``gltf-validator``.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

BPY = os.environ.get("KINEME_BPY", "")
NODE = shutil.which("node") or ""
MODULES = Path(os.environ.get("KINEME_NODE", "node_modules"))
THREE, VALIDATOR = MODULES / "three", MODULES / "gltf-validator"
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
IN_THREE = """
(async () => {
  const [folder, path, name, frames] = process.argv.slice(1);
  globalThis.self = globalThis;
  const three = await import(folder + "/build/three.module.js");
  const { GLTFLoader } = await import(folder + "/examples/jsm/loaders/GLTFLoader.js");
  const bytes = new Uint8Array(require("fs").readFileSync(path)).buffer;
  const file = await new GLTFLoader().parseAsync(bytes, "");
  const mixer = new three.AnimationMixer(file.scene);
  mixer.clipAction(file.animations.find((clip) => clip.name === name)).play();
  const poses = JSON.parse(frames).map((frame) => {
    mixer.setTime(frame / 30);
    file.scene.updateMatrixWorld(true);
    const pose = {};
    file.scene.traverse((each) => {
      if (each.isBone) pose[each.name] = new three.Vector3().setFromMatrixPosition(
        each.matrixWorld).toArray();
    });
    return pose;
  });
  console.log(JSON.stringify(poses));
})();
"""
VALIDATE = """
const [folder, ...paths] = process.argv.slice(1);
const { validateBytes } = require(folder);
(async () => {
  let errors = 0;
  for (const path of paths) {
    const report = await validateBytes(new Uint8Array(require("fs").readFileSync(path)));
    errors += report.issues.numErrors;
  }
  console.log(errors);
})();
"""

Pose = dict[str, list[float]]


def read_in_blender(path: Path, folder: Path, action: str = "") -> list[Pose]:
    """Return the heads of the bones at rest and in `FRAMES`, in metres."""
    target = folder / f"{path.name}.json"
    arguments = ["-c", IN_BLENDER, str(path), action, json.dumps(FRAMES), str(target)]
    subprocess.run([BPY, *arguments], check=True, capture_output=True, timeout=300)
    found: list[Pose] = json.loads(target.read_text())
    return found


def read_in_three(path: Path, animation: str) -> list[Pose]:
    """Return the positions of bones in `FRAMES` of an animation, in metres."""
    found: list[Pose] = _run_node(IN_THREE, THREE, path, animation, json.dumps(FRAMES))
    return found


def count_errors(paths: Sequence[Path]) -> int:
    """Count the errors that the Khronos validator finds in glTF files."""
    return int(_run_node(VALIDATE, VALIDATOR, *paths))


def list_missing() -> list[str]:
    """Return missing programs and the variable that names each."""
    found = [] if BPY else ["Blender (KINEME_BPY)"]
    found += [] if NODE and THREE.exists() else ["three.js (KINEME_NODE)"]
    return found + ([] if NODE and VALIDATOR.exists() else ["gltf-validator (KINEME_NODE)"])


def _run_node(program: str, module: Path, *arguments: object) -> Any:
    command = [NODE, "-e", program, str(module.resolve()), *map(str, arguments)]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
