"""Corners of the studio in which something was in the way, was untrue, or came late."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from kineme.studio.storage.sidecars import make_file_id
from screen import Screen, box_of, until

ON_TOP = """button => {
    const { left, top, width, height } = button.getBoundingClientRect();
    return document.elementFromPoint(left + width / 2, top + height / 2) === button;
}"""

ASKED = """id => performance.getEntriesByType("resource").filter(
    ({ name }) => name.includes(`${id}/curves/`)).length"""


def in_sight(place: Any) -> None:
    """Until nothing lies over it."""
    until(place.page, lambda: place.evaluate(ON_TOP), f"{place} in sight")


@pytest.mark.parametrize("size", [(1600, 1000), (1366, 768)])
def test_what_makes_a_preview_the_table_is_in_sight(page, size):
    screen = Screen(page)
    page.set_viewport_size({"width": size[0], "height": size[1]})
    for segment in screen.lane("primitive")[:30:27]:  # names that are lost, which is said
        screen.click(segment)
        screen.name_segment(f"name {segment['start_frame']}")
        screen.saved()
    page.get_by_role("slider", name="Detail").press("Home")
    for preset in ("kineme", "voegele2014"):
        page.get_by_label("Preset", exact=True).select_option(preset)
        screen.previewed()
        for name in ("Apply", "Discard"):
            in_sight(page.get_by_role("button", name=name))
    in_sight(page.get_by_text("would be lost"))
    page.get_by_text("Advanced").click()
    page.locator(".parameter input[type=range]").last.focus()  # below what is in sight at first
    in_sight(page.locator(".parameter input[type=range]").last)
    page.get_by_role("button", name="Apply").click()
    screen.wait("k.saved !== '' && k.other === null")


def test_arrow_keys_are_the_players_after_a_click_on_a_tab(page):
    screen = Screen(page)
    before = screen.starts()
    for tab in ("Table", "Clusters"):
        page.get_by_role("tab", name=tab).click()
        frame = screen.state["frame"]
        page.keyboard.press("ArrowRight")
        screen.wait(f"k.frame === {frame + 1}")
        page.get_by_role("tab", name=tab, selected=True).wait_for()
    page.get_by_role("tab", name="Review").click()
    page.keyboard.press("Alt+ArrowRight")
    screen.saved()
    assert screen.starts() != before
    page.get_by_role("tab", name="Review", selected=True).wait_for()


def test_who_reaches_a_tab_with_the_tab_key_goes_on_with_arrows(page):
    screen = Screen(page)
    page.get_by_role("tab", name="Segment").focus()
    page.keyboard.press("ArrowRight")
    page.get_by_role("tab", name="Table", selected=True).wait_for()
    assert screen.state["frame"] == 0


def test_an_edge_that_was_dragged_leaves_the_arrow_keys_to_the_player(page):
    screen = Screen(page)
    edge = page.get_by_role("separator", name="Size of side panel")
    edge.click()
    width = box_of(page.locator(".place-side"))["width"]
    page.keyboard.press("ArrowRight")
    screen.wait("k.frame === 1")
    assert box_of(page.locator(".place-side"))["width"] == width


def test_news_go_with_what_they_are_of(new_tab, server, take):
    second = Path(shutil.copy(take, take.with_stem(f"{take.stem}_b")))
    page = new_tab(server.address_of(take))
    screen = Screen(page).opened()
    news = page.locator(".news")
    page.get_by_role("tab", name="Table").click()
    rows = page.locator(".table-rows [role=row]")
    rows.nth(1).click()
    rows.nth(2).click(modifiers=["Control"])
    page.get_by_label("Name for all chosen").fill("step")
    for news_end in ("Control+z", "PageDown"):
        page.get_by_role("button", name="Name 2").click()
        page.get_by_text("2 segments named “step”").wait_for()
        page.keyboard.press(news_end)
        screen.wait(f"k.name !== '{take.name}' || k.segments.every((row) => row.label !== 'step')")
        until(page, lambda: news.count() == 0, "no news", seconds=3)  # sooner than they end alone
    screen.wait(f"k.name === '{second.name}'")


def test_channels_of_the_recording_before_are_not_asked_for(new_tab, server):
    paths = []
    for name, length in (("wrist_1", 60), ("wrist_2", 240)):
        seconds = np.arange(0, length, 0.02)
        waves = [np.sin((i + 1) * seconds) for i in range(6)]
        table = np.column_stack([seconds, *waves])
        heads = ",".join(["time", *(f"acc_{name}_{i}" for i in range(6))])
        paths.append(server.folder / f"{name}.csv")
        np.savetxt(paths[-1], table, delimiter=",", header=heads, comments="")
    page = new_tab(server.address_of(paths[0]))
    screen = Screen(page)
    screen.wait("k?.n_segments > 0 && !k.finding")
    ids = [make_file_id(path) for path in paths]
    screen.wait(f"({ASKED})('{ids[0]}') === 12")  # of each channel its outline, and its values
    page.keyboard.press("PageDown")
    screen.wait(f"k.name === '{paths[1].name}' && ({ASKED})('{ids[1]}') >= 12")
    page.wait_for_timeout(500)
    assert page.evaluate(ASKED, ids[0]) == 12


def test_a_label_file_that_comes_is_offered_at_once(page, take):
    screen = Screen(page)
    name = f"{take.stem}_said.csv"
    (take.parent / name).write_text("start_s,stop_s,label\n0,20,walk\n20,40,hop\n")
    page.keyboard.press("c")
    page.get_by_role("button", name=name, exact=True).click()
    screen.wait(f"k.other === '{name}'")
