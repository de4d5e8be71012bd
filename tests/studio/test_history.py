"""Nothing that was done to a table is lost: versions, undo after a restart, edits made once.

Restarts are a second studio on the same folder, which reads what the first one wrote;
`test_durability` kills processes.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from studio_clients import Studio

import kineme
from kineme.segments import editing
from kineme.studio.storage import tables


def named(studio: Studio, label: str = "hop") -> dict[str, Any]:
    """The recording once a border was made and a segment named."""
    studio.apply("split", level="activity", frame=50)
    return studio.apply("name_segment", level="activity", frame=50, label=label)


def versions(studio: Studio) -> list[dict[str, Any]]:
    """Return the tables that were replaced, the latest first."""
    return studio.get(f"{studio.one}/versions").json()["versions"]


def fail(*_: Any) -> None:
    raise RuntimeError("the end")


def labels(message: dict[str, Any]) -> set[str]:
    return {row["label"] for row in message["segmentation"]["segments"]} - {""}


def test_a_preview_changes_nothing_and_says_what_would_become_of_the_corrections(studio) -> None:
    before = named(studio)
    wanted = {"preset": "voegele2014", "parameters": {}, "keep": True}
    shown = studio.post(f"{studio.one}/preview", wanted).json()
    assert labels(shown) == {"hop"}
    assert (shown["corrections"] > 0, shown["names"], shown["lost"]) == (True, 1, [])
    anew = studio.post(f"{studio.one}/preview", {**wanted, "keep": False}).json()
    assert labels(anew) == set()
    assert anew["lost"] == [f"{shown['corrections']} corrections and 1 names"]
    assert studio.recording()["segmentation"] == before["segmentation"]
    applied = studio.apply("segment", preset="voegele2014", parameters={})
    assert applied["segmentation"]["segments"] == shown["segmentation"]["segments"]
    assert 50 in kineme.read_segments(studio.table).cuts("activity")


def test_every_table_that_was_replaced_can_be_looked_at_and_restored(make_studio) -> None:
    studio = make_studio()
    before = named(studio)
    studio.apply("segment", preset="voegele2014", parameters={}, keep=False)
    again = make_studio()
    (version,) = versions(again)
    assert (version["edit"]["kind"], version["names"]) == ("name_segment", 1)
    looked_at = again.get(f"{again.one}/versions/{version['number']}").json()
    assert looked_at["segmentation"] == before["segmentation"]
    state = again.apply("restore", version=version["number"])
    assert state["segmentation"] == before["segmentation"]
    assert [each["edit"]["kind"] for each in versions(again)] == ["segment", "name_segment"]
    assert again.get(f"{again.one}/versions/999").status_code == 400
    assert again.edit(state["revision"], "restore", version=999).status_code == 400


def test_undo_and_redo_outlive_the_server(make_studio) -> None:
    studio = make_studio()
    tables = [studio.recording()["segmentation"]["segments"]]
    for frame in (50, 70, 90):
        state = studio.apply("split", level="activity", frame=frame)
        tables.append(state["segmentation"]["segments"])
    undone = studio.apply("undo")
    again = make_studio()
    message = again.recording()
    assert (message["can_undo"], message["can_redo"]) == (True, True)
    assert message["revision"] == undone["revision"] == 5
    state = again.apply("redo")
    assert state["segmentation"]["segments"] == tables[3]
    for table in reversed(tables[:3]):
        state = again.apply("undo")
        assert state["segmentation"]["segments"] == table
    assert not state["can_undo"]


def test_what_was_taken_back_and_cannot_be_redone_is_kept(studio) -> None:
    before = named(studio)
    studio.apply("undo")
    studio.apply("split", level="activity", frame=90)
    number = versions(studio)[0]["number"]
    table = studio.get(f"{studio.one}/versions/{number}").json()
    assert table["segmentation"] == before["segmentation"]


def test_an_edit_that_is_sent_twice_is_made_once(make_studio) -> None:
    studio = make_studio()
    sent = {
        "revision": studio.recording()["revision"],
        "edit": {"kind": "split", "level": "activity", "frame": 50},
        "name": "an edit of its own",
    }
    address = f"{studio.one}/edits"
    first = studio.post(address, sent).json()
    assert studio.post(address, sent).json()["revision"] == first["revision"]
    table = studio.recording()["segmentation"]
    again = make_studio()
    assert again.post(address, sent).json()["segmentation"] == table


@pytest.mark.parametrize("cut", ["table", "history"])
def test_a_server_that_ended_between_two_files_goes_on_from_the_last_that_was_whole(
    make_studio: Callable[..., Studio], monkeypatch: pytest.MonkeyPatch, cut: str
) -> None:
    studio = make_studio()
    before = named(studio)
    places = {"table": "tables.TableFile.write", "history": "tables.write_record"}

    with monkeypatch.context() as patch:
        patch.setattr(f"kineme.studio.storage.{places[cut]}", fail)
        sent = {
            "revision": before["revision"],
            "edit": {"kind": "split", "level": "activity", "frame": 90},
            "name": "has no answer",
        }
        address = f"{studio.one}/edits"
        assert studio.post(address, sent).status_code == 500
    again = make_studio()
    message = again.recording()
    assert message["segmentation"] == before["segmentation"]
    assert message["revision"] == before["revision"]
    again.post(address, sent)
    assert 90 in again.starts()
    state = again.apply("undo")
    assert state["segmentation"] == before["segmentation"]
    state = again.apply("undo")
    assert labels(state) == set()


def test_an_undo_that_was_interrupted_goes_back_one_step_when_it_is_sent_again(
    make_studio: Callable[..., Studio], monkeypatch: pytest.MonkeyPatch
) -> None:
    studio = make_studio()
    named(studio)
    checked = studio.apply("check", level="activity", frames=[50], checked=True)
    state = studio.apply("check", level="activity", frames=[50], checked=False)  # as two edits ago
    sent = {"revision": state["revision"], "edit": {"kind": "undo"}, "name": "has no answer"}
    with monkeypatch.context() as patch:
        patch.setattr(tables.TableFile, "write", fail)
        assert studio.post(f"{studio.one}/edits", sent).status_code == 500
    again = make_studio()
    again.post(f"{again.one}/edits", sent)
    assert again.recording()["segmentation"] == checked["segmentation"]


def test_an_edit_is_kept_for_another_try_if_another_program_writes_at_the_same_time(
    studio: Studio, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = named(studio)
    write = tables.TableFile.write
    theirs = editing.split(kineme.read_segments(studio.table), "activity", 120)

    def write_late(file: tables.TableFile, content: bytes) -> None:
        kineme.write_segments(theirs, studio.table)
        write(file, content)

    edit = {"kind": "split", "level": "activity", "frame": 90}
    sent = {"revision": before["revision"], "edit": edit, "name": "sent twice"}
    with monkeypatch.context() as patch:
        patch.setattr(tables.TableFile, "write", write_late)
        assert studio.post(f"{studio.one}/edits", sent).status_code == 409
    sent["revision"] = studio.recording()["revision"]
    assert studio.post(f"{studio.one}/edits", sent).status_code == 200
    assert {90, 120} <= set(studio.starts())


def test_a_history_that_cannot_be_read_is_no_obstacle_and_its_tables_stay(
    make_studio: Callable[..., Studio], folder: Path
) -> None:
    named(make_studio())
    place = folder / ".kineme" / "take.segments"
    old = {path.name: path.read_bytes() for path in place.glob("[0-9]*.json")}
    (place / "history.json").write_text("{")
    studio = make_studio()
    message = studio.recording()
    assert labels(message) == {"hop"}
    assert not message["can_undo"]
    studio.apply("split", level="activity", frame=90)
    assert old.items() <= {path.name: path.read_bytes() for path in place.iterdir()}.items()


def test_the_history_is_plain_and_bounded(studio, folder: Path, monkeypatch) -> None:
    monkeypatch.setattr(tables, "MAX_VERSIONS", 3)
    monkeypatch.setattr("kineme.segments.history.LONGEST", 10)
    for _ in range(6):
        studio.apply("segment", preset="voegele2014", parameters={}, keep=False)
    for turn in range(15):
        state = studio.apply("name_segment", level="activity", frame=0, label=f"n{turn}")
    place = folder / ".kineme" / "take.segments"
    said = json.loads((place / "history.json").read_text())
    assert said["schema"] == "kineme.history/1"
    assert said["revision"] == state["revision"]
    written = sorted(place.glob("[0-9]*.json"))
    assert len(written) == 10 + 1 + 3
    assert all(kineme.read_segments(path) is not None for path in written)
    assert [f["name"] for f in studio.state()["annotations"]] == []
