"""How soon the studio shows a recording, how fluently it plays, and how long an edit takes.

    python benchmarks/studio_in_browser.py

The bundled recording, repeated to two minutes and to an hour, is opened by a
server that has not seen it, in Chromium, which draws with the processor. The
first picture is the one with the figure in it, counted from the request for the
page, segmentation included. Drawing is counted over some seconds of playing, the
edit from the key to the table on the disk. What else the machine does falls on
all of them.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from pathlib import Path
from time import perf_counter
from typing import Any

from playwright.sync_api import sync_playwright

from _measure import verdict
from kineme.datasets import bundled_recording
from kineme.studio.folder import file_id
from report_in_browser import (
    FIRST_PICTURE,
    FLAGS,
    SIZE,
    drawing_rate,
    first_picture,
    show_rate,
    wait,
)
from studio import WARM, start

MINUTES = (2, 60)


def main() -> None:
    print(f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")
    with tempfile.TemporaryDirectory() as name, sync_playwright() as playwright:
        folder = Path(name)
        sandbox = [] if os.geteuid() else ["--no-sandbox"]
        program = os.environ.get("KINEME_CHROMIUM") or shutil.which("chromium")
        browser = playwright.chromium.launch(executable_path=program, args=[*FLAGS, *sandbox])
        for minutes in MINUTES:
            path = folder / f"{minutes}_minutes.bvh"
            path.write_text(repeated(bundled_recording().read_text(), minutes * 60 * 60))
        studio = start(folder)
        tab = browser.new_page(viewport=SIZE)
        tab.wait_for_timeout(1000 * WARM)
        for minutes in MINUTES:
            recording = file_id(folder / f"{minutes}_minutes.bvh")
            show(tab, minutes, f"{studio.base}/?token={studio.token}&open={recording}")
        browser.close()
        studio.end()


def show(tab: Any, minutes: int, address: str) -> None:
    tab.goto("about:blank")
    first, rate = first_picture(tab, address), drawing_rate(tab)
    tab.keyboard.press("Space")
    begun = perf_counter()
    tab.keyboard.press("s")
    wait(tab, "window.kineme.saved !== '' && window.kineme.unsent.length === 0")
    edit = perf_counter() - begun
    n = tab.evaluate("window.kineme.segments.length")
    print(f"{minutes} minutes, {n} segments")
    promise = f"; {verdict(first, FIRST_PICTURE)}" if minutes <= 2 else ""
    print(f"  first picture {first:.2f} s{promise}")
    show_rate(rate)
    print(f"  an edit, shown and on the disk: {edit:.2f} s")


def repeated(bvh: str, n_frames: int) -> str:
    """A recording with so many frames, from the start again where it ends."""
    head, motion = bvh.split("MOTION\n")
    _, frame_time, *frames = motion.strip().split("\n")
    lines = [frames[i % len(frames)] for i in range(n_frames)]
    return "\n".join([head + "MOTION", f"Frames: {n_frames}", frame_time, *lines, ""])


if __name__ == "__main__":
    main()
