"""The folder as a whole: details, labels in common, exports of what is checked, clips."""

from __future__ import annotations

import base64
import io
import shutil
import zipfile
import zlib

import numpy as np
import pytest
from studio_clients import Studio

import kineme
from kineme.clips.loops import Carry
from kineme.formats.scenes.gltf_writer import write_animations
from kineme.recordings.operations import turn
from kineme.studio.folder import read_brief, summarize_table
from kineme.web.encoding import to_json


def test_a_detail_is_shown_before_it_is_made(studio: Studio) -> None:
    address = f"{studio.one}/preview"
    sent = {"preset": "kineme", "parameters": {}, "keep": True, "detail": 0.125}
    preview = studio.post(address, sent).json()
    assert preview["detail"] == preview["details"][0]
    made = studio.apply("segment", preset="kineme", parameters={}, detail=0.125)
    assert made["segmentation"]["segments"] == preview["segmentation"]["segments"]
    assert studio.post(address, {**sent, "detail": -1}).status_code == 400


def test_repetitions_are_measured_as_by_the_command(studio: Studio) -> None:
    one = studio.one
    channels = studio.get(f"{one}/cycles").json()["channels"]
    assert channels[0]["name"] == "knee_l"
    motion = kineme.read(studio.path)
    cycles = kineme.cycles(motion, kineme.segment(motion), channels=["hip_l"])
    curves = studio.get(f"{one}/cycles/0?channel=hip_l").json()
    mean = cycles.layout("hip_l", "cluster 0").mean(axis=0)
    assert curves["mean"] == pytest.approx(mean, abs=0.01)
    assert studio.get(f"{one}/cycles/0").json()["channel"] in {each["name"] for each in channels}
    for wrong in ("99", "0?channel=tail", "x"):
        assert studio.get(f"{one}/cycles/{wrong}").status_code == 404
    row = next(each for each in kineme.segment(motion).primitives if each.kind == "primitive")
    frame = row.stop_frame  # an edit is measured anew
    studio.apply("delete_border", level="primitive", frame=frame)
    fewer = studio.get(f"{one}/cycles/0?channel=hip_l").json()
    assert fewer["total"] == curves["total"] - 1


def test_curves_come_in_pieces(studio: Studio) -> None:
    head = studio.get(f"{studio.one}/curves").json()
    assert {each["group"] for each in head["curves"]} >= {"height", "speed"}
    piece = studio.get(f"{studio.one}/curves/0/0/0").content
    assert np.frombuffer(piece, "<f4").size == 2 * studio.recording()["n_frames"]
    assert studio.get(f"{studio.one}/curves/0/9/0").status_code == 404


def test_checked_recordings_are_written_together_and_known_by_their_names(studio: Studio) -> None:
    message = studio.recording()
    assert studio.get("/api/export/json").status_code == 400  # none is checked yet
    for row in message["segmentation"]["segments"]:
        level, frame = row["level"], row["start_frame"]
        edit = {"level": level, "frames": [frame], "checked": True}
        studio.apply("check", **edit)
    row = next(each for each in message["segmentation"]["segments"] if each["kind"] == "activity")
    named = {"level": row["level"], "frame": row["start_frame"], "label": "walk"}
    studio.apply("name_segment", **named)
    answer = studio.get("/api/export/json")
    assert zipfile.ZipFile(io.BytesIO(answer.content)).namelist() == ["take.segments.json"]
    assert answer.headers["content-disposition"].endswith("folder.checked.segments.json.zip")
    answer = studio.get("/api/export/csv")
    files = zipfile.ZipFile(io.BytesIO(answer.content))
    assert files.namelist() == ["take.segments.csv", "folder.all.segments.csv"]
    one, together = (files.read(name).decode().splitlines() for name in files.namelist())
    assert together == [f"recording,{one[0]}", *(f"take.bvh,{row}" for row in one[1:])]
    wanted = {"name": "../moves", "recordings": [studio.id]}
    made = studio.post("/api/knowledge", wanted).json()
    assert made["name"] == "moves.npz"
    assert (studio.folder / "moves.npz").exists()
    assert studio.post("/api/knowledge", wanted).status_code == 400  # there already
    assert studio.state()["recordings"][0]["named"] >= 1


def test_the_folder_tells_of_tables_without_reading_recordings(studio: Studio) -> None:
    message = studio.recording()
    (found,) = studio.get("/api/tables").json()["recordings"]  # as found, saved nowhere
    rows = message["segmentation"]["segments"]
    assert found["table"]["start_frame"] == [row["start_frame"] for row in rows]
    frame = rows[0]["start_frame"]
    edit = {"level": rows[0]["level"], "frames": [frame], "checked": True}
    studio.apply("check", **edit)
    said = {"level": rows[0]["level"], "frame": frame, "text": "slips"}
    studio.apply("comment", **said)
    table = next(studio.folder.glob("*.segments.json"))
    assert to_json(read_brief(table)) == to_json(summarize_table(kineme.read_segments(table)))
    (studio.folder / "take.bvh").write_text("no recording any more")
    (told,) = studio.get("/api/tables").json()["recordings"]
    assert (told["table"]["checked"], told["table"]["comments"]) == ([0], 1)
    assert told["table"]["confidence"] == [row["confidence"] for row in rows]


def test_what_is_called_otherwise_in_one_recording_is_in_all(studio: Studio) -> None:
    shutil.copy(studio.path, studio.folder / "other.bvh")
    other = studio.choose("other.bvh")
    rows = studio.recording()["segmentation"]["segments"]
    cluster = next(row["cluster"] for row in rows if row["cluster"] >= 0)
    other.apply("name_cluster", cluster=cluster, label="walk")
    sent = {"recording": studio.id, "cluster": cluster, "before": "walk", "label": "stride"}
    told = studio.post("/api/names", sent).json()
    assert told == {"tables": 1, "others": 0, "left": []}
    assert other.recording()["segmentation"]["cluster_names"][str(cluster)] == "stride"
    undone = other.apply("undo")
    assert undone["change"]["cluster_names"][str(cluster)] == "walk"
    assert studio.post("/api/names", {**sent, "before": ""}).status_code == 400


def test_labels_are_shared_and_clips_are_of_chosen_rows(studio: Studio) -> None:
    studio.post("/api/labels", {"labels": ["walk", " walk ", "", "jump"]})
    assert studio.state()["labels"] == ["walk", "jump"]
    address = f"{studio.one}/clips"
    clips = studio.post(address, {"rows": [0], "loops": True})
    names = zipfile.ZipFile(io.BytesIO(clips.content)).namelist()
    assert sum(name.endswith(".bvh") for name in names) == 1
    assert studio.post(address, {"rows": [10_000], "loops": False}).status_code == 400


def test_repetitions_are_ranked_as_loops(studio: Studio) -> None:
    rows = studio.recording()["segmentation"]["segments"]
    loops = studio.get(f"{studio.one}/loops").json()["loops"]
    candidates = [
        number
        for number, row in enumerate(rows)
        if row["level"] == "primitive" and row["kind"] != "transition"
    ]
    assert sorted(each["number"] for each in loops) == candidates
    costs: dict[int, list[float]] = {}
    for each in loops:
        of_cluster = costs.setdefault(rows[each["number"]]["cluster"], [])
        of_cluster.append(each["cost"])
        assert each["rank"] == len(of_cluster)
    assert all(each == sorted(each) for each in costs.values())


def test_a_loop_plays_as_it_is_written(studio: Studio) -> None:
    number = studio.get(f"{studio.one}/loops").json()["loops"][0]["number"]
    sent = studio.get(f"{studio.one}/loops/{number}").json()
    head, row = sent["motion"], studio.recording()["segmentation"]["segments"][number]
    n, joints = head["n_samples"], len(head["joints"])
    assert n == row["stop_frame"] - row["start_frame"] + 1
    steps = np.frombuffer(zlib.decompress(base64.b64decode(sent["numbers"])), "<i2")
    steps = np.cumsum(steps.reshape(3 * joints, n), axis=1, dtype=np.int16)
    positions = head["origin"] + head["step"] * steps.T.reshape(n, joints, 3)
    address = f"{studio.one}/clips"
    clips = studio.post(address, {"rows": [number], "loops": True})
    with zipfile.ZipFile(io.BytesIO(clips.content)) as files:
        (name,) = (name for name in files.namelist() if name.endswith(".bvh"))
        files.extract(name, studio.folder.parent)
    written = kineme.read(studio.folder.parent / name).positions
    assert np.abs(positions[:-1] - written).max() < 1e-3
    carried = Carry(sent["turn"], sent["x"], sent["z"]).apply(positions[:1])
    assert np.abs(positions[-1:] - carried).max() < 1e-3
    assert studio.get(f"{studio.one}/loops/9999").status_code == 400


def test_a_comment_outlives_borders_and_new_segmentations(studio: Studio) -> None:
    message = studio.recording()
    row = message["segmentation"]["segments"][0]
    said = {"level": row["level"], "frame": row["start_frame"], "text": "slips"}
    studio.apply("comment", **said)
    made = studio.apply("segment", preset="kineme", parameters={}, detail=8)
    rows = made["segmentation"]["segments"]
    (commented,) = [each for each in rows if "comment" in each]
    assert commented["comment"] == "slips"
    middle = (row["start_frame"] + row["stop_frame"]) // 2
    assert commented["start_frame"] <= middle < commented["stop_frame"]


def test_a_recording_can_be_read_otherwise(studio: Studio) -> None:
    message = studio.recording()
    chosen = {"preset": "voegele2014", "parameters": {"radius": 0.5}}
    studio.apply("segment", **chosen)
    address = f"{studio.one}/reading"
    assert studio.post(address, {"options": {"unit": "parsec"}}).status_code == 400
    assert studio.recording()["fps"] == message["fps"]
    assert studio.post(address, {"options": {"fps": 30.0}}).status_code == 200
    after = studio.recording()
    assert (after["fps"], after["read_options"]) == (30.0, {"fps": 30.0})
    assert after["segmentation"]["fps"] == 30.0
    made = after["segmentation"]["provenance"]  # as the table was made before
    assert (made["preset"], made["parameters"]["radius"]) == ("voegele2014", 0.5)
    assert after["can_undo"] is False or after["saved"]


def test_each_take_of_a_file_has_a_table_of_its_own(studio: Studio) -> None:
    motion = kineme.read(studio.path)
    path = studio.folder / "takes.glb"
    motions = {"walk": motion, "turned": turn(motion, 1.0), "short": motion[:200]}
    write_animations(motions, path)
    takes = studio.choose("takes.glb")
    address = f"{takes.one}/reading"

    def named(take: str) -> tuple[str | None, set[str]]:
        """The take that is shown once it is asked for, and the names in its table."""
        assert studio.post(address, {"options": {"take": take}}).status_code == 200
        shown = takes.recording()
        return shown["take"], {row["label"] for row in shown["segmentation"]["segments"]} - {""}

    first = takes.recording()
    assert (first["take"], first["takes"]) == ("walk", ["walk", "turned", "short"])
    name = {"level": "activity", "frame": 0}
    takes.apply("name_segment", **name, label="of walk")
    assert named("turned") == ("turned", set())
    takes.apply("name_segment", **name, label="of turned")
    assert named("walk") == ("walk", {"of walk"})
    assert named("turned") == ("turned", {"of turned"})
    tables = [path.with_name(f"takes.{kind}segments.json") for kind in ("", "glb.")]
    assert [kineme.read_segments(each).provenance["input"]["take"] for each in tables] == [
        "walk",
        "turned",
    ]
    assert named("short") == ("short", set())
    assert not any("was not used" in each for each in takes.recording()["warnings"])
    refused = studio.post(address, {"options": {"take": "run"}})
    assert (refused.status_code, refused.json()["reading"]) == (400, True)
    assert takes.recording()["take"] == "short"
