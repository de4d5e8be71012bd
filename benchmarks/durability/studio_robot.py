"""Whether the studio loses anything: a robot in Chromium, until it has made 500 edits.

    python -m benchmarks studio_robot [--edits 500] [--seeds 0 1 2 3 4] [--figure] [--quick]

It edits at random, segments anew, undoes, reloads, kills the server and changes between two
tabs and three recordings, on a line that is slow by 0 to 800 ms, now more, now less. It makes
several edits without waiting for an answer, and goes on editing while the server is gone.
After each step the table on the disk is the one that the page shows; at the end every table
that was replaced is a version, and undo and redo give the same tables. What is not so ends
it. The figure is the one thing that takes a graphics card, and no table depends on it:
without ``--figure`` the browser has none, which halves the time. ``--quick`` is one seed and
a step of each kind in which something could be lost.
"""

from __future__ import annotations

import collections
import shutil
import sys
import tempfile
from pathlib import Path
from time import perf_counter

from _browser import FLAGS, chromium
from _options import command_line, few
from kineme.datasets import bundled_recording

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "helpers"))
import screen
from robot import Robot
from studio_server import StudioServer

RECORDINGS = 3
LATENCY = 800.0  # milliseconds, at most
QUICK = ("nudge", "burst", "outage", "kill", "undo")
SIZE = {"width": 640, "height": 480}  # what is drawn in software takes most of the time
NO_FIGURE = ("--disable-gpu", "--disable-3d-apis")
PATIENCE = 300.0  # seconds; a busy machine loses nothing, either


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--edits", type=int, default=few(500, 0))
    parser.add_argument("--seeds", type=int, nargs="+", default=few([0, 1, 2, 3, 4], [0]))
    parser.add_argument("--figure", action="store_true", help="draw it, in software")
    options = parser.parse_args()
    screen.PATIENCE = PATIENCE
    with chromium(*(FLAGS if options.figure else NO_FIGURE)) as browser:
        for seed in options.seeds:
            began, steps = perf_counter(), collections.Counter[str]()
            context = browser.new_context(viewport=SIZE, reduced_motion="reduce")
            context.set_default_timeout(1000 * PATIENCE)
            with tempfile.TemporaryDirectory() as name, StudioServer(Path(name)) as server:
                takes = [
                    Path(shutil.copy(bundled_recording(), Path(name) / f"take_{i}.bvh"))
                    for i in range(RECORDINGS)
                ]
                robot = Robot(context, server, takes, seed, latency=LATENCY)
                for what in few((), QUICK):
                    steps[robot.step(what)] += 1
                for wanted in [*range(100, options.edits, 100), options.edits]:
                    while robot.edits < wanted:
                        steps[robot.step()] += 1
                    print(f"seed {seed}: {robot.edits} edits so far", flush=True)
                robot.finish()
            context.close()
            told = ", ".join(f"{count} {what}" for what, count in steps.most_common())
            print(
                f"seed {seed}: {robot.edits} edits, nothing lost, "
                f"{perf_counter() - began:.0f} s ({told})",
                flush=True,
            )


if __name__ == "__main__":
    main()
