"""Take the pictures of the report and the studio, with the bundled recording.

    python docs/make_screenshots.py

Needs Chromium, and the packages of the ``test`` extra.
"""

from __future__ import annotations

import io
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image
from playwright.sync_api import Page, sync_playwright

import kineme
from kineme._util.files import atomic_write
from kineme.datasets import Action, bundled_truth, synthesize
from kineme.recordings import Skeleton
from kineme.recordings.operations import move, turn
from kineme.report.sessions import write_sessions

IMAGES = Path(__file__).parent / "images"
SIZE = {"width": 1280, "height": 720}
SHEET = {"width": 740, "height": 960}
DRAWN_IN_SOFTWARE = [
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
]
NAMES = ("walk", "squat", "arm circles", "jump", "run", "kick")  # of clusters 0 to 5
LIBRARY_NAMES = ("walk", "squat", "arm circles", "kick", "jump", "run")
STILL = 1500  # milliseconds until trails, tiles and curves are drawn


def main() -> None:
    chromium = os.environ.get("KINEME_CHROMIUM") or shutil.which("chromium")
    with tempfile.TemporaryDirectory() as name, sync_playwright() as driver:
        folder = Path(name)
        shutil.copy(kineme.bundled_recording(), folder)
        kineme.write_segments(kineme.read_segments(bundled_truth()), folder / "truth.csv")
        browser = driver.chromium.launch(executable_path=chromium, args=DRAWN_IN_SOFTWARE)
        with studio(folder) as address:
            draw_studio(browser.new_page(viewport=SIZE, color_scheme="dark"), address)
        people = folder / "people"
        people.mkdir()
        write_people(people / "duet.trc")
        with studio(people) as address:
            draw_people(browser.new_page(viewport=SIZE, color_scheme="dark"), address)
        library = folder / "library"
        kineme.library.build(kineme.bundled_recording(), library)
        with studio(library) as address:
            draw_library(browser.new_page(viewport=SIZE, color_scheme="light"), address)
        draw_report(browser.new_page(viewport=SIZE, color_scheme="light"), folder)
        draw_sheet(browser.new_page(viewport=SHEET), folder)
        browser.close()


def draw_studio(page: Page, address: str) -> None:
    page.goto(address)
    page.get_by_role("tab", name="Clusters").click()
    for cluster, name in enumerate(NAMES):
        page.locator(".cluster-name").nth(cluster).dblclick()
        page.keyboard.type(name)
        page.keyboard.press("Enter")
    page.get_by_text("saved as").wait_for()
    page.locator(".cluster-name", has_text="jump").click()
    go_on(page, 62)
    save(page, "studio")

    page.get_by_role("button", name="In step").click()
    save(page, "studio-in-step")
    page.get_by_role("button", name="In step").click()

    page.keyboard.press("c")
    page.get_by_role("button", name="truth.csv").click()
    page.get_by_text("Stop comparing").wait_for()
    save(page, "studio-compare")


def write_people(path: Path) -> None:
    """Markers of two people: one squats, the other jumps, facing each other."""
    actions = {
        "Anna": [Action("squat", 4), Action("arm circles", 6)],
        "Bob": [Action("jump", 7), Action("squat", 4)],
    }
    made = [synthesize(each, fps=60, seed=7).motion for each in actions.values()]
    n = min(motion.n_frames for motion in made)
    places = [
        move(turn(motion[:n], angle), (0, 0, far)).positions
        for motion, angle, far in zip(made, (0, np.pi), (-0.9, 0.9), strict=True)
    ]
    names = tuple(
        f"{who}:{joint}"
        for who, motion in zip(actions, made, strict=True)
        for joint in motion.skeleton.names
    )
    skeleton = Skeleton(names, (-1,) * len(names), np.zeros((len(names), 3)))
    kineme.write(kineme.Motion(skeleton, np.concatenate(places, axis=1), 60), path)


def draw_people(page: Page, address: str) -> None:
    page.goto(address)
    page.get_by_role("button", name="All 2 people").click()
    page.locator(".name-tags span").nth(1).wait_for()
    go_on(page, 130)
    save(page, "studio-people")


def draw_library(page: Page, address: str) -> None:
    page.goto(address)
    for cluster, name in enumerate(LIBRARY_NAMES):
        page.get_by_label(f"Name of cluster {cluster}", exact=True).fill(name)
        page.keyboard.press("Enter")
        page.get_by_role("button", name=f"Find more like this: {name}").wait_for()
    save(page, "studio-library")
    page.get_by_role("button", name="Find more like this: walk").click()
    page.locator(".hit .figure[data-drawn=true]").first.wait_for()
    page.locator(".hit").first.focus()
    for key in "yyn":
        page.keyboard.press(key)
    save(page, "studio-library-search")


def draw_report(page: Page, folder: Path) -> None:
    recording = kineme.read(folder / kineme.bundled_recording().name)
    segments = kineme.read_segments(folder / "exercises.segments.json")
    report = folder / "exercises.html"
    kineme.write_report(recording, segments, report)
    page.goto(report.as_uri())
    page.locator(".cluster-name", has_text="kick").click()
    go_on(page, 50)
    save(page, "report")


def draw_sheet(page: Page, folder: Path) -> None:
    """Eight squats before and after, as the page on cycles has them."""
    sessions = []
    for amplitude, seed in ((1.0, 3), (0.8, 4)):
        made = synthesize([Action("squat", 8, amplitude=amplitude)], fps=100, seed=seed)
        sessions.append(kineme.cycles(made.motion, made.truth))
    sheet = folder / "changed.html"
    write_sessions(sessions[0], sessions[1], sheet, names=("before", "after"))
    page.goto(sheet.as_uri())
    save(page, "sessions")


def go_on(page: Page, frames: int) -> None:
    """Some frames into the segment, where the pose tells what it is."""
    for _ in range(frames):
        page.keyboard.press("ArrowRight")


def save(page: Page, name: str) -> None:
    """The page as it is, in few enough colours for a small file."""
    page.mouse.move(640, 505)
    page.wait_for_timeout(STILL)
    picture: Any = Image.open(io.BytesIO(page.screenshot()))
    with atomic_write(IMAGES / f"{name}.png") as draft:
        picture.convert("RGB").quantize(255).save(draft, format="png", optimize=True)


@contextmanager
def studio(folder: Path) -> Iterator[str]:
    """The studio of a folder; its address."""
    command = [sys.executable, "-m", "kineme", "studio", str(folder), "--no-browser"]
    process = subprocess.Popen(  # noqa: S603 (our own command)
        [*command, "--port", "0"], stdout=subprocess.PIPE, text=True
    )
    try:
        said = process.stdout.readline() if process.stdout else ""
        yield re.findall(r"http\S+", said)[0]
    finally:
        process.terminate()
        process.wait()


if __name__ == "__main__":
    main()
