"""What a pointer does to narrow segments and beside borders."""

from __future__ import annotations

import pytest

from bundled import write_repeated
from screen import Screen


@pytest.mark.slow
def test_every_segment_of_a_long_take_can_be_clicked(new_tab, server):
    take = write_repeated(server.folder / "long_take.bvh", 180 * 60)
    screen = Screen(new_tab(server.address_of(take))).opened()
    rows = screen.lane("primitive")
    start, stop = (screen.point(at, "primitive")[0] for at in (0, screen.state["duration"]))
    pixels = (stop - start) / screen.state["duration"]
    narrow = [row for row in rows if 3 < pixels * (row["stop_s"] - row["start_s"]) < 10]
    assert len(narrow) > 20  # that are narrower than the grips of both borders
    for row in narrow[:30]:
        screen.click(row)
        screen.wait(f"k.selected?.start_frame === {row['start_frame']}")
    assert screen.lane("primitive") == rows


def test_a_press_beside_a_border_selects_and_a_drag_goes_as_far_as_the_pointer(page):
    screen = Screen(page)
    rows = screen.lane("primitive")
    widest = max(rows[1:], key=lambda row: row["stop_s"] - row["start_s"])
    mouse = page.mouse
    x, y = screen.point(widest["start_s"], "primitive")
    mouse.move(x + 4, y)
    mouse.down()
    mouse.move(x + 5, y)
    mouse.up()
    screen.wait(f"k.selected?.start_frame === {widest['start_frame']}")
    assert screen.lane("primitive") == rows
    assert screen.state["unsent"] == []
    mouse.move(x + 4, y)
    mouse.down()
    mouse.move(x + 20, y, steps=4)
    mouse.up()
    screen.saved()
    room = screen.point(screen.state["duration"], "primitive")[0] - screen.point(0, "primitive")[0]
    frames = screen.state["duration"] * 60 / room * 16  # of the pixels that the pointer went
    moved = next(row for row in screen.lane("primitive") if row["stop_s"] == widest["stop_s"])
    assert abs(moved["start_frame"] - widest["start_frame"] - frames) <= 1
