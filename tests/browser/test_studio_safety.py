"""Nothing is lost: when the server is killed, when the tab goes, when two tabs edit."""

from __future__ import annotations

import signal

import kineme
from screen import Screen, two_tabs
from studio_server import saved_table


def test_edits_outlive_the_tab_that_could_not_send_them(new_tab, mortal):
    page = new_tab(mortal.address)
    screen = Screen(page)
    screen.opened()
    mortal.process.send_signal(signal.SIGSTOP)
    screen.name_segment("kept")
    mortal.kill()
    page.locator("[data-notice=trouble]").wait_for()
    page.close()
    mortal.start()
    second = Screen(new_tab(mortal.address))
    second.wait("k?.hasMotion && k.segments.some((row) => row.label === 'kept')")
    second.saved()
    assert saved_table(mortal.folder / "take.bvh").primitives.label.tolist()[0] == "kept"


def test_a_second_tab_sees_what_the_first_one_does(new_tab, server, take):
    first, second = (Screen(new_tab(server.address_of(take))) for _ in range(2))
    for screen in (first, second):
        screen.opened()
    first.name_segment("from the first")
    second.wait("k.segments.some((row) => row.label === 'from the first')")
    second.name_segment("from the second")
    first.wait("k.segments.some((row) => row.label === 'from the second')")
    first.page.keyboard.press("Control+z")
    second.wait("k.segments.some((row) => row.label === 'from the first')")


def test_an_edit_of_an_old_table_waits_until_its_author_has_seen_the_new_one(new_tab, server, take):
    first, second = two_tabs(new_tab, server.address_of(take))
    late = second.page
    for screen in (first, second):
        screen.opened()
    border = first.starts()[4]
    first.name_segment("first")
    first.saved()
    second.click(second.lane("primitive")[4])
    late.keyboard.press("Delete")
    notice = late.locator("[data-notice=held]")
    notice.filter(has_text="deleted").wait_for()
    path = take.with_suffix(".segments.json")
    assert border in kineme.read_segments(path).cuts("primitive")
    second.wait("k.segments.some((row) => row.label === 'first')")  # the new table
    assert border in second.starts()
    late.get_by_role("button", name="Make them here").click()
    second.wait("k.unsent.length === 0")
    saved = kineme.read_segments(path)
    assert border not in saved.cuts("primitive")
    assert saved.primitives.label[0] == "first"


def test_a_table_that_another_program_wrote_is_not_overwritten_unseen(page, take):
    screen = Screen(page)
    screen.name_segment("mine")
    screen.saved()
    path = take.with_suffix(".segments.json")
    path.write_text(path.read_text().replace("mine", "theirs"))
    page.keyboard.press("Shift+ArrowRight")
    screen.name_segment("mine, too")
    notice = page.locator("[data-notice=held]")
    notice.wait_for()
    assert kineme.read_segments(path).primitives.label.tolist()[:2] == ["theirs", ""]
    page.get_by_role("button", name="Drop them").click()
    notice.wait_for(state="detached")
    screen.wait("k.segments.some((row) => row.label === 'theirs')")
    assert screen.labels()[:2] == ["theirs", ""]
