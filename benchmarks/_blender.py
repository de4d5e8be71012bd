"""What `benchmarks/durability/scenes.py` has Blender do; run by a Python that has ``bpy``.

    PYTHON _blender.py JOBS.json

Each job imports BVH files, exports or reads a scene, and leaves where Blender has the bones:
positions (frames, bones, 3) and matrices (frames, bones, 3, 3) in its own axes (z up), by name.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import bpy
import numpy as np


def emptied() -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)


def armatures() -> list[Any]:
    return [each for each in bpy.context.scene.objects if each.type == "ARMATURE"]


def imported(job: dict[str, Any]) -> None:
    """The BVH files of a job, each an armature; the first sets rate and length."""
    for number, path in enumerate(job["bvh"]):
        bpy.ops.import_anim.bvh(
            filepath=path,
            global_scale=0.01,
            rotate_mode=job.get("rotations", "NATIVE"),
            update_scene_fps=number == 0,
            update_scene_duration=number == 0,
        )
        bpy.context.object.location.x += number
    scene = bpy.context.scene
    scene.frame_start = 1
    lengths = [int(action.frame_range[1]) for action in bpy.data.actions]
    scene.frame_end = min(*lengths, scene.frame_end, job["frames"])
    if job.get("prop"):
        bpy.ops.mesh.primitive_cube_add()
        cube = bpy.context.object
        cube.name = "Box"
        for frame, x in ((1, 0.0), (20, 1.0)):
            cube.location.x = x
            cube.keyframe_insert("location", frame=frame)


def with_takes(job: dict[str, Any]) -> None:
    """The BVH files of a job as actions of one armature."""
    imported(job)
    first, *others = armatures()
    for other in others:
        bpy.data.objects.remove(other)
    for action in bpy.data.actions:
        action.use_fake_user = True
    held = {}
    for action in bpy.data.actions:
        first.animation_data.action = action
        first.animation_data.action_slot = action.slots[0]
        start, stop = map(int, action.frame_range)
        bpy.context.scene.frame_start, bpy.context.scene.frame_end = start, stop
        body = {key.partition("/")[2]: value for key, value in poses().items()}
        held |= {f"{action.name}/{what}": value for what, value in body.items()}
    np.savez(job["poses"], **held)


def exported(job: dict[str, Any]) -> None:
    options = job.get("options", {})
    if job["path"].endswith(".fbx"):
        bpy.ops.export_scene.fbx(filepath=job["path"], **options)
    elif job["path"].endswith(".usdc"):
        bpy.ops.wm.usd_export(filepath=job["path"], **options)
    else:
        bpy.ops.export_scene.gltf(filepath=job["path"], **options)


def read(job: dict[str, Any]) -> None:
    """A scene at the rate that it has frames at."""
    bpy.context.scene.render.fps = round(job["fps"])
    bpy.context.scene.render.fps_base = round(job["fps"]) / job["fps"]
    if job["path"].endswith((".glb", ".gltf")):
        bpy.ops.import_scene.gltf(filepath=job["path"])
    elif job["path"].endswith((".usda", ".usdc", ".usd")):
        bpy.ops.wm.usd_import(filepath=job["path"])
    else:
        bpy.ops.import_scene.fbx(filepath=job["path"])
    bpy.context.scene.frame_start = job.get("first", 1)
    bpy.context.scene.frame_end = job.get("first", 1) + job["frames"] - 1


def poses() -> dict[str, np.ndarray]:
    """Where the bones of all armatures are at each frame."""
    scene = bpy.context.scene
    frames = range(scene.frame_start, scene.frame_end + 1)
    held: dict[str, np.ndarray] = {}
    bodies = armatures()
    for body in bodies:
        names = [bone.name for bone in body.pose.bones]
        held[f"{body.name}/names"] = np.array(names)
        held[f"{body.name}/positions"] = np.empty((len(frames), len(names), 3))
        held[f"{body.name}/turns"] = np.empty((len(frames), len(names), 3, 3))
    for k, frame in enumerate(frames):
        scene.frame_set(frame)
        for body in bodies:
            for j, bone in enumerate(body.pose.bones):
                matrix = np.array(body.matrix_world @ bone.matrix)
                turn = matrix[:3, :3] / np.linalg.norm(matrix[:3, :3], axis=0)
                held[f"{body.name}/positions"][k, j] = matrix[:3, 3]
                held[f"{body.name}/turns"][k, j] = turn
    return held


def main() -> None:
    for job in json.loads(Path(sys.argv[1]).read_text()):
        emptied()
        if job["task"] == "takes":
            with_takes(job)
            exported(job)
            continue
        if job["task"] == "export":
            imported(job)
            exported(job)
        else:
            read(job)
        np.savez(job["poses"], **poses())


main()
