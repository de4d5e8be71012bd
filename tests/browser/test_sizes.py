"""How much is seen on small screens: eight rows of each table, and every button."""

from __future__ import annotations

import shutil

import pytest
from test_views import FAULTS

import kineme
from bundled import copy_of_bundled
from screen import Screen
from studio_server import StudioServer

SIZES = {"1366 x 768": (1366, 768), "1024 x 768": (1024, 768), "1366 x 768 at 200 %": (683, 384)}
ROWS = """(selector) => [...document.querySelectorAll(selector)].filter((row) => {
  const { top, bottom, left, width } = row.getBoundingClientRect();
  const seen = (y) => row.contains(document.elementFromPoint(left + Math.min(width, 200) / 2, y));
  return seen(top + 2) && seen(bottom - 2);
}).length"""
LEAST = 8


@pytest.fixture(scope="module")
def twelve(chromium, tmp_path_factory):
    """A server of twelve recordings that are segmented."""
    folder = tmp_path_factory.mktemp("twelve")
    takes = [copy_of_bundled(folder) for _ in range(12)]
    found = kineme.segment(kineme.read(takes[0]))
    kineme.write_segments(found, takes[0].with_suffix(".segments.json"))
    for take in takes[1:]:
        shutil.copy(takes[0].with_suffix(".segments.json"), take.with_suffix(".segments.json"))
    with StudioServer(folder) as running:
        yield running


@pytest.mark.parametrize("size", SIZES)
def test_eight_rows_and_all_buttons_are_seen(twelve, new_tab, size):
    page = new_tab(twelve.address)
    page.set_viewport_size(dict(zip(("width", "height"), SIZES[size], strict=True)))
    page.locator(".folder-rows .gradient").first.wait_for()
    screen = Screen(page)
    screen.drawn()
    assert page.evaluate(ROWS, "[role=rowgroup] > .folder-row") >= LEAST
    assert page.evaluate(FAULTS) == [], "folder"
    page.get_by_role("button", name="Open take", exact=False).first.click()
    screen.opened()
    page.get_by_role("tab", name="Table").click()
    screen.drawn()
    assert page.evaluate(ROWS, ".table-rows [role=row]") >= LEAST
    assert page.evaluate(FAULTS) == []
