"""A long recording is shown before its segments are found."""

from __future__ import annotations

import queue
import shutil
import threading

import pytest

import kineme
from kineme.errors import ParameterError
from kineme.studio.folder import Folder
from kineme.studio.loading import LoadedRecording
from kineme.studio.open_recordings import OpenRecordings
from kineme.web.requests import EditRequest, Split


def test_a_long_recording_is_shown_first_and_segmented_then(tmp_path, monkeypatch):
    shutil.copy(kineme.bundled_recording(), tmp_path / "take.bvh")
    wanted, first_table = threading.Event(), LoadedRecording.first_table
    monkeypatch.setattr("kineme.studio.loading.LONG", 1.0)
    monkeypatch.setattr(
        LoadedRecording, "first_table", lambda loaded: wanted.wait(60) and first_table(loaded)
    )
    told: queue.Queue[tuple[str, int]] = queue.Queue()
    recordings = OpenRecordings(Folder(tmp_path), lambda *news: told.put(news))
    (name,) = recordings.folder.recordings()
    shown = recordings.message(name)
    assert shown.finding
    assert [row.kind for row in shown.segmentation.segments] == ["transition"]
    split = EditRequest(revision=shown.revision, edit=Split(level="activity", frame=100))
    with pytest.raises(ParameterError, match="still being found"):
        recordings.edit(name, split)
    wanted.set()
    assert told.get(timeout=60) == (name, shown.revision + 1)
    then = recordings.message(name)
    assert not then.finding
    assert len(then.segmentation.segments) > 10
    assert not (tmp_path / "take.segments.json").exists()
