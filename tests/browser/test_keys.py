"""Keys do what the page says, whatever was clicked before; what is typed stays typed."""

from __future__ import annotations

from screen import Screen

BUTTONS = ("Follow", "Trails", "Reset view", "Play", "One frame on", "Show all", "Zoom in")
"""Controls that change no table; the figure and the lanes are clicked, too."""


def plays(screen: Screen) -> bool:
    """Whether Space plays and pauses, and arrows, Home, End and letters do what they should."""
    keys = screen.page.keyboard
    if screen.state["playing"]:
        keys.press("Space")
    keys.press("Home")
    screen.wait("k.frame === 0 && !k.playing")
    keys.press("ArrowRight")
    keys.press("ArrowRight")
    screen.wait("k.frame === 2")
    keys.press("ArrowLeft")
    screen.wait("k.frame === 1")
    keys.press("End")
    screen.wait("k.playhead === k.duration")
    keys.press("Home")
    keys.press("Space")
    screen.wait("k.playing")
    keys.press("Space")
    screen.wait("!k.playing")
    keys.press("l")
    screen.wait("k.loop !== null")
    keys.press("l")
    screen.wait("k.loop === null")
    keys.press("Home")  # where what is shown of the segment is the same each time
    screen.wait("k.frame === 0")
    return True


def test_keys_are_the_players_after_each_control_was_clicked(page):
    screen = Screen(page)
    before = screen.state
    for name in BUTTONS:
        page.get_by_role("button", name=name, exact=True).first.click()
        assert plays(screen), name
    for place in (".viewer canvas", ".matrix canvas"):
        page.locator(place).click()
        assert plays(screen), place
    for tab in ("table", "review", "clusters", "compare", "about", "segment"):
        page.locator(f"#tab-{tab}").click()
        assert plays(screen), tab
    for label in ("Speed", "Cluster of the segment"):
        chosen = page.get_by_label(label, exact=True)
        value = chosen.input_value()
        chosen.focus()
        page.mouse.move(5, 5)
        chosen.click()
        page.keyboard.press("Escape")  # the list that opened
        assert plays(screen), label
        assert chosen.input_value() == value
    slider = page.locator(".parameter input[type=range]").first
    value = slider.input_value()
    box = slider.bounding_box()
    page.mouse.click(box["x"] + 3 + 0.5 * box["width"], box["y"] + box["height"] / 2)
    moved = slider.input_value()
    assert plays(screen)
    assert slider.input_value() == moved
    assert screen.state["segments"] == before["segments"]
    assert screen.state["revision"] == before["revision"]


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
    box = page.locator(".lanes canvas").bounding_box()
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
    width = page.locator(".lanes canvas").bounding_box()["width"] - 78
    pixels = (shortest["stop_s"] - shortest["start_s"]) / screen.state["duration"] * width
    assert pixels > 5
