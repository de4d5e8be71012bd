"""What was acknowledged is on the disk: killed servers, two pages, other programs, Ctrl+C."""

from __future__ import annotations

import json
import os
import random
import signal
import socket
import sys
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

import httpx2 as httpx
import pytest
from hypothesis import given
from hypothesis import strategies as st
from studio_clients import Process, change_rows

import kineme
from kineme._util.files import ABANDONED_S, remove_abandoned_drafts
from kineme.errors import ParameterError
from kineme.segments import editing
from kineme.segments.history import LONGEST, History
from kineme.studio import server
from kineme.studio.folder import Folder
from kineme.studio.http.bodies import Upload
from kineme.studio.http.events import Hub
from kineme.studio.open_recordings import OpenRecordings


@pytest.mark.slow
def test_kills_at_any_moment_lose_nothing_that_was_acknowledged(start) -> None:
    kills = edit_and_kill(start, edits=12, seed=1)
    assert kills > 1


def edit_and_kill(start: Callable[[], Process], *, edits: int, seed: int) -> int:
    """Make so many edits while the server is killed over and over; how often it was.

    Each time some edits are made in peace, and the kill comes at any moment of the two that
    follow, however long these take on this machine. After each start the table is that of the
    last acknowledged edit, or of the one whose answer was on its way: that one is sent again by
    its name, and made once.
    """
    chance, kills, made = random.Random(seed), 0, 0
    sent: dict[str, Any] | None = None
    studio = start()
    shown = studio.recording()
    rows, revision = shown["segmentation"]["segments"], shown["revision"]
    while made < edits:
        peace, took = chance.randrange(1, 5), 0.0
        killer = threading.Timer(0, studio.server.process.kill)
        try:
            while made < edits:
                if peace == 0:
                    killer.interval = chance.uniform(0, 2 * took)
                    killer.start()
                peace, began = peace - 1, time.monotonic()
                edit = sent or {"revision": revision, "edit": _any_edit(rows, chance)}
                sent = {"name": f"edit {made}", **edit}
                answer = studio.post(f"{studio.one}/edits", sent)
                sent, took = None, time.monotonic() - began
                if answer.status_code == 400:
                    continue
                message = answer.json()
                assert (answer.status_code, message.get("revision")) == (200, revision + 1), message
                made, revision = made + 1, message["revision"]
                change, table = message["change"], message["segmentation"]
                rows = change_rows(rows, change) if change else table["segments"]
        except httpx.TransportError:
            kills += 1
        killer.cancel()
        studio.end(signal.SIGKILL)
        studio = start()
        shown = studio.recording()
        if shown["revision"] == revision:
            assert shown["segmentation"]["segments"] == rows
        else:
            assert sent is not None
            assert shown["revision"] == revision + 1
    saved = kineme.read_segments(studio.table).table
    assert saved.start_frame.tolist() == [row["start_frame"] for row in rows]
    assert saved.label.tolist() == [row["label"] for row in rows]
    return kills


def _any_edit(rows: list[dict[str, Any]], chance: random.Random) -> dict[str, Any]:
    """An edit that can mostly be made."""
    row = chance.choice(rows)
    at = {"level": row["level"], "frame": row["start_frame"]}
    middle = chance.randrange(row["start_frame"], row["stop_frame"])
    edits: list[dict[str, Any]] = [
        {"kind": "split", "level": row["level"], "frame": middle},
        {"kind": "move_border", **at, "to": middle},
        {"kind": "name_segment", **at, "label": f"n{chance.random()}"},
        {"kind": "comment", **at, "text": f"c{chance.random()}"},
        {"kind": "check", "level": row["level"], "frames": [row["start_frame"]], "checked": True},
        {"kind": "delete_border", **at},
        {"kind": "undo"},
    ]
    return chance.choice(edits)


def test_of_many_edits_at_once_one_counts_and_the_others_are_told(studio) -> None:
    revision = studio.recording()["revision"]
    frames = range(10, 90, 10)
    with ThreadPoolExecutor(len(frames)) as pages:
        answers = list(
            pages.map(
                lambda frame: studio.edit(revision, "split", level="activity", frame=frame), frames
            )
        )
    assert sorted(answer.status_code for answer in answers) == [200] + [409] * 7
    for answer in answers:
        assert answer.status_code == 200 or "changed elsewhere" in answer.json()["error"]
    saved = kineme.read_segments(studio.table).cuts().tolist()
    assert studio.starts()[1:] == saved
    studio.apply("split", level="activity", frame=95)
    assert {95, *saved} <= set(studio.starts())


def test_another_program_is_not_overwritten(studio) -> None:
    state = studio.apply("split", level="activity", frame=50)
    theirs = editing.split(kineme.read_segments(studio.table), "activity", 120)
    kineme.write_segments(theirs, studio.table)
    on_disk = studio.table.read_bytes()
    refused = studio.edit(state["revision"], "split", level="activity", frame=70)
    assert refused.status_code == 409
    assert "another program" in refused.json()["error"]
    assert studio.table.read_bytes() == on_disk
    message = studio.recording()
    assert {50, 120} <= set(studio.starts())
    assert message["revision"] > state["revision"]
    mine = studio.apply("undo")  # what the page had is one step back
    assert 120 not in [row["start_frame"] for row in mine["segmentation"]["segments"]]
    studio.apply("redo")
    assert 120 in kineme.read_segments(studio.table).cuts()


def test_a_table_that_came_or_went_meanwhile_is_seen(studio) -> None:
    revision = studio.recording()["revision"]
    theirs = kineme.segment(kineme.read(studio.path))
    kineme.write_segments(editing.split(theirs, "activity", 33), studio.table)
    assert studio.edit(revision, "split", level="activity", frame=70).status_code == 409
    assert 33 in studio.starts()
    studio.table.unlink()
    studio.apply("split", level="activity", frame=70)
    assert {33, 70} <= set(kineme.read_segments(studio.table).cuts().tolist())


def test_tables_of_others_are_left_alone(studio, folder: Path) -> None:
    other = kineme.segment(kineme.read(kineme.bundled_recording()))
    kineme.write_segments(other, studio.table)
    (folder / "take.bvh.segments.json").write_text("{}")
    before = studio.table.read_bytes()
    message = studio.recording()
    assert [note.split(" ")[0] for note in message["warnings"]] == [
        "take.segments.json",
        "take.bvh.segments.json",
    ]
    saved = studio.apply("split", level="activity", frame=50)["saved"]
    assert saved == "take.bvh.2.segments.json"
    assert studio.table.read_bytes() == before
    assert (folder / "take.bvh.segments.json").read_text() == "{}"


def test_recordings_of_one_name_have_tables_of_their_own(studio, folder: Path) -> None:
    kineme.write(kineme.read(studio.path), folder / "take.npz")
    saved = {}
    for name, frame in (("take.npz", 40), ("take.bvh", 60)):
        made = studio.choose(name).apply("split", level="activity", frame=frame)
        saved[name] = made["saved"]
    assert saved == {"take.npz": "take.segments.json", "take.bvh": "take.bvh.segments.json"}
    assert 60 in kineme.read_segments(folder / "take.bvh.segments.json").cuts()


def test_a_recording_that_is_replaced_is_opened_anew(studio) -> None:
    state = studio.apply("split", level="activity", frame=50)
    lines = studio.path.read_text().splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith("Frames:"))
    lines[start] = "Frames: 120"
    studio.path.write_text("\n".join(lines[: start + 122]) + "\n")
    message = studio.recording()
    assert (message["n_frames"], message["revision"]) == (120, state["revision"] + 1)
    assert "was not used" in message["warnings"][0]
    studio.path.unlink()
    assert studio.get(studio.one).status_code == 404


def test_news_reach_every_page_and_ctrl_c_ends_them_at_once(start) -> None:
    studio = start()
    studio.recording()
    ready = threading.Semaphore(0)

    def listen() -> list[dict[str, object]]:
        address = f"{studio.address}api/events?token={studio.token}"
        with httpx.Client(timeout=300) as client, client.stream("GET", address) as answer:
            assert answer.headers["content-type"].startswith("text/event-stream")
            lines = answer.iter_lines()
            assert next(lines).startswith(":")
            ready.release()
            return [json.loads(line[6:]) for line in lines if line.startswith("data: ")]

    with ThreadPoolExecutor(2) as pool:
        pages = [pool.submit(listen) for _ in range(2)]
        assert all(ready.acquire(timeout=300) for _ in pages)
        edited = studio.apply("split", level="activity", frame=50)
        added = studio.client.post("/api/recordings?name=other.bvh", content=b"HIERARCHY").json()
        assert studio.end(signal.SIGINT) == (0, "", "")
        heard = [page.result(300) for page in pages]
    assert (
        heard
        == [
            [
                {"recording": studio.id, "revision": edited["revision"]},
                {"recording": added["id"], "revision": 0},
            ]
        ]
        * 2
    )


def test_an_upload_that_breaks_off_leaves_nothing(start) -> None:
    studio = start()

    def files() -> list[str]:
        return [path.name for path in studio.folder.iterdir()]

    def begin_upload(line: socket.socket, length: int) -> None:
        line.sendall(
            "POST /api/recordings?name=half.bvh HTTP/1.1\r\n"
            f"Host: 127.0.0.1:{studio.port}\r\nX-Kineme-Token: {studio.token}\r\n"
            f"Content-Length: {length}\r\n\r\n".encode()
            + b"x" * 1000
        )

    connect = partial(socket.create_connection, ("127.0.0.1", studio.port), timeout=300)
    with connect() as line:
        begin_upload(line, 2 * 10**9)
        assert b" 413 " in line.recv(100)
    with connect() as line:
        begin_upload(line, 10**6)
        while len(files()) == 1:
            time.sleep(0.01)
    deadline = time.monotonic() + 60
    while len(files()) > 1 and time.monotonic() < deadline:
        time.sleep(0.01)
    assert files() == ["take.bvh"]
    assert studio.get("/api/state").status_code == 200


@pytest.mark.skipif(sys.platform == "win32", reason="open files cannot be removed there")
def test_an_upload_that_pauses_for_hours_is_not_swept_by_another_server(tmp_path: Path) -> None:
    with Upload(tmp_path, "take.bvh") as upload:
        upload.write(b"HIERARCHY")
        (draft,) = tmp_path.iterdir()
        os.utime(draft, (time.time() - 2 * ABANDONED_S,) * 2)
        remove_abandoned_drafts(tmp_path)
        assert draft.exists()
        assert upload.finish().read_bytes() == b"HIERARCHY"


@given(st.lists(st.integers(0, 9) | st.sampled_from(["undo", "redo"]), max_size=150))
def test_undo_and_redo_are_each_others_inverse(steps: list[int | str]) -> None:
    history = History(-1)
    told = [-1]
    at = 0
    for step in steps:
        try:
            if step == "undo":
                history, at = history.undone(), at - 1
            elif step == "redo":
                history, at = history.redone(), at + 1
            else:
                history, told, at = (
                    history.followed_by(int(step)),
                    [*told[: at + 1], int(step)],
                    at + 1,
                )
        except ParameterError:
            assert not (history.past if step == "undo" else history.future)
        assert history.present == told[at]
        assert len(history.past) <= LONGEST
        if history.past:
            assert history.undone().redone() == history


def test_what_fails_after_the_end_is_not_said(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def failing(ended: threading.Event) -> None:
        raise RuntimeError("cannot schedule new futures after interpreter shutdown")

    monkeypatch.setattr(server, "load_compiled_code", failing)
    documents = OpenRecordings(Folder(folder, None), lambda name, revision: None)
    hub, ended = Hub(), threading.Event()
    hub.has_listener.set()
    with pytest.raises(RuntimeError):
        server.warm_up(documents, hub, ended)
    ended.set()
    server.warm_up(documents, hub, ended)
