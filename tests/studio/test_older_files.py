"""A folder that an older studio worked in: its table and its history are taken up as they are."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from starlette.testclient import TestClient
from studio_clients import PORT, TOKEN, Studio

from kineme.studio.app import create_app
from kineme.studio.folder import Folder
from kineme.studio.http.events import Hub
from kineme.studio.open_recordings import OpenRecordings
from kineme.studio.storage.listed import file_id

OLDER = Path(__file__).parents[1] / "older" / "studio"


@pytest.fixture
def older(tmp_path: Path) -> Studio:
    """Its last edits there: a primitive made a transition, a cluster named, the primitive made one
    again, and that taken back."""
    folder = shutil.copytree(OLDER, tmp_path / "folder")
    hub = Hub()
    app = create_app(OpenRecordings(Folder(folder), hub.tell), token=TOKEN, port=PORT, hub=hub)
    client = TestClient(app, base_url=f"http://127.0.0.1:{PORT}", headers={"x-kineme-token": TOKEN})
    studio = Studio(client, folder)
    studio.path, studio.table = folder / "take.csv", folder / "take.segments.json"
    studio.id = file_id(studio.path)
    return studio


def kind_at_22(message: dict) -> str:
    (row,) = [
        row
        for row in message["segmentation"]["segments"]
        if (row["level"], row["start_frame"]) == ("primitive", 22)
    ]
    return row["kind"]


def test_its_table_and_its_history_are_taken_up(older: Studio) -> None:
    message = older.recording()
    assert (message["can_undo"], message["can_redo"]) == (True, True)
    assert kind_at_22(message) == "transition"
    assert message["segmentation"]["cluster_names"] == {"0": "row"}
    redone = older.done(message["revision"], "redo")
    assert kind_at_22(redone) == "primitive"
    assert not redone["can_redo"]
    revision = redone["revision"]
    for _ in range(4):
        undone = older.done(revision, "undo")
        revision = undone["revision"]
    assert not undone["can_undo"]
    assert undone["segmentation"]["cluster_names"] == {}
    assert any(row["confidence"] is not None for row in undone["segmentation"]["segments"])


def test_an_edit_of_an_older_page_is_made(older: Studio) -> None:
    """It calls a primitive that is none any more an activity."""
    revision = older.recording()["revision"]
    sent = {"level": "primitive", "frame": 22, "to": "activity"}
    assert kind_at_22(older.done(revision, "set_kind", **sent)) == "primitive"
