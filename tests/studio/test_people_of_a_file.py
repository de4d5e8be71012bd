"""Several people in one file: each is a recording of its own, with a table of its own."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from studio_clients import Studio
from typer.testing import CliRunner

import kineme
from kineme.cli.app import app
from kineme.cli.studio import _split_people
from kineme.errors import KinemeWarning
from kineme.formats import ReadOptions
from kineme.studio.storage.sidecars import ListedRecording
from people_files import write_people

NAME = {"level": "activity", "frame": 0}


@pytest.fixture
def duet(studio: Studio) -> Studio:
    """A studio, its recording a file with two people."""
    path = write_people(studio.folder / "duet.trc", {"Anna": 0, "Bob": 300})
    return studio.choose(path.name)


def of(duet: Studio, person: str) -> Studio:
    """The same, its recording that of a person."""
    return duet.choose(f"duet.trc · {person}")


def ids_of(duet: Studio) -> dict[str, str]:
    return {name: each for name, each in duet.ids().items() if name.startswith("duet")}


def choose(duet: Studio, *, everybody: bool = False, **options: Any) -> list[str]:
    wanted = {"options": options, "everybody": everybody}
    answer = duet.post(f"{duet.one}/reading", wanted)
    assert answer.status_code == 200, answer.text
    return answer.json()


def labels(duet: Studio) -> set[str]:
    return {row["label"] for row in duet.recording()["segmentation"]["segments"]} - {""}


def test_it_asks_once_and_each_has_a_table_of_its_own(duet: Studio) -> None:
    asked = duet.get(duet.one)
    assert (asked.status_code, asked.json()["people"]) == (400, ["Anna", "Bob"])
    assert "2 people found" in asked.json()["error"]
    assert ids_of(duet) == {"duet.trc": duet.id}
    shown = choose(duet, everybody=True)
    assert shown == [*ids_of(duet).values()]
    assert [*ids_of(duet)] == ["duet.trc · Anna", "duet.trc · Bob"]
    anna, bob = of(duet, "Anna"), of(duet, "Bob")
    heads = anna.recording(), bob.recording()
    assert [each["person"] for each in heads] == ["Anna", "Bob"]
    assert heads[0]["people"] == heads[1]["people"] == ["Anna", "Bob"]
    assert heads[0]["file"] == heads[1]["file"] == duet.id
    assert not any(":" in name for name in heads[1]["motion"]["joints"])
    for studio, label in ((anna, "of Anna"), (bob, "of Bob")):
        studio.apply("name_segment", **NAME, label=label)
    assert labels(anna) == {"of Anna"}
    assert labels(bob) == {"of Bob"}
    bob.apply("undo")
    assert (labels(anna), labels(bob)) == ({"of Anna"}, set())
    tables = sorted(path.name for path in duet.folder.glob("duet*.segments.json"))
    assert tables == ["duet_Anna.segments.json", "duet_Bob.segments.json"]
    table = kineme.read_segments(duet.folder / "duet_Anna.segments.json")
    assert table.provenance["input"]["person"] == "Anna"
    state = duet.state()
    assert {each["name"] for each in state["recordings"] if each["corrected"]} == {*ids_of(duet)}
    assert not any(each["name"].startswith("duet") for each in state["annotations"])
    exported = duet.get(f"{anna.one}/export/csv").headers["content-disposition"]
    assert "duet_Anna.segments.csv" in exported


def test_reading_the_file_otherwise_makes_the_tables_of_all_anew(duet: Studio) -> None:
    choose(duet, person="Bob")
    anna, bob = of(duet, "Anna"), of(duet, "Bob")
    for studio in (anna, bob):
        studio.apply("name_segment", **NAME, label="before")
    assert choose(bob, person="Anna") == [anna.id]
    assert (labels(anna), labels(bob)) == ({"before"}, {"before"})
    assert choose(bob, person="Bob", fps=15.0) == [bob.id]
    for studio in (anna, bob):
        message = studio.recording()
        assert message["fps"] == message["segmentation"]["fps"] == 15.0
        assert labels(studio) == set()
        versions = duet.get(f"{studio.one}/versions").json()["versions"]
        assert [each["names"] for each in versions] == [1]
    wanted = {"options": {"person": "Eve"}}
    refused = duet.post(f"{bob.one}/reading", wanted)
    assert (refused.status_code, refused.json()["people"]) == (400, ["Anna", "Bob"])
    assert bob.recording()["fps"] == 15.0


def test_reading_it_as_it_is_read_makes_no_table_anew(duet: Studio) -> None:
    assert choose(duet, person="Bob", fps=15.0) == [of(duet, "Bob").id]
    bob = of(duet, "Bob")
    bob.apply("name_segment", **NAME, label="before")
    revision = bob.recording()["revision"]
    assert choose(bob, person="Bob", fps=15.0) == [bob.id]
    assert (labels(bob), bob.recording()["revision"]) == ({"before"}, revision)


def test_commands_take_all_people(duet: Studio, monkeypatch: pytest.MonkeyPatch) -> None:
    choose(duet, everybody=True)
    for person in ("Anna", "Bob"):
        one = of(duet, person)
        call = {"cluster": 0, "label": f"by {person}"}
        one.apply("name_cluster", **call)
    ids = [*ids_of(duet).values()]
    sent = {"name": "known", "recordings": ids}
    assert duet.post("/api/knowledge", sent).status_code == 200
    known = kineme.KnowledgeBase.load(duet.folder / "known.npz")
    assert {*known.labels} == {"by Anna", "by Bob"}
    monkeypatch.chdir(duet.folder)

    def run(*arguments: str) -> str:
        asked = [arguments[0], "duet.trc", "--person", "all", *arguments[1:]]
        done = CliRunner().invoke(app, asked)
        assert done.exit_code == 0, done.output
        return done.output

    run("cycles", "--segments", ".", "--ends", "-q", "-o", "cycles.csv")
    rows = Path("cycles.csv").read_text()
    assert "duet_Anna" in rows
    assert "duet_Bob" in rows
    assert "by Anna" in rows
    run("split", "--segments", ".", "--level", "primitive", "-o", "clips")
    assert any("Anna" in each.name for each in Path("clips_Anna").iterdir())
    assert any(Path("clips_Bob").iterdir())
    run("report", "--segments", ".", "-o", "page.html")
    assert "by Anna" in Path("page_Anna.html").read_text()
    assert "by Anna" not in Path("page_Bob.html").read_text()
    with pytest.warns(KinemeWarning, match="left heel, right heel not found"):
        run("events", "-o", "feet.csv")
    assert {path.name for path in Path().glob("feet*.csv")} == {"feet_Anna.csv", "feet_Bob.csv"}


def test_everybody_can_be_asked_for_at_the_start(duet: Studio) -> None:
    _split_people([duet.path, duet.folder / "take.bvh"], ReadOptions())
    assert [*ids_of(duet)] == ["duet.trc · Anna", "duet.trc · Bob"]
    asked = ["studio", "--no-browser", str(duet.folder), "--person", "all"]
    done = CliRunner().invoke(app, asked)
    assert done.exit_code == 1
    assert "--person all needs file names" in done.stderr


def test_names_that_files_cannot_hold() -> None:
    odd = ListedRecording(Path("walk.c3d"), "A/../b c")
    assert odd.person_path.name == "walk_A_.._b_c.c3d"
    assert odd.name == "walk.c3d · A/../b c"
    assert ListedRecording(Path("walk.json"), "1").name == "walk.json · person 1"
    assert odd.id != ListedRecording(Path("walk.c3d"), "A").id
    for person in ("é" * 500, "\ud800", "..."):
        long = ListedRecording(Path("walk.c3d"), person)
        assert len(long.person_path.name.encode()) < 80
        assert long.id
