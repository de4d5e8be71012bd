"""Measure edits of an hour-long recording in the studio: time of server and page, bytes sent.

    python -m benchmarks studio_edits [--segments 5000 20000] [--record]

The bundled recording, repeated to an hour, gets a table with so many primitives. Edits of each
kind are sent over HTTP. Then keys are pressed in Chromium, which measures the time until an edit
is saved, the computing time of the page, and the bytes that it receives.
"""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

import numpy as np

import kineme
from _figures import add_option, record
from _measure import judge, take_medians
from _options import choose_size, make_parser, need_packages, skip
from bundled import write_repeated
from kineme.segments import editing
from studio import find_recordings, time_request, wait_for_segments
from studio_server import StudioServer

MINUTES, SEGMENTS, ROUNDS = choose_size((60, (5000, 20000), 7), (1, (100,), 1))
MOST_S, MOST_BYTES = 0.1, 20_000
SOFTWARE_RENDERING = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
"""Options of Chromium, as on a computer without a graphics card."""
SIZE = {"width": 1280, "height": 720}
DRAWN = "window.kineme?.hasMotion && window.kineme.drawn > 0"
EACH = 20
"""Primitives per activity."""
KEYS = {"a border": "Alt+ArrowRight", "a split": "s", "a check": "k", "an undo": "Control+z"}


def main() -> None:
    parser = make_parser(__doc__)
    parser.add_argument("--segments", type=int, nargs="+", default=SEGMENTS)
    add_option(parser)
    lengths = parser.parse_args().segments
    print(f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")
    n_frames = MINUTES * 60 * 60
    with tempfile.TemporaryDirectory() as name, open_chromium() as browser:
        path = write_repeated(Path(name) / "hour.bvh", n_frames)
        for n in lengths:
            print(f"{MINUTES} minutes, {n} primitives")
            kineme.write_segments(make_table(n, n_frames), path.with_suffix(".segments.json"))
            with StudioServer(Path(name)) as studio:
                time_requests(studio, n, n_frames)
                time_keys(browser.new_page(viewport=SIZE), studio, n)


@contextmanager
def open_chromium() -> Iterator[Any]:
    """Open a browser; skip the benchmark if none is installed."""
    need_packages("playwright")
    from playwright.sync_api import sync_playwright

    program = os.environ.get("KINEME_CHROMIUM") or shutil.which("chromium")
    if program is None:
        skip("needs Chromium: install it, or set KINEME_CHROMIUM to its program")
    sandbox = [] if os.geteuid() else ["--no-sandbox"]
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=program, args=[*SOFTWARE_RENDERING, *sandbox]
        )
        yield browser
        browser.close()


def wait(tab: Any, condition: str) -> None:
    """Wait until the condition holds; poll, because the page's policy forbids evaluated code."""
    while not tab.evaluate(condition):
        tab.wait_for_timeout(10)


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


def time_requests(studio: StudioServer, n: int, n_frames: int) -> None:
    """Send edits of each kind over HTTP and print their times."""
    one = find_recordings(studio)["hour.bvh"]
    revision = wait_for_segments(studio, one)
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


def time_keys(tab: Any, studio: StudioServer, n: int) -> None:
    """Press keys in the page and print the times of edits."""
    line = tab.context.new_cdp_session(tab)
    line.send("Network.enable")
    line.send("Performance.enable")
    received: list[int] = []
    line.on("Network.dataReceived", lambda event: received.append(event["dataLength"]))
    tab.goto(studio.address)
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
