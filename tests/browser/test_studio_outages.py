"""A slow line or an outage loses no edit, and each is made on what it was made on."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

import kineme
from screen import Screen, two_tabs, until


def saved_primitives(path: Path) -> list[tuple[int, str, bool]]:
    """Start, label and whether it is checked, of each primitive on the disk."""
    table = kineme.read_segments(path)
    checked = {*table.annotation.checked}
    return [
        (row.start_frame, row.label, (row.level, row.start_frame, row.stop_frame) in checked)
        for row in table.primitives
    ]


def test_edits_on_their_way_when_the_server_dies_are_kept_and_sent_and_no_more_are_taken(
    new_tab, mortal
):
    page = new_tab(mortal.address)
    screen = Screen(page).opened()
    page.keyboard.press("Shift+ArrowRight")
    page.keyboard.press("Shift+ArrowRight")
    border = screen.state["selected"]["start_frame"]
    mortal.process.send_signal(signal.SIGSTOP)  # it answers nothing, but is not gone
    for _ in range(3):
        page.keyboard.press("Alt+ArrowRight")
    page.get_by_label("Name of its own").fill("hop")
    page.keyboard.press("Enter")
    page.keyboard.press("Shift+K")
    screen.wait("k.unsent.length === 5")
    assert border in screen.starts()  # what is shown is saved
    mortal.kill()
    notice = page.locator("[data-notice=trouble]")
    notice.filter(has_text="Not saved yet: 2 earlier").wait_for()  # and the last three in words
    page.keyboard.press("s")
    page.get_by_text("Not done:").wait_for()
    assert len(screen.state["unsent"]) == 5
    page.keyboard.press("z")
    page.keyboard.press("End")  # who looks elsewhere meanwhile loses nothing
    mortal.start()  # has a new token, which the tab learns from the one that is opened now
    page.get_by_text("started anew").wait_for()
    new_tab(mortal.address)
    screen.wait("k.unsent.length === 0 && k.saved !== ''")
    saved = saved_primitives(mortal.folder / "take.segments.json")
    assert saved[2] == (border + 3, "hop", True)
    assert screen.starts()[2] == border + 3
    until(page, lambda: page.locator("[data-notice]").count() == 0, "no notice")
    page.reload()
    screen.opened()
    assert screen.labels()[2] == "hop"
    for _ in range(5):
        page.keyboard.press("Control+z")
    screen.wait("k.unsent.length === 0")
    assert saved_primitives(mortal.folder / "take.segments.json")[2] == (border, "", False)


@pytest.mark.parametrize("answered", [False, True], ids=["after the typing", "amid the typing"])
def test_on_a_slow_line_edits_are_made_as_they_were_done(page, take, answered):
    screen = Screen(page)
    page.keyboard.press("Shift+ArrowRight")
    border = screen.state["selected"]["start_frame"]
    screen.slow_down(500)
    for _ in range(3):
        page.keyboard.press("Alt+ArrowRight")
    page.keyboard.press("n")
    page.keyboard.type("hop")
    if answered:  # the segment that is being named has moved by then
        screen.wait("k.unsent.length === 0")
    page.keyboard.press("Enter")
    assert len(screen.state["unsent"]) >= 1
    screen.saved()
    assert screen.starts()[1] == border + 3
    assert screen.labels()[1] == "hop"
    assert saved_primitives(take.with_suffix(".segments.json"))[1][:2] == (border + 3, "hop")


def test_what_is_refused_is_said_until_it_was_read(page, take):
    screen = Screen(page)

    def no_room(route) -> None:
        sent = route.request.post_data_json
        refused = sent["edit"]["kind"] == "name_segment"
        answer = {"status": 400, "json": {"error": "the label is too odd"}}
        route.fulfill(**answer) if refused else route.continue_()

    page.clock.install()
    page.route("**/edits", no_room)
    screen.name_segment("odd")
    notice = page.locator("[data-notice=problem]")
    notice.filter(has_text="“odd” (the label is too odd)").wait_for()
    page.keyboard.press("Shift+ArrowRight")
    page.keyboard.press("Shift+K")
    screen.saved()
    page.clock.fast_forward(7000)  # longer than news are shown
    screen.drawn()
    assert notice.is_visible()
    notice.get_by_role("button", name="Dismiss").click()
    notice.wait_for(state="detached")
    saved = saved_primitives(take.with_suffix(".segments.json"))
    assert saved[0][1] == ""
    assert saved[1][2]


def test_held_edits_are_made_on_the_segments_they_were_made_on(new_tab, server, take):
    first, second = two_tabs(new_tab, server.address_of(take))
    late = second.page
    for screen in (first, second):
        screen.opened()
        screen.page.keyboard.press("Shift+ArrowRight")
    border = first.state["selected"]["start_frame"]
    first.page.keyboard.press("Alt+Shift+ArrowRight")
    first.saved()
    second.name_segment("hop")
    late.get_by_role("button", name="Make them here").click()
    second.saved()
    assert second.starts()[1] == border + 10
    assert second.labels()[:3] == ["", "hop", ""]
