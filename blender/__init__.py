"""kineme in Blender: the motion of an armature cut into activities, repetitions and clips.

`table` says what is shown, in plain Python; `sampling` reads an armature, `process` has kineme
work on it, `results` shows what it found, with `curves` for the actions of each version of
Blender. `operators` and `panels` are what the user meets; `worker` alone runs outside Blender.
"""

import bpy
from bpy.app.handlers import persistent

from . import operators, panels, results
from .background import Work

CLASSES = (*panels.PANELS, *operators.OPERATORS)


@persistent
def write_catalogues(*_: object) -> None:
    """Name the catalogues of clips, once there is a place beside a file."""
    results.write_catalogues()


@persistent
def end_work(*_: object) -> None:
    """End what is going on before undo or another file takes away what it works on."""
    Work.end()


HANDLERS = (
    (bpy.app.handlers.save_post, write_catalogues),
    *((each, end_work) for each in (bpy.app.handlers.undo_pre, bpy.app.handlers.redo_pre)),
    (bpy.app.handlers.load_pre, end_work),
)


def register() -> None:
    """What Blender calls when the extension is enabled."""
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Scene.kineme = bpy.props.PointerProperty(type=panels.Settings)
    for handlers, handler in HANDLERS:
        handlers.append(handler)


def unregister() -> None:
    """What Blender calls when it is disabled."""
    Work.end()
    for handlers, handler in HANDLERS:
        handlers.remove(handler)
    del bpy.types.Scene.kineme
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
