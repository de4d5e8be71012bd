"""What the buttons do: segment, show, go from segment to segment, search, name, save."""

import math
import tempfile
from collections.abc import Generator
from pathlib import Path
from typing import Any

import bpy
from bpy.props import EnumProperty, IntProperty, StringProperty

from . import results
from .background import InBackground, Steps, Work
from .process import FailureError, python_of, work
from .sampling import bones_of, sampled
from .table import Marker, frames_of, names_given, neighbour, row_at, shortened

UNDONE = {"REGISTER", "UNDO"}


def armature_of(context: bpy.types.Context) -> bpy.types.Object | None:
    """The active armature, or that of the active mesh."""
    chosen = context.active_object
    if chosen is None or chosen.type == "ARMATURE":
        return chosen
    return chosen.find_armature()


def python(context: bpy.types.Context) -> list[str]:
    """The command of kineme's Python."""
    preferences = context.preferences.addons[__package__].preferences
    return python_of(bpy.path.abspath(preferences.python) if preferences.python else "")


def span_of(scene: bpy.types.Scene, armature: bpy.types.Object, scope: str) -> tuple[int, int]:
    """The first and last frame that are segmented."""
    action = results.owner_of(armature)
    if scope == "PREVIEW":
        if not scene.use_preview_range:
            raise FailureError("there is no preview range: drag one with P in the timeline")
        span = scene.frame_preview_start, scene.frame_preview_end
    elif scope == "ACTION" and isinstance(action, bpy.types.Action):
        first, last = action.frame_range
        span = math.ceil(first), math.floor(last)
    else:
        span = scene.frame_start, scene.frame_end
    if span[1] - span[0] < 1:
        raise FailureError(f"frames {span[0]} to {span[1]} are too few to segment")
    return span


def recorded(
    context: bpy.types.Context, armature: bpy.types.Object, span: tuple[int, int], folder: str
) -> Generator[tuple[float | None, str], None, str]:
    """Leave the motion of an armature in a folder; where is what comes back."""
    bones = bones_of(armature, context.scene.kineme.bones)
    if len(bones) < 2:
        raise FailureError("kineme looks at two bones at least: select more, or take all")
    path = Path(folder) / "recording.npz"
    for share in sampled(context.scene, armature, bones, *span, path):
        yield share, "reading the motion"
    return str(path)


def answered(
    context: bpy.types.Context, task: dict[str, Any]
) -> Generator[tuple[float | None, str], None, dict[str, Any]]:
    """What kineme answers."""
    steps = work(python(context), task)
    try:
        while True:
            yield None, next(steps)
    except StopIteration as done:
        return done.value
    finally:
        steps.close()


class OfArmature:
    """An operator that wants an armature."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return armature_of(context) is not None


class OfTable:
    """An operator that wants an armature whose action was segmented."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return results.record_of(armature_of(context)) is not None


class Segment(OfArmature, InBackground, bpy.types.Operator):
    """Cut the motion of the active armature into activities and repetitions"""

    bl_idname, bl_label, bl_options = "kineme.segment", "Segment", UNDONE

    def steps(self, context: bpy.types.Context) -> Steps:
        scene, settings, armature = context.scene, context.scene.kineme, armature_of(context)
        python(context)  # better said before than after the reading
        owner, level = results.owner_of(armature), settings.level
        span = span_of(scene, armature, settings.scope)
        with tempfile.TemporaryDirectory(prefix="kineme-") as folder:
            path = yield from recorded(context, armature, span, folder)
            task = {"task": "segment", "recording": path, "name": owner.name,
                    "detail": settings.detail, "effectors": settings.effectors}  # fmt: skip
            answer = yield from answered(context, task)
        results.keep_table(scene, owner, {"first": span[0], "table": answer["table"]}, level)
        kinds = [row["kind"] for row in answer["table"]["segments"]]
        return f"{kinds.count('activity')} activities, {kinds.count('primitive')} repetitions"


class Cancel(bpy.types.Operator):
    """End what kineme is doing"""

    bl_idname, bl_label, bl_options = "kineme.cancel", "Cancel", {"INTERNAL"}

    def execute(self, _context: bpy.types.Context) -> set[str]:
        Work.end()
        return {"FINISHED"}


class Find(OfArmature, InBackground, bpy.types.Operator):
    """Mark movements like that of the preview range, or like the segment at the current frame"""

    bl_idname, bl_label, bl_options = "kineme.find", "Find Similar", UNDONE

    def steps(self, context: bpy.types.Context) -> Steps:
        scene, armature = context.scene, armature_of(context)
        python(context)
        owner, record = results.owner_of(armature), results.record_of(armature)
        if record is not None:
            whole = record["first"], record["first"] + record["table"]["n_frames"] - 1
        else:
            whole = span_of(scene, armature, "ACTION")
        first, last = self.example(scene, record)
        if not whole[0] <= first < last <= whole[1]:
            raise FailureError(f"the example, frames {first} to {last}, is not within the motion, "
                               f"frames {whole[0]} to {whole[1]}")  # fmt: skip
        fps = scene.render.fps / scene.render.fps_base
        with tempfile.TemporaryDirectory(prefix="kineme-") as folder:
            path = yield from recorded(context, armature, whole, folder)
            answer = yield from answered(context, {
                "task": "search", "recording": path,
                "start_s": (first - whole[0]) / fps, "stop_s": (last + 1 - whole[0]) / fps,
            })  # fmt: skip
        hits = [
            Marker(whole[0] + round(start * fps), f"similar {number}: {distance:.2f}")
            for number, (start, _, distance) in enumerate(answer["hits"], start=1)
        ]
        results.keep_hits(scene, owner, hits)
        return f"{len(hits)} movements like frames {first} to {last}"

    def example(self, scene: bpy.types.Scene, record: dict[str, Any] | None) -> tuple[int, int]:
        """The frames that are searched for."""
        if scene.use_preview_range:
            return scene.frame_preview_start, scene.frame_preview_end
        row = record and row_at(record, scene.kineme.level, scene.frame_current)
        if not row:
            raise FailureError("what is searched for? Drag a preview range with P in the timeline")
        return frames_of(record, row)


class Show(OfTable, bpy.types.Operator):
    """Show the segments of the level chosen, in place of those shown before"""

    bl_idname, bl_label, bl_options = "kineme.show", "Show Segments", UNDONE
    form: EnumProperty(
        items=[
            ("MARKERS", "Markers", "A marker of the timeline where each segment starts"),
            ("STRIPS", "NLA Strips", "A strip of the action for each, one track a cluster"),
            ("ACTIONS", "Actions", "An action for each, an asset in the catalogue of its cluster"),
        ]
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        armature, level = armature_of(context), context.scene.kineme.level
        record = results.record_of(armature)
        try:
            if self.form == "MARKERS":
                results.keep_table(context.scene, results.owner_of(armature), record, level)
                done = f"{len(record['markers'])} markers"
            elif self.form == "STRIPS":
                done = f"{results.make_strips(armature, record, level)} strips"
            else:
                done = f"{len(results.make_actions(armature, record, level))} actions"
        except (FailureError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, done)
        return {"FINISHED"}


class Jump(OfTable, bpy.types.Operator):
    """Go to where the next segment starts, or the one before"""

    bl_idname, bl_label, bl_options = "kineme.jump", "Go to Segment", {"REGISTER"}
    step: IntProperty(name="Step", default=1, min=-1, max=1)

    def execute(self, context: bpy.types.Context) -> set[str]:
        scene, record = context.scene, results.record_of(armature_of(context))
        frame = neighbour(record, scene.kineme.level, scene.frame_current, self.step)
        if frame is None:
            return {"CANCELLED"}
        scene.frame_set(frame)
        return {"FINISHED"}


class Preview(OfTable, bpy.types.Operator):
    """Make the segment at the current frame the preview range, to play it again and again"""

    bl_idname, bl_label, bl_options = "kineme.preview", "Preview Segment", UNDONE

    def execute(self, context: bpy.types.Context) -> set[str]:
        scene, record = context.scene, results.record_of(armature_of(context))
        row = row_at(record, scene.kineme.level, scene.frame_current)
        if row is None:
            self.report({"WARNING"}, f"no segment is at frame {scene.frame_current}")
            return {"CANCELLED"}
        scene.use_preview_range = True
        scene.frame_preview_start, scene.frame_preview_end = frames_of(record, row)
        return {"FINISHED"}


class TakeNames(OfTable, InBackground, bpy.types.Operator):
    """Name clusters and segments as their markers were renamed"""

    bl_idname, bl_label, bl_options = "kineme.names", "Take Names of Markers", UNDONE

    def steps(self, context: bpy.types.Context) -> Steps:
        scene, armature = context.scene, armature_of(context)
        owner, record = results.owner_of(armature), results.record_of(armature)
        level, markers = record["level"], results.scene_markers(scene)
        clusters, segments = names_given(record, level, markers)
        if not clusters and not segments:
            raise FailureError("no marker of a segment has another name than before")
        task = {"task": "name", "table": record["table"], "level": level,
                "clusters": clusters, "segments": segments}  # fmt: skip
        answer = yield from answered(context, task)
        record["table"] = answer["table"]
        results.keep_table(scene, owner, record, level)
        return f"{len(clusters)} clusters and {len(segments)} segments named"


class Save(OfTable, InBackground, bpy.types.Operator):
    """Write the table as kineme does: JSON, CSV and others, by the suffix of the file"""

    bl_idname, bl_label = "kineme.save", "Save Table"
    filepath: StringProperty(subtype="FILE_PATH")

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        if not self.filepath:
            name = bpy.path.clean_name(shortened(results.owner_of(armature_of(context)).name))
            self.filepath = f"{name}.segments.json"
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def steps(self, context: bpy.types.Context) -> Steps:
        path = bpy.path.abspath(self.filepath)
        table = results.record_of(armature_of(context))["table"]
        yield from answered(context, {"task": "save", "table": table, "path": path})
        return f"{path} is written"


OPERATORS = (Segment, Cancel, Find, Show, Jump, Preview, TakeNames, Save)
