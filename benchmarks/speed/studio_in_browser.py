"""How soon the studio shows a recording, how fluently it plays, and how long an edit takes.

    python -m benchmarks studio_in_browser [--minutes 2 60] [--record]

The bundled recording, repeated to two minutes and to an hour, is opened by a
server that has not seen it, in Chromium, which draws with the processor. The
first picture is the one with the figure in it, counted from the request for the
page, segmentation included. Drawing is counted over some seconds of playing, the
edit from the key to the table on the disk. A long recording is shown before its segments
are found, which is counted, too. What else the machine does falls on all of them but the
server's processor time.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from time import perf_counter
from typing import Any

from _browser import FLAGS, chromium
from _figures import add_option, record
from _measure import verdict
from _options import command_line, few
from kineme.datasets import bundled_recording
from kineme.studio.storage.listed import file_id
from report_in_browser import (
    FIRST_PICTURE,
    SIZE,
    drawing_rate,
    first_picture,
    show_rate,
    wait,
)
from studio import WARM, Studio, processor_time, start

MINUTES = (2, 60)
PROMISED = {2: FIRST_PICTURE, 60: 5.0}  # seconds until the first picture


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--minutes", type=int, nargs="+", default=few(MINUTES, (1,)))
    add_option(parser)
    lengths = parser.parse_args().minutes
    print(f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")
    with tempfile.TemporaryDirectory() as name, chromium(*FLAGS) as browser:
        folder = Path(name)
        for minutes in lengths:
            path = folder / f"{minutes}_minutes.bvh"
            path.write_text(repeated(bundled_recording().read_text(), minutes * 60 * 60))
        studio = start(folder)
        tab = browser.new_page(viewport=SIZE)
        tab.wait_for_timeout(1000 * WARM)
        for minutes in lengths:
            recording = file_id(folder / f"{minutes}_minutes.bvh")
            show(tab, minutes, studio, recording)
        studio.end()


def show(tab: Any, minutes: int, studio: Studio, recording: str) -> None:
    tab.goto("about:blank")
    begun, before = perf_counter(), processor_time(studio.process.pid)
    first = first_picture(tab, f"{studio.base}/?token={studio.token}&open={recording}")
    spent = processor_time(studio.process.pid) - before
    rate = drawing_rate(tab)
    wait(tab, "window.kineme.n_segments > 1")
    found, spent_on_all = perf_counter() - begun, processor_time(studio.process.pid) - before
    tab.keyboard.press("Space")
    begun = perf_counter()
    tab.keyboard.press("s")
    wait(tab, "window.kineme.saved !== '' && window.kineme.unsent.length === 0")
    edit = perf_counter() - begun
    n = tab.evaluate("window.kineme.segments.length")
    print(f"{minutes} minutes, {n} segments")
    promise = f"; {verdict(first, PROMISED[minutes])}" if minutes in PROMISED else ""
    print(f"  first picture {first:.2f} s, of which the server computed {spent:.2f} s{promise}")
    print(f"  segments within {found:.1f} s, of which it computed {spent_on_all:.1f} s")
    show_rate(rate)
    record(f"studio_in_browser.{minutes}.first", round(first, 2), unit="s")
    record(f"studio_in_browser.{minutes}.first.processor", round(spent, 2), unit="s")
    record(f"studio_in_browser.{minutes}.segments.processor", round(spent_on_all, 1), unit="s")
    print(f"  an edit, shown and on the disk: {edit:.2f} s")


def repeated(bvh: str, n_frames: int) -> str:
    """A recording with so many frames, from the start again where it ends."""
    head, motion = bvh.split("MOTION\n")
    _, frame_time, *frames = motion.strip().split("\n")
    lines = [frames[i % len(frames)] for i in range(n_frames)]
    return "\n".join([head + "MOTION", f"Frames: {n_frames}", frame_time, *lines, ""])


if __name__ == "__main__":
    main()
