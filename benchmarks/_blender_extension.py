"""What `benchmarks/durability/blender_extension.py` has Blender do; run by a Python with ``bpy``.

    PYTHON _blender_extension.py TASK.json

The extension is installed from its zip and has the recordings of the task segmented, shown,
undone, saved and opened. What was there then is left as JSON, for kineme's own to be held against.
"""

from __future__ import annotations

import json
import os
import sys
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any

TASK = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
os.environ["BLENDER_USER_RESOURCES"] = TASK["home"]  # before bpy reads it

import bpy  # noqa: E402
import numpy as np  # noqa: E402

MODULE = "bl_ext.user_default.kineme"


def installed() -> None:
    bpy.ops.extensions.package_install_files(
        filepath=TASK["zip"], repo="user_default", enable_on_install=True
    )
    bpy.context.preferences.addons[MODULE].preferences.python = TASK["python"]


def opened(recording: dict[str, Any]) -> Any:
    """An armature that moves as a recording does, in an empty scene at its rate."""
    bpy.ops.wm.read_homefile(use_empty=True)
    scene = bpy.context.scene
    if recording["path"].endswith(".bvh"):
        bpy.ops.import_anim.bvh(
            filepath=recording["path"],
            global_scale=0.01,
            frame_start=recording["first"],
            update_scene_fps=True,
            update_scene_duration=True,
        )
    else:
        scene.render.fps = round(recording["fps"])
        bpy.ops.import_scene.gltf(filepath=recording["path"])
        scene.frame_start, scene.frame_end = 0, recording["frames"] - 1
    armature = next(each for each in scene.objects if each.type == "ARMATURE")
    bpy.context.view_layer.objects.active = armature
    return armature


def pose(armature: Any, frame: int) -> np.ndarray:
    bpy.context.scene.frame_set(frame)
    return np.array([armature.matrix_world @ bone.matrix for bone in armature.pose.bones])


def shown(armature: Any) -> dict[str, Any]:
    """Markers, strips and clips that there are."""
    action = armature.animation_data.action
    markers = bpy.context.scene.timeline_markers
    tracks = armature.animation_data.nla_tracks
    clips = [each for each in bpy.data.actions if each.get("kineme_clip_of") == action.name]
    return {
        "markers": sorted([marker.frame, marker.name] for marker in markers),
        "strips": {
            track.name: [
                [strip.name, strip.frame_start, strip.frame_end, strip.action_frame_start]
                for strip in track.strips
            ]
            for track in tracks
            if track.name.startswith("kineme: ")  # importers make others
        },
        "clips": {
            clip.name: [*clip.frame_range, clip.asset_data.catalog_id, clip["kineme_catalogue"]]
            for clip in clips
        },
    }


def differing(armature: Any) -> float:
    """By how much clips pose the armature other than the action does, at most, at their ends."""
    animation = armature.animation_data
    action, slot = animation.action, getattr(animation, "action_slot", None)
    animation.use_nla, worst = False, 0.0
    for clip in [each for each in bpy.data.actions if each.get("kineme_clip_of") == action.name]:
        for frame in map(int, clip.frame_range):
            expected = pose(armature, clip["kineme_clip_from"] + frame - 1)
            animation.action = clip
            if slot is not None:
                animation.action_slot = clip.slots[0]
            found = pose(armature, frame)
            animation.action = action
            if slot is not None:
                animation.action_slot = slot
            worst = max(worst, float(np.abs(found - expected).max()))
    animation.use_nla = True
    return worst


def sampled(recording: dict[str, Any]) -> None:
    """Leave what the extension reads of the armature; and again of it turned, larger, in part."""
    armature, scene = opened(recording), bpy.context.scene
    sampling = sys.modules[f"{MODULE}.sampling"]
    first, last = map(int, armature.animation_data.action.frame_range)
    for form in ("plain", "turned"):
        if form == "turned":
            armature.rotation_euler, armature.scale = (0.3, -1.2, 2.0), (3.0, 3.0, 3.0)
            scene.unit_settings.scale_length = 0.5
            for bone in armature.data.bones:
                bone.use_deform = bone.name != "LeftToeBase"
            scene.frame_set(first)
        bones = sampling.bones_of(armature, "DEFORM")
        path = Path(f"{recording['output']}.{form}.npz")
        list(sampling.sampled(scene, armature, bones, first, last, path))


def all_of_it(recording: dict[str, Any]) -> dict[str, Any]:
    """Every button, in turn."""
    armature = opened(recording)
    scene, settings, kineme = bpy.context.scene, bpy.context.scene.kineme, bpy.ops.kineme
    scene.timeline_markers.new("mine", frame=5)
    held: dict[str, Any] = {"bones": len(armature.pose.bones)}
    kineme.segment()
    record = json.loads(armature.animation_data.action["kineme_record"])
    held |= {"table": record["table"], "first": record["first"], "fps": scene.render.fps}
    for level in ("activity", "primitive"):
        settings.level = level
        for form in ("MARKERS", "STRIPS", "ACTIONS"):
            kineme.show(form=form)
        held[level] = shown(armature)
        held[level]["differ"] = differing(armature)

    settings.level = "activity"
    scene.frame_set(record["first"])
    visited = []
    while kineme.jump(step=1) == {"FINISHED"}:
        visited.append(scene.frame_current)
    held["jumps"] = visited
    held["panels"] = [drawn(), drawn(iter(()))]
    kineme.jump(step=-1)
    kineme.preview()
    held["preview"] = [scene.frame_preview_start, scene.frame_preview_end]
    kineme.find()
    held["similar"] = [
        [each.frame, each.name] for each in scene.timeline_markers if "similar" in each.name
    ]
    scene.use_preview_range = False

    kineme.show(form="MARKERS")
    for marker in scene.timeline_markers:
        if marker.frame == record["first"] and marker.name != "mine":
            marker.name = "stroll"
    kineme.names()
    held["named"] = json.loads(armature.animation_data.action["kineme_record"])["table"]
    held["named markers"] = shown(armature)["markers"]
    for suffix in ("json", "csv"):
        kineme.save(filepath=f"{recording['output']}.{suffix}")
    held |= undone() | reopened(recording)
    return held


def undone() -> dict[str, Any]:
    """What is there before strips go, after, after an undo and after redoing it."""
    states = []

    def note() -> None:
        armature = next(each for each in bpy.data.objects if each.type == "ARMATURE")
        states.append([shown(armature), armature.animation_data.action["kineme_record"]])

    bpy.ops.ed.undo_push(message="before")
    note()
    bpy.context.scene.kineme.level = "primitive"
    bpy.ops.kineme.show(form="STRIPS")
    bpy.ops.kineme.show(form="MARKERS")
    bpy.ops.ed.undo_push(message="after")
    note()
    bpy.ops.ed.undo()
    note()
    bpy.ops.ed.redo()
    note()
    return {"undone": states[2] == states[0] != states[1], "redone": states[3] == states[1]}


def reopened(recording: dict[str, Any]) -> dict[str, Any]:
    """Whether all is there again after the file was saved, and opened."""
    path = f"{recording['output']}.blend"
    armature = next(each for each in bpy.data.objects if each.type == "ARMATURE")
    before = [shown(armature), armature.animation_data.action["kineme_record"]]
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    armature = next(each for each in bpy.data.objects if each.type == "ARMATURE")
    bpy.context.view_layer.objects.active = armature
    after = [shown(armature), armature.animation_data.action["kineme_record"]]
    scene = bpy.context.scene
    scene.frame_set(scene.frame_start)
    catalogues = Path(path).parent / "blender_assets.cats.txt"
    return {
        "opened": before == after and bpy.ops.kineme.jump(step=1) == {"FINISHED"},
        "catalogues": catalogues.read_text(encoding="utf-8"),
    }


def refused(recording: dict[str, Any]) -> list[str]:
    """What is said where something is missing, and of work that is ended."""
    armature = opened(recording)
    said = []

    def ask(work: Any) -> None:
        try:
            work()
            said.append("nothing")
        except RuntimeError as error:
            said.append(str(error).strip())

    preferences = bpy.context.preferences.addons[MODULE].preferences
    preferences.python = "/no/such/python"
    ask(bpy.ops.kineme.segment)
    preferences.python = TASK["python"]
    ask(bpy.ops.kineme.find)
    bpy.context.scene.kineme.scope = "PREVIEW"
    ask(bpy.ops.kineme.segment)
    bpy.context.scene.kineme.scope = "ACTION"
    bpy.context.scene.kineme.effectors = "head=Nose"
    ask(bpy.ops.kineme.segment)
    bpy.context.scene.kineme.effectors = ""
    return [*said, by_ticks(armature), ended(armature)]


class Layout:
    """A layout of a panel that draws nothing: what it is given must be there in Blender."""

    functions = bpy.types.UILayout.bl_rna.functions

    def __init__(self) -> None:
        self.shown: list[str] = []

    def __getattr__(self, name: str) -> Any:
        if name not in self.functions:
            raise AttributeError(name)

        def call(*given: Any, **options: Any) -> Any:
            known = self.functions[name].parameters
            for key, value in options.items():
                if key == "icon" and value not in known[key].enum_items:
                    raise ValueError(value)
                known[key]
            if name == "prop":
                given[0].bl_rna.properties[given[1]]
            if name == "operator":
                part, _, rest = given[0].partition(".")
                getattr(getattr(bpy.ops, part), rest).get_rna_type()
            self.shown += [str(options.get("text", given[-1] if given else name))]
            return self

        return call


def drawn(work: Any = None) -> list[str]:
    """What the panels show."""
    panels = sys.modules[f"{MODULE}.panels"]
    background = sys.modules[f"{MODULE}.background"]
    background.Work.steps, shown = work, []
    for panel in (panels.ViewPanel, panels.DopeSheetPanel):
        layout = Layout()
        stand = type("Stand", (), {"layout": layout, "draw_table": panel.draw_table})()
        panel.draw(stand, bpy.context)
        shown += layout.shown
    background.Work.steps = None
    preferences, layout = bpy.context.preferences.addons[MODULE].preferences, Layout()
    options = {"layout": layout, "python": preferences.python, "bl_rna": preferences.bl_rna}
    stand = type("Stand", (), options)()
    type(preferences).draw(stand, bpy.context)
    return [*shown, *layout.shown]


def by_ticks(armature: Any) -> str:
    """How work ends that ticks of a timer take on, as in a window."""
    operators = sys.modules[f"{MODULE}.operators"]
    background = sys.modules[f"{MODULE}.background"]
    said: list[str] = []

    class Stand(background.InBackground):
        steps = operators.Segment.steps

        def report(self, _kind: set[str], text: str) -> None:
            said.append(text)

    stand, seen = Stand(), set()
    background.Work.steps = stand.steps(bpy.context)
    tick, other = SimpleNamespace(type="TIMER"), SimpleNamespace(type="MOUSEMOVE")
    result = stand.modal(bpy.context, other)
    while result == {"PASS_THROUGH"}:
        seen.add(background.Work.stage)
        time.sleep(background.TICK_S)
        result = stand.modal(bpy.context, tick)
    fine = result == {"FINISHED"} and "reading the motion" in seen and len(seen) > 2
    del armature.animation_data.action["kineme_record"]
    return said[0] if fine else f"{result} {said} {seen}"


def ended(armature: Any) -> str:
    """How work ends that is cancelled while kineme is at it: its process is gone."""
    module = sys.modules[f"{MODULE}.process"]
    begun: list[Any] = []
    popen = module.subprocess.Popen

    def watched(*given: Any, **options: Any) -> Any:
        begun.append(popen(*given, **options))
        return begun[-1]

    module.subprocess.Popen = watched
    try:
        operators = sys.modules[f"{MODULE}.operators"]
        background = sys.modules[f"{MODULE}.background"]
        steps = operators.Segment.steps(None, bpy.context)
        background.Work.steps = steps
        while next(steps)[0] is not None:
            pass
        bpy.ops.kineme.cancel()
    finally:
        module.subprocess.Popen = popen
    gone = begun[0].poll() is not None and background.Work.steps is None
    return "ended" if gone and "kineme_record" not in armature.animation_data.action else "goes on"


def main() -> None:
    installed()
    held = {"version": list(bpy.app.version)}
    held["recordings"] = [all_of_it(recording) for recording in TASK["recordings"]]
    sampled(TASK["recordings"][0])
    held["refused"] = refused(TASK["recordings"][0])
    bpy.ops.preferences.addon_disable(module=MODULE)
    Path(TASK["output"]).write_text(json.dumps(held), encoding="utf-8")


main()
