"""Array files in the layouts that programs write."""

import json
from pathlib import Path

import numpy as np
import pytest
from keypoint_samples import write_trc

import kineme

RNG = np.random.default_rng(4)
POINTS = RNG.normal(size=(40, 3, 3)).cumsum(axis=0) + 900


@pytest.mark.parametrize("tabs", ["\t", "\t\t", "\t\t\t"])
def test_trc_names_stand_any_number_of_tabs_apart(tmp_path: Path, tabs: str) -> None:
    path = tmp_path / "take.trc"
    names = ["LELB", "RELB", "STRN"]
    text = write_trc(path, POINTS, names, fps=60).read_text()
    path.write_text(text.replace("LELB\t\t\tRELB\t\t\tSTRN", tabs.join(names)))
    motion = kineme.read(path, up="y")
    found = motion.positions[:, [motion.joint(name) for name in names]]
    assert np.abs(found - POINTS / 1000).max() < 1e-6


def test_columns_with_a_unit_behind_the_axis_are_read_in_it(tmp_path: Path) -> None:
    """A head in mm beside a hip in metres without a unit."""
    path = tmp_path / "take.csv"
    rows = (f"{i / 50},{0.1},{0.9},{0.2},{100},{1700},{200 + i % 3}\n" for i in range(40))
    path.write_text("time,hip_x,hip_y,hip_z,head_x_mm,head_y_mm,head_z_mm\n" + "".join(rows))
    with pytest.warns(kineme.KinemeWarning, match="1 point state no unit; read in m"):
        motion = kineme.read(path, up="y")
    heights = dict(zip(motion.skeleton.names, motion.positions[0, :, 1], strict=True))
    assert heights == pytest.approx({"hip": 0.9, "head": 1.7})


XSENS = "// Update Rate: 100.0Hz\nPacketCounter\tSampleTimeFine\tUTC_Second\tAcc_X\tGyr_X\n"


@pytest.mark.parametrize("clock", ["\t", "{i}00\t5"])
def test_xsens_takes_the_rate_of_its_header(tmp_path: Path, clock: str) -> None:
    path = tmp_path / "take.txt"
    rows = (f"{i:05}\t{clock.format(i=i)}\t{i % 7}.5\t{i % 5}.5\n" for i in range(300))
    path.write_text(XSENS + "".join(rows))
    for options, names in (({}, ("Acc_X", "Gyr_X")), ({"columns": ["Gyr_X"]}, ("Gyr_X",))):
        signals = kineme.read(path, **options)
        assert (signals.fps, signals.names) == (100, names)


@pytest.mark.parametrize(("order", "first"), [("dd/MM/yyyy", 1733875200), ("M/d/yyyy", 1731369600)])
def test_actigraph_dates_are_in_the_order_of_its_header(
    tmp_path: Path, order: str, first: int
) -> None:
    path = tmp_path / "take.csv"
    head = f"--- Data File Created By ActiGraph LEAP date format {order} at 32 Hz ---\nSerial: 1\n"
    rows = (f"11/12/2024 00:00:{i / 32:06.3f},{i % 3}.5,{i % 5}.5\n" for i in range(320))
    path.write_text(head + "Timestamp,Accelerometer X,Accelerometer Y\n" + "".join(rows))
    signals = kineme.read(path, columns=["Accelerometer *"])
    assert signals.fps == 32
    assert signals.provenance.clock is not None
    assert signals.provenance.clock.times[0] == first


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


def test_ultralytics_people_by_frame(tmp_path: Path) -> None:
    """A frame without anybody keeps its place."""
    x = [100.0 + 10 * (i % 3) for i in range(17)]
    y = [50.0 + 20 * i for i in range(17)]
    box = {"x1": 0, "y1": 0, "x2": 1, "y2": 1}
    keypoints = {"x": x, "y": y, "visible": [0.9] * 17}
    person = {"name": "person", "box": box, "track_id": 1, "keypoints": keypoints}
    path = tmp_path / "take.json"
    path.write_text(json.dumps([[person] if i != 5 else [] for i in range(40)]))
    motion = kineme.read(path, fps=30)
    assert motion.n_frames == 40
    assert "left_knee" in motion.skeleton.names
    # The same as fractions of the image, as with normalize=True.
    keypoints.update(x=[value / 1280 for value in x], y=[value / 720 for value in y])
    path.write_text(json.dumps([[person]] * 40))
    with pytest.warns(kineme.KinemeWarning, match="unknown size, assumed square"):
        kineme.read(path, fps=30)


def test_freemocap_counts_nanoseconds(tmp_path: Path) -> None:
    joints = ("nose", "left_hip", "right_hip", "left_ankle", "right_ankle")
    heights = (1600, 900, 900, 100, 100)
    names = [f"body_{joint}_{axis}" for joint in joints for axis in "xyz"]
    rows = (
        ",".join(
            [f"{1e11 + i * 1e9 / 30:.1f}", *(f"{i % 3},{10 * k},{heights[k]}" for k in range(5))]
        )
        for i in range(60)
    )
    path = tmp_path / "take.csv"
    path.write_text("\n".join([",".join(["timestamp", *names]), *rows]))
    motion = kineme.read(path)
    assert motion.fps == pytest.approx(30)
    head = motion.positions[0, motion.joint("nose")]
    assert head[1] == pytest.approx(1.6)


def test_motive_strays_hide_no_rigid_bodies(tmp_path: Path) -> None:
    columns = [("Rigid Body", name) for name in ("Hips", "Head")]
    columns += [("Marker", "Hips:Marker1"), ("Marker", "Stray")]
    head = ["Format Version,1.23,Export Frame Rate,60,Length Units,Meters", ""]
    for label, cells in (
        ("Type", [kind for kind, _ in columns]),
        ("Name", [name for _, name in columns]),
        ("", ["Position"] * 4),
    ):
        head.append(f",{label}," + ",".join(cell for cell in cells for _ in range(3)))
    head.append("Frame,Time (Seconds)," + ",".join(["X,Y,Z"] * 4))
    rows = [f"{i},{i / 60},0,0.9,0,0,1.6,0,0.1,0.9,0,,," for i in range(60)]
    path = tmp_path / "take.csv"
    path.write_text("\n".join([*head, *rows]))
    motion = kineme.read(path)
    assert motion.skeleton.names == ("Hips", "Head")
