"""How the studio bears much: a folder of 500 recordings, a table of 10,000 segments, and hours.

    python -m benchmarks studio_many [--record]

In Chromium, which draws with the processor. Listing is counted from the request for
the page to the last row, with tables beside a fifth of the recordings; scrolling in pictures
the page gets to draw while the table is scrolled from end to end; memory over recordings opened
one after the other, once the first ten have been. Processor time is that of the server, which
other work on the machine spares.
"""

from __future__ import annotations

import json
import os
import tempfile
from pathlib import Path
from time import perf_counter, sleep
from typing import Any

import numpy as np

import kineme
from _browser import FLAGS, chromium
from _figures import add_option, record
from _measure import verdict
from _options import command_line, few
from kineme.datasets import bundled_recording
from kineme.studio.storage.listed import file_id
from report_in_browser import SIZE, wait
from studio import WARM, Studio, processor_time, start

MEASURING = ("--enable-precise-memory-info", "--js-flags=--expose-gc")
RECORDINGS, TABLED = few(500, 15), 5  # one in so many has a table
ROWS = 10_000
OPENED, ASKED, FIRST = few((40, 120, 10), (6, 6, 2))
LISTED_S, LEAST_RATE, MOST_MB = 1.0, 50, 0.1
SCROLL = """(async () => {
    const rows = document.querySelector(".table-rows");
    const most = rows.scrollHeight - rows.clientHeight;
    const begun = performance.now(), times = [];
    while (performance.now() - begun < 4000) {
        times.push(await new Promise(requestAnimationFrame));
        rows.scrollTop = most * ((performance.now() - begun) / 4000);
    }
    return times;
})()"""


def main() -> None:
    parser = command_line(__doc__)
    add_option(parser)
    parser.parse_args()
    print(f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")
    with tempfile.TemporaryDirectory() as name, chromium(*FLAGS, *MEASURING) as browser:
        tab = browser.new_page(viewport=SIZE)
        folder = many(Path(name))
        studio = start(folder)
        listing(tab, studio)
        memory_of_page(tab, studio, folder)
        memory_of_server(studio, folder)
        studio.end()
        folder = long_table(Path(name))
        studio = start(folder)
        scrolling(tab, studio, folder)
        studio.end()


def many(place: Path) -> Path:
    """A folder of short recordings, some with a table."""
    folder = place / "many"
    folder.mkdir()
    head, motion = bundled_recording().read_text().split("MOTION\n")
    _, frame_time, *frames = motion.strip().split("\n")
    for i in range(RECORDINGS):
        kept = frames[i : i + 300]
        path = folder / f"session_{i // 20:02d}_take_{i:03d}.bvh"
        path.write_text("\n".join([head + "MOTION", f"Frames: {len(kept)}", frame_time, *kept, ""]))
        if i % TABLED == 0:
            table = rows_of(30, 300, 60.0)
            kineme.write_segments(table, path.with_suffix(".segments.json"))
    return folder


def rows_of(n: int, n_frames: int, fps: float) -> kineme.Segmentation:
    """A table of so many activities."""
    edges = np.linspace(0, n_frames, n + 1).astype(int)
    columns = {
        "level": ["activity"] * n,
        "kind": ["activity"] * n,
        "start_frame": edges[:-1],
        "stop_frame": edges[1:],
        "cluster": np.arange(n) % 12,
    }
    return kineme.Segmentation.from_columns(columns, n_frames=n_frames, fps=fps)


def long_table(place: Path) -> Path:
    """A folder with a recording of signals, and a table of ten thousand rows."""
    folder = place / "long"
    folder.mkdir()
    times = np.arange(ROWS * 6) / 60
    lines = np.column_stack([times, np.sin(times), np.cos(3 * times)])
    path = folder / "long.csv"
    np.savetxt(path, lines, delimiter=",", header="time,a,b", comments="", fmt="%.4f")
    fps = kineme.read(path).fps
    kineme.write_segments(rows_of(ROWS, len(times), fps), path.with_suffix(".segments.json"))
    return folder


def listing(tab: Any, studio: Studio) -> None:
    """Twice: as a studio just started does, and again."""
    for when in ("first", "again"):
        processor, begun = processor_time(studio.process.pid), perf_counter()
        tab.goto(f"{studio.base}/?token={studio.token}")
        wait(tab, f"document.querySelectorAll('.recordings li').length >= {RECORDINGS}")
        took = perf_counter() - begun
        spent = processor_time(studio.process.pid) - processor
        print(f"{RECORDINGS} recordings listed, {when}: {verdict(took, LISTED_S)}")
        print(f"  {took:.2f} s, of which the server computed {spent:.2f} s")
        record(f"studio_many.listed.{when}", round(took, 2), unit="s")
        record(f"studio_many.listed.{when}.processor", round(spent, 2), unit="s")


def memory_of_page(tab: Any, studio: Studio, folder: Path) -> None:
    """What a page keeps of each recording that was opened and left."""
    names = sorted(path.name for path in folder.glob("*.bvh"))
    tab.goto(f"{studio.base}/?token={studio.token}&open={file_id(folder / names[0])}")
    wait(tab, "window.kineme?.hasMotion")
    kept = []
    for i, name in enumerate(names[1:OPENED], start=1):
        tab.keyboard.press("PageDown")
        wait(tab, f"window.kineme.name === '{name}' && window.kineme.hasMotion")
        if i in (FIRST, OPENED - 1):
            tab.wait_for_timeout(500)
            tab.evaluate("gc()")
            tab.evaluate("gc()")
            kept.append(tab.evaluate("performance.memory.usedJSHeapSize") / 1e6)
    show_memory("page", kept, OPENED - 1 - FIRST)


def memory_of_server(studio: Studio, folder: Path) -> None:
    """The same of the server, asked for all that a page shows at first, once its code is loaded."""
    sleep(WARM)
    kept = []
    paths = sorted(folder.glob("*.bvh"))[-ASKED:]
    for i, path in enumerate(paths):
        one = f"/api/recordings/{file_id(path)}"
        poses = json.loads(studio.ask(one))["motion"]["n_samples"]
        for part in (f"/motion?poses={poses}", "/matrix/0/0/0", "/curves"):
            studio.ask(one + part)
        if i in (FIRST, ASKED - 1):
            kept.append(resident(studio.process.pid))
    show_memory("server", kept, ASKED - 1 - FIRST)


def show_memory(what: str, kept: list[float], n: int) -> None:
    """What each of so many recordings added."""
    each = (kept[1] - kept[0]) / n
    print(f"{what}, of each recording opened: {each:.3f} MB; {verdict(each, MOST_MB)}")
    record(f"studio_many.memory.{what}", round(each, 3), unit="MB")


def resident(pid: int) -> float:
    """Megabytes of memory that a process has."""
    return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE") / 1e6


def scrolling(tab: Any, studio: Studio, folder: Path) -> None:
    """Pictures a second while the table is scrolled from end to end."""
    tab.goto(f"{studio.base}/?token={studio.token}&open={file_id(folder / 'long.csv')}")
    wait(tab, f"window.kineme?.n_segments === {ROWS}")
    begun = perf_counter()
    tab.locator("#tab-table").click()
    wait(tab, "document.querySelectorAll('.table-rows [role=row]').length > 5")
    print(f"{ROWS} segments as a table: {perf_counter() - begun:.2f} s until it is there")
    steps = np.diff(tab.evaluate(SCROLL))
    rate, slow = 1000 / steps.mean(), float(np.percentile(steps, 95))
    rows = tab.locator(".table-rows [role=row]").count()
    print(f"  {rate:.0f} pictures a second ({LEAST_RATE} promised), 95 % within {slow:.0f} ms")
    print(f"  {rows} rows drawn at a time")
    record("studio_many.scrolled", round(float(rate)), unit="pictures/s")


if __name__ == "__main__":
    main()
