"""Each view of studio and report: reachable by everybody, and whole at every size."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import kineme
from axe import AXE, load_axe, violations
from screen import Screen, box_of

FAULTS = Path(__file__).with_name("faults.js").read_text(encoding="utf-8")
TABS = ("segment", "table", "review", "clusters", "compare", "about")
DIALOGS = "htce?"
SIZES = {390: 844, 768: 1024, 1024: 768, 1440: 900, 2560: 1000}
WALKED = (390, 768, 1024, 1440)  # widths at which every view is looked at


def views(page: Any, screen: Screen) -> Iterator[tuple[str, str]]:
    """Every view of a recording in the studio, one after the other, and what is new in it."""
    for tab in TABS:
        page.locator(f"#tab-{tab}").click()
        if tab == "review":
            page.keyboard.press("j")
        if tab == "clusters":
            page.locator(".cluster-name").first.click()
        yield tab, "body" if tab == TABS[0] else ".place-side"
    page.get_by_label("Preset", exact=True).select_option("voegele2014")
    screen.wait("k.other === 'Preview'")
    yield "preview", ".preset-panel"
    page.get_by_role("button", name="Discard").click()
    screen.wait("k.other === null")
    page.keyboard.press("g")
    page.locator(".channels canvas").wait_for()
    yield "curves", ".place-curves"
    page.keyboard.press("g")
    for key in DIALOGS:
        page.keyboard.press(key)
        page.locator("dialog[open]").wait_for()
        yield f"dialog {key}", "dialog[open]"
        page.keyboard.press("Escape")
        page.locator("dialog[open]").wait_for(state="detached")


@pytest.fixture
def sensors(server) -> Path:
    """A recording without a body."""
    times = np.arange(900) / 60
    values = np.sin(2 * np.pi * times * np.where(times < 7, 1, 2))
    path = server.folder / "sensors.csv"
    table = np.column_stack([times, values, np.roll(values, 5)])
    np.savetxt(path, table, delimiter=",", header="time,a,b", comments="")
    return path


@pytest.fixture
def report(take, tmp_path) -> Path:
    motion = kineme.read(take)
    kineme.write_report(motion, kineme.segment(motion), tmp_path / "report.html")
    return tmp_path / "report.html"


@pytest.mark.slow
def test_nobody_is_kept_out_of_any_view(page, server, sensors, report):
    if not AXE.exists():
        pytest.skip("no axe-core: npm ci in src/kineme/web/pages")
    screen, found = Screen(page), []

    def look(view: str, part: str = "body", *, colors_only: bool = False) -> None:
        screen.drawn()
        said = violations(page, part, colors_only=colors_only)
        found.extend(f"{view}, {each}" for each in said)

    load_axe(page)
    for scheme in ("dark", "light"):
        # Colours on their way from one theme to the other have any contrast.
        page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
        for view, part in views(page, screen):
            look(f"{scheme}, {view}", part, colors_only=scheme == "light")
    page.goto(server.address_of(sensors))
    screen.wait("k?.segments?.length")
    load_axe(page)
    look("sensors")
    page.goto(report.as_uri())
    screen.opened()
    load_axe(page)
    for i, tab in enumerate(page.get_by_role("tab").all()):
        tab.click()
        look(f"report, {tab.inner_text()}", ".place-side" if i else "body")
    assert found == []


@pytest.mark.slow
def test_nothing_is_cut_off_covered_or_empty_at_any_size(page, server, sensors, report):
    screen, found = Screen(page), []
    page.get_by_label("A label for all recordings of the folder").fill("hop")
    page.keyboard.press("Enter")
    page.get_by_label("Take “hop” off the list").wait_for()

    def look(view: str) -> None:
        screen.drawn()
        found.extend(f"{view}: {each}" for each in dict.fromkeys(page.evaluate(FAULTS)))

    for width, height in SIZES.items():
        page.set_viewport_size({"width": width, "height": height})
        for scheme, motion in (("dark", "no-preference"), ("light", "reduce")):
            page.emulate_media(color_scheme=scheme, reduced_motion=motion)
            screen.opened()
            look(f"{width}, {scheme}, {motion}")
        assert box_of(page.locator(".viewer canvas"))["height"] > 200
        page.get_by_label("Frame", exact=True).wait_for()
        page.get_by_label("Playhead", exact=True).wait_for()
        for view, _ in views(page, screen) if width in WALKED else ():
            look(f"{width}, {view}")
    for address in (server.address_of(sensors), report.as_uri()):
        page.goto(address)
        screen.wait("k?.n_segments")
        for width, height in SIZES.items():
            page.set_viewport_size({"width": width, "height": height})
            look(f"{width}, {address[-20:]}")
    assert found == []
