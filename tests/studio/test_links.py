"""Links in a folder that came from elsewhere: the studio writes nothing through them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

ACTS: dict[str, Callable[..., object]] = {
    "labels.json": lambda studio: studio.post("/api/labels", {"labels": ["walk"]}),
    "take.bvh.video.json": lambda studio: studio.post(f"{studio.one}/video", {"offset_s": 2.0}),
    "take.bvh.reading.json": lambda studio: studio.post(
        f"{studio.one}/reading", {"options": {"fps": 30.0}}
    ),
    "take.segments/history.json": lambda studio: studio.edit(
        1, "split", level="activity", frame=50
    ),
}


@pytest.fixture
def studio(make_studio, folder: Path):
    (folder / "take.mp4").write_bytes(b"a video")
    found = make_studio()
    found.recording()
    return found


def contents(place: Path) -> dict[str, bytes]:
    files = (path for path in place.rglob("*") if path.is_file())
    return {str(path.relative_to(place)): path.read_bytes() for path in files}


@pytest.mark.parametrize("name", ACTS)
def test_a_file_of_the_user_is_not_overwritten(studio, folder: Path, name: str) -> None:
    mine = folder.parent / "mine.json"
    mine.write_text("mine")
    link = folder / ".kineme" / name
    link.parent.mkdir(parents=True)
    link.symlink_to(mine)
    answer = ACTS[name](studio)
    assert answer.status_code == 400
    assert "is a link" in answer.json()["error"]
    assert mine.read_text() == "mine"
    assert not studio.table.exists()


def test_a_table_of_the_history_that_is_a_link_is_not_followed(studio, folder: Path) -> None:
    mine = folder.parent / "mine.json"
    mine.write_text("mine")
    history = folder / ".kineme" / "take.segments"
    history.mkdir(parents=True)
    for number in range(1, 5):
        (history / f"{number}.json").symlink_to(mine)
    studio.edit(1, "split", level="activity", frame=50)
    assert mine.read_text() == "mine"


@pytest.mark.parametrize("name", ACTS)
@pytest.mark.parametrize("there", [True, False])
def test_a_linked_folder_gets_nothing(studio, folder: Path, name: str, there: bool) -> None:
    elsewhere = folder.parent / "elsewhere"
    if there:
        (elsewhere / "take.segments").mkdir(parents=True)
        (elsewhere / "labels.json").write_text('["mine"]')
    (folder / ".kineme").symlink_to(elsewhere)
    before = contents(elsewhere)
    answer = ACTS[name](studio)
    assert answer.status_code == 400
    assert "is a link" in answer.json()["error"]
    assert contents(elsewhere) == before
    assert (elsewhere / "take.segments").exists() == there
