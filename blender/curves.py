"""The curves of actions, whichever version of Blender: the one place that knows of the difference.

Until 4.3 an action has its curves itself. From 4.4 on they lie in its layers, in strips, in a bag
for each slot; 5.0 has no others.
"""

from collections.abc import Iterator

import bpy
import numpy as np


def curves_of(action: bpy.types.Action) -> Iterator[bpy.types.FCurve]:
    """All curves of an action."""
    if not hasattr(action, "layers"):
        yield from action.fcurves
        return
    for layer in action.layers:
        for strip in layer.strips:
            for bag in strip.channelbags:
                yield from bag.fcurves


def with_slot_of(strip: bpy.types.NlaStrip, animation: bpy.types.AnimData) -> None:
    """Have a strip play the same slot as the armature does."""
    if hasattr(strip, "action_slot"):
        strip.action_slot = animation.action_slot


def cut(action: bpy.types.Action, name: str, first: int, last: int) -> bpy.types.Action:
    """A new action of the frames of a span alone, from frame 1 on: a key on each frame."""
    frames = np.arange(first, last + 1)
    clip = action.copy()
    clip.name = name
    for curve in curves_of(clip):
        values = [curve.evaluate(frame) for frame in frames]
        for modifier in reversed(list(curve.modifiers)):
            curve.modifiers.remove(modifier)
        points = curve.keyframe_points
        points.clear()
        points.add(len(frames))
        points.foreach_set("co", np.column_stack([frames - first + 1, values]).ravel())
        for point in points:
            point.interpolation = "LINEAR"
        curve.update()
    clip.use_frame_range = True
    clip.frame_start, clip.frame_end = 1, len(frames)
    return clip
