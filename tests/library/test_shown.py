"""A library in the studio: what its addresses answer."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient

from kineme.library import Library
from kineme.studio.http.events import Hub
from kineme.studio.library import StudioLibrary
from kineme.studio.open_recordings import OpenRecordings
from kineme.studio.routes import create_app

TOKEN, PORT = "the token", 8750
WALK = {"recording": "walk.bvh", "start_s": 0.5, "stop_s": 1.6}


@pytest.fixture
def client(folder: Path) -> Iterator[TestClient]:
    shown, hub = StudioLibrary(folder), Hub()
    recordings = OpenRecordings(shown.as_folder(), hub.tell, *shown.options())
    app = create_app(recordings, token=TOKEN, port=PORT, hub=hub, library=shown)
    with TestClient(
        app, base_url=f"http://127.0.0.1:{PORT}", headers={"x-kineme-token": TOKEN}
    ) as client:
        yield client


def search(client: TestClient, *like: dict[str, Any], **rest: Any) -> Any:
    sent = {"like": like, "unlike": [], "threshold": 0.85, "top": 50, "mirror": False, **rest}
    return client.post("/api/library/search", json=sent)


def edit_clusters(client: TestClient, kind: str, **rest: Any) -> Any:
    return client.post("/api/library/edits", json={"kind": kind, **rest})


def test_a_library_is_told_with_its_recordings_and_clusters(client, folder, takes):
    assert client.get("/api/library", headers={"x-kineme-token": "no"}).status_code == 403
    told = client.get("/api/library").json()
    own = Library(folder)
    assert [each["cluster"] for each in told["clusters"]] == [c.cluster for c in own.clusters()]
    by_name = {each["recording"]: each for each in told["recordings"]}
    assert by_name.keys() == {"walk.bvh", "jacks.bvh", "wrist.csv"}
    assert by_name["walk.bvh"]["status"] == "as found"
    assert [Path(path).name for path in told["failed"]] == ["broken.bvh"]
    listed = client.get("/api/state").json()
    assert listed["of_library"]
    assert {each["id"] for each in listed["recordings"]} == {e["id"] for e in by_name.values()}
    page = client.get("/", params={"token": TOKEN}).text
    assert page != client.get("/", params={"token": TOKEN, "open": "none"}).text


def test_clusters_are_named_merged_and_split_as_on_the_command_line(client, folder):
    bodies = [
        c for c in client.get("/api/library").json()["clusters"] if c["vocabulary"] == "bodies"
    ]
    wide = next(c["cluster"] for c in bodies if len(c["recordings"]) == 2)
    other = next(c["cluster"] for c in bodies if c["cluster"] != wide)

    told = edit_clusters(client, "name", cluster=wide, name=" 7 ").json()
    assert {c["label"] for c in told["clusters"] if c["cluster"] == wide} == {"7"}
    assert Library(folder).numbers("7") == [wide]
    parted = edit_clusters(client, "split", cluster=wide, recordings=["walk.bvh"]).json()
    assert len(parted["clusters"]) == len(told["clusters"]) + 1
    Library(folder).name(other, "said elsewhere")  # on the command line, meanwhile
    joined = edit_clusters(client, "merge", cluster=other, others=[wide]).json()
    assert wide not in [c["cluster"] for c in joined["clusters"]]
    assert "said elsewhere" in [c["label"] for c in joined["clusters"]]
    refused = edit_clusters(client, "split", cluster=other, recordings=["none"])
    assert refused.status_code == 400
    assert "there is no recording 'none' in the library" in refused.json()["error"]


def test_more_like_this_takes_examples_and_counterexamples_of_the_library_alone(client, takes):
    found = search(client, WALK).json()["hits"]
    own = Library(client.get("/api/library").json()["folder"])
    assert [hit["distance"] for hit in found] == [
        hit.distance for hit in own.search("walk.bvh", 0.5, 1.6)
    ]
    assert found[0]["recording"] == "walk.bvh"
    assert found[0]["distance"] < 0.1
    last = {name: found[-1][name] for name in WALK}
    fewer = search(client, WALK, unlike=[last]).json()["hits"]
    assert last not in [{name: hit[name] for name in WALK} for hit in fewer]
    assert len(fewer) < len(found)
    refused = search(client, {**WALK, "recording": str(takes / "walk.bvh")})
    assert refused.status_code == 400
    assert "no recording" in refused.json()["error"]
    assert "nothing to search for" in search(client).json()["error"]


def test_figures_are_of_bodies_or_channels_and_only_of_what_is_there(client, takes, folder):
    def figure(**asked: Any) -> Any:
        return client.get("/api/library/figure", params=asked)

    body = figure(recording="walk.bvh", start=0.5, stop=1.6).json()
    assert body["motion"]["n_samples"] in (33, 34)
    assert len(body["numbers"]) > 100
    wrist = figure(recording="wrist.csv", start=0, stop=2).json()
    assert wrist["motion"] is None
    assert all(0 <= value <= 1 for curve in wrist["curves"] for value in curve)
    assert figure(recording="/etc/hostname", start=0, stop=1).status_code == 400
    assert figure(recording="walk.bvh", start=2, stop=1).status_code == 400
    assert figure(recording="walk.bvh").status_code == 400


@pytest.fixture
def without_tables(takes: Path) -> Iterator[None]:
    """Tables that are left beside the recordings, which all tests share, are taken away."""
    yield
    (takes / "walk.segments.json").unlink()
    shutil.rmtree(takes / ".kineme")


@pytest.mark.usefixtures("without_tables")
def test_hits_are_named_alone_in_the_tables_beside_their_recordings(client, folder):
    hits = search(client, WALK).json()["hits"]
    spans = [{name: hit[name] for name in WALK} for hit in hits[:2]]
    nowhere = {"recording": "walk.bvh", "start_s": 0.0, "stop_s": 1e6}
    before = [cluster.label for cluster in Library(folder).clusters()]
    wanted = {"name": "limps", "hits": [*spans, nowhere, {**nowhere, "recording": "none"}]}
    told = client.post("/api/library/names", json=wanted).json()
    assert told["named"] == 2
    assert [said.split(": ")[1] for said in told["left"]] == [
        "there is no segment",
        "its file is missing",
    ]
    named = {hit["name"] for hit in search(client, WALK).json()["hits"][:2]}
    assert named == {"limps"}
    assert [cluster.label for cluster in Library(folder).clusters()] == before


def shown(client: TestClient, name: str) -> dict[str, Any]:
    """A recording as the studio opens it."""
    listed = client.get("/api/library").json()["recordings"]
    (found,) = [each["id"] for each in listed if each["recording"] == name]
    return client.get(f"/api/recordings/{found}").json()


def clusters_of(message: dict[str, Any]) -> list[int]:
    return [row["cluster"] for row in message["segmentation"]["segments"]]


def in_library(folder: Path, name: str) -> list[int]:
    table = Library(folder).table("segments").to_pylist()
    return [row["cluster"] for row in table if row["recording"] == name]


def test_recordings_have_the_clusters_and_names_of_the_library(client, folder):
    told = client.get("/api/library").json()
    first, second = [c["cluster"] for c in told["clusters"] if c["vocabulary"] == "bodies"][:2]
    walk = shown(client, "walk.bvh")
    assert clusters_of(walk) == in_library(folder, "walk.bvh")
    assert walk["saved"] == ""
    edit_clusters(client, "name", cluster=clusters_of(walk)[0], name="stroll")
    again = shown(client, "walk.bvh")
    assert again["revision"] > walk["revision"]
    assert again["segmentation"]["cluster_names"][str(clusters_of(walk)[0])] == "stroll"
    tables = client.get("/api/tables").json()["recordings"]
    assert {each["id"] for each in tables if each["table"]} == {each["id"] for each in tables}

    before = in_library(folder, "walk.bvh"), in_library(folder, "jacks.bvh")
    merged = edit_clusters(client, "merge", cluster=first, others=[second]).json()
    assert "merged into" in merged["undo"]
    assert second not in clusters_of(shown(client, "walk.bvh"))
    assert "stroll" in edit_clusters(client, "undo").json()["undo"]
    assert (in_library(folder, "walk.bvh"), in_library(folder, "jacks.bvh")) == before
    assert clusters_of(shown(client, "walk.bvh")) == before[0]
    Library(folder).name(first, "said elsewhere")
    assert client.get("/api/library").json()["undo"] == ""
    assert edit_clusters(client, "undo").status_code == 400


def correct(client: TestClient, message: dict[str, Any], kind: str, **edit: Any) -> dict[str, Any]:
    sent = {"revision": message["revision"], "edit": {"kind": kind, **edit}}
    return client.post(f"/api/recordings/{message['id']}/edits", json=sent).json()


@pytest.mark.usefixtures("without_tables")
def test_saved_tables_take_numbers_and_names_when_they_are_told_to(client, folder):
    walk = shown(client, "walk.bvh")
    rows = walk["segmentation"]["segments"]
    cluster = next(each["cluster"] for each in rows if each["cluster"] >= 0)
    members = [each for each in rows if each["cluster"] == cluster]
    alone = {"level": members[0]["level"], "frame": members[0]["start_frame"], "label": "limp"}
    correct(client, walk, "name_segment", **alone)
    edit_clusters(client, "name", cluster=cluster, name="stroll")
    assert "stroll" not in labels_of(shown(client, "walk.bvh"))
    others = {row["cluster"] for row in rows} - {cluster, -1}
    edit_clusters(client, "merge", cluster=cluster, others=[*others][:1])
    brought = client.post("/api/library/tables", json={"names": False}).json()
    assert brought == {"tables": 1, "others": 0, "left": []}
    after = shown(client, "walk.bvh")
    assert clusters_of(after) == in_library(folder, "walk.bvh")
    assert labels_of(after)[rows.index(members[0])] == "limp"
    assert labels_of(after).count("stroll") >= len(members) - 1
    again = client.post("/api/library/tables", json={"names": False}).json()
    assert again == {"tables": 0, "others": 0, "left": []}
    correct(client, after, "undo")
    assert "stroll" not in labels_of(shown(client, "walk.bvh"))


@pytest.mark.usefixtures("without_tables")
def test_a_name_of_one_recording_is_given_to_all_and_others_are_kept(client, folder):
    walk = shown(client, "walk.bvh")
    jacks = shown(client, "jacks.bvh")
    (cluster, *_) = sorted({*clusters_of(walk)} & {*clusters_of(jacks)} - {-1})
    walk = correct(client, walk, "name_cluster", cluster=cluster, label="mine") | {"id": walk["id"]}
    sent = {"recording": jacks["id"], "cluster": cluster, "before": "", "label": "ours"}
    told = client.post("/api/library/everywhere", json=sent).json()
    assert told == {"tables": 0, "others": 1, "left": []}
    assert Library(folder).numbers("ours") == [cluster]
    names = shown(client, "jacks.bvh")["segmentation"]["cluster_names"]
    assert names[str(cluster)] == "ours"
    assert shown(client, "walk.bvh")["segmentation"]["cluster_names"][str(cluster)] == "mine"
    assert client.post("/api/library/tables", json={"names": True}).json()["tables"] == 1
    assert shown(client, "walk.bvh")["segmentation"]["cluster_names"][str(cluster)] == "ours"


def labels_of(message: dict[str, Any]) -> list[str]:
    return [row["label"] for row in message["segmentation"]["segments"]]
