"""The report as people open it: from a file, in a real browser without a graphics card."""

from __future__ import annotations

import hashlib
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import kineme
from kineme.datasets import bundled_recording
from kineme.report.page import write_report
from screen import box_of, until

sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")

CHROMIUM = os.environ.get("KINEME_CHROMIUM") or shutil.which("chromium")
SOFTWARE = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
PLACES = {"viewer": ".viewer canvas", "lanes": ".lanes", "matrix": ".matrix-square"}

pytestmark = pytest.mark.skipif(not CHROMIUM, reason="no chromium on this machine")


class Page:
    """A report that is open, what the browser complained of and what it asked the network for."""

    def __init__(self, tab: Any, file: Path) -> None:
        self.tab = tab
        self.complaints: list[str] = []
        self.requests: list[str] = []
        tab.on("console", self._heard)
        tab.on("pageerror", lambda error: self.complaints.append(str(error)))
        tab.on("request", lambda request: self.requests.append(request.url))
        tab.goto(file.as_uri())
        self.wait("s?.hasMotion")

    def state(self) -> Any:
        return self.tab.evaluate("window.kineme")

    def wait(self, condition: str) -> None:
        """Until a condition on the state, called ``s``, holds.

        Asked from here: what would ask inside the page is barred by the page's own policy.
        """
        question = f"(() => {{ const s = window.kineme; return Boolean({condition}); }})()"
        until(self.tab, lambda: self.tab.evaluate(question), condition)

    def pictures(self) -> dict[str, str]:
        """A digest of what is seen in each place, once nothing moves any more."""
        before: dict[str, str] = {}
        for _ in range(40):
            now = {name: self._digest(place) for name, place in PLACES.items()}
            if now == before:
                return now
            before = now
            self.tab.wait_for_timeout(250)
        raise AssertionError("the page does not come to rest")

    def _digest(self, place: str) -> str:
        picture = self.tab.locator(place).first.screenshot()
        return hashlib.sha256(picture).hexdigest()

    def _heard(self, message: Any) -> None:
        if message.type in {"error", "warning"}:
            self.complaints.append(message.text)


@pytest.fixture(scope="module")
def segmentation() -> kineme.Segmentation:
    return kineme.segment(kineme.read(bundled_recording()))


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory, segmentation: kineme.Segmentation) -> Path:
    path = tmp_path_factory.mktemp("report") / "exercises.html"
    write_report(kineme.read(bundled_recording()), segmentation, path)
    return path


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    sandbox = [] if os.geteuid() else ["--no-sandbox"]  # chromium refuses to be root with one
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=[*SOFTWARE, *sandbox])
        yield browser
        browser.close()


@pytest.fixture
def open_report(browser: Any, file: Path) -> Iterator[Callable[..., Page]]:
    contexts = []

    def open_in(width: int = 1280, height: int = 720, scheme: str = "light") -> Page:
        size = {"width": width, "height": height}
        contexts.append(browser.new_context(viewport=size, color_scheme=scheme))
        return Page(contexts[-1].new_page(), file)

    yield open_in
    for context in contexts:
        context.close()


def test_it_opens_from_a_file_and_asks_nobody_for_anything(
    open_report: Callable[..., Page], file: Path, segmentation: kineme.Segmentation
) -> None:
    page = open_report()
    page.pictures()
    assert [url for url in page.requests if not url.startswith("data:")] == [file.as_uri()]
    assert page.complaints == []
    assert page.state()["name"] == "exercises.bvh"
    assert page.state()["n_segments"] == len(segmentation.table)
    rows = page.tab.locator(".clusters tbody tr")
    assert rows.count() == len(segmentation.repetitions())
    counts = [int(text) for text in page.tab.locator(".clusters .count").all_inner_texts()]
    assert counts == list(segmentation.repetitions().values())


def test_playing_moves_the_playhead_and_the_figure(open_report: Callable[..., Page]) -> None:
    page = open_report()
    before = page.pictures()
    page.tab.get_by_role("button", name="Play", exact=True).click()
    page.wait("s.playing && s.playhead > 0.4")
    page.tab.get_by_role("button", name="Pause").click()
    stopped = page.state()
    after = page.pictures()
    assert page.state()["playhead"] == stopped["playhead"]
    assert stopped["frame"] == int(stopped["playhead"] * 60 + 1e-6)
    assert all(after[place] != before[place] for place in PLACES)


def test_a_click_on_a_primitive_moves_everything(
    open_report: Callable[..., Page], segmentation: kineme.Segmentation
) -> None:
    page = open_report()
    before = page.pictures()
    row = next(row for row in segmentation.primitives if row.cluster >= 0 and row.start_s > 20)
    click_in_lanes(page, (row.start_s + row.stop_s) / 2)
    page.wait("s.selection !== null")
    state = page.state()
    assert state["selection"] == {"level": "primitive", "start_frame": row.start_frame}
    assert state["frame"] == row.start_frame
    assert state["cluster"] == row.cluster
    after = page.pictures()
    assert all(after[place] != before[place] for place in PLACES)
    pressed = page.tab.locator(".clusters tr.shown").inner_text()
    assert f"cluster {row.cluster}" in pressed


def test_a_click_in_the_matrix_goes_there(
    open_report: Callable[..., Page], segmentation: kineme.Segmentation
) -> None:
    page = open_report()
    before = page.pictures()
    box = box_of(page.tab.locator(".matrix-square canvas"))
    page.tab.mouse.click(box["x"] + 9 + 0.75 * (box["width"] - 9), box["y"] + 0.3 * box["height"])
    page.wait("s.selection !== null")
    state = page.state()
    assert state["playhead"] == pytest.approx(0.75 * state["duration"], abs=0.5)
    rows = segmentation.primitives
    here = next(row for row in rows if row.start_frame <= state["frame"] < row.stop_frame)
    assert state["selection"]["start_frame"] == here.start_frame
    assert page.pictures()["lanes"] != before["lanes"]


def test_the_keyboard_is_enough(
    open_report: Callable[..., Page], segmentation: kineme.Segmentation
) -> None:
    page = open_report()
    press = page.tab.keyboard.press
    press("ArrowRight")
    assert page.state()["frame"] == 1
    press("Shift+ArrowRight")
    second = segmentation.primitives[1]
    assert page.state()["selection"]["start_frame"] == second.start_frame
    press("l")
    assert page.state()["loop"]["start_s"] == pytest.approx(second.start_s)
    press("Space")
    page.wait("s.playing")
    page.tab.wait_for_timeout(int(1500 * (second.stop_s - second.start_s)))
    assert second.start_s <= page.state()["playhead"] <= second.stop_s
    press("Space")
    press("+")
    assert page.state()["range"]["stop_s"] < page.state()["duration"]
    press("0")
    press("End")
    assert page.state()["playhead"] == pytest.approx(page.state()["duration"])
    press("Home")
    assert page.state()["playhead"] == 0


def test_members_of_a_cluster_play_in_step(open_report: Callable[..., Page]) -> None:
    page = open_report()
    page.tab.locator(".clusters tbody tr").nth(1).click()
    alone = page.pictures()["viewer"]
    page.tab.get_by_role("button", name="In step").click()
    together = page.pictures()["viewer"]
    assert page.state()["inStep"]
    assert together != alone
    page.tab.keyboard.press("ArrowRight")
    assert page.pictures()["viewer"] != together
    assert page.complaints == []


@pytest.mark.parametrize("size", [(1280, 720), (1024, 768)])
@pytest.mark.parametrize("scheme", ["dark", "light"])
def test_everything_is_in_view(
    open_report: Callable[..., Page], size: tuple[int, int], scheme: str
) -> None:
    page = open_report(*size, scheme)
    overflow = "[document.documentElement.scrollWidth, document.documentElement.scrollHeight]"
    until(page.tab, lambda: page.tab.evaluate(overflow) == list(size), "all of it in the window")
    for place in [*PLACES.values(), ".clusters", ".curves canvas", ".transport"]:
        box = box_of(page.tab.locator(place).first)
        assert box["width"] > 60
        assert box["height"] > 25
        assert box["x"] + box["width"] <= size[0] + 1
        assert box["y"] + box["height"] <= size[1] + 1
    theme = "document.documentElement.dataset.theme"
    assert page.tab.evaluate(theme) == scheme
    page.tab.get_by_role("button", name="Show the page").click()
    until(page.tab, lambda: page.tab.evaluate(theme) != scheme, "the other theme")


def click_in_lanes(page: Page, seconds: float) -> None:
    """A click on the lane of primitives."""
    box = box_of(page.tab.locator(".lanes canvas"))
    gutter = 78
    x = gutter + seconds / page.state()["duration"] * (box["width"] - gutter)
    page.tab.mouse.click(box["x"] + x, box["y"] + 0.55 * box["height"])
