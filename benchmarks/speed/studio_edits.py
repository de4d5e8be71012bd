"""Measure edits of an hour-long recording in the studio: time of server and page, bytes sent.

    python -m benchmarks studio_edits [--segments 5000 20000] [--record]

The bundled recording, repeated to an hour, gets a table with so many primitives. Edits of each
kind are sent over HTTP. Then keys are pressed in Chromium, which measures the time until an edit
is saved, the computing time of the page, and the bytes that it receives.
"""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

import numpy as np

import kineme
from _browser import DRAWN, FLAGS, SIZE, open_chromium, wait
from _figures import add_option, record
from _measure import judge, take_medians
from _options import choose_size, make_parser
from kineme.datasets import bundled_recording
from kineme.segments import editing
from studio import Studio, start_studio, time_request

MINUTES, SEGMENTS, ROUNDS = choose_size((60, (5000, 20000), 7), (1, (100,), 1))
MOST_S, MOST_BYTES = 0.1, 20_000
EACH = 20
"""Primitives per activity."""
KEYS = {"a border": "Alt+ArrowRight", "a split": "s", "a check": "k", "an undo": "Control+z"}


def repeat_bvh(bvh: str, n_frames: int) -> str:
    """Repeat the frames of a BVH to so many frames."""
    head, motion = bvh.split("MOTION\n")
    _, frame_time, *frames = motion.strip().split("\n")
    lines = [frames[i % len(frames)] for i in range(n_frames)]
    return "\n".join([head + "MOTION", f"Frames: {n_frames}", frame_time, *lines, ""])


def main() -> None:
    parser = make_parser(__doc__)
    parser.add_argument("--segments", type=int, nargs="+", default=SEGMENTS)
    add_option(parser)
    lengths = parser.parse_args().segments
    print(f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")
    n_frames = MINUTES * 60 * 60
    with tempfile.TemporaryDirectory() as name, open_chromium(*FLAGS) as browser:
        path = Path(name) / "hour.bvh"
        path.write_text(repeat_bvh(bundled_recording().read_text(), n_frames))
        for n in lengths:
            print(f"{MINUTES} minutes, {n} primitives")
            kineme.write_segments(make_table(n, n_frames), path.with_suffix(".segments.json"))
            studio = start_studio(Path(name))
            time_requests(studio, n, n_frames)
            time_keys(browser.new_page(viewport=SIZE), studio, n)
            studio.end()


def make_table(n: int, n_frames: int) -> kineme.Segmentation:
    """Make a table of equally long primitives in eight clusters, half of them checked."""
    random = np.random.default_rng(0)
    edges = np.linspace(0, n_frames, n + 1).astype(int)
    wide = np.append(edges[:-1:EACH], n_frames)
    levels = ["activity"] * (len(wide) - 1) + ["primitive"] * n
    columns = {
        "level": levels,
        "kind": levels,
        "start_frame": [*wide[:-1], *edges[:-1]],
        "stop_frame": [*wide[1:], *edges[1:]],
        "cluster": [*np.arange(len(wide) - 1) % 8, *np.arange(n) // EACH % 8],
        "confidence": random.uniform(0.3, 1, len(levels)),
        "border_confidence": random.uniform(0.3, 1, len(levels)),
    }
    table = kineme.Segmentation.from_columns(columns, n_frames=n_frames, fps=60.0)
    return editing.check(table, "primitive", edges[1:-1:2].tolist(), checked=True)


def time_requests(studio: Studio, n: int, n_frames: int) -> None:
    """Send edits of each kind over HTTP and print their times."""
    one = f"/api/recordings/{json.loads(studio.ask('/api/state'))['recordings'][0]['id']}"
    while (message := json.loads(studio.ask(one))).get("finding"):
        pass
    revision = message["revision"]
    for kind, edits in make_edits(n, n_frames).items():
        rows, sizes = [], []
        for edit in edits:
            sent = {"revision": revision, "edit": edit}
            took, answer = time_request(studio, f"{one}/edits", sent)
            revision = json.loads(answer)["revision"]
            rows.append(took)
            sizes.append(len(answer))
        took, size = take_medians(rows[1:] or rows), median(sizes)
        print(f"  {kind}: {took}, {size:.0f} bytes; {judge(size, MOST_BYTES)}")
        record(f"studio_edits.{n}.{kind}.processor", round(took.processor, 3), unit="s")
        record(f"studio_edits.{n}.{kind}.bytes", size)


def make_edits(n: int, n_frames: int) -> dict[str, Iterator[dict[str, Any]]]:
    """Return edits by kind, each of another segment; kinds must be sent in this order."""
    edges = np.linspace(0, n_frames, n + 1).astype(int).tolist()
    level = {"level": "primitive"}
    places = [5 + 3 * i for i in range(ROUNDS + 1)]
    return {
        "border": ({"kind": "move_border", **level, "frame": edges[i], "to": edges[i] + 1}
                   for i in places),
        "undo": ({"kind": "undo"} for _ in places),
        "name": ({"kind": "name_segment", **level, "frame": edges[i], "label": f"hop {i}"}
                 for i in places),
        "check": ({"kind": "check", **level, "frames": [edges[i]], "checked": i % 2 == 0}
                  for i in places),
        "cluster": ({"kind": "name_cluster", "cluster": i % 4, "label": f"walk {i}"}
                    for i in places),
    }  # fmt: skip


def time_keys(tab: Any, studio: Studio, n: int) -> None:
    """Press keys in the page and print the times of edits."""
    line = tab.context.new_cdp_session(tab)
    line.send("Network.enable")
    line.send("Performance.enable")
    received: list[int] = []
    line.on("Network.dataReceived", lambda event: received.append(event["dataLength"]))
    tab.goto(f"{studio.base}/?token={studio.token}")
    wait(tab, DRAWN)
    tab.keyboard.press("End")
    tab.wait_for_timeout(choose_size(3000, 500))
    for what, key in KEYS.items():
        rows = []
        for _ in range(ROUNDS + 1):
            if what != "an undo":
                tab.keyboard.press("ArrowLeft")
            tab.wait_for_timeout(300)
            received.clear()
            begun, busy = perf_counter(), read_busy_seconds(line)
            tab.keyboard.press(key)
            wait(tab, "window.kineme.unsent.length === 0")
            saved = perf_counter() - begun
            tab.wait_for_timeout(500)
            rows.append((saved, read_busy_seconds(line) - busy, float(sum(received))))
        saved, busy, size = (median(column) for column in zip(*rows[1:], strict=True))
        print(
            f"  {what} in the page: {saved:.3f} s until it is saved, {judge(saved, MOST_S)}; "
            f"the page computes {busy:.3f} s, is sent {size:.0f} bytes"
        )
        record(f"studio_edits.{n}.{what.split()[1]}.page", round(busy, 3), unit="s")
        record(f"studio_edits.{n}.{what.split()[1]}.saved", round(saved, 3), unit="s")


def read_busy_seconds(line: Any) -> float:
    """Return the seconds that the page has computed so far."""
    metrics = line.send("Performance.getMetrics")["metrics"]
    return next(each["value"] for each in metrics if each["name"] == "TaskDuration")


if __name__ == "__main__":
    main()
