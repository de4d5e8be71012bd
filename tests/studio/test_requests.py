"""What the studio answers: recordings, edits with undo, comparisons, exports."""

from __future__ import annotations

import copy
import json
import math
import shutil
import zipfile
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from studio_clients import TOKEN

import kineme
from kineme.labels import label_formats
from kineme.methods import PRESETS, resolve_preset
from kineme.transfer import KnowledgeBase
from kineme.web import messages
from kineme.web.encoding import to_json


def conforms(kind: type, answer: dict[str, Any]) -> bool:
    """Whether an answer has exactly the fields of its message, each of its own type."""
    typed = copy.deepcopy(answer)
    for row in typed.get("segmentation", {}).get("segments", []):
        for name in ("confidence", "border_confidence"):  # JSON has no nan
            row[name] = math.nan if row[name] is None else row[name]
    return json.loads(to_json(msgspec.convert(typed, kind))) == answer


def write_imu(path: Path) -> None:
    """Twenty seconds of three channels that repeat."""
    seconds = np.arange(0, 20, 0.02)
    waves = np.column_stack([np.sin(6 * seconds), np.cos(6 * seconds), np.sin(12 * seconds)])
    rows = np.column_stack([seconds, waves])
    np.savetxt(path, rows, delimiter=",", header="time,acc_1,acc_2,gyro_1", comments="")


def test_what_there_is_to_open(studio, folder: Path) -> None:
    table = kineme.segment(kineme.read(studio.path))
    kineme.write_segments(table, folder / "labels.csv")
    kineme.write_segments(table, folder / "labels.eaf")
    named = kineme.segments.editing.name_cluster(table, 0, "walk")
    KnowledgeBase.from_recording(kineme.read(studio.path), named).save(folder / "base.npz")
    kineme.write(kineme.read(studio.path), folder / "poses.csv")
    (folder / "take.asf").write_text(":version 1.10")
    (folder / "package.json").write_text('{"name": "other"}')
    (folder / ".hidden.bvh").write_text("HIERARCHY")
    state = studio.state()
    names = {
        what: [file["name"] for file in state[what]]
        for what in ("recordings", "knowledge_bases", "annotations")
    }
    assert names == {
        "recordings": ["poses.csv", "take.bvh"],
        "knowledge_bases": ["base.npz"],
        "annotations": ["labels.csv", "labels.eaf"],
    }
    assert not any(file["corrected"] for file in state["recordings"])
    assert state["default_preset"] == state["presets"][0]["name"]
    assert {".bvh", ".c3d", ".npz"} <= set(state["suffixes"])
    assert conforms(messages.State, state)


def test_what_the_pages_address_names_is_opened_ahead(studio, monkeypatch) -> None:
    studio.get(f"/?token={TOKEN}&open=none&open={studio.id}")
    monkeypatch.setattr("kineme.studio.loading.read_quietly", _unread)
    assert studio.recording()["segmentation"]["segments"]


@pytest.mark.parametrize("token", ["", "wrong"])
def test_nothing_is_opened_ahead_without_the_token(studio, token, monkeypatch) -> None:
    studio.client.headers.pop("x-kineme-token")
    monkeypatch.setattr("kineme.studio.loading.read_quietly", _unread)
    assert studio.get(f"/?token={token}&open={studio.id}").status_code == 200


def _unread(*_: object) -> None:
    pytest.fail("the file is read")


def test_each_preset_offers_its_own_constants_with_their_help(studio) -> None:
    for choice in studio.state()["presets"]:
        preset = PRESETS[choice["name"]]
        assert choice["help"] == preset.help
        for signals, which in ((False, "parameters"), (True, "signal_parameters")):
            values = resolve_preset(choice["name"], signals=signals)
            sliders = [known.name for known in values.constants() if known.slider]
            assert [offered["name"] for offered in choice[which]] == sliders
            for offered in choice[which]:
                assert offered["help"]
                assert offered["value"] == getattr(values, offered["name"])
                assert offered["minimum"] <= offered["value"] <= offered["maximum"]
                steps = (offered["value"] - offered["minimum"]) / offered["step"]
                assert steps == pytest.approx(round(steps), abs=1e-6)  # where a slider can stand


def test_lengths_of_signals_are_in_their_own_unit_however_often_they_are_sent(
    studio, folder: Path
) -> None:
    write_imu(folder / "imu.csv")
    studio = studio.choose("imu.csv")
    choice = next(each for each in studio.state()["presets"] if each["name"] == "voegele2014")
    values = {each["name"]: each["value"] for each in choice["signal_parameters"]}
    plain = kineme.segment(kineme.read(folder / "imu.csv"), preset="voegele2014")
    for _ in range(2):
        again = studio.apply("segment", preset="voegele2014", parameters=values)
        used = again["segmentation"]["provenance"]["parameters"]
        assert kineme.read_segments(folder / "imu.segments.json").table == plain.table
        values = {name: used[name] for name in values}  # as the page does


def test_a_recording_is_what_segment_finds(studio) -> None:
    found = kineme.segment(kineme.read(studio.path))
    message = studio.recording()
    rows = message["segmentation"]["segments"]
    assert [row["start_frame"] for row in rows] == found.table.start_frame.tolist()
    assert [row["cluster"] for row in rows] == found.table.cluster.tolist()
    assert (message["revision"], message["saved"], message["can_undo"]) == (1, "", False)
    assert not studio.table.exists()
    data = studio.get(f"{studio.one}/motion").content
    assert len(data) > 1000
    assert message["motion"]["n_samples"] == message["n_frames"] // 2
    tile = studio.get(f"{studio.one}/matrix/0/0/0")
    assert tile.content.startswith(b"\x89PNG")
    for place in ("0/1/0", "9/0/0", "0/-1/0", "0/x/0", "0/" + "9" * 5000 + "/0"):
        assert studio.get(f"{studio.one}/matrix/{place}").status_code == 404


def test_each_edit_is_on_the_disk_and_can_be_taken_back(studio) -> None:
    first = studio.recording()
    before = first["segmentation"]["segments"]
    border = first["n_frames"] // 3
    split = studio.apply("split", level="activity", frame=border)
    assert split["saved"] == "take.segments.json"
    assert border in kineme.read_segments(studio.table).cuts("activity")
    assert kineme.read_segments(studio.table).annotation.corrections == 1
    studio.apply("move_border", level="activity", frame=border, to=border + 7)
    named = studio.apply("name_segment", level="activity", frame=border + 7, label="<b>hop</b>")
    labels = kineme.read_segments(studio.table).activities.label.tolist()
    assert "<b>hop</b>" in labels
    for _ in range(3):
        state = studio.apply("undo")
    assert state["segmentation"]["segments"] == before
    assert (state["can_undo"], state["can_redo"]) == (False, True)
    assert kineme.read_segments(studio.table).table.start_frame.tolist() == [
        row["start_frame"] for row in before
    ]
    for _ in range(3):
        state = studio.apply("redo")
    assert state["segmentation"] == named["segmentation"]
    assert studio.recording()["segmentation"] == named["segmentation"]
    assert studio.state()["recordings"][0]["corrected"]


@pytest.mark.parametrize(
    ("kind", "rest"),
    [
        ("move_border", {"level": "activity", "frame": 1, "to": 2}),
        ("segment", {"preset": "best", "parameters": {}}),
        ("segment", {"preset": "kineme", "parameters": {"segment_cost": 1e12}}),
        ("transfer", {"knowledge_base": "../secret.npz"}),
        ("undo", {}),
        ("redo", {}),
    ],
)
def test_what_cannot_be_done_is_a_sentence_and_changes_nothing(studio, kind, rest) -> None:
    before = studio.recording()
    answer = studio.edit(before["revision"], kind, **rest)
    assert answer.status_code == (404 if kind == "transfer" else 400)
    assert len(answer.json()["error"]) > 10
    assert studio.recording() == before
    assert not studio.table.exists()


def test_segmenting_again_gives_what_the_package_gives(studio) -> None:
    motion = kineme.read(studio.path)
    for preset, parameters in (("kineme", {"segment_cost": 0.5}), ("krueger2017", {"radius": 0.5})):
        again = studio.apply("segment", preset=preset, parameters=parameters)
        expected = kineme.segment(motion, preset=preset, **parameters)
        rows = again["segmentation"]["segments"]
        assert [row["start_frame"] for row in rows] == expected.table.start_frame.tolist()
        assert again["segmentation"]["provenance"] == expected.provenance


def test_labels_come_from_a_knowledge_base_of_the_folder(studio, folder: Path) -> None:
    motion = kineme.read(studio.path)
    table = kineme.segments.editing.set_cluster(kineme.segment(motion), "activity", 0, 0)
    table = kineme.segments.editing.name_segment(table, "activity", 0, "walk")
    KnowledgeBase.from_recording(motion, table).save(folder / "base.npz")
    base = studio.state()["knowledge_bases"][0]["id"]
    named = studio.apply("transfer", knowledge_base=base, threshold=0.2, spread=True)
    assert "labelled" in named["notes"][0]
    again = studio.edit(named["revision"], "transfer", knowledge_base=base, threshold=-1.0)
    assert again.status_code == 400
    (folder / "base.npz").write_bytes((folder / "base.npz").read_bytes()[:-40])
    assert studio.edit(named["revision"], "transfer", knowledge_base=base).status_code in (400, 404)


def test_another_result_beside_the_one_shown(studio, folder: Path) -> None:
    studio.recording()
    compare = f"{studio.one}/compare"
    same = studio.post(compare, {"preset": "kineme"}).json()
    assert conforms(messages.Comparison, same)
    assert same["name"] == "kineme"
    assert same["segmentation"]["segments"] == studio.recording()["segmentation"]["segments"]
    (folder / "said.csv").write_text("start_s,stop_s,label\n0,2,walk\n2,4,hop\n")
    kineme.write_segments(kineme.segment(kineme.read(studio.path)), folder / "said.eaf")
    (folder / "other.csv").write_text("start_s,stop_s,label\n0,9,walk\n")
    files = {f["name"]: f["id"] for f in studio.state()["annotations"]}
    said = studio.post(compare, {"annotation": files["said.csv"]}).json()
    rows = said["segmentation"]["segments"]
    assert [(row["start_frame"], row["label"]) for row in rows] == [(0, "walk"), (120, "hop")]
    assert 0 <= said["scores"]["one_to_one"] <= 1
    assert said["meanings"].keys() == said["scores"].keys()
    assert all(0 <= start < stop <= 4 for start, stop in said["differences"])
    elan = studio.post(compare, {"annotation": files["said.eaf"]})
    assert elan.status_code == 200
    long = studio.post(compare, {"annotation": files["other.csv"]})
    assert long.status_code == 400
    assert "9.000 s" in long.json()["error"]
    for wrong in ({}, {"preset": "kineme", "annotation": "x"}, {"annotation": "../secret.bvh"}):
        assert studio.post(compare, wrong).status_code in (400, 404)


def test_every_format_can_be_taken_away(studio, tmp_path: Path) -> None:
    message = studio.recording()
    formats = studio.state()["export_formats"]
    writers = {name for name, known in label_formats().items() if known.write}
    assert {known["name"] for known in formats} == writers | {"motions", "report"}
    before, names = sorted(studio.folder.iterdir()), set[str]()
    for known in formats:
        address = f"{studio.one}/export/{known['name']}?level=activity"
        answer = studio.get(address)
        assert answer.status_code == 200, answer.text
        said = answer.headers["content-disposition"]
        assert said.startswith("attachment; filename*=UTF-8''take.")
        assert said.endswith(known["suffix"])
        assert said not in names  # of two formats with one suffix
        names.add(said)
        assert answer.headers["content-type"] == "application/octet-stream"
        if known["suffix"] == ".zip":
            assert zipfile.ZipFile(BytesIO(answer.content)).testzip() is None
            continue
        if known["name"] == "report":
            assert answer.content.startswith(b"<!doctype html>")
            assert b"take.bvh" in answer.content
            continue
        path = tmp_path / f"taken{known['suffix']}"
        path.write_bytes(answer.content)
        read = kineme.read_segments(
            path, format=known["name"], fps=message["fps"], n_frames=message["n_frames"]
        )
        assert read.cuts().tolist() == studio.starts()[1:]
    assert sorted(studio.folder.iterdir()) == before
    assert studio.get(f"{studio.one}/export/exe").status_code == 400
    assert studio.get(f"{studio.one}/export/json?level=both").status_code == 400


def test_a_single_point_is_shown_whole(studio, folder: Path) -> None:
    rows = "".join(f"{i},1,0,{i / 10}\n" for i in range(40))
    (folder / "point.csv").write_text(f"p_x,p_y,p_z,time\n{rows}")
    message = studio.choose("point.csv").recording()
    assert [row["stop_frame"] for row in message["segmentation"]["segments"]] == [40]
    assert "not segmented: a single point" in message["warnings"][-1]


def test_signals_are_shown_and_segmented_like_motions(studio, folder: Path) -> None:
    write_imu(folder / "imu.csv")
    studio = studio.choose("imu.csv")
    message = studio.recording()
    assert (message["motion"], message["n_frames"], message["fps"]) == (None, 1000, 50.0)
    assert studio.get(f"{studio.one}/motion").content == b""
    assert studio.get(f"{studio.one}/matrix/0/0/0").status_code == 200
    studio.apply("segment", preset="kineme", parameters={"min_action": 1.2})
    signals = kineme.read(folder / "imu.csv")
    stored = kineme.read_segments(folder / "imu.segments.json")
    assert stored.table == kineme.segment(signals, preset="kineme", min_action=1.2).table
    assert stored.provenance["preset"] == "sensors"
    studio.apply("split", level="activity", frame=500)
    assert 500 in kineme.read_segments(folder / "imu.segments.json").cuts()
    clips = studio.get(f"{studio.one}/export/motions")
    assert clips.status_code == 400
    assert "holds signals" in clips.json()["error"]


def test_a_file_that_cannot_be_read_is_a_sentence(studio, folder: Path) -> None:
    (folder / "bad.bvh").write_text("HIERARCHY <script>alert(1)</script>")
    (folder / "empty.c3d").write_bytes(b"")
    for name in ("bad.bvh", "empty.c3d"):
        answer = studio.get(studio.choose(name).one)
        assert answer.status_code == 400
        assert name in answer.json()["error"]


def test_only_files_that_were_named_are_listed(make_studio, folder: Path) -> None:
    shutil.copy(folder / "take.bvh", folder / "other.bvh")
    studio = make_studio([folder / "take.bvh"])
    assert [f["name"] for f in studio.state()["recordings"]] == ["take.bvh"]
    data = (folder / "take.bvh").read_bytes() + b"\n"
    studio.client.post("/api/recordings?name=new.bvh", content=data)
    names = [f["name"] for f in studio.state()["recordings"]]
    assert names == ["take.bvh", "new.bvh"]


def test_rows_of_a_message_tile_and_are_of_its_type(studio) -> None:
    message = studio.apply("segment", preset="voegele2014", parameters={"min_primitive": 0.1})
    rows = [row for row in message["segmentation"]["segments"] if row["level"] == "primitive"]
    assert all(a["stop_frame"] == b["start_frame"] for a, b in pairwise(rows))
    assert np.isclose(rows[-1]["stop_s"], 4.0)
    assert conforms(messages.Edited, message)
    assert conforms(messages.Recording, studio.recording())


def test_what_a_reader_warns_of_reaches_the_page(studio, folder: Path) -> None:
    text = (folder / "take.bvh").read_text().replace("Frames: 240", "Frames: 250")
    (folder / "short.bvh").write_text(text)
    studio = studio.choose("short.bvh")
    warnings = studio.recording()["warnings"]
    assert any("250 frames declared" in warning for warning in warnings)
    report = studio.get(f"{studio.one}/export/report").text
    assert "250 frames declared" in report


def test_the_list_of_recordings_says_how_far_each_is(studio) -> None:
    state = studio.apply("name_segment", level="activity", frame=0, label="hop")
    rows = state["segmentation"]["segments"]
    check = {"kind": "check", "checked": True}
    places = [{"level": row["level"], "frames": [row["start_frame"]]} for row in rows[:2]]
    studio.apply("together", edits=[check | place for place in places])
    listing = studio.state()["recordings"][0]
    named = sum(row["label"] != "" for row in rows)
    counts = (listing["corrected"], listing["segments"], listing["checked"], listing["named"])
    assert counts == (True, len(rows), 2, named)


@pytest.mark.parametrize(
    "table",
    [
        "start_s,stop_s,label\n0,2,walk\n2,4,hop\n",
        "recording,start_s,stop_s,label\nrun,0,90,run\ntake,0,2,walk\ntake,2,4,hop\n",
        "recording,start_s,stop_s,label\nrun,0,90,run\ntake.bvh,0,2,walk\ntake.bvh,2,4,hop\n",
    ],
)
def test_labels_of_another_program_become_the_table(studio, folder: Path, table: str) -> None:
    """Of a table of many recordings, its own rows are taken."""
    (folder / "labels.csv").write_text(table)
    chosen = studio.state()["annotations"][0]["id"]
    sent = {"annotation": chosen}
    compared = studio.post(f"{studio.one}/compare", sent).json()
    taken = studio.apply("take_labels", **sent)
    for message in (compared, taken):
        found = [row for row in message["segmentation"]["segments"] if row["level"] == "activity"]
        assert [(row["start_frame"], row["label"]) for row in found] == [(0, "walk"), (120, "hop")]
    assert studio.edit(taken["revision"], "take_labels", annotation="x").status_code == 404


def test_a_table_of_other_recordings_is_refused_by_name(studio, folder: Path) -> None:
    (folder / "labels.csv").write_text("recording,start_s,stop_s,label\nrun,0,2,a\njog,0,2,b\n")
    chosen = studio.state()["annotations"][0]["id"]
    refused = studio.edit(studio.recording()["revision"], "take_labels", annotation=chosen)
    assert refused.status_code == 400
    assert "has no labels of 'take', but of 'run', 'jog'" in refused.json()["error"]


def test_bulk_changes_are_one_step_and_say_how_many(studio) -> None:
    message = studio.recording()
    rows = [row for row in message["segmentation"]["segments"] if row["level"] == "primitive"]
    edits = [
        {"kind": "name_segment", "level": "primitive", "frame": row["start_frame"], "label": "a"}
        for row in rows
    ]
    studio.apply("together", edits=edits)
    cluster = next(row["cluster"] for row in rows if row["cluster"] >= 0)
    called = studio.apply("name_cluster", cluster=cluster, label="walk")
    assert "keep their own name" in called["notes"][0]
    assert called["segmentation"]["cluster_names"][str(cluster)] == "walk"
    studio.apply("undo")
    state = studio.apply("undo")
    assert state["segmentation"]["segments"] == message["segmentation"]["segments"]
    broken = studio.edit(state["revision"], "together", edits=[*edits, {**edits[0], "frame": 1}])
    assert broken.status_code == 400
    assert studio.recording()["segmentation"] == state["segmentation"]
