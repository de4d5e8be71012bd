"""The studio in a tab, as a person uses it: what it shows, and where to put the pointer."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

DESKTOP = {"width": 1280, "height": 720}
GUTTER, RULER, GAP = 78, 22, 4  # pixels of the timeline, as in its lanes.ts
SHARES = {"activity": 1.0, "primitive": 1.2, "label": 0.7}
PATIENCE = 180.0  # seconds: until then a slow machine may be at work yet, then something hangs
NEXT_FRAME = "new Promise((done) => requestAnimationFrame(done))"
PLACES = {"figure": ".place-viewer", "lanes": ".place-timeline", "matrix": ".place-matrix"}


class Screen:
    def __init__(self, page: Any):
        self.page = page
        self._line: Any = None  # to the browser's network

    @property
    def state(self) -> dict[str, Any]:
        """What the page says it shows."""
        return self.page.evaluate("window.kineme")

    def wait(self, condition: str) -> None:
        """Until a condition on its state ``k`` holds.

        Asked from outside: the page's policy bars what Playwright would do inside.
        """
        question = f"(() => {{ const k = window.kineme; return Boolean({condition}); }})()"
        until(self.page, lambda: self.page.evaluate(question), condition)

    def opened(self) -> Screen:
        """The same, once a recording is there, segmented and drawn."""
        self.wait("k?.hasMotion && !k.finding")
        self.drawn()
        return self

    def drawn(self) -> None:
        """Until what the state says is seen, too."""
        for _ in range(2):  # lanes and figure are drawn in one picture, measured in the next
            self.page.evaluate(NEXT_FRAME)

    def previewed(self) -> None:
        """Until the preview of the last choice is there, and the panel is not drawn anew."""
        self.wait("k.other === 'Preview'")
        self.page.locator(".preset-panel:not([aria-busy=true])").wait_for()

    def lane(self, level: str) -> list[dict[str, Any]]:
        return [row for row in self.state["segments"] if row["level"] == level]

    def starts(self, level: str = "primitive") -> list[int]:
        return [row["start_frame"] for row in self.lane(level)]

    def labels(self, level: str = "primitive") -> list[str]:
        return [row["label"] for row in self.lane(level)]

    def pixels(self) -> dict[str, bytes]:
        """What figure, lanes and matrix look like."""
        return {name: self.page.locator(place).screenshot() for name, place in PLACES.items()}

    def changed(self, before: dict[str, bytes], *names: str) -> None:
        """Until these places look different."""
        for name in names:
            place = self.page.locator(PLACES[name])
            until(
                self.page,
                lambda place=place, was=before[name]: place.screenshot() != was,
                f"another picture of {name}",
            )

    def point(self, seconds: float, level: str) -> tuple[float, float]:
        """Where a moment is on a lane, while all of the recording is shown."""
        box = box_of(self.page.locator(".lanes canvas"))
        duration = self.lane(level)[-1]["stop_s"]
        room = (box["height"] - RULER - GAP * len(SHARES)) / sum(SHARES.values())
        top = RULER
        for name, share in SHARES.items():
            height = min(room * share, 44 * share)
            if name == level:
                break
            top += height + GAP
        x = box["x"] + GUTTER + seconds / duration * (box["width"] - GUTTER)
        return x, box["y"] + top + height / 2

    def click(self, segment: dict[str, Any]) -> None:
        """The middle of a segment."""
        middle = (segment["start_s"] + segment["stop_s"]) / 2
        self.page.mouse.click(*self.point(middle, segment["level"]))

    def name_segment(self, label: str) -> None:
        """Name the segment at the playhead, with the keyboard."""
        self.page.keyboard.press("n")
        self.page.keyboard.type(label)
        self.page.keyboard.press("Enter")

    def drag_border(self, segment: dict[str, Any], seconds: float) -> None:
        """The start of a segment, to another moment."""
        mouse = self.page.mouse
        mouse.move(*self.point(segment["start_s"], segment["level"]))
        mouse.down()
        mouse.move(*self.point(seconds, segment["level"]), steps=4)
        mouse.up()

    def saved(self) -> None:
        """Until the server has confirmed everything."""
        self.wait("k.unsent.length === 0 && k.saved !== ''")

    def slow_down(self, milliseconds: float) -> None:
        """Let every answer to the page take so much longer, from now on."""
        if self._line is None:
            self._line = self.page.context.new_cdp_session(self.page)
            self._line.send("Network.enable")
        unlimited = {"downloadThroughput": -1, "uploadThroughput": -1, "offline": False}
        conditions = {"latency": milliseconds, **unlimited}
        self._line.send("Network.emulateNetworkConditions", conditions)


def until(
    page: Any, holds: Callable[[], Any], what: str = "what was to be", seconds: float | None = None
) -> None:
    """Until a question has yes for an answer; TimeoutError, which says what was waited for."""
    seconds = PATIENCE if seconds is None else seconds
    deadline = time.monotonic() + seconds
    while not holds():
        if time.monotonic() > deadline:
            raise TimeoutError(f"not within {seconds} s: {what}")
        page.wait_for_timeout(20)


def box_of(place: Any) -> dict[str, float]:
    """Where something is, in pixels, once it is seen and does not move.

    A panel that is drawn anew has no place meanwhile, or another one a frame later.
    """
    boxes: list[Any] = [None]

    def rests() -> bool:
        place.page.evaluate(NEXT_FRAME)
        boxes.append(place.bounding_box())
        return boxes[-1] is not None and boxes[-1] == boxes[-2]

    until(place.page, rests, f"{place} at rest")
    return boxes[-1]


def picture_of(place: Any) -> bytes:
    """What something looks like once it does not change any more."""
    pictures = [place.screenshot()]

    def rests() -> bool:
        place.page.evaluate(NEXT_FRAME)
        pictures.append(place.screenshot())
        return pictures[-1] == pictures[-2]

    until(place.page, rests, f"{place} at rest")
    return pictures[-1]


def two_tabs(new_tab: Any, address: str) -> tuple[Screen, Screen]:
    """The same recording in two tabs, of which the second hears nothing of the server's news."""
    first = Screen(new_tab(address))
    late = new_tab("about:blank")
    late.route("**/api/events*", lambda route: route.abort())
    late.goto(address)
    return first, Screen(late)
