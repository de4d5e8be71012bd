"""Three people's labels of a folder, compared in a browser with a few clicks."""

from __future__ import annotations

import pytest

from bundled import copy_of_bundled
from screen import Screen, until
from studio_server import StudioServer

LABELS = "start_s,stop_s,label\n0,{first},walk\n{first},16,squat\n16,48,jump\n"
PEOPLE = {"anna": 6, "ben": 8, "cleo": 6}


@pytest.fixture
def labelled(chromium, tmp_path):
    """A server of two recordings that three people labelled."""
    for _ in range(2):
        take = copy_of_bundled(tmp_path)
        for who, first in PEOPLE.items():
            (tmp_path / who).mkdir(exist_ok=True)
            (tmp_path / who / f"{take.stem}.csv").write_text(LABELS.format(first=first))
    with StudioServer(tmp_path) as running:
        yield running, take


def test_three_people_are_compared_with_two_clicks(labelled, new_tab):
    server, take = labelled
    page = new_tab(server.address_of(take))
    screen = Screen(page).opened()
    page.get_by_role("button", name="Compare…").first.click()
    page.get_by_role("button", name="Compare 3 people").click()
    screen.wait("k.others.length === 3")
    assert screen.state["others"] == ["anna", "ben", "cleo"]
    rows = page.locator(".scores tbody tr")
    agreement = rows.filter(has_text="anna, cleo").locator("td").first
    until(page, lambda: agreement.inner_text() == "1.000", "anna and cleo agree")
    assert 0 < float(rows.filter(has_text="Fleiss").locator("td").first.inner_text()) < 1
    places = page.locator(".differences").first.get_by_role("button")
    until(page, lambda: places.count() == 1, "one place where they differ")
    places.click()
    screen.wait("Math.abs(k.playhead - 6) < 0.05")
    page.get_by_role("button", name="Compare…").first.click()
    page.get_by_role("button", name="uniform", exact=True).click()
    screen.wait("k.other === 'uniform' && k.others.length === 1")
    page.get_by_role("button", name="Stop comparing").click()
    screen.wait("k.others.length === 3")  # theirs come back
    page.get_by_role("button", name="Stop comparing").click()
    screen.wait("k.others.length === 0")
