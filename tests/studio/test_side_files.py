"""Damaged files beside a recording: it opens all the same, and the page says which were left."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

DEEP = b"[" * 100_000
SIDE_FILES = {
    "labels.json": [DEEP, b'["walk", 3]', b"\xff"],
    "take.bvh.video.json": [
        b'{"offset_s": 1' + b"0" * 400 + b"}",
        b'{"offset_s": NaN}',
    ],
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
    assert studio.get("/api/state").json()["labels"] == []
    assert place.read_bytes() == content
    assert studio.edit(1, "split", level="activity", frame=50).status_code == 200


def test_marks_of_another_shape_are_not_believed(make_studio, folder: Path) -> None:
    studio = make_studio()
    studio.done(1, "split", level="activity", frame=50)
    told = json.loads(studio.table.read_text())
    told["annotation"]["checked"] = [["activity", [], {}]]
    studio.table.write_text(json.dumps(told))
    message = make_studio().recording()
    assert any("take.segments.json was not used" in note for note in message["warnings"])
    assert studio.get("/api/state").status_code == 200
