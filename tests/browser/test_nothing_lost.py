"""A robot edits on a slow line, reloads, kills the server and changes tabs: nothing is lost."""

from __future__ import annotations

from pathlib import Path

import pytest

from bundled import copy_of_bundled
from robot import EDITS, STEPS, Robot
from studio_server import StudioServer

SMALL = {"width": 640, "height": 480}  # what is drawn in software takes most of the time
EACH = (
    *("nudge", "outage", "burst", *EDITS, "undo", "redo", "other tab", "kill", "reload"),
    *("next", "nudge", "undo"),
)
"""Everything that the robot can do, once; what exactly, is left to chance."""


@pytest.mark.slow
def test_a_robot_loses_nothing(chromium, tmp_path: Path) -> None:
    takes = [copy_of_bundled(tmp_path) for _ in range(2)]
    context = chromium.new_context(viewport=SMALL, device_scale_factor=0.5, reduced_motion="reduce")
    context.set_default_timeout(30_000)
    with StudioServer(tmp_path) as server:
        robot = Robot(context, server, takes, seed=1, latency=200)
        for what in EACH:
            robot.step(what)
        robot.finish()
    context.close()
    assert set(robot.steps) == set(STEPS)
    assert robot.edits > 10
