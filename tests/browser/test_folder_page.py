"""The folder as a whole: its page, and the review that goes through all of its recordings."""

from __future__ import annotations

import pytest

import kineme
from bundled import copy_of_bundled
from kineme.segments.editing.annotating import find_marked
from screen import Screen, until
from studio_server import StudioServer, saved_table

FRAMES = 2898


@pytest.fixture
def several(chromium, tmp_path):
    """A studio of three recordings, each with one border that is doubtful."""
    for name, doubt in (("a", 0.6), ("b", 0.2), ("c", 0.4)):
        path = copy_of_bundled(tmp_path).rename(tmp_path / f"{name}.bvh")
        columns = {
            "level": ["activity"] * 3,
            "kind": ["activity"] * 3,
            "start_frame": [0, 1000, 2000],
            "stop_frame": [1000, 2000, FRAMES],
            "cluster": [0, 1, 0],
            "confidence": [1.0] * 3,
            "border_confidence": [float("nan"), doubt, 0.9],
        }
        table = kineme.Segmentation.from_columns(columns, n_frames=FRAMES, fps=60.0)
        kineme.write_segments(table, path.with_suffix(".segments.json"))
    with StudioServer(tmp_path) as running:
        yield running


def test_the_folder_is_a_page_and_a_review_goes_through_it_with_keys(new_tab, several):
    page = new_tab(several.address)
    screen = Screen(page)
    rows = page.locator(".folder-page [role=rowgroup] [role=row]")
    until(page, lambda: rows.locator(".gradient").count() == 3, "3 rows")
    assert "20 %" in rows.nth(1).inner_text()
    page.get_by_text("0 of 9 checked; 2 of the others below 50 %").wait_for()
    page.get_by_role("button", name="Lowest confidence").click()
    until(page, lambda: rows.first.inner_text().startswith("b.bvh"), "b first")
    page.get_by_label("Filter the recordings by name").fill("c.")
    until(page, lambda: rows.count() == 1, "1 row")
    page.get_by_label("Filter the recordings by name").fill("")
    page.get_by_label("Filter the recordings by name").blur()

    page.keyboard.press("j")
    screen.wait("k.name === 'b.bvh' && k.selected?.start_frame === 1000")
    page.locator(".folder-page").wait_for(state="detached")
    why = page.locator(".queue-why")
    until(page, lambda: "is 20 %" in why.inner_text(), "why it is looked at")
    said = why.inner_text()
    page.keyboard.press("Alt+Shift+ArrowRight")
    screen.name_segment("hop")
    screen.saved()
    assert why.inner_text() == said
    page.keyboard.press("k")
    screen.wait("k.name === 'c.bvh' && k.selected?.start_frame === 1000")
    page.get_by_text("1 of 9 checked").wait_for()
    page.keyboard.press("j")
    screen.wait("k.name === 'a.bvh' && k.selected?.start_frame === 1000")
    corrected = saved_table(several.folder / "b.bvh")
    assert find_marked(corrected, "checked") == {("activity", 1010, 2000)}
    assert corrected.activities.label.tolist() == ["", "hop", ""]

    page.get_by_role("button", name="Folder", exact=True).click()
    page.keyboard.press("s")  # edits nothing that is not seen
    assert len(saved_table(several.folder / "a.bvh").activities) == 3
    page.keyboard.press("Escape")
    until(page, lambda: page.locator(".folder-page").count() == 0, "the recording again")
    assert screen.state["unsent"] == []
