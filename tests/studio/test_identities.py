"""Segments are who they were, whatever edits make of them, restarts and undo included."""

from __future__ import annotations

import signal
from typing import Any

from studio_clients import Studio

from kineme.studio.storage.identities import descent


def who(message: dict[str, Any], level: str = "activity") -> dict[int, str]:
    """The identities of the segments of a level by their first frames."""
    rows = message["segmentation"]["segments"]
    assert len(rows) == len(message["ids"]) == len(set(message["ids"]))
    of_each = zip(rows, message["ids"], strict=True)
    return {row["start_frame"]: who for row, who in of_each if row["level"] == level}


def border_of(studio: Studio) -> tuple[int, dict[str, Any]]:
    """A border between activities, made at frame 50."""
    made = studio.done(studio.recording()["revision"], "split", level="activity", frame=50)
    return 50, made


def test_a_segment_is_the_same_wherever_its_borders_go(studio) -> None:
    border, state = border_of(studio)
    before = who(state)
    for to in (51, 52, 48):
        moved = {"level": "activity", "frame": border, "to": to}
        state, border = studio.done(state["revision"], "move_border", **moved), to
        assert who(state)[to] == before[50]
        assert {who(state)[start] for start in before if start != 50} < set(before.values())
    named = studio.done(state["revision"], "name_segment", level="activity", frame=48, label="x")
    assert who(named) == who(state)
    whole = {"level": "activity", "start_frame": 0, "stop_frame": _stop(named, 48)}
    merged = studio.done(named["revision"], "merge", **whole)
    assert who(merged)[0] == before[0]
    assert before[50] not in who(merged).values()
    undone = studio.done(merged["revision"], "undo")
    assert who(undone) == who(named)


def test_identities_outlive_the_server_saved_or_not(start) -> None:
    studio = start()
    found = studio.recording()["ids"]
    studio.end(signal.SIGKILL)
    studio = start()
    assert studio.recording()["ids"] == found
    _, state = border_of(studio)
    moved = {"level": "activity", "frame": 50, "to": 55}
    state = studio.done(state["revision"], "move_border", **moved)
    studio.end(signal.SIGKILL)
    again = start()
    assert again.recording()["ids"] == state["ids"]
    undone = again.done(again.recording()["revision"], "undo")
    assert who(undone)[50] == who(state)[55]


def test_what_an_edit_makes_is_known_by_the_name_of_the_edit(studio) -> None:
    sent = {
        "revision": studio.recording()["revision"],
        "edit": {"kind": "split", "level": "activity", "frame": 50},
        "name": "0123456789",
    }
    made = studio.client.post(f"/api/recordings/{studio.id}/edits", json=sent).json()
    assert who(made)[50] == "a01234567:50"
    assert who(made, "primitive")[50] == "p01234567:50"


def test_another_table_has_other_segments_but_for_those_taken_over(studio) -> None:
    _, state = border_of(studio)
    checked = {"level": "activity", "frames": [50], "checked": True}
    state = studio.done(state["revision"], "check", **checked)
    anew = {"preset": "voegele2014", "parameters": {}, "keep": True}
    found = studio.done(state["revision"], "segment", **anew)
    assert who(found)[50] == who(state)[50]
    spans = {(row["level"], row["start_frame"], row["stop_frame"]): who for row, who in zip(
        state["segmentation"]["segments"], state["ids"], strict=True)}  # fmt: skip
    for row, who_now in zip(found["segmentation"]["segments"], found["ids"], strict=True):
        span = row["level"], row["start_frame"], row["stop_frame"]
        assert (who_now in state["ids"]) == (span in spans)


def test_a_table_that_another_program_changed_has_the_same_segments_where_it_was_left_alone(
    studio,
) -> None:
    _, state = border_of(studio)
    studio.table.write_text(studio.table.read_text().replace('"label": ""', '"label": "theirs"'))
    assert studio.recording()["ids"] == state["ids"]


def test_of_borders_that_went_the_nearest_is_the_one_that_came() -> None:
    assert descent([0, 30, 60], [0, 30, 60]) == {0: 0, 30: 30, 60: 60}
    assert descent([100, 150, 200, 250], [100, 220, 250]) == {100: 100, 220: 200, 250: 250}
    assert descent([0, 30, 60, 90], [0, 25, 55, 90]) == {0: 0, 25: 30, 55: 60, 90: 90}
    assert descent([0, 60], [0, 20, 60]) == {0: 0, 60: 60}


def _stop(message: dict[str, Any], start: int) -> int:
    rows = message["segmentation"]["segments"]
    stop: int = next(row["stop_frame"] for row in rows if row["start_frame"] == start)
    return stop
