"""Several people's labels in the studio: who there is, how far they agree, lanes, differences."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from studio_clients import Studio

SAID = {
    "anna": "start_s,stop_s,label\n0,2,walk\n2,4,squat\n",
    "ben": "start_s,stop_s,label\n0,3,Walk\n3,4,squat\n",
}


@pytest.fixture
def labelled(folder: Path) -> Path:
    """A folder with two recordings, labels of two people in folders, and of others beside them."""
    shutil.copy(folder / "take.bvh", folder / "second.bvh")
    for who, text in SAID.items():
        (folder / who).mkdir()
        for name in ("take", "second"):
            (folder / who / f"{name}.csv").write_text(text)
    (folder / "take.cleo.csv").write_text(SAID["anna"])
    (folder / "dora.csv").write_text("recording,start_s,stop_s,label\ntake,0,4,walk\n")
    (folder / "clips").mkdir()
    return folder


def test_people_are_found_and_compared(labelled: Path, make_studio) -> None:
    studio: Studio = make_studio()
    people = {each["name"]: each for each in studio.get("/api/annotators").json()}
    assert {name: each["recordings"] for name, each in people.items()} == {
        "anna": 2,
        "ben": 2,
        "dora": 1,
        "cleo": 1,
    }
    sent = {"annotators": [people[name]["id"] for name in ("anna", "ben", "cleo")]}
    found = studio.post("/api/agreement", sent).json()
    assert (found["annotators"], found["by_names"]) == (["anna", "ben", "cleo"], True)
    kappas = {tuple(pair["annotators"]): pair["cohen_kappa"] for pair in found["pairs"]}
    assert kappas["anna", "cleo"] == pytest.approx(1)
    assert 0 < kappas["anna", "ben"] < 1
    assert found["recordings"][1]["id"] == studio.id
    assert found["recordings"][1]["differences"] == [
        {"start_s": 2.0, "stop_s": 3.0, "labels": ["squat", "Walk", "squat"]}
    ]
    lanes = studio.post(f"{studio.one}/lanes", sent).json()
    assert [lane["name"] for lane in lanes] == ["anna", "ben", "cleo"]
    assert lanes[1]["segmentation"]["segments"][0]["label"] == "Walk"


def test_whoever_works_here_is_one_of_them(labelled: Path, make_studio) -> None:
    studio: Studio = make_studio()
    studio.apply("name_segment", level="activity", frame=0, label="walk")
    (last,) = [each for each in studio.get("/api/annotators").json() if each["id"] == "tables"]
    assert (last["name"], last["recordings"]) == ("Tables of this studio", 1)


def test_nobody_to_compare_is_said(labelled: Path, make_studio) -> None:
    studio: Studio = make_studio()
    people = {each["name"]: each["id"] for each in studio.get("/api/annotators").json()}
    for sent, status, text in (
        ([people["anna"]], 400, "no recording has labels by two of them"),
        (["nobody"], 404, "has no labels any more"),
        ([], 400, "no recording has labels by two"),
    ):
        answer = studio.post("/api/agreement", {"annotators": sent})
        assert (answer.status_code, text in answer.text) == (status, True), answer.text
    (labelled / "ben" / "take.csv").write_text("start_s,stop_s,label\n0,9999,walk\n")
    (labelled / "ben" / "second.csv").write_text("start_s,stop_s,label\nx,y,walk\n")
    answer = studio.post("/api/agreement", {"annotators": [people["anna"], people["ben"]]})
    assert "second.bvh, ben: " in answer.text
