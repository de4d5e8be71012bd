"""The report opened from the disk, as somebody would who got it by mail."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import kineme
from kineme.datasets import bundled_recording
from kineme.report.page import write_report
from screen import Screen

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
def segments() -> kineme.Segmentation:
    """Those of the bundled recording, each called something nasty."""
    found = kineme.segment(kineme.read(bundled_recording()))
    columns = dict(found.table.columns())
    columns["label"] = np.full(len(found), NASTY)
    return kineme.Segmentation.from_columns(
        columns, n_frames=found.n_frames, fps=found.fps, provenance=found.provenance
    )


def test_it_plays_without_a_network(chromium, segments, tmp_path: Path) -> None:
    path = tmp_path / "report <b>&.html"
    write_report(kineme.read(bundled_recording()), segments, path, name=NASTY)
    context = chromium.new_context(viewport={"width": 1280, "height": 720}, offline=True)
    page = context.new_page()
    said: list[str] = []
    asked: list[str] = []
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.on("dialog", lambda dialog: said.append(dialog.message))
    page.on("request", lambda request: asked.append(request.url))
    page.goto(path.as_uri())
    screen = Screen(page).opened()
    before = screen.pixels()
    page.keyboard.press("Space")
    screen.wait("k.playhead > 0.3")
    page.keyboard.press("Space")
    screen.wait("!k.playing")
    screen.changed(before, *before)
    shown = screen.state
    page.emulate_media(color_scheme="dark")
    printed = page.evaluate(MEAN_RED)
    assert page.locator("img").count() == 0
    context.close()
    assert said == []
    assert [url for url in asked if not url.startswith(("file:", "data:", "blob:"))] == []
    assert sum(url.startswith("file:") for url in asked) == 1
    assert shown["name"] == NASTY
    assert shown["n_segments"] == len(segments)
    assert printed > 200  # light, though the screen is dark


def test_the_studio_prints_what_the_report_does(page, take) -> None:
    page.emulate_media(media="print")
    shown = {
        place: page.locator(place).first.is_visible()
        for place in (".viewer", ".place-timeline", ".paper .repetitions", ".place-left", ".video")
    }
    buttons = page.get_by_role("button").all()
    assert [button.inner_text() for button in buttons if button.is_visible()] == []
    assert [place for place, is_shown in shown.items() if is_shown] == [
        ".viewer",
        ".place-timeline",
        ".paper .repetitions",
    ]


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_printed_figure_is_the_one_on_the_screen(chromium, segments, tmp_path, scheme) -> None:
    path = tmp_path / "report.html"
    write_report(kineme.read(bundled_recording()), segments, path)
    page = chromium.new_page(color_scheme=scheme)
    page.goto(path.as_uri())
    Screen(page).opened()
    page.wait_for_timeout(1500)  # the picture rests: what it was drawn into is gone
    mean, shades = page.evaluate(PRINTED_FIGURE)
    page.close()
    assert mean > 150  # light, as paper is
    assert shades > 30


def test_signals_have_no_figure_but_lanes_and_matrix(chromium, tmp_path: Path) -> None:
    times = np.arange(3000) / 50
    values = np.column_stack([np.sin(6 * times), np.cos(6 * times)])
    signals = kineme.Signals(values, 50.0)
    write_report(signals, kineme.segment(signals), tmp_path / "signals.html", name="wrist")
    page = chromium.new_page()
    said: list[str] = []
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.goto((tmp_path / "signals.html").as_uri())
    screen = Screen(page)
    screen.wait("k?.n_segments > 0")
    shown = screen.state
    page.wait_for_timeout(500)
    page.close()
    assert said == []
    assert (shown["hasMotion"], shown["name"], shown["duration"]) == (False, "wrist", 60)
