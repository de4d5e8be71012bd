"""The motion of an armature as kineme reads it: an npz of joints, of what a BVH would hold.

A joint is at the head of a bone, and turns as the bone does from its rest; a bone without children
has the end of the limb at its tail. Blender's z points up, kineme's y does: (x, y, z) is
(x, z, -y) there. Lengths are metres, with the scale of units of the scene.
"""

from collections.abc import Iterator
from pathlib import Path

import bpy
import numpy as np
from mathutils import Quaternion, Vector

END_NAMES = ("_end", "end", "nub", "site")
"""Of bones that are ends of limbs themselves, as FBX has them."""


def bones_of(armature: bpy.types.Object, which: str) -> list[bpy.types.PoseBone]:
    """The bones that are looked at, parents first.

    Of a rig with controls those that deform; all where none does; or those that are selected.
    """
    roots = [bone for bone in armature.pose.bones if bone.parent is None]
    bones = [each for root in roots for each in (root, *root.children_recursive)]
    if which == "SELECTED":
        return [bone for bone in bones if is_selected(bone)]
    return [bone for bone in bones if bone.bone.use_deform] or bones


def is_selected(bone: bpy.types.PoseBone) -> bool:
    """Whether a bone is selected, which 5.0 asks of the pose."""
    return bone.select if hasattr(bone, "select") else bone.bone.select


def sampled(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    bones: list[bpy.types.PoseBone],
    first: int,
    last: int,
    path: Path,
) -> Iterator[float]:
    """Leave what the bones do from frame ``first`` to ``last`` at ``path``; the share that is done.

    After each share the scene is back where it was.
    """
    at = {bone.name: number for number, bone in enumerate(bones)}
    parents = [_parent(bone, at) for bone in bones]
    tips = [number for number, bone in enumerate(bones) if _has_end(bone, at)]
    names = [*at, *(_unique(f"{bones[number].name}_end", at) for number in tips)]
    rests = [bone.bone.matrix_local for bone in bones]
    unrest = [rest.to_quaternion().conjugated() for rest in rests]
    unit = scene.unit_settings.scale_length
    scale = armature.matrix_world.to_scale() * unit
    heads = [rest.translation for rest in rests]
    offsets = [
        head if parent < 0 else head - heads[parent]
        for head, parent in zip(heads, parents, strict=True)
    ] + [bones[number].bone.tail_local - heads[number] for number in tips]

    count = last - first + 1
    positions = np.empty((count, len(names), 3))
    rotations = np.zeros((count, len(names), 4))
    rotations[..., 0] = 1
    shown = scene.frame_current
    for k in range(count):
        scene.frame_set(first + k)
        world = armature.matrix_world
        turn = world.to_quaternion()
        turns: list[Quaternion] = []
        for number, bone in enumerate(bones):
            positions[k, number] = _upright(world @ bone.head)
            turns.append(turn @ bone.matrix.to_quaternion() @ unrest[number])
            parent = parents[number]
            local = turns[-1] if parent < 0 else turns[parent].conjugated() @ turns[-1]
            rotations[k, number] = local.w, local.x, local.z, -local.y
        for number, tip in enumerate(tips, start=len(bones)):
            positions[k, number] = _upright(world @ bones[tip].tail)
        if k % 32 == 31 or k == count - 1:
            scene.frame_set(shown)
            yield (k + 1) / count
            shown = scene.frame_current
    fps = scene.render.fps / scene.render.fps_base
    np.savez(
        path,
        positions=positions * unit,
        rotations=rotations / np.linalg.norm(rotations, axis=-1, keepdims=True),
        names=np.array(names),
        parents=np.array([*parents, *tips]),
        offsets=np.array([_upright(offset * scale) for offset in offsets]),
        end_sites=np.arange(len(bones), len(names)),
        fps=fps,
    )


def _upright(vector: Vector) -> tuple[float, float, float]:
    """A vector with y up."""
    return vector.x, vector.z, -vector.y


def _parent(bone: bpy.types.PoseBone, at: dict[str, int]) -> int:
    """The nearest bone above that is looked at, -1 for none."""
    for above in bone.parent_recursive:
        if above.name in at:
            return at[above.name]
    return -1


def _has_end(bone: bpy.types.PoseBone, at: dict[str, int]) -> bool:
    """Whether the tail of a bone is the end of a limb."""
    if bone.name.lower().endswith(END_NAMES):
        return False
    return not any(child.name in at for child in bone.children_recursive)


def _unique(name: str, names: dict[str, int]) -> str:
    while name in names:
        name += "_"
    return name
