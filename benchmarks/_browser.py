"""Start Chromium with software rendering, as on a computer without a graphics card."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from _options import need_packages, skip

FLAGS = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
SIZE = {"width": 1280, "height": 720}
DRAWN = "window.kineme?.hasMotion && window.kineme.drawn > 0"


@contextmanager
def open_chromium(*flags: str) -> Iterator[Any]:
    """Open a browser with these flags; skip the benchmark if none is installed."""
    need_packages("playwright")
    from playwright.sync_api import sync_playwright

    program = os.environ.get("KINEME_CHROMIUM") or shutil.which("chromium")
    if program is None:
        skip("needs Chromium: install it, or set KINEME_CHROMIUM to its program")
    sandbox = [] if os.geteuid() else ["--no-sandbox"]
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=[*flags, *sandbox])
        yield browser
        browser.close()


def wait(tab: Any, condition: str) -> None:
    """Wait until the condition holds; poll, because the page's policy forbids evaluated code."""
    while not tab.evaluate(condition):
        tab.wait_for_timeout(10)
