"""How soon a report shows its first picture, and how fluently it plays, without a graphics card.

    python -m benchmarks report_in_browser [RECORDING]

The recording, by default the bundled one, is repeated to two minutes and to an
hour (see report.py), and opened in Chromium, which draws with the processor.
The first picture is the one with the figure in it, counted from the request for
the page. Drawing is counted over some seconds of playing. What else the machine
does falls on both.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from time import perf_counter
from typing import Any

import kineme
from _browser import FLAGS, chromium
from _measure import verdict
from _options import command_line, few
from kineme.datasets import bundled_recording
from kineme.report.page import write_report
from report import repeated

SIZE = {"width": 1280, "height": 720}
SECONDS = few(8, 1)
FIRST_PICTURE, LEAST_RATE = 1.5, 30
DRAWN = "window.kineme?.hasMotion && window.kineme.drawn > 0"


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("recording", nargs="?", type=Path, default=bundled_recording())
    path = parser.parse_args().recording
    motion = kineme.read(path)
    segments = kineme.segment(motion)
    print(f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")
    with tempfile.TemporaryDirectory() as folder, chromium(*FLAGS) as browser:
        for minutes in few((2, 60), (1,)):
            file = Path(folder) / f"{minutes}.html"
            write_report(*repeated(motion, segments, minutes), file)
            show(browser, minutes, file)


def show(browser: Any, minutes: float, file: Path) -> None:
    tab = browser.new_page(viewport=SIZE)
    first, rate = first_picture(tab, file.as_uri()), drawing_rate(tab)
    print(f"{minutes} minutes")
    promise = verdict(first, FIRST_PICTURE) if minutes <= 2 else "usable"
    print(f"  first picture {first:.2f} s; {promise}")
    show_rate(rate)
    tab.close()


def first_picture(tab: Any, address: str) -> float:
    """Seconds from the request for a page to the picture with the figure in it."""
    start = perf_counter()
    tab.goto(address)
    wait(tab, DRAWN)
    tab.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    return perf_counter() - start


def drawing_rate(tab: Any) -> float:
    """Pictures per second while it plays, which goes on."""
    tab.keyboard.press("Space")
    tab.wait_for_timeout(2000)
    before = tab.evaluate("[performance.now(), window.kineme.drawn]")
    tab.wait_for_timeout(1000 * SECONDS)
    after = tab.evaluate("[performance.now(), window.kineme.drawn]")
    return 1000 * (after[1] - before[1]) / (after[0] - before[0])


def show_rate(rate: float) -> None:
    kept = "kept" if rate >= LEAST_RATE else "NOT KEPT"
    print(f"  {rate:.0f} pictures per second; at least {LEAST_RATE} promised: {kept}")


def wait(tab: Any, condition: str) -> None:
    """Until the condition holds; asked from outside, as the page's policy wants it."""
    while not tab.evaluate(condition):
        tab.wait_for_timeout(10)


if __name__ == "__main__":
    main()
