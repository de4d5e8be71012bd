"""A long recording is shown before it is read, and before its segments are found."""

from __future__ import annotations

import gc
import queue
import shutil
import threading
import time
import weakref
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from studio_clients import change_rows

import kineme
from kineme.errors import ParameterError, ReadError
from kineme.formats import ReadOptions, sketch
from kineme.studio.downloads import export_download
from kineme.studio.folder import Folder
from kineme.studio.jobs import Run
from kineme.studio.loading import LoadedRecording, RecordingCache
from kineme.studio.open_recordings import OpenRecordings
from kineme.web.encoding import to_json
from kineme.web.requests import EditRequest, Split

COST = kineme.PRESETS["kineme"].segment_cost
News = queue.Queue[tuple[str, int]]


def held_back(monkeypatch: pytest.MonkeyPatch) -> threading.Event:
    """Segments are found from now on once this is set."""
    wanted, first_table = threading.Event(), LoadedRecording.first_table
    monkeypatch.setattr(
        LoadedRecording, "first_table", lambda loaded: wanted.wait(60) and first_table(loaded)
    )
    return wanted


def open_take(folder: Path) -> tuple[OpenRecordings, str, News]:
    """Open a studio of the bundled recording alone; the recording's id, and the news of it."""
    if not (folder / "take.bvh").exists():
        shutil.copy(kineme.bundled_recording(), folder / "take.bvh")
    told: News = queue.Queue()
    recordings = OpenRecordings(Folder(folder), lambda *news: told.put(news))
    (name,) = recordings.folder.recordings()
    return recordings, name, told


def test_a_long_recording_is_shown_first_and_segmented_then(tmp_path, monkeypatch):
    wanted = held_back(monkeypatch)
    monkeypatch.setattr("kineme.studio.loading.LONG_S", 1.0)
    recordings, name, told = open_take(tmp_path)
    shown = recordings.message(name)
    assert shown.finding
    assert [row.kind for row in shown.segmentation.segments] == ["transition"]
    split = EditRequest(revision=shown.revision, edit=Split(level="activity", frame=100))
    with pytest.raises(ParameterError, match="still being segmented"):
        recordings.edit(name, split)
    wanted.set()
    assert told.get(timeout=600) == (name, shown.revision + 1)
    then = recordings.message(name)
    assert not then.finding
    assert len(then.segmentation.segments) > 10
    assert not (tmp_path / "take.segments.json").exists()


def test_a_long_recording_that_is_read_otherwise_says_when_its_segments_are_there(
    tmp_path, monkeypatch
):
    recordings, name, told = open_take(tmp_path)
    before = recordings.message(name).revision
    wanted = held_back(monkeypatch)
    monkeypatch.setattr("kineme.studio.loading.LONG_S", 1.0)
    recordings.change_reading(name, ReadOptions(fps=30))
    assert told.get(timeout=600) == (name, before)  # one more once they are found
    assert recordings.message(name).finding
    wanted.set()
    assert told.get(timeout=600) == (name, before + 1)
    assert not recordings.message(name).finding


def test_segments_that_take_long_are_waited_for_by_files_and_not_by_pages(tmp_path, monkeypatch):
    wanted = held_back(monkeypatch)
    monkeypatch.setattr("kineme.studio.open_recording.FIRST_WAIT_S", 0.1)
    recordings, name, _ = open_take(tmp_path)
    assert recordings.message(name).finding
    threading.Timer(0.2, wanted.set).start()
    _, content = export_download(recordings.get(name), "csv", None)
    assert len(content.splitlines()) > 10
    assert not recordings.message(name).finding


def test_an_edit_of_found_segments_waits_for_a_server_that_finds_them_again(tmp_path, monkeypatch):
    before, name, _ = open_take(tmp_path)
    seen = before.message(name)
    wanted = held_back(monkeypatch)
    monkeypatch.setattr("kineme.studio.loading.LONG_S", 1.0)
    again = OpenRecordings(Folder(tmp_path), lambda *_: None)
    assert again.message(name).finding
    threading.Timer(0.2, wanted.set).start()
    split = EditRequest(revision=seen.revision, edit=Split(level="activity", frame=100))
    made = again.edit(name, split)
    assert made.change.rows[0].stop_frame == 100


def test_segments_that_cannot_be_found_are_said_to_be_missing(tmp_path, monkeypatch):

    wanted = threading.Event()

    def fail(_: LoadedRecording) -> None:
        wanted.wait(60)
        raise ParameterError("no such constant")

    monkeypatch.setattr("kineme.studio.loading.LONG_S", 1.0)
    monkeypatch.setattr(LoadedRecording, "first_table", fail)
    recordings, name, told = open_take(tmp_path)
    assert recordings.message(name).finding
    wanted.set()
    assert told.get(timeout=600)[0] == name
    assert "not segmented: no such constant" in recordings.message(name).warnings


@pytest.fixture
def large_take(tmp_path, monkeypatch):
    """A recording that is read once ``wanted`` is set: its folder, id and news."""
    wanted, read = threading.Event(), RecordingCache.read
    monkeypatch.setattr("kineme.studio.loading.LARGE_FILE", 1000)
    monkeypatch.setattr("kineme.studio.loading.MAX_POSES", 200)
    monkeypatch.setattr(
        RecordingCache, "read", lambda cache, path: wanted.wait(60) and read(cache, path)
    )
    recordings, name, told = open_take(tmp_path)
    return recordings, name, told, wanted


def test_a_large_file_shows_some_of_its_poses_while_it_is_read(large_take):
    recordings, name, told, wanted = large_take
    few = recordings.message(name)
    assert few.finding
    assert few.n_frames == 2898
    assert few.motion.n_samples == 2898 // 15 + 1
    assert few.motion.sample_fps == pytest.approx(60 / 15)
    poses = recordings.poses(name, few.motion.n_samples)
    split = EditRequest(revision=few.revision, edit=Split(level="activity", frame=100))
    with pytest.raises(ParameterError, match="still being segmented"):
        recordings.edit(name, split)
    wanted.set()
    assert told.get(timeout=600)[0] == name
    whole = recordings.message(name)
    assert not whole.finding
    assert whole.motion.n_samples == 1449
    assert recordings.poses(name, few.motion.n_samples) == poses
    assert len(recordings.poses(name, 1449)) > 5 * len(poses)


def test_a_large_file_that_is_not_wanted_any_more_is_not_opened(large_take, monkeypatch):
    opened = []
    first_table = LoadedRecording.first_table
    monkeypatch.setattr(
        LoadedRecording, "first_table", lambda self: opened.append(self) or first_table(self)
    )
    recordings, name, told, wanted = large_take
    assert recordings.message(name).being_read
    recordings.cancel(name)
    wanted.set()
    while recordings.progress(name).stage:
        time.sleep(0.01)
    assert not opened
    assert told.empty()
    assert recordings.message(name).being_read  # somebody opens it after all
    assert told.get(timeout=600)[0] == name
    assert not recordings.message(name).being_read


def test_a_large_file_that_is_wanted_again_while_it_is_read_is_opened(large_take):
    recordings, name, told, wanted = large_take
    recordings.message(name)
    recordings.cancel(name)
    recordings.message(name)
    wanted.set()
    assert told.get(timeout=600)[0] == name
    assert not recordings.message(name).being_read


def test_poses_of_a_sketch_are_those_of_the_recording():
    path = kineme.bundled_recording()
    found, whole = sketch(path, ReadOptions(), 300), kineme.read(path)
    assert (found.n_frames, found.fps) == (whole.n_frames, whole.fps)
    np.testing.assert_allclose(found.motion.positions, whole.positions[::10], atol=1e-9)
    assert sketch(path, ReadOptions(), 2898) is None


def test_a_large_file_that_is_damaged_says_so_once_it_is_read(tmp_path, monkeypatch):
    text = kineme.bundled_recording().read_text().splitlines()
    text[-7] = text[-7].replace(text[-7].split()[3], "x", 1)
    (tmp_path / "take.bvh").write_text("\n".join(text))
    monkeypatch.setattr("kineme.studio.loading.LARGE_FILE", 1000)
    monkeypatch.setattr("kineme.studio.loading.MAX_POSES", 200)
    recordings, name, told = open_take(tmp_path)
    assert recordings.message(name).finding
    assert told.get(timeout=600)[0] == name
    with pytest.raises(ReadError, match="not a number"):
        recordings.message(name)


def test_what_is_drawn_of_recordings_left_long_ago_is_not_kept(tmp_path, monkeypatch):
    monkeypatch.setattr("kineme.studio.open_recordings.MAX_PICTURES", 2)
    for number in range(3):
        shutil.copy(kineme.bundled_recording(), tmp_path / f"take_{number}.bvh")
    recordings = OpenRecordings(Folder(tmp_path), lambda *_: None)
    names = list(recordings.folder.recordings())
    first = recordings.message(names[0])
    drawn = [weakref.ref(recordings.get(name).loaded.page_data()) for name in names]
    gc.collect()
    assert [each() is None for each in drawn] == [True, False, False]
    assert to_json(recordings.message(names[0])) == to_json(first)


def test_an_edit_is_answered_by_the_rows_that_differ_or_by_another_table(studio):
    before = studio.recording()
    address = f"{studio.one}/edits"
    edit = {"kind": "name_segment", "level": "activity", "frame": 0, "label": "hop"}
    sent = {"revision": before["revision"], "edit": edit, "name": "a name"}
    made = studio.post(address, sent).json()
    now = studio.recording()["segmentation"]
    assert made["segmentation"] is None
    assert made["change"] == {
        "of": before["revision"],
        "removed": [],
        "rows": now["segments"][:1],
        "cluster_names": now["cluster_names"],
    }
    again = studio.post(address, sent).json()  # nobody knows what the asker has by now
    assert (again["change"], again["segmentation"]) == (None, now)
    anew = {"kind": "segment", "preset": "voegele2014", "parameters": {}}
    other = studio.post(address, {"revision": made["revision"], "edit": anew}).json()
    assert (other["change"], other["segmentation"]) == (None, studio.recording()["segmentation"])


def test_each_edit_changes_the_rows_that_an_answer_has_of_it(studio):
    state = studio.recording()
    address = f"{studio.one}/edits"
    level, primitive = {"level": "activity"}, {"level": "primitive"}
    for edit in (
        {"kind": "split", **level, "frame": 50},
        {"kind": "split", **level, "frame": 90},
        {"kind": "move_border", **level, "frame": 50, "to": 60},
        {"kind": "check", **level, "frames": [60], "checked": True},
        {"kind": "comment", **primitive, "frame": 60, "text": "slips"},
        {"kind": "exclude", "frames": [60], "excluded": True},
        {"kind": "exclude", "frames": [60], "excluded": False},
        {"kind": "set_kind", **level, "frame": 60, "to": "transition"},
        {"kind": "undo"},
        {"kind": "delete_border", **level, "frame": 90},
        {"kind": "undo"},
        {"kind": "redo"},
    ):
        sent = {"revision": state["revision"], "edit": edit}
        change = studio.post(address, sent).json()["change"]
        rows = change_rows(state["segmentation"]["segments"], change)
        assert change["rows"], edit
        state = studio.recording()
        assert rows == state["segmentation"]["segments"], edit
        assert change["cluster_names"] == state["segmentation"]["cluster_names"]


def held_at(monkeypatch: pytest.MonkeyPatch, name: str) -> tuple[threading.Event, threading.Event]:
    """Segmentations wait at the end of a stage; the events say that one has come, and may go on."""
    there, wanted, stage = threading.Event(), threading.Event(), Run.start_stage

    def waiting(run: Run, following: str) -> None:
        if run.progress().stage == name:
            there.set()
            wanted.wait(60)
        stage(run, following)

    monkeypatch.setattr(Run, "start_stage", waiting)
    return there, wanted


def test_a_first_segmentation_that_is_cancelled_leaves_a_table_to_work_on(studio, monkeypatch):
    monkeypatch.setattr("kineme.studio.loading.LONG_S", 1.0)
    there, wanted = held_at(monkeypatch, "views")
    one = studio.one
    assert studio.get(f"{one}/progress").json() == {"stage": "", "share": None}
    assert studio.get(one).json()["finding"]
    assert there.wait(60)
    progress = studio.get(f"{one}/progress").json()
    assert progress["stage"] == "views"
    assert 0 < progress["share"] < 0.2
    assert studio.client.post(f"{one}/cancel").status_code == 204
    assert "cancelled" in studio.get(f"{one}/progress").json()["stage"]  # until the stage has ended
    wanted.set()
    left = studio.recording()
    assert [row["kind"] for row in left["segmentation"]["segments"]] == ["transition"]
    assert "not segmented: it was cancelled" in left["warnings"]
    assert studio.get(f"{one}/progress").json()["stage"] == ""
    asked = {"preset": "kineme", "parameters": {}, "keep": True}
    preview = studio.post(f"{one}/preview", asked).json()
    made = studio.apply("segment", preset="kineme", parameters={})
    assert made["segmentation"]["segments"] == preview["segmentation"]["segments"]
    assert len(made["segmentation"]["segments"]) > 1


def test_a_segmentation_that_is_cancelled_leaves_what_stood(studio, monkeypatch):
    before = studio.recording()
    there, wanted = held_at(monkeypatch, "features")
    again = {"preset": "kineme", "parameters": {"segment_cost": 0.9 * COST}}
    with ThreadPoolExecutor() as pool:
        answer = pool.submit(studio.edit, before["revision"], "segment", **again)
        assert there.wait(60)
        studio.client.post(f"{studio.one}/cancel")
        wanted.set()
        refused = answer.result()
    assert (refused.status_code, refused.json()["error"]) == (400, "it was cancelled")
    assert studio.recording()["segmentation"] == before["segmentation"]
    studio.apply("segment", **again)


def test_a_newer_preview_ends_the_one_before(studio, monkeypatch):
    studio.recording()
    there, wanted = held_at(monkeypatch, "features")
    ended, cancel = threading.Event(), Run.cancel
    monkeypatch.setattr(Run, "cancel", lambda run: cancel(run) or ended.set())
    address = f"{studio.one}/preview"
    asked = {"preset": "kineme", "parameters": {"segment_cost": 0.9 * COST}, "keep": True}
    with ThreadPoolExecutor() as pool:
        first = pool.submit(studio.client.post, address, json=asked)
        assert there.wait(60)
        ended.clear()  # the first has ended a segmentation, too: one that had not begun
        newer = {**asked, "parameters": {"segment_cost": 0.8 * COST}}
        second = pool.submit(studio.client.post, address, json=newer)
        assert ended.wait(60)
        wanted.set()
        assert (first.result().status_code, second.result().status_code) == (400, 200)
