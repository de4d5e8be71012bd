"""A robot edits on a slow line, reloads, kills the server and changes tabs: nothing is lost.

`python -m benchmarks studio_robot` lets it do so 500 times on three recordings, with five seeds.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from bundled import copy_of_bundled
from robot import Robot
from screen import DESKTOP
from studio_server import StudioServer

STEPS = 25


@pytest.mark.slow
def test_a_robot_loses_nothing(chromium, tmp_path: Path) -> None:
    takes = [copy_of_bundled(tmp_path) for _ in range(2)]
    context = chromium.new_context(viewport=DESKTOP)
    context.set_default_timeout(30_000)
    with StudioServer(tmp_path) as server:
        robot = Robot(context, server, takes, seed=1, latency=200)
        for what in ("nudge", "outage", "burst", *[""] * STEPS):
            robot.step(what)
        robot.finish()
    context.close()
    assert robot.edits > 3
