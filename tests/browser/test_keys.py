"""Keys do what the page says, whatever was clicked before; what is typed stays typed."""

from __future__ import annotations

import shutil

import pytest
from keyboard import CHECKS

from screen import Screen, box_of

CONTROLS = ".viewer-buttons button, .transport button, .transport select, .scrub, .tab-row button, \
.parameter input[type=range], .segment-panel select, .viewer canvas, .lanes canvas, .matrix canvas"


def calmed(screen: Screen) -> None:
    """What the click began is ended: playing, a loop, a preview, full screen."""
    state = screen.state
    if screen.page.evaluate("Boolean(document.fullscreenElement)"):
        screen.page.keyboard.press("f")
        screen.page.locator(".place-side").wait_for()
    for key in ["Space"] * state["playing"] + ["l"] * (state["loop"] is not None):
        screen.page.keyboard.press(key)
    discard = screen.page.get_by_role("button", name="Discard")
    if discard.count() or screen.page.locator(".preset-panel[aria-busy=true]").count():
        discard.click()


@pytest.mark.slow
def test_each_documented_key_does_what_the_help_says_whatever_was_clicked(new_tab, server, take):
    """Another control is clicked before each key, until all of both had their turn."""
    shutil.copy(take, take.with_stem(f"{take.stem}_b"))  # the next one
    page = new_tab(server.address_of(take))
    screen = Screen(page).opened()
    page.keyboard.press("?")
    page.locator(".keys th").first.wait_for()
    assert page.locator(".keys th").all_inner_texts() == list(CHECKS)
    page.keyboard.press("Escape")
    before = screen.state["segments"]
    page.get_by_text("Advanced").click()
    controls = page.locator(CONTROLS)
    n, known = controls.count(), list(CHECKS.items())
    for turn in range(max(n, len(known))):
        page.locator("#tab-segment").click()
        control = controls.nth(turn % n)
        kind = control.evaluate("(control) => `${control.tagName} ${control.ariaLabel}`")
        control.click()
        if kind.startswith("SELECT"):
            page.keyboard.press("Escape")  # the list that opened
        calmed(screen)
        key, check = known[turn % len(known)]
        try:
            check(screen)
        except Exception as error:
            raise AssertionError(f"{key} after a click on {kind}") from error
    assert screen.state["segments"] == before


def test_who_tabs_keeps_the_keys_of_a_control_and_sees_the_focus(page):
    screen = Screen(page)
    speed = page.get_by_label("Speed", exact=True)
    page.locator(".transport button").last.focus()
    speed.focus()
    page.keyboard.press("Tab")
    page.keyboard.press("Shift+Tab")
    assert speed.evaluate("(field) => field === document.activeElement")
    assert speed.evaluate("(field) => getComputedStyle(field).outlineStyle") == "solid"
    page.keyboard.press("ArrowDown")
    screen.wait("k.speed === 2")
    assert screen.state["frame"] == 0


def test_the_wheel_over_a_number_and_letters_in_a_field_change_nothing_else(page):
    screen = Screen(page)
    page.get_by_text("Advanced").click()
    field = page.locator(".parameter input[type=number]").first
    value = field.input_value()
    field.click()
    page.mouse.wheel(0, -240)
    page.wait_for_timeout(300)
    assert field.input_value() == value
    assert screen.state["other"] is None
    page.keyboard.press("n")
    page.keyboard.type("slim kit")  # S, L, I, M, K and Space are keys elsewhere
    assert screen.state["unsent"] == []
    page.keyboard.press("Escape")
    page.wait_for_timeout(100)
    assert screen.state["revision"] == 1
    assert not screen.state["playing"]


def test_an_edit_of_what_is_off_the_screen_shows_it_first(page):
    screen = Screen(page)
    page.keyboard.press("Shift+ArrowRight")
    for _ in range(8):
        page.keyboard.press("+")
    screen.wait("k.range.stop_s - k.range.start_s < 10")
    box = box_of(page.locator(".lanes canvas"))
    page.mouse.move(box["x"] + 300, box["y"] + 60)
    page.keyboard.down("Shift")
    page.mouse.wheel(0, 3000)  # the view goes on, the playhead stays
    page.keyboard.up("Shift")
    screen.wait("k.range.start_s > k.playhead")
    before = screen.state["segments"]
    page.keyboard.press("Delete")
    screen.wait("k.range.start_s <= k.playhead && k.playhead <= k.range.stop_s")
    assert screen.state["segments"] == before
    page.keyboard.press("Delete")
    screen.wait(f"k.segments.length === {len(before) - 1}")


def test_escape_ends_a_drag(page):
    screen = Screen(page)
    before = screen.state["segments"]
    segment = screen.lane("primitive")[3]
    page.mouse.move(*screen.point(segment["start_s"], "primitive"))
    page.mouse.down()
    page.mouse.move(*screen.point(segment["start_s"] + 0.4, "primitive"), steps=3)
    page.keyboard.press("Escape")
    page.mouse.up()
    page.wait_for_timeout(200)
    assert screen.state["segments"] == before
    assert screen.state["unsent"] == []


def test_a_border_dragged_past_its_neighbour_stops_where_both_can_be_seen(page):
    screen = Screen(page)
    before, after = screen.lane("primitive")[2:4]
    screen.drag_border(after, before["start_s"] - 2)
    screen.wait(f"!k.segments.some((row) => row.start_frame === {after['start_frame']})")
    shortest = screen.lane("primitive")[2]
    width = box_of(page.locator(".lanes canvas"))["width"] - 78
    pixels = (shortest["stop_s"] - shortest["start_s"]) / screen.state["duration"] * width
    assert pixels > 5


def test_a_frame_typed_while_playing_is_the_one_that_is_sought(page):
    """The field keeps its draft while the playhead moves on."""
    screen = Screen(page)
    field = page.get_by_label("Frame", exact=True)
    for wanted in (1206, 77, 1800):
        if not screen.state["playing"]:
            page.keyboard.press("Space")
        before = screen.state["frame"]
        screen.wait(f"k.frame > {before} + 20")
        field.select_text()
        for digit in str(wanted):
            page.wait_for_timeout(150)  # several frames are played between two digits
            page.keyboard.press(digit)
        assert field.input_value() == str(wanted)
        page.keyboard.press("Enter")
        screen.wait(f"k.frame >= {wanted} && k.frame < {wanted} + 300")


def test_escape_leaves_the_frame_as_it_was(page):
    screen = Screen(page)
    page.get_by_label("Frame", exact=True).select_text()
    page.keyboard.type("1206")
    page.keyboard.press("Escape")
    page.wait_for_timeout(200)
    assert screen.state["frame"] == 0
    assert page.get_by_label("Frame", exact=True).input_value() == "0"
