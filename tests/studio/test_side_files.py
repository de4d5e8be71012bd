"""Folders as they are: damaged files, closed to writing, with names that are not UTF-8."""

from __future__ import annotations

import json
import os
import shutil
import sys
from pathlib import Path

import pytest
from starlette.testclient import TestClient
from studio_clients import Studio

from kineme.studio.storage import sidecars
from kineme.studio.storage.sidecars import make_file_id

DEEP = b"[" * 100_000
SIDE_FILES = {
    "labels.json": [DEEP, b'["walk", 3]', b"\xff"],
    "take.bvh.video.json": [b'{"offset_s": 1' + b"0" * 400 + b"}", b'{"offset_s": NaN}'],
    "take.bvh.reading.json": [b'{"fps": -1}', b'{"colour": 1}'],
    "take.segments/history.json": [b'{"kept": [7]}', b'{"revision": 1e999}'],
}
DAMAGED = [(name, content) for name, contents in SIDE_FILES.items() for content in contents]


@pytest.mark.parametrize(("name", "content"), DAMAGED, ids=lambda each: str(each)[:30])
def test_the_recording_opens_and_the_file_is_named(
    make_studio, folder: Path, name: str, content: bytes
) -> None:
    (folder / "take.mp4").write_bytes(b"a video")
    place = folder / ".kineme" / name
    place.parent.mkdir(parents=True)
    place.write_bytes(content)
    studio = make_studio()
    message = studio.recording()
    said = f"{place.name} was ignored: it "
    assert [note.startswith(said) for note in message["warnings"] if ".json" in note] == [True]
    assert message["read_options"] == {}
    assert message["video"] == {"name": "take.mp4", "offset_s": 0.0}
    assert studio.state()["labels"] == []
    assert place.read_bytes() == content
    assert studio.edit(1, "split", level="activity", frame=50).status_code == 200


def test_marks_of_another_shape_are_not_believed(make_studio, folder: Path) -> None:
    studio = make_studio()
    studio.apply("split", level="activity", frame=50)
    told = json.loads(studio.table.read_text())
    told["annotation"]["checked"] = [["activity", [], {}]]
    studio.table.write_text(json.dumps(told))
    message = make_studio().recording()
    assert any("take.segments.json was not used" in note for note in message["warnings"])
    assert studio.get("/api/state").status_code == 200


ODD = os.fsdecode(b"w\xe9")


@pytest.mark.skipif(sys.platform != "linux", reason="where names of files are any bytes")
def test_a_name_that_is_not_utf8_is_shown_and_downloaded(make_studio, folder: Path) -> None:
    (folder / "take.bvh").rename(folder / f"{ODD}.bvh")
    shutil.copy(Path(__file__).parents[1] / "browser" / "clock.webm", folder / f"{ODD}.webm")
    client: TestClient = make_studio().client
    one = f"/api/recordings/{make_file_id(folder / f'{ODD}.bvh')}"
    formats = [each["name"] for each in client.get("/api/state").json()["export_formats"]]
    asked = [f"export/{name}" for name in (*formats, "motions", "report")]
    for address in ("", *(f"/{each}" for each in (*asked, "video", "versions"))):
        answer = client.get(f"{one}{address}")
        assert answer.status_code == 200, (address, answer.text)
    for address, sent in (
        ("video", {"offset_s": 1.5}),
        ("reading", {"options": {"fps": 30}}),
        ("clips", {"rows": [0], "loops": False}),
    ):
        answer = client.post(f"{one}/{address}", json=sent)
        assert answer.status_code == 200, (address, answer.text)
    told = client.get(f"{one}/export/json").headers["content-disposition"]
    assert told == "attachment; filename*=UTF-8''w_.segments.json"


def test_a_folder_that_nothing_can_be_written_to_is_said(studio: Studio, folder: Path) -> None:
    (folder / ".kineme").write_text("a file where a folder should be")  # for root may write all
    one = studio.one
    assert studio.get(one).status_code == 200
    for address, sent in (
        (f"{one}/video", {"offset_s": 1.5}),
        (f"{one}/reading", {"options": {"fps": 30}}),
        ("/api/labels", {"labels": ["walk"]}),
    ):
        answer = studio.post(address, sent)
        assert "cannot be created" in answer.json()["error"], address
    assert sidecars.read_video_offset(folder / "take.bvh") == 0.0


@pytest.mark.parametrize(
    "damage",
    [
        lambda text: text[:200],
        lambda text: "[" * 100_000,
        lambda text: text.replace(
            '"provenance": {', '"provenance": {"checked": [["activity", [1], 2]],'
        ),
        lambda text: text.replace('"provenance": {', '"provenance": {"checked": 5,'),
        lambda text: text.replace('"stop_frame": 240', '"stop_frame": "x"'),
        lambda text: text.replace('"cluster": ', '"cluster": 1e400, "x": '),
    ],
)
def test_a_damaged_table_costs_itself_only(make_studio, folder: Path, damage) -> None:
    shutil.copy(folder / "take.bvh", folder / "other.bvh")
    first = make_studio()
    saved = first.get(f"{first.one}/export/json").text
    assert json.loads(saved)
    (folder / "other.segments.json").write_text(saved)
    (folder / "take.segments.json").write_text(damage(saved))
    listed = make_studio().get("/api/state")
    assert listed.status_code == 200, listed.text
    counted = {each["name"]: each["segments"] for each in listed.json()["recordings"]}
    assert counted["other.bvh"] > 0
    assert set(counted) == {"take.bvh", "other.bvh"}
