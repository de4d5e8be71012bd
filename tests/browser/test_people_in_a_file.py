"""Two people in one file, in a browser: seen together, corrected each by themselves."""

from __future__ import annotations

from pathlib import Path

import pytest

import kineme
from people_files import write_people
from screen import Screen
from studio_server import StudioServer


@pytest.mark.slow
def test_two_people_are_corrected_side_by_side(new_tab, tmp_path: Path) -> None:
    write_people(tmp_path / "duet.trc", {"Anna": 0, "Bob": 300})
    anna, bob = (tmp_path / f"duet_{who}.segments.json" for who in ("Anna", "Bob"))
    with StudioServer(tmp_path) as server:
        page = new_tab(server.address)
        page.get_by_text("2 people are in duet.trc").wait_for()
        page.get_by_role("button", name="All 2 people").click()
        screen = Screen(page)
        screen.wait("k?.recordings.length === 2 && k.name === 'duet.trc · Anna' && k.hasMotion")
        page.locator(".caption p").nth(1).wait_for()
        assert [each.split()[0] for each in page.locator(".caption p").all_inner_texts()] == [
            "Anna",
            "Bob",
        ]
        page.locator(".name-tags span").nth(1).wait_for()
        assert page.locator(".name-tags span").all_inner_texts() == ["Anna", "Bob"]

        def call(name: str) -> None:
            """Name the segment at the playhead."""
            page.locator(".place-viewer canvas").click(position={"x": 5, "y": 300})
            screen.name_segment(name)
            screen.wait(
                f"k.unsent.length === 0 && k.segments.some((row) => row.label === '{name}')"
            )

        screen.opened()
        call("of Anna")
        before = screen.lane("activity")
        box = page.locator(".lanes canvas").bounding_box()
        page.mouse.click(box["x"] + 20, box["y"] + box["height"] - 40)  # the other's name
        screen.wait("k.name === 'duet.trc · Bob' && !k.finding")
        assert screen.lane("activity") != before
        assert "of Anna" not in screen.labels()
        call("of Bob")
        page.keyboard.press("Control+z")
        screen.wait("k.unsent.length === 0 && !k.segments.some((row) => row.label)")
        call("Bob again")
        page.reload()
        screen.wait("k?.recordings.length === 2 && k.hasMotion")
        page.locator("button.recording", has_text="Anna").click()
        screen.wait("k.name === 'duet.trc · Anna' && k.saved === 'duet_Anna.segments.json'")
        assert {*screen.labels()} == {"of Anna", ""}
        page.locator("button.recording", has_text="Bob").click()
        screen.wait("k.name === 'duet.trc · Bob' && k.saved === 'duet_Bob.segments.json'")
        assert {*screen.labels()} == {"Bob again", ""}
    for path, name in ((anna, "of Anna"), (bob, "Bob again")):
        assert {*kineme.read_segments(path).primitives.label} == {name, ""}
