"""Many segments and many recordings: the table, the review queue, the next recording."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import kineme
from kineme.segments.editing.annotating import find_marked
from screen import Screen, until
from studio_server import saved_table


def test_many_rows_are_chosen_with_keys_and_named_in_one_step(page, take):
    screen = Screen(page)
    page.locator("#tab-table").click()
    page.get_by_label("Level", exact=True).select_option("primitive")
    grid = page.get_by_role("grid", name="Segments")
    grid.get_by_role("row").nth(2).click()
    screen.wait("k.selected")
    assert screen.state["selected"] == screen.lane("primitive")[2]
    grid.focus()
    for _ in range(3):
        page.keyboard.press("Shift+ArrowDown")
    page.get_by_text("4 chosen").wait_for()
    until(page, lambda: grid.locator("[aria-selected=true]").count() == 4, "4 chosen rows")
    page.get_by_label("Name for all chosen").fill("step")
    page.get_by_role("button", name="Name 4").click()
    page.get_by_text("4 segments named “step”").wait_for()
    screen.saved()
    assert screen.labels().count("step") == 4
    assert saved_table(take).primitives.label.tolist() == screen.labels()
    page.keyboard.press("Control+z")
    screen.wait("!k.segments.some((row) => row.label === 'step')")


def test_the_queue_shows_the_least_sure_first_and_a_new_segmentation_leaves_what_is_checked(
    page, take
):
    screen = Screen(page)
    page.locator("#tab-review").click()
    page.keyboard.press("j")
    screen.wait("k.selected")
    numbers = page.locator(".doubts .number:last-child")
    until(page, lambda: numbers.count() > 5, "a queue")
    shown = numbers.all_inner_texts()
    known = [int(text.removesuffix(" %")) for text in shown if text != "–"]
    assert len(known) > 5
    assert known == sorted(known)
    page.locator(".doubts li").first.locator("[aria-current=true]").wait_for()
    first = screen.state["selected"]
    until(page, lambda: page.locator(".why").inner_text().strip(), "why it is in the queue")
    page.keyboard.press("k")
    screen.saved()
    screen.wait(f"k.selected && k.selected.start_frame !== {first['start_frame']}")
    span = (first["level"], first["start_frame"], first["stop_frame"])
    assert find_marked(saved_table(take), "checked") == {span}
    page.get_by_label("Preset", exact=True).select_option("voegele2014")
    page.get_by_role("button", name="Apply").click()
    screen.wait("k.other === null && k.unsent.length === 0")
    spans = [(r["level"], r["start_frame"], r["stop_frame"]) for r in screen.state["segments"]]
    assert span in spans
    assert find_marked(saved_table(take), "checked") == {span}


def test_a_segment_has_one_confidence_in_queue_panel_and_table(page):
    page.locator("#tab-review").click()
    page.keyboard.press("j")
    Screen(page).wait("k.selected")
    shown = page.locator(".doubts [aria-current=true] .number:last-child").inner_text()

    def said(place: str, words: str) -> list[str]:
        return re.findall(words, page.locator(place).inner_text())

    until(page, lambda: said(".why", r"\d+ %") == [shown], f"why: {shown}")
    page.locator("#tab-segment").click()
    until(page, lambda: said(".segment-panel", r"\d+ %|score") == [shown], f"panel: {shown}")
    page.locator("#tab-table").click()
    chosen = page.locator(".table-rows [aria-selected=true]")
    cell = chosen.locator("[role=gridcell]").last
    until(page, lambda: cell.inner_text() == shown, f"table: {shown}")
    page.get_by_role("button", name="More").click()
    page.get_by_label("Confidence below").fill(str(int(shown[:-2]) / 100 - 0.01))
    page.get_by_text("0 segments").wait_for()


def test_the_next_recording_opens_at_its_start_and_its_status_is_shown(new_tab, server, take):
    second = Path(shutil.copy(take, take.with_stem(f"{take.stem}_b")))
    page = new_tab(server.address_of(take))
    screen = Screen(page)
    screen.opened()
    failed: list[str] = []
    page.on("response", lambda answer: answer.status == 404 and failed.append(answer.url))
    page.keyboard.press("End")
    page.keyboard.press("PageDown")
    screen.wait(f"k.name === '{second.name}' && k.hasMotion")
    assert (screen.state["recordings"], screen.state["playhead"]) == ([second.name], 0)
    for key in ("PageUp", "PageDown") * 3:  # faster than they open
        page.keyboard.press(key)
        page.wait_for_timeout(60)
    page.wait_for_timeout(1500)  # what is not there would be asked for late
    screen.opened()
    assert failed == []
    screen.name_segment("hop")
    screen.saved()
    name = screen.state["name"]
    page.get_by_label("Show recordings that are").select_option("corrected")
    page.locator(".recording .name", has_text=name).wait_for()


def test_labels_of_others_are_shown_as_labels(new_tab, server, take):
    columns = {
        "level": ["activity"] * 3,
        "kind": ["activity", "transition", "activity"],
        "start_frame": [0, 600, 1200],
        "stop_frame": [600, 1200, 2898],
        "label": ["walk", "rest", "walk"],
    }
    table = kineme.Segmentation.from_columns(columns, n_frames=2898, fps=60.0)
    kineme.write_segments(table, take.with_suffix(".segments.json"))
    page = new_tab(server.address_of(take))
    screen = Screen(page)
    screen.opened()
    page.locator("#tab-clusters").click()
    rows = page.locator("table.clusters tbody tr")
    until(page, lambda: rows.count() == 2, "2 labels")
    assert [text.split()[0] for text in rows.all_inner_texts()] == ["walk", "rest"]
    colors = [
        row.locator(".swatch").evaluate("(swatch) => getComputedStyle(swatch).backgroundColor")
        for row in rows.all()
    ]
    assert len(set(colors)) == 2
    assert "rgb(221, 221, 221)" not in colors
