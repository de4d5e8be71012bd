"""Recognition of recordings among other files in a folder."""

from __future__ import annotations

import os
import zipfile
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest
from pyarrow import parquet

import kineme
from kineme.formats import listing
from kineme.formats.listing import holds_recording, scan_folder
from kineme.transfer.knowledge import holds_knowledge

BVH = kineme.bundled_recording().read_text(encoding="utf-8")


def save_archive(path: Path, *names: str) -> Path:
    np.savez(path, **{name: np.zeros(3) for name in names})
    return path


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        ("a.bvh", "", True),
        ("a.BVH", "", True),
        ("86.asf", "", False),
        ("a.md", "", False),
        ("imu.csv", "time,acc_x\n0,1\n", True),
        ("nameless.csv", "0.5,0.25\n", True),
        ("labels.csv", "start_s,stop_s,label\n0,1,a\n", False),
        ("labels.csv", "start_s;stop_s;label\n" + "0.5;1.5;walk\n" * 3, False),
        ("labels.csv", "Observer,Ann\nstart_s,stop_s,label\n" + "0.5,1.5,walk\n" * 3, False),
        ("labels.csv", "from,to,trial_type\n" + "0,1,walk\n" * 3, False),
        ("labels.csv", "t_start,t_end,activity\n" + "0,1,walk\n" * 3, False),
        ("imu.csv", "time,from,acc_x\n" + "0,1,2\n" * 3, True),
        ("labels.tsv", "\ufeffonset\tduration\n", False),
        ("readme.txt", "time went by\n", False),
        ("take.txt", "acc_x\tacc_y\n" + "0.1\t0.2\n" * 20, True),  # nothing tells its rate
        ("take.txt", "hip_x hip_y hip_z\n" + "0.1 0.9 0.2\n" * 20, True),
        ("take.txt", "On Monday, subject 3.\n12 trials, 3 of them bad\nNo notes.\n", False),
        ("take.txt", "0.5\t1.5\twalk\n1.5\t2.0\trun\n2.0\t2.5\twalk\n", False),
        ("take.txt", "0.1\n" * 30, False),
        ("a.json", '{"people": []}', False),  # a frame of a folder
        ("a.json", '[{"people": []}]', True),
        ("a.json", '{"0": {"people": []}, "1": {"people": []}}', True),
        ("a.json", '[{"image_id": 1, "keypoints": [0, 1, 2]}]', True),
        ("a.json", '[{"image_id": 1, "bbox": [0, 1, 2, 3]}]', False),
        ("a.json", '{"meta_info": {"keypoint_id2name": {' + " " * 9999, True),  # MMPose
        ("a.json", '{"fps": 25, "frames": [{"poseWorldLandmarks": []}]}', True),
        ("a.segments.json", '{"segments": [{"label": "landmarks"}]}', False),
    ],
)
def test_texts(tmp_path: Path, name: str, text: str, expected: bool) -> None:
    (tmp_path / name).write_text(text, encoding="utf-8")
    assert holds_recording(tmp_path / name) is expected
    assert scan_folder(tmp_path).recordings == [tmp_path / name] * expected


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (("poses", "trans", "mocap_framerate"), True),
        (("positions",), True),
        (("hip", "toe", "fps"), True),
        (("hip_x", "hip_y"), True),
        (("betas",), False),
        (("head", "lengths", "labels", "features", "start_s"), False),
    ],
)
def test_archives(tmp_path: Path, names: tuple[str, ...], expected: bool) -> None:
    path = save_archive(tmp_path / "a.npz", *names)
    assert holds_recording(path) is expected
    assert holds_knowledge(path) is ("lengths" in names)


def test_parquet_of_labels_is_told_by_its_last_bytes(tmp_path: Path) -> None:
    parquet.write_table(pa.table({"start_s": [0.0], "label": ["a"]}), tmp_path / "a.parquet")
    parquet.write_table(pa.table({"time": [0.0], "acc_x": [1.0]}), tmp_path / "b.parquet")
    assert scan_folder(tmp_path).recordings == [tmp_path / "b.parquet"]


def test_one_bad_file_never_ends_a_listing(tmp_path: Path, monkeypatch) -> None:
    (tmp_path / "walk.bvh").write_text(BVH, encoding="utf-8")
    for name in ("gone.csv", "locked.csv", "strange.csv"):
        (tmp_path / name).write_text("time,a\n", encoding="utf-8")
    data = bytearray(save_archive(tmp_path / "newer.npz", "poses").read_bytes())
    data[data.index(b"PK\x01\x02") + 6] = 255  # version needed to extract, in the directory
    (tmp_path / "newer.npz").write_bytes(data)
    (tmp_path / "torn.npz").write_bytes(b"PK\x03\x04")
    faults = {
        "gone.csv": FileNotFoundError(2, "No such file or directory"),
        "locked.csv": PermissionError(13, "Permission denied"),
        "strange.csv": RuntimeError("something\nelse"),
    }
    first_bytes = listing.read_head

    def failing(path: Path) -> bytes:
        if path.name in faults:
            raise faults[path.name]
        return first_bytes(path)

    monkeypatch.setattr(listing, "read_head", failing)
    found = scan_folder(tmp_path)
    assert found.recordings == [tmp_path / "walk.bvh"]
    reasons = {path.name: reason for path, reason in found.passed_over}
    assert reasons.keys() == {*faults, "newer.npz", "torn.npz"}
    assert reasons["gone.csv"] == "cannot be opened: No such file or directory"
    assert reasons["locked.csv"] == "cannot be opened: Permission denied"
    assert reasons["strange.csv"] == "is damaged: something else"
    assert reasons["newer.npz"].startswith("is damaged: zip file version")
    assert not holds_recording(tmp_path / "newer.npz")
    assert not holds_knowledge(tmp_path / "newer.npz")


def test_names_that_are_no_utf8_and_links_to_nowhere(tmp_path: Path) -> None:
    odd = os.fsencode(tmp_path) + b"/caf\xe9.bvh"
    try:
        Path(os.fsdecode(odd)).write_text(BVH, encoding="utf-8")
    except OSError:
        pytest.skip("the file system takes no such names")
    (tmp_path / "link.csv").symlink_to(tmp_path / "nowhere.csv")
    assert [os.fsencode(p) for p in scan_folder(tmp_path).recordings] == [odd]
    assert kineme.read(scan_folder(tmp_path).recordings[0]).n_frames > 0


def test_folders_within_folders(tmp_path: Path) -> None:
    for place in ("a", "b/c", ".hidden"):
        (tmp_path / place).mkdir(parents=True)
        (tmp_path / place / "x.bvh").write_text("", encoding="utf-8")
    (tmp_path / "top.bvh").write_text("", encoding="utf-8")
    flat = scan_folder(tmp_path)
    assert flat.recordings == [tmp_path / "top.bvh"]
    assert flat.folders == [tmp_path / "a", tmp_path / "b"]
    deep = scan_folder(tmp_path, recursive=True)
    assert [str(p.relative_to(tmp_path)) for p in deep.recordings] == [
        "top.bvh",
        "a/x.bvh",
        "b/c/x.bvh",
    ]
    assert scan_folder(tmp_path / "nowhere").passed_over[0][1].startswith("cannot be opened")


def test_a_numbered_json_beside_recordings_is_no_frame(tmp_path: Path) -> None:
    (tmp_path / "walk.bvh").write_text(BVH, encoding="utf-8")
    (tmp_path / "notes_1.json").write_text('{"who": "me"}', encoding="utf-8")
    found = scan_folder(tmp_path)
    assert (found.recordings, found.passed_over) == ([tmp_path / "walk.bvh"], [])


def test_archives_that_are_none_are_not_listed_as_zip(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "a.npz", "w") as file:
        file.writestr("poses.npy", b"")
    assert holds_recording(tmp_path / "a.npz")


ELAN = "Sport\t\t00:00:01.200\t1.2\t00:00:05.900\t5.9\tsquat\n"
WIDE = "Begin Time - msec\tEnd Time - msec\tSport\n1200\t5900\tsquat\n"
BORIS = (
    "Observation id,Behavior,Behavior type,Start (s),Stop (s)\n"
    "o,squat,STATE,1.2,5.9\no,clap,POINT,7.0,7.0\n"
)


@pytest.mark.filterwarnings("ignore:.*point events")
@pytest.mark.parametrize(
    ("name", "text"), [("a.txt", ELAN), ("b.txt", WIDE), ("c.tsv", WIDE), ("d.csv", BORIS)]
)
def test_labels_are_no_recording(tmp_path: Path, name: str, text: str) -> None:
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(kineme.ReadError, match="holds labels of"):
        kineme.read(path)
    found = kineme.read_segments(path, fps=10).activities
    spans = [(a.start_s, a.stop_s) for a in found if a.label == "squat"]
    assert spans == [(1.2, 5.9)]
