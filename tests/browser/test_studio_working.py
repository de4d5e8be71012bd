"""Working in the studio: detail, curves, ghosts, many recordings, exports."""

from __future__ import annotations

from screen import Screen


def test_detail_is_a_preview_until_it_is_applied(page):
    screen = Screen(page)
    before = screen.starts("activity")
    page.keyboard.press(",")
    screen.wait("k.other === 'Preview'")
    page.keyboard.press(",")
    assert screen.starts("activity") == before
    page.get_by_role("slider", name="Detail").press("Home")
    page.wait_for_timeout(400)
    page.get_by_role("button", name="Apply").click()
    screen.wait("k.saved !== '' && k.other === null")
    assert set(screen.starts("activity")) < set(before)


def test_curves_lie_under_the_timeline_and_follow_its_zoom(page):
    screen = Screen(page)
    page.keyboard.press("g")
    curves = page.locator(".channels canvas")
    page.wait_for_timeout(500)
    whole = curves.screenshot()
    page.keyboard.press("z")
    page.wait_for_timeout(300)
    assert curves.screenshot() != whole
    edge = page.get_by_role("separator", name="Size of curves")
    tall = curves.bounding_box()["height"]
    edge.press("ArrowUp")
    screen.wait("true")
    assert curves.bounding_box()["height"] == tall + 16
