"""The report opened from the disk, as somebody would who got it by mail."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import kineme
from kineme.datasets import bundled_recording
from kineme.report.page import write_report
from screen import DESKTOP, Screen, box_of

MEAN_RED = """() => {
    dispatchEvent(new Event("beforeprint"));
    const canvas = document.querySelector(".matrix canvas");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    dispatchEvent(new Event("afterprint"));
    return data.reduce((sum, value, i) => sum + (i % 4 ? 0 : value), 0) / (data.length / 4);
}"""
PRINTED_FIGURE = """async () => {
    dispatchEvent(new Event("beforeprint"));
    const figure = document.querySelector("img.on-paper");
    await figure.decode();
    const pen = new OffscreenCanvas(figure.width, figure.height).getContext("2d");
    pen.drawImage(figure, 0, 0, figure.width, figure.height);
    dispatchEvent(new Event("afterprint"));
    const { data } = pen.getImageData(0, 0, figure.width, figure.height);
    const seen = [...data].filter((_, i) => i % 4 < 3);
    return [seen.reduce((sum, value) => sum + value, 0) / seen.length, new Set(seen).size];
}"""
NASTY = "</script><img src=x onerror=alert(1)><b>squat</b>"


@pytest.fixture(scope="module")
def segmentation() -> kineme.Segmentation:
    return kineme.segment(kineme.read(bundled_recording()))


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory, segmentation: kineme.Segmentation) -> Path:
    path = tmp_path_factory.mktemp("report") / "exercises.html"
    write_report(kineme.read(bundled_recording()), segmentation, path)
    return path


@pytest.fixture
def open_report(chromium: Any, file: Path) -> Iterator[Callable[..., Screen]]:
    """Opens a report in a tab, without a network; the test fails if the page complains."""
    contexts, complaints, asked = [], [], []

    def heard(message: Any) -> None:
        driver = "GL Driver Message" in message.text  # how fast it is in software
        if message.type in {"error", "warning"} and not driver:
            complaints.append(message.text)

    def open_in(path: Path = file, size: dict[str, int] = DESKTOP, scheme: str = "light") -> Screen:
        contexts.append(chromium.new_context(viewport=size, color_scheme=scheme, offline=True))
        tab = contexts[-1].new_page()
        tab.on("console", heard)
        tab.on("pageerror", lambda error: complaints.append(str(error)))
        tab.on("dialog", lambda dialog: complaints.append(dialog.message))
        tab.on("request", lambda request: asked.append(request.url))
        tab.goto(path.as_uri())
        return Screen(tab)

    yield open_in
    for context in contexts:
        context.close()
    assert complaints == []
    assert [url for url in asked if not url.startswith(("file:", "data:", "blob:"))] == []
    assert sum(url.startswith("file:") for url in asked) == len(contexts)


def test_it_shows_what_was_found_and_plays(
    open_report: Callable[..., Screen], segmentation: kineme.Segmentation
) -> None:
    screen = open_report().opened()
    page, before = screen.page, screen.pixels()
    assert screen.state["name"] == "exercises.bvh"
    assert screen.state["n_segments"] == len(segmentation.table)
    counts = [int(text) for text in page.locator(".clusters .count").all_inner_texts()]
    assert counts == list(segmentation.repetitions().values())
    page.get_by_role("button", name="Play", exact=True).click()
    screen.wait("k.playing && k.playhead > 0.3")
    page.get_by_role("button", name="Pause").click()
    stopped = screen.state
    screen.changed(before, *before)
    assert screen.state["playhead"] == stopped["playhead"]
    assert stopped["frame"] == int(stopped["playhead"] * 60 + 1e-6)


def test_names_are_text_and_nothing_else(
    open_report: Callable[..., Screen], segmentation: kineme.Segmentation, tmp_path: Path
) -> None:
    columns = {**segmentation.table.columns(), "label": np.full(len(segmentation), NASTY)}
    named = kineme.Segmentation.from_columns(
        columns,
        n_frames=segmentation.n_frames,
        fps=segmentation.fps,
        provenance=segmentation.provenance,
    )
    path = tmp_path / "report <b>&.html"
    write_report(kineme.read(bundled_recording()), named, path, name=NASTY)
    screen = open_report(path).opened()
    assert screen.page.locator("img").count() == 0
    assert screen.state["name"] == NASTY
    assert screen.state["n_segments"] == len(segmentation)


def test_the_studio_prints_what_the_report_does(page, take) -> None:
    page.emulate_media(media="print")
    for place in (".viewer", ".place-timeline", ".paper .repetitions"):
        page.locator(place).first.wait_for(state="visible")
    for place in (".place-left", ".video"):
        page.locator(place).first.wait_for(state="hidden")
    buttons = page.get_by_role("button").all()
    assert [button.inner_text() for button in buttons if button.is_visible()] == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_what_is_printed_is_light_and_shows_the_figure(
    open_report: Callable[..., Screen], scheme: str
) -> None:
    page = open_report(scheme=scheme).opened().page
    page.wait_for_timeout(1500)  # the picture rests: what it was drawn into is gone
    mean, shades = page.evaluate(PRINTED_FIGURE)
    assert mean > 150  # light, as paper is
    assert shades > 30
    assert page.evaluate(MEAN_RED) > 200


def test_signals_have_no_figure_but_lanes_and_matrix(
    open_report: Callable[..., Screen], tmp_path: Path
) -> None:
    times = np.arange(3000) / 50
    values = np.column_stack([np.sin(6 * times), np.cos(6 * times)])
    signals = kineme.Signals(values, 50.0)
    write_report(signals, kineme.segment(signals), tmp_path / "signals.html", name="wrist")
    screen = open_report(tmp_path / "signals.html")
    screen.wait("k?.n_segments > 0")
    screen.drawn()
    shown = screen.state
    assert (shown["hasMotion"], shown["name"], shown["duration"]) == (False, "wrist", 60)


def test_a_click_in_the_matrix_goes_there(
    open_report: Callable[..., Screen], segmentation: kineme.Segmentation
) -> None:
    screen = open_report().opened()
    before = screen.pixels()
    box = box_of(screen.page.locator(".matrix-square canvas"))
    screen.page.mouse.click(
        box["x"] + 9 + 0.75 * (box["width"] - 9), box["y"] + 0.3 * box["height"]
    )
    screen.wait("k.selection !== null")
    state = screen.state
    assert state["playhead"] == pytest.approx(0.75 * state["duration"], abs=0.5)
    rows = segmentation.primitives
    here = next(row for row in rows if row.start_frame <= state["frame"] < row.stop_frame)
    assert state["selection"]["start_frame"] == here.start_frame
    screen.changed(before, "lanes")
