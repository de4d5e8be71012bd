"""Work that takes a while: in the background of a window, or at once where there is none.

An operator says its work as a generator of (share, stage) pairs; the share is None while kineme is
at work, whose end nobody can tell. A timer takes it on by some milliseconds at a time, and the
panels show how far it is. Without a window, as in scripts, it is done when the call returns.
"""

import time
from collections.abc import Generator

import bpy

from .process import FailureError

TICK_S, BUSY_S = 0.05, 0.03
"""Seconds between ticks, and of each tick for the work."""

Steps = Generator[tuple[float | None, str], None, str]
"""What comes back at the end is said to the user."""


class Work:
    """The one work that is going on: how far it is, and whether it is to end."""

    steps: Steps | None = None
    share: float | None = None
    stage = ""

    @classmethod
    def end(cls) -> None:
        """Let go of it; kineme's process ends with it."""
        if cls.steps is not None:
            cls.steps.close()
        cls.steps, cls.share, cls.stage = None, None, ""


class InBackground:
    """An operator whose ``steps`` are done bit by bit."""

    timer: bpy.types.Timer | None = None

    def steps(self, context: bpy.types.Context) -> Steps:
        """The work."""
        raise NotImplementedError

    def execute(self, context: bpy.types.Context) -> set[str]:
        steps = self.steps(context)
        try:
            while True:
                share, _ = next(steps)
                time.sleep(TICK_S if share is None else 0)
        except StopIteration as done:
            self.report({"INFO"}, done.value)
            return {"FINISHED"}
        except (FailureError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        if bpy.app.background or context.window is None:
            return self.execute(context)
        if Work.steps is not None:
            self.report({"WARNING"}, "kineme is at work already")
            return {"CANCELLED"}
        Work.steps = self.steps(context)
        manager = context.window_manager
        self.timer = manager.event_timer_add(TICK_S, window=context.window)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if Work.steps is None:  # cancelled, or undone
            return self._leave(context, {"CANCELLED"})
        until = time.monotonic() + BUSY_S
        try:
            while time.monotonic() < until:
                Work.share, Work.stage = next(Work.steps)
                if Work.share is None:
                    break
        except StopIteration as done:
            self.report({"INFO"}, done.value)
            return self._leave(context, {"FINISHED"})
        except (FailureError, OSError, ReferenceError) as error:
            self.report({"ERROR"}, str(error))
            return self._leave(context, {"CANCELLED"})
        redraw(context)
        return {"PASS_THROUGH"}

    def cancel(self, context: bpy.types.Context) -> None:
        """What Blender calls where it ends the work, as when another file is opened."""
        self._leave(context, {"CANCELLED"})

    def _leave(self, context: bpy.types.Context, how: set[str]) -> set[str]:
        Work.end()
        if self.timer is not None:
            context.window_manager.event_timer_remove(self.timer)
            self.timer = None
        redraw(context)
        return how


def redraw(context: bpy.types.Context) -> None:
    """Have the panels drawn anew."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in ("VIEW_3D", "DOPESHEET_EDITOR"):
                area.tag_redraw()
