"""What is seen: a panel in the sidebars of 3D view and dope sheet, its settings, preferences."""

from collections import Counter

import bpy
from bpy.props import EnumProperty, FloatProperty, StringProperty

from .background import Work
from .operators import armature_of
from .process import FailureError, python_of
from .results import record_of
from .table import name_of, row_at, rows_of

MOST_LINES = 12
"""Of clusters that the panel lists."""


class Settings(bpy.types.PropertyGroup):
    """What is segmented and shown; kept with the scene."""

    scope: EnumProperty(
        name="Frames",
        items=[
            ("ACTION", "Action", "All frames of the action"),
            ("SCENE", "Scene", "The frame range of the scene"),
            ("PREVIEW", "Preview Range", "The preview range of the timeline"),
        ],
    )
    bones: EnumProperty(
        name="Bones",
        items=[
            ("DEFORM", "Deforming", "Bones that deform the mesh; all where none does"),
            ("SELECTED", "Selected", "The bones that are selected in pose mode"),
        ],
    )
    level: EnumProperty(
        name="Show",
        items=[
            ("activity", "Activities", "Activities, and transitions between them"),
            ("primitive", "Repetitions", "Each repetition, such as each double step"),
        ],
    )
    detail: FloatProperty(
        name="Detail",
        description="Above 1 for more, shorter segments; below for fewer, longer ones",
        default=1.0,
        min=0.05,
        max=20.0,
        soft_min=0.25,
        soft_max=4.0,
    )
    effectors: StringProperty(
        name="Joints",
        description="Where names of bones do not tell: left ankle, right ankle, head, left wrist, "
        "right wrist, between commas; or some, as in left_wrist=NAME,head=NAME",
    )


class Preferences(bpy.types.AddonPreferences):
    """Where kineme is."""

    bl_idname = __package__
    python: StringProperty(
        name="Python",
        description="A Python that has kineme, or the command kineme itself; empty to look for it",
        subtype="FILE_PATH",
    )

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.prop(self, "python")
        try:
            command = python_of(bpy.path.abspath(self.python) if self.python else "")
            self.layout.label(text=f"kineme runs in {command[0]}", icon="CHECKMARK")
        except FailureError as error:
            self.layout.label(text=str(error), icon="ERROR")


class _Panel:
    bl_label, bl_category, bl_region_type = "kineme", "kineme", "UI"

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = self.layout, context.scene.kineme
        layout.use_property_split, layout.use_property_decorate = True, False
        armature = armature_of(context)
        if armature is None:
            layout.label(text="Select an armature", icon="ARMATURE_DATA")
            return
        if Work.steps is not None:
            layout.progress(factor=Work.share or 0.0, text=Work.stage)
            layout.operator("kineme.cancel", icon="X")
            return
        column = layout.column()
        for name in ("scope", "bones", "detail", "effectors"):
            column.prop(settings, name)
        layout.operator("kineme.segment", icon="ACTION")
        layout.operator("kineme.find", icon="VIEWZOOM")
        record = record_of(armature)
        if record is not None:
            self.draw_table(context, record)

    def draw_table(self, context: bpy.types.Context, record: dict) -> None:
        """What was found, and what can be made of it."""
        layout, level = self.layout.box(), context.scene.kineme.level
        layout.use_property_split = False
        layout.row().prop(context.scene.kineme, "level", expand=True)
        row = layout.row(align=True)
        row.operator("kineme.jump", text="", icon="PREV_KEYFRAME").step = -1
        here = row_at(record, level, context.scene.frame_current)
        row.operator("kineme.preview", text=name_of(here) if here else "–", icon="PREVIEW_RANGE")
        row.operator("kineme.jump", text="", icon="NEXT_KEYFRAME").step = 1
        counts = Counter(
            name_of(each) for each in rows_of(record, level) if each["kind"] != "transition"
        )
        column = layout.column(align=True)
        for name, count in counts.most_common(MOST_LINES):
            column.label(text=f"{count} × {name}")
        if len(counts) > MOST_LINES:
            column.label(text=f"and {len(counts) - MOST_LINES} more")
        row = layout.row(align=True)
        for form, text in (("MARKERS", "Markers"), ("STRIPS", "Strips"), ("ACTIONS", "Actions")):
            row.operator("kineme.show", text=text).form = form
        layout.operator("kineme.names", icon="SORTALPHA")
        layout.operator("kineme.save", icon="EXPORT")


class ViewPanel(_Panel, bpy.types.Panel):
    """In the sidebar of the 3D view."""

    bl_idname, bl_space_type = "KINEME_PT_view", "VIEW_3D"


class DopeSheetPanel(_Panel, bpy.types.Panel):
    """In the sidebar of the dope sheet, and of the timeline."""

    bl_idname, bl_space_type = "KINEME_PT_dope_sheet", "DOPESHEET_EDITOR"


PANELS = (Settings, Preferences, ViewPanel, DopeSheetPanel)
