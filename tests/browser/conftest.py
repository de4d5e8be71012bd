"""A real Chromium with the studio in it; each test has a recording of its own."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from bundled import copy_of_bundled
from screen import DESKTOP, Screen
from studio_server import StudioServer

CHROMIUM = os.environ.get("KINEME_CHROMIUM") or shutil.which("chromium")
# Drawing in software, so that every machine draws the same; and the pages themselves without the
# detour over a graphics card that is not there, which takes twice the time.
ARGUMENTS = [
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-gpu-compositing",
    "--disable-gpu-rasterization",
]


@pytest.fixture(scope="module")  # while it is open, nothing else can use an event loop
def chromium() -> Iterator:
    if CHROMIUM is None:
        pytest.skip("no chromium: install it, or set KINEME_CHROMIUM to where it is")
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def server(chromium, tmp_path_factory: pytest.TempPathFactory) -> Iterator[StudioServer]:
    """The studio's server on a folder of its own."""
    with StudioServer(tmp_path_factory.mktemp("takes")) as running:
        yield running


@pytest.fixture
def take(server: StudioServer) -> Path:
    """The bundled recording, under a new name in the server's folder."""
    return copy_of_bundled(server.folder)


@pytest.fixture
def mortal(chromium, take: Path, tmp_path: Path) -> Iterator[StudioServer]:
    """A server that may be killed, on a folder with one take."""
    take.rename(tmp_path / "take.bvh")
    with StudioServer(tmp_path) as running:
        yield running


@pytest.fixture
def new_tab(chromium) -> Iterator[Callable]:
    """Opens an address in a tab; the test fails if a page of it fails."""
    context = chromium.new_context(
        viewport=DESKTOP,
        device_scale_factor=0.5,  # a quarter of the pixels to draw in software
        reduced_motion="reduce",
        accept_downloads=True,
    )
    context.set_default_timeout(30_000)
    errors: list[str] = []

    def tab(address: str):
        page = context.new_page()
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(address)
        return page

    yield tab
    context.close()
    assert errors == []


@pytest.fixture
def page(new_tab, server: StudioServer, take: Path):
    """A tab with the take open and drawn."""
    tab = new_tab(server.address_of(take))
    Screen(tab).opened()
    return tab
