"""Looking at a recording in the studio: figure, lanes and matrix tell the same."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from test_views import FAULTS

import kineme
from kineme.datasets import bundled_truth
from screen import Screen, box_of, until

BRIGHTNESS = """video => {
    const pen = new OffscreenCanvas(8, 8).getContext("2d");
    pen.drawImage(video, 0, 0, 8, 8);
    return pen.getImageData(4, 4, 1, 1).data[0];
}"""


def test_a_click_on_a_primitive_moves_everything_there(page):
    screen = Screen(page)
    before = screen.pixels()
    chosen = screen.lane("primitive")[9]
    screen.click(chosen)
    screen.wait("k.selected")
    state = screen.state
    assert state["selected"] == chosen
    assert state["playhead"] == pytest.approx(chosen["start_s"])
    assert state["cluster"] == chosen["cluster"]
    screen.changed(before, "figure", "lanes", "matrix")
    page.locator(".segment-panel").filter(has_text=f"{chosen['start_s']:.2f}").wait_for()


def test_playing_moves_playhead_and_figure_until_it_is_stopped(page):
    screen = Screen(page)
    page.keyboard.press("Space")
    screen.wait("k.playhead > 0.4")
    first = screen.pixels()
    screen.changed(first, "figure")
    page.keyboard.press("Space")
    screen.wait("!k.playing")
    stopped = screen.state["playhead"]
    page.wait_for_timeout(200)
    assert screen.state["playhead"] == stopped


def test_all_members_of_a_cluster_play_in_step(page):
    screen = Screen(page)
    screen.click(screen.lane("primitive")[9])
    screen.wait("k.selected")
    alone = screen.pixels()
    page.get_by_role("button", name="In step").click()
    screen.wait("k.inStep")
    screen.changed(alone, "figure")


def test_a_repetition_is_left_out_of_the_mean_and_brought_back(page, take):
    """By a click, by a key; it is kept with the table, so that ``kineme cycles`` leaves it out."""
    screen = Screen(page)
    page.get_by_role("tab", name="Clusters").click()
    note, left_out = page.locator(".curves .note"), page.get_by_label("Left out by hand")
    note.filter(has_text="5 inner of 9 repetitions, mean").wait_for()
    page.get_by_label("Leave out of the mean").first.click()
    note.filter(has_text="4 inner of 9 repetitions, 1 left out by hand, mean").wait_for()
    left_out.wait_for()
    screen.saved()
    recording, table = kineme.read(take), kineme.read_segments(take.with_suffix(".segments.json"))
    reasons = kineme.cycles(recording, table, channels=[]).columns["excluded"].tolist()
    assert reasons.count("by hand") == 1
    left_out.get_by_role("button").first.click()  # goes there
    page.get_by_role("button", name="Bring back", exact=True).wait_for()
    page.keyboard.press("x")
    note.filter(has_text="5 inner of 9 repetitions, mean").wait_for()
    left_out.wait_for(state="detached")
    page.keyboard.press("Control+z")
    note.filter(has_text="4 inner of 9").wait_for()
    left_out.get_by_role("button").last.click()
    note.filter(has_text="5 inner of 9").wait_for()


def test_two_recordings_stand_side_by_side(new_tab, server, take):
    second = Path(shutil.copy(take, take.with_stem(f"{take.stem}_too")))
    for path in (take, second):
        shutil.copy(bundled_truth(), path.with_suffix(".segments.json"))
    page = new_tab(server.address_of(take))
    screen = Screen(page)
    screen.opened()
    page.get_by_role("button", name=f"Show {second.name} beside the others").click()
    screen.wait("k.recordings.length === 2 && k.hasMotion")
    assert screen.state["recordings"] == [take.name, second.name]
    page.reload()
    screen.wait("k?.recordings?.length === 2 && k.hasMotion")
    page.get_by_role("tab", name="Clusters").click()
    page.get_by_label("Beside", exact=True).select_option(take.name)
    page.locator(".curves .note").filter(has_text=f"{take.name} (dashed): 5 of 9").wait_for()
    page.get_by_role("button", name=f"Close {second.name}").click()
    screen.wait("k.recordings.length === 1")


def test_labels_and_names_are_text_and_nothing_else(new_tab, server, take):
    evil = "<img src=x onerror=document.title='caught'>"
    table = kineme.segment(kineme.read(take))
    named = take.rename(take.with_name("<b>bold<b> &amp; 'quoted'.bvh"))
    columns = {**table.table.columns(), "label": [evil] * len(table)}
    labelled = kineme.Segmentation.from_columns(
        columns, n_frames=table.n_frames, fps=table.fps, provenance=table.provenance
    )
    kineme.write_segments(labelled, named.with_suffix(".segments.json"))
    page = new_tab(server.address_of(named))
    screen = Screen(page)
    screen.opened()
    screen.click(screen.lane("primitive")[3])
    screen.wait("k.selected")
    screen.drawn()
    assert screen.state["selected"]["label"] == evil
    page.locator(".recording .name", has_text=named.name).wait_for()  # one, not several
    assert page.locator("img, b:text('bold')").count() == 0
    assert page.title().startswith(named.name)


def test_what_is_told_covers_no_button_and_goes(new_tab, server, take):
    broken = server.folder / "broken.bvh"
    broken.write_text("HIERARCHY\nnothing of the kind\n")
    page = new_tab(server.address_of(take))
    page.set_viewport_size({"width": 1024, "height": 768})
    screen = Screen(page).opened()
    page.keyboard.press("9")
    page.get_by_text("No label is on the key 9 yet").wait_for()
    notice = page.locator("[data-notice=problem]")
    dismiss = notice.get_by_role("button", name="Dismiss")
    good = page.get_by_role("button", name=take.name, exact=True)
    for end in (dismiss.click, lambda: page.keyboard.press("Escape"), good.click):
        page.get_by_role("button", name="broken.bvh", exact=True).click()
        notice.wait_for()
        screen.drawn()
        assert page.evaluate(FAULTS) == []
        end()
        notice.wait_for(state="detached")
    broken.unlink()


def test_a_dropped_file_is_taken_into_the_folder_and_opened(new_tab, server, take):
    page = new_tab(server.address)
    page.get_by_role("button", name=take.name, exact=True).wait_for()
    transfer = page.evaluate_handle(
        """([name, text]) => {
            const transfer = new DataTransfer();
            transfer.items.add(new File([text], name));
            return transfer;
        }""",
        [f"dropped_{take.name}", take.read_text() + "\n"],
    )
    for event in ("dragover", "drop"):
        page.dispatch_event("body", event, {"dataTransfer": transfer})
    screen = Screen(page)
    screen.wait(f"k.name === 'dropped_{take.name}' && k.hasMotion")
    assert (server.folder / f"dropped_{take.name}").read_text().strip() == take.read_text().strip()


@pytest.mark.parametrize("place", [".lanes canvas", ".matrix canvas"])
def test_two_fingers_zoom_to_what_is_between_them(page, place):
    screen = Screen(page)
    before = screen.state
    box = box_of(page.locator(place))
    middle, y = box["x"] + 0.6 * box["width"], box["y"] + 0.6 * box["height"]
    touches = page.context.new_cdp_session(page)

    def touch(kind: str, *apart: float) -> None:
        points = [{"x": middle + x, "y": y, "id": i} for i, x in enumerate(apart)]
        touches.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    touch("touchStart", -30)
    touch("touchStart", -30, 30)
    for wide in (40, 60, 90, 120):
        touch("touchMove", -wide, wide)
    touch("touchEnd", -120)
    touch("touchEnd")
    screen.wait(f"k.range.stop_s - k.range.start_s < {0.3 * before['duration']}")
    after = screen.state
    assert after["range"]["stop_s"] - after["range"]["start_s"] > 0.2 * before["duration"]
    assert (after["selected"], after["playhead"]) == (None, before["playhead"])
    touch("touchStart", 0)
    touch("touchMove", 50)
    touch("touchMove", 100)
    touch("touchEnd")
    screen.wait(f"k.range.start_s < {after['range']['start_s']}")
    moved = screen.state["range"]
    assert moved["stop_s"] - moved["start_s"] == pytest.approx(
        after["range"]["stop_s"] - after["range"]["start_s"]
    )


def test_the_video_follows_the_playhead(page, take):
    """Its luma is 20, and 20 more for each of its 10 seconds."""
    shutil.copy(Path(__file__).with_name("clock.webm"), take.with_suffix(".webm"))
    page.reload()
    screen = Screen(page).opened()
    video = page.locator(".video video")

    def shown(seconds: float) -> float:
        """Seconds of the picture that is seen once the video is sent there."""
        ready = f"v => !v.seeking && v.readyState >= 2 && Math.abs(v.currentTime - {seconds}) < 0.1"
        until(page, lambda: video.evaluate(ready), "the video is where the playhead is")
        luma = 16 + video.evaluate(BRIGHTNESS) * 219 / 255
        return (luma - 20) / 20

    page.get_by_label("Frame", exact=True).fill("180")
    page.keyboard.press("Enter")
    screen.wait("k.frame === 180")
    assert shown(3.0) == pytest.approx(3.0, abs=0.25)
    page.get_by_label("starts at").fill("2.5")
    page.keyboard.press("Enter")
    assert shown(5.5) == pytest.approx(5.5, abs=0.25)
    page.reload()
    screen.opened()
    assert shown(2.5) == pytest.approx(2.5, abs=0.25)
    page.keyboard.press("Space")
    screen.wait("k.playhead > 1")
    until(page, lambda: video.evaluate("v => !v.paused"), "the video plays")
    page.keyboard.press("Space")
    screen.wait("!k.playing")
    stopped = screen.state["playhead"] + 2.5
    assert shown(stopped) == pytest.approx(stopped, abs=0.25)
    until(page, lambda: video.evaluate("v => v.paused"), "the video rests")
