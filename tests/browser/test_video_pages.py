"""A video on the pages: large, in step with the playhead to the frame, keypoints over it."""

from __future__ import annotations

from fractions import Fraction
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest

import kineme
from kineme.pose import Pose
from screen import Screen, until
from squats import squat, write_squats

FRAMES, BITS, SIZE = 120, 7, (320, 240)
NUMBER = """video => {
    const pen = new OffscreenCanvas(320, 240).getContext("2d");
    pen.drawImage(video, 0, 0, 320, 240);
    const bright = k => pen.getImageData(32 * k + 16, 16, 1, 1).data[0] > 128;
    return [0, 1, 2, 3, 4, 5, 6].reduce((sum, k) => sum + (bright(k) ? 2 ** k : 0), 0);
}"""
"""Number of the frame that a video shows, which is written in it."""
DRAWN = """canvas => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    const rows = new Set();
    for (let i = 3; i < data.length; i += 4)
        if (data[i]) rows.add(Math.floor(i / 4 / canvas.width));
    return [Math.min(...rows), Math.max(...rows)].map((row) => row / canvas.height);
}"""
"""Highest and lowest row of what is drawn over a video, as shares of its height."""
TIMES = """(() => {
    const video = document.querySelector(".video video");
    return [window.kineme.playhead, video.currentTime, video.paused, video.muted];
})()"""


@pytest.fixture(scope="module")
def video(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Four seconds in which the number of each frame is written, in bright blocks."""
    av = pytest.importorskip("av")
    path = tmp_path_factory.mktemp("videos") / "squats.webm"
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libvpx", rate=30)
        stream.width, stream.height, stream.pix_fmt = *SIZE, "yuv420p"
        for n in range(FRAMES):
            picture = np.zeros((SIZE[1], SIZE[0], 3), np.uint8)
            for k in range(BITS):
                picture[:32, 32 * k : 32 * k + 32] = 255 * (n >> k & 1)
            frame = av.VideoFrame.from_ndarray(picture, format="rgb24")
            frame.pts, frame.time_base = n, Fraction(1, 30)
            container.mux(stream.encode(frame))
        container.mux(stream.encode())

    def smaller(time: float) -> list[Pose]:
        pose = squat(time)
        return [Pose(pose.image / 2, pose.confidence, pose.metres)]

    told = {"sha256": sha256(path.read_bytes()).hexdigest(), "width": SIZE[0], "height": SIZE[1]}
    table = path.with_name("squats.webm.poses.parquet")
    write_squats(table, np.arange(FRAMES) / 30, smaller, **told)
    return path


@pytest.fixture
def screen(new_tab, server, video: Path) -> Screen:
    for path in video.parent.glob("squats.webm*"):
        (server.folder / path.name).write_bytes(path.read_bytes())
    return Screen(new_tab(server.address_of(server.folder / video.name))).opened()


def test_each_frame_is_shown_with_its_keypoints(screen: Screen) -> None:
    page = screen.page
    shown = page.locator(".video.large video")
    for frame in (0, 31, 32, 64, 119):
        page.get_by_label("Frame", exact=True).fill(str(frame))
        page.keyboard.press("Enter")
        until(page, lambda n=frame: shown.evaluate(NUMBER) == n, f"frame {frame} in the video")
    page.evaluate("document.activeElement.blur()")
    for n in (118, 117):
        page.keyboard.press("ArrowLeft")
        until(page, lambda n=n: shown.evaluate(NUMBER) == n, f"frame {n} in the video")
    image = squat(117 / 30).image[:, 1] / 480
    over = page.locator(".picture canvas")
    expected = pytest.approx([image.min(), image.max()], abs=0.04)
    until(page, lambda: over.evaluate(DRAWN) == expected, "keypoints of the frame")


def test_the_page_follows_a_video_that_plays(screen: Screen) -> None:
    page = screen.page
    page.keyboard.press("Space")
    screen.wait("k.playhead > 1")
    playhead, seconds, paused, muted = page.evaluate(TIMES)
    assert (paused, muted) == (False, False)
    assert 0 <= seconds - playhead < 1.0  # at most the picture before, on a slow machine
    page.keyboard.press("Home")
    screen.wait("k.playhead < 1")
    screen.wait("!k.playing && k.frame === 119")  # at the end it stops


def test_full_screen_and_the_figure_in_its_place(screen: Screen) -> None:
    page = screen.page
    video, figure = page.locator(".video"), page.locator(".viewer")
    assert video.bounding_box()["width"] > 2 * figure.bounding_box()["width"]
    page.keyboard.press("f")
    until(page, lambda: not page.locator(".place-side").is_visible(), "full screen")
    page.locator(".place-timeline").wait_for()
    page.keyboard.press("f")
    until(page, page.locator(".place-side").is_visible, "the whole page again")
    page.get_by_role("button", name="Figure large").click()
    until(
        page,
        lambda: video.bounding_box()["width"] * 2 < figure.bounding_box()["width"],
        "the figure large",
    )


def test_a_report_shows_the_video_beside_it(new_tab, video: Path, tmp_path: Path) -> None:
    motion = kineme.read(video)
    page_path = tmp_path / "squats.html"
    kineme.write_report(motion, kineme.segment(motion), page_path)
    page = new_tab(page_path.as_uri())
    screen = Screen(page).opened()
    page.get_by_label("Frame", exact=True).fill("64")
    page.keyboard.press("Enter")
    shown = page.locator(".video.large video")
    # Its pixels are closed to scripts of a file.
    ready = "v => v.readyState >= 2 && !v.seeking && Math.round(v.currentTime * 30) === 64"
    until(page, lambda: shown.evaluate(ready), "the frame in the video")
    moved = tmp_path / "elsewhere" / "squats.html"
    moved.parent.mkdir()
    page_path.rename(moved)
    page.goto(moved.as_uri())
    screen.opened()
    page.get_by_text("squats.webm is not beside this page").wait_for()
    (moved.parent / video.name).write_bytes(video.read_bytes())
    page.reload()
    screen.opened()
    page.locator(".video.large video").wait_for()
