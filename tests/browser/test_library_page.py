"""A library in the browser: named, searched, and told what is right."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import kineme
from axe import AXE, load_axe, violations
from kineme.library import Library, build
from screen import Screen, until
from studio_server import StudioServer

FITS = "document.documentElement.scrollWidth <= innerWidth"


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    home = tmp_path_factory.mktemp("shelf")
    build(kineme.bundled_recording(), home / "library")
    return home / "library"


def listed(page) -> list[str]:
    return page.locator(".hit").evaluate_all("(all) => all.map((hit) => hit.ariaLabel)")


@pytest.mark.slow
def test_a_cluster_is_named_more_of_it_found_and_what_is_wrong_refused(new_tab, library):
    with StudioServer(library) as server:
        page = new_tab(server.address)
        page.locator(".figure[data-drawn=true]").first.wait_for()
        name = page.get_by_label("Name of cluster 0", exact=True)
        name.fill("walk")
        name.press("Enter")
        page.get_by_role("button", name="Find more like this: walk").click()
        page.locator(".hit .figure[data-drawn=true]").first.wait_for()
        assert Library(library).numbers("walk") == [0]
        before = listed(page)
        page.keyboard.press("y")  # the next card is in front afterwards
        page.keyboard.press("n")
        page.get_by_text("1 confirmed, 1 refused").wait_for()
        assert listed(page) == before  # nothing changes unasked
        with page.expect_download() as taken:
            page.get_by_role("button", name="JSON").click()
        rows = [json.loads(line) for line in Path(taken.value.path()).read_text().splitlines()]
        assert [row["confirmed"] for row in rows[:3]] == [True, False, None]
        page.get_by_role("button", name="Search again with these").click()
        page.locator(f".hit[aria-label='{before[1]}']").wait_for(state="detached")
        until(page, lambda: listed(page)[:1] == before[:1], "the confirmed one comes first")
        check_views(page)
        page.get_by_role("tab", name="Search").click()
        page.locator(".hit a").first.click()
        screen = Screen(page).opened()
        screen.wait(f"Math.abs(k.playhead - {rows[0]['start_s']}) < 0.1")
        page.get_by_role("link", name="Library").click()
        page.locator(".card").first.wait_for()


def check_views(page) -> None:
    """Nothing is wider than the window, and axe-core has nothing to say, in both themes."""
    page.emulate_media(reduced_motion="reduce")  # buttons have their new colours at once
    if axe := AXE.exists():
        load_axe(page)
    for tab in ("Clusters", "Recordings", "Search"):
        page.get_by_role("tab", name=tab).click()
        for width in (390, 768, 1440, 2560):
            page.set_viewport_size({"width": width, "height": 900})
            until(page, lambda: page.evaluate(FITS), f"{tab} no wider than {width}")
        assert not axe or violations(page) == []
        page.get_by_role("button", name="Show the page").click()
        assert not axe or violations(page, colors_only=True) == []
