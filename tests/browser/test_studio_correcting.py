"""Correcting a result in the studio: every edit can be seen, undone, and found on the disk."""

from __future__ import annotations

import kineme
from screen import Screen, box_of, until
from studio_server import saved_table


def test_a_border_is_dragged_and_brought_back(page, take):
    screen = Screen(page)
    before, after = screen.lane("primitive")[2:4]
    screen.drag_border(after, before["start_s"] + 0.4 * (before["stop_s"] - before["start_s"]))
    screen.wait(f"!k.segments.some((row) => row.start_frame === {after['start_frame']})")
    screen.saved()
    moved = screen.lane("primitive")[3]["start_frame"]
    assert before["start_frame"] < moved < after["start_frame"]
    assert saved_table(take).primitives.start_frame.tolist() == screen.starts()
    page.keyboard.press("Control+z")
    screen.wait(f"k.segments.some((row) => row.start_frame === {after['start_frame']})")
    screen.saved()
    assert saved_table(take).primitives.start_frame.tolist() == screen.starts()
    page.keyboard.press("Control+Shift+z")
    screen.wait(f"k.segments.some((row) => row.start_frame === {moved})")


def test_a_border_comes_to_the_playhead_and_a_held_key_is_one_step_back(page, take):
    screen = Screen(page)
    untouched = screen.starts()
    segment = screen.lane("primitive")[2]
    screen.click(segment)
    for _ in range(4):
        page.keyboard.press("ArrowRight")
    page.keyboard.press("[")
    here = segment["start_frame"] + 4
    screen.wait(f"k.segments.some((row) => row.start_frame === {here})")
    screen.saved()
    page.keyboard.down("Alt")
    for _ in range(3):
        page.keyboard.down("ArrowRight")
    page.keyboard.up("ArrowRight")
    page.keyboard.up("Alt")
    screen.wait(f"k.segments.some((row) => row.start_frame === {here + 3})")
    screen.saved()
    page.keyboard.press("Control+z")
    screen.wait(f"k.segments.some((row) => row.start_frame === {here})")
    page.keyboard.press("Control+z")
    screen.saved()
    assert screen.starts() == untouched


def test_a_recording_keeps_the_level_one_works_in(page, take):
    screen = Screen(page)
    activities = page.get_by_role("button", name="Activities")
    activities.click()
    assert activities.get_attribute("aria-pressed") == "true"
    page.reload()
    screen.opened()
    assert activities.get_attribute("aria-pressed") == "true"


def test_a_cluster_is_named_exported_and_found_again(page, take, tmp_path):
    screen = Screen(page)
    chosen = screen.lane("primitive")[9]
    screen.click(chosen)
    page.keyboard.press("Shift+N")
    page.keyboard.type("squat & <jump>")
    page.keyboard.press("Enter")
    screen.wait("k.segments.some((row) => row.label !== '')")
    screen.saved()
    page.keyboard.press("e")
    for name in ("json", "csv", "elan"):
        with page.expect_download() as download:
            page.locator(f"[data-format={name}]").click()
        path = tmp_path / download.value.suggested_filename
        download.value.save_as(path)
        segments = kineme.read_segments(path)
        clusters = [row.label for row in segments.primitives if row.label]
        members = [row for row in screen.lane("primitive") if row["cluster"] == chosen["cluster"]]
        assert clusters == ["squat & <jump>"] * len(members)
    page.reload()
    screen.opened()
    assert screen.labels().count("squat & <jump>") == len(members)
    assert saved_table(take).primitives.label.tolist() == screen.labels()


def test_other_parameters_are_a_preview_until_they_are_applied(page, take):
    screen = Screen(page)
    screen.name_segment("mine")
    screen.saved()
    before = screen.state["segments"]
    page.get_by_label("Preset", exact=True).select_option("voegele2014")
    screen.previewed()
    assert screen.state["segments"] == before
    page.get_by_text("Advanced").click()
    slider = page.get_by_role("slider", name="Window").or_(page.get_by_role("slider").first)
    box = box_of(slider.first)
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + box["height"] / 2)
    page.mouse.down()
    for share in (0.55, 0.6, 0.65, 0.7):
        page.mouse.move(box["x"] + share * box["width"], box["y"] + box["height"] / 2)
        page.wait_for_timeout(150)
    page.mouse.up()
    page.keyboard.press("ArrowRight")  # a frame on: the slider was clicked, and has no keys
    screen.wait("k.frame === 1")
    assert screen.state["segments"] == before
    assert saved_table(take).primitives.label[0] == "mine"
    page.get_by_role("button", name="Apply").wait_for()
    page.get_by_label("Take over 0 corrections, 1 name").uncheck()
    apply = page.get_by_role("button", name="Apply: replaces 0 corrections, 1 name")
    apply.wait_for()
    apply.click()
    screen.wait("!k.segments.some((row) => row.label === 'mine')")
    screen.wait("k.unsent.length === 0 && k.other === null")
    page.keyboard.press("Control+z")  # one drag, and all that was looked at: one step
    screen.wait("k.segments.some((row) => row.label === 'mine')")
    screen.wait("k.unsent.length === 0")
    assert screen.state["segments"] == before
    until(page, lambda: page.get_by_label("Preset", exact=True).input_value() == "kineme")


def test_a_new_segmentation_takes_over_what_people_did_and_the_old_table_can_be_had_again(
    page, server, take
):
    screen = Screen(page)
    page.keyboard.press("Shift+ArrowRight")
    page.keyboard.press("Alt+Shift+ArrowRight")
    screen.saved()
    border = screen.state["selected"]["start_frame"]
    screen.name_segment("mine")
    screen.wait("k.segments.some((row) => row.label === 'mine')")
    screen.saved()
    before = screen.state["segments"]
    page.get_by_label("Preset", exact=True).select_option("voegele2014")
    page.get_by_role("button", name="Apply").click()
    screen.wait("k.other === null && k.unsent.length === 0")
    assert screen.state["segments"] != before
    assert border in screen.starts()
    assert "mine" in screen.labels()
    page.keyboard.press("h")
    page.get_by_role("button", name="Look").first.click()
    screen.wait("k.other === 'Version 3'")
    page.keyboard.press("h")
    page.get_by_role("button", name="Bring back").first.click()
    screen.wait(f"k.n_segments === {len(before)}")
    screen.saved()
    assert screen.state["segments"] == before
    assert saved_table(take).primitives.start_frame.tolist() == screen.starts()


def test_kind_and_cluster_of_a_segment_can_be_set(page, take):
    screen = Screen(page)
    chosen = screen.lane("primitive")[4]
    screen.click(chosen)
    page.get_by_label("Cluster of the segment").select_option("3")
    screen.wait("k.selected.cluster === 3")
    page.get_by_label("Kind").select_option("transition")
    screen.wait("k.selected.kind === 'transition'")
    screen.saved()
    row = saved_table(take).primitives[4]
    assert (row.kind, row.cluster) == ("transition", -1)


def test_naming_a_cluster_where_there_is_none_leaves_the_keyboard_to_the_player(page):
    screen = Screen(page)
    rows = screen.lane("primitive")
    longest = sorted(rows, key=lambda row: row["start_s"] - row["stop_s"])
    screen.click(next(row for row in longest if row["cluster"] < 0))
    screen.wait("k.selected")
    page.keyboard.press("Shift+N")
    page.get_by_text("This segment is in no cluster").wait_for()
    screen.click(next(row for row in longest if row["cluster"] >= 0))
    screen.wait("k.selected?.cluster >= 0")
    for key in ("ArrowRight", "ArrowRight", "s"):
        page.keyboard.press(key)
    screen.wait(f"k.segments.filter((row) => row.level === 'primitive').length > {len(rows)}")
