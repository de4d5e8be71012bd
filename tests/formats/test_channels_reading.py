"""Signals from users' tables, OpenSim's files and analog channels, and from invalid files."""

from __future__ import annotations

import re
import warnings
from contextlib import nullcontext, suppress
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pyarrow import csv, parquet
from scipy.io import savemat

from kineme import Motion, Signals, as_signals, bundled_recording, read
from kineme.errors import FileError, KinemeWarning, ParameterError, ReadError
from kineme.formats.dialects import hold_channels


def write(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_decimal_commas_are_those_of_numbers_alone(tmp_path) -> None:
    dates = "".join(f"2026-01-31 09:30:00,{i}00;{i},5;1,25\n" for i in range(9))
    path = write(tmp_path, "a.csv", "time;acc_x;acc_y\n" + dates)
    assert read(path).fps == 10
    path = write(tmp_path, "b.csv", path.read_text().replace("3,5", "1,203,5"))
    with pytest.raises(ReadError, match="line 5: '1,203,5' is not a number"):
        read(path)


def test_a_first_row_with_holes_is_no_line_of_units(tmp_path) -> None:
    text = "time,acc,said\n,nan,walk\n0.1,1,walk\n0.2,2,run\n0.3,3,run\n"
    signals = read(write(tmp_path, "a.csv", text))
    assert (signals.n_frames, signals.fps) == (3, 10)


def test_clocks_and_labels_under_other_names_are_no_channels(tmp_path) -> None:
    rows = [f"{i / 50:.2f},{i // 60},{i % 7}\n" for i in range(240)]
    path = write(tmp_path, "a.csv", "Zeit (s),label,acc\n" + "".join(rows))
    with pytest.raises(ReadError, match=r"\(--fps\); 'Zeit \(s\)' rises by 0.02 a row"):
        read(path)
    signals = read(path, fps=50)
    assert signals.names == ("acc",)
    assert signals.provenance.notes == ("columns that are not channels: Zeit (s), label",)
    assert read(path, fps=50, columns=["Zeit (s)"]).names == ("Zeit (s)",)


@pytest.mark.parametrize(
    "text",
    [
        ",a,b\n0,1,2\n1,3,4\n",  # pandas with its index
        "a,b,\n1,2,\n3,4,\n",
        "__index_level_0__,a,b\n0,1,2\n1,3,4\n",
    ],
)
def test_columns_without_a_name_are_no_channels(tmp_path, text) -> None:
    signals = read(write(tmp_path, "a.csv", text), fps=50)
    assert signals.names == ("a", "b")
    assert signals.values.tolist() == [[1, 2], [3, 4]]
    assert signals.provenance.notes[0].startswith("columns that are not channels: ")


@pytest.mark.parametrize("column", ["hip_x,hip_y,hip_z", "a,b,c"])
def test_times_a_second_apart_are_refused(tmp_path, column) -> None:
    rows = "".join(f"{i},{i % 7},2,3\n" for i in range(20))
    path = write(tmp_path, "a.csv", f"time,{column}\n{rows}")
    with pytest.raises(ReadError, match=r"times are 1 apart.*1000 for milliseconds"):
        read(path)


def test_channels_of_another_length_are_named(tmp_path) -> None:
    path = tmp_path / "two_rates.mat"
    muscle = np.sin(np.arange(40))
    savemat(path, {"fs": 100.0, "emg": muscle, "angles": np.zeros((10, 2))})
    signals = read(path)
    assert signals.names == ("angles_1", "angles_2")
    assert signals.provenance.notes == ("left out, since their length differs: emg",)
    assert read(path, columns=["emg"]).values[:, 0].tolist() == muscle.tolist()
    with pytest.raises(ReadError, match="'angles_1' is not as long as 'emg'"):
        read(path, columns=["emg", "angles_1"])


def test_arrays_are_no_signal_files(tmp_path) -> None:
    np.save(tmp_path / "a.npy", np.zeros((10, 2)))
    with pytest.raises(ReadError, match=r"kineme\.Signals"):
        read(tmp_path / "a.npy", fps=10, columns=["1"])


def test_numbers_without_names(tmp_path) -> None:
    signals = read(write(tmp_path, "a.txt", "  1.5e-02 2\n  -3.5  4\n"), fps=10)
    assert signals.names == ("1", "2")
    assert signals.values.tolist() == [[0.015, 2], [-3.5, 4]]
    one = read(write(tmp_path, "b.txt", "1\n2\n"), fps=10, columns=["1"])
    assert one.values.tolist() == [[1], [2]]


def test_chosen_columns_in_the_order_given(tmp_path) -> None:
    path = write(tmp_path, "a.csv", "time,a,label,b,frame\n0,1,x,2,7\n0.1,3,y,4,8\n")
    signals = read(path, columns=["frame", "b"])
    assert signals.names == ("frame", "b")
    assert signals.values.tolist() == [[7, 2], [8, 4]]
    assert signals.fps == pytest.approx(10)
    with pytest.raises(ReadError, match="no column 'c'; there are time, a, label, b, frame"):
        read(path, columns=["c"])
    with pytest.raises(ReadError, match="line 2: 'x' is not a number"):
        read(path, columns=["label"])
    with pytest.raises(ReadError, match="selected twice"):
        read(path, columns=["a", "a"])


def test_what_tells_the_rate(tmp_path) -> None:
    uptime = "".join(f"{86_400_000 + 10 * i},{i}\n" for i in range(9))
    path = write(tmp_path, "a.csv", "timestamp,a\n" + uptime)
    with pytest.warns(
        KinemeWarning, match="timestamp is read in milliseconds, inferred from its steps"
    ):
        assert read(path).fps == 100
    assert read(tmp_path / "a.csv", fps=100).names == ("a",)
    with pytest.raises(ReadError, match="it does not state its frame rate: give fps"):
        read(write(tmp_path, "b.csv", "a\n1\n2\n"))
    rated = write(tmp_path, "c.csv", "fps,a\n60,1\n60,2\n")
    assert read(rated).fps == 60
    with pytest.raises(ParameterError, match="fps is -1"):
        read(rated, fps=-1)


@pytest.mark.parametrize(
    ("name", "unit"),
    [("timestamp", 1), ("time", 1000), ("unix_time", 1_000_000), ("Timestamp", 1_000_000_000)]
    + [("epoc (ms)", 1000), ("time_us", 1_000_000), ("epoch_ns", 1_000_000_000)],
)
def test_times_since_1970_in_any_unit(tmp_path, name, unit) -> None:
    at = [f"{1_700_000_000 * unit + i * unit // 50}" for i in range(30)]
    at = [f"{1_700_000_000 + i / 50:.2f}" for i in range(30)] if unit == 1 else at
    rows = "".join(f"{t},{i}\n" for i, t in enumerate(at))
    signals = read(write(tmp_path, "a.csv", f"{name},a\n{rows}"))
    assert (signals.fps, signals.names, signals.provenance.notes) == (50, ("a",), ())


@pytest.mark.parametrize(
    "moment",
    [
        lambda t: t.isoformat(),
        lambda t: t.isoformat(" ", "milliseconds"),
        lambda t: t.isoformat(timespec="milliseconds") + "Z",
        lambda t: t.isoformat(timespec="microseconds") + "000+02:00",
        lambda t: t.time().isoformat("milliseconds"),
    ],
)
def test_dates_tell_the_rate(tmp_path, moment) -> None:
    start = datetime(2026, 5, 1, 9, 30)  # noqa: DTZ001 - loggers write no zone
    at = [start + timedelta(milliseconds=20 * i) for i in range(120)]
    rows = "".join(f'"{moment(t)}",{i}\n' for i, t in enumerate(at))
    signals = read(write(tmp_path, "a.csv", f"timestamp,a\n{rows}"))
    assert (signals.fps, signals.n_frames, signals.provenance.notes) == (50, 120, ())
    dates = pa.table({"timestamp": at, "a": range(120)})
    parquet.write_table(dates, tmp_path / "a.parquet")
    assert read(tmp_path / "a.parquet").fps == 50
    texts = pa.table({"time": [moment(t) for t in at], "a": range(120)})
    parquet.write_table(texts, tmp_path / "b.parquet")
    assert read(tmp_path / "b.parquet").fps == 50


EVEN = np.arange(400) / 100


@pytest.mark.filterwarnings("ignore:.*rows with the same time as the row before")
@pytest.mark.parametrize(
    "form",
    ["{minutes:02}:{seconds:06.3f}", "0:{minutes:02}:{seconds:06.3f}", "{minutes}:{whole:02}"],
)
def test_times_without_hours_are_minutes_and_seconds(tmp_path, form) -> None:
    at = [(i / 50 // 60, i / 50 % 60) for i in range(58 * 50, 70 * 50)]
    texts = [form.format(minutes=int(m), seconds=s, whole=int(s)) for m, s in at]
    rows = "".join(f"{text},{i}\n" for i, text in enumerate(texts))
    signals = read(write(tmp_path, "a.csv", f"time,a\n{rows}"))
    frame = as_signals(pa.table({"time": texts, "a": range(600)}).to_pandas())
    assert (signals.fps, signals.n_frames) == (frame.fps, frame.n_frames) == (50, 600)


@pytest.mark.filterwarnings("ignore:.*rows with the same time as the row before")
@pytest.mark.parametrize(
    ("begin", "per_minute", "head", "fps"),
    [
        (9 * 60 + 45, 60, "time", 1),
        (23 * 60 + 58, 20, "time", 1 / 3),  # midnight
        (9 * 60 + 45, 20, "time (hh:mm)", 1 / 3),
        (9 * 60 + 45, 50, "time", 50),
        (0, 100, "time", 100),  # elapsed
    ],
)
def test_times_of_two_parts_may_be_hours_and_minutes(
    tmp_path, begin, per_minute, head, fps
) -> None:
    at = [(begin + i // per_minute) % 1440 for i in range(9 * per_minute)]
    texts = [f"{minute // 60:02}:{minute % 60:02}" for minute in at]
    rows = "".join(f"{text},{i}\n" for i, text in enumerate(texts))
    signals = read(write(tmp_path, "a.csv", f"{head},a\n{rows}"))
    assert (signals.fps, signals.n_frames) == (pytest.approx(fps), len(at))
    told = "minutes and seconds" if fps > 1 else "hours and minutes"
    assert any(note.endswith(f"read as {told}") for note in get_notes(signals))
    if "(" not in head:  # only tables in text have such headers
        assert as_signals(np.arange(len(at)), times=texts).fps == signals.fps


def test_a_text_of_times_may_be_missing() -> None:
    texts = ["9:30:00.00", "9:30:00.02", np.nan, "9:30:00.06", "9:30:00.08"]
    assert as_signals(np.arange(5), times=np.array(texts, object)).fps == 50


def read_clock(folder: Path, times: np.ndarray) -> Signals:
    """Signals whose one channel counts the rows of the file."""
    rows = "".join(f"{float(t)!r},{i}\n" for i, t in enumerate(times))
    return read(write(folder, "clock.csv", f"time,a\n{rows}"))


def get_notes(signals: Signals) -> tuple[str, ...]:
    return signals.provenance.notes


@pytest.mark.parametrize(
    ("times", "n_frames", "gaps", "said"),
    [
        (EVEN - 0.05 * (EVEN >= 2), 395, (), "uneven (5 rows with the same time as another"),
        (EVEN + 5 * (EVEN >= 2), 900, ((200, 700),), "uneven (1 step longer than a frame and a"),
        (EVEN + 0.1 * (EVEN >= 2), 410, (), "uneven (1 step longer"),
        (1.769e9 + EVEN + 3600 * (EVEN >= 2), 360400, ((200, 360200),), "uneven (1 step longer"),
        (EVEN + 0.004 * (np.arange(400) % 3), 400, (), "uneven (jitter)"),
        (np.where(np.arange(400) % 20, EVEN, np.r_[0, EVEN[:-1]]), 400, (), "uneven (19 rows with"),
        # Clocks that are set or stand still are warned of.
        ((3598 + EVEN) % 3600, 400, (), "jump by an hour, since they have no hours"),
        (5000 + EVEN - 3600 * (EVEN >= 2), 400, (), "jump by an hour, as for summer time"),
        (1_769_398_198.01 + EVEN - 3600 * (EVEN >= 2), 400, (), "jump by an hour"),
        (1_769_399_998 + EVEN + 3600 * (EVEN >= 2), 400, (), "jump by an hour"),
        (1_769_399_997.9 + EVEN + 3600 * (EVEN >= 2), 400, (), "jump by an hour"),
        (EVEN - 1.5 * (EVEN >= 2), 401, ((200, 201),), "goes back 1 time"),
        (EVEN + 1.7e9 * (EVEN >= 1), 401, ((100, 101),), "of 1.7e+09 s after second 0.99"),
        (np.floor(EVEN * 4) / 4, 400, (), "384 rows with the same time as the row before"),
        (np.floor(EVEN + 0.37), 400, (), "395 rows with the same time as the row before"),
    ],
)
def test_frames_are_where_the_clock_says(tmp_path, times, n_frames, gaps, said) -> None:
    is_warned = not said.startswith("uneven")
    with pytest.warns(KinemeWarning, match=re.escape(said)) if is_warned else nullcontext():
        signals = read_clock(tmp_path, times)
    assert (signals.fps, signals.n_frames, signals.gaps) == (100, n_frames, gaps)
    assert any(said in note for note in get_notes(signals))
    if is_warned:
        assert set(np.arange(400.0)) <= set(signals.values[:, 0])


def test_midnight_is_no_end(tmp_path) -> None:
    signals = read_clock(tmp_path, (86398 + EVEN) % 86400)
    assert (signals.n_frames, signals.gaps, get_notes(signals)) == (400, (), ())
    assert signals.provenance.clock.time([1.0, 3.0]).tolist() == [86399, 1]


def test_clocks_that_count_milliseconds(tmp_path) -> None:
    signals = read_clock(tmp_path, np.floor(np.arange(2000) / 0.12) / 1000)
    assert signals.fps == pytest.approx(120, rel=1e-3)


def test_rows_without_a_time_are_left_out(tmp_path) -> None:
    rows = "".join(f"{'' if 10 <= i < 14 else i / 50},{i}\n" for i in range(60))
    signals = read(write(tmp_path, "a.csv", "time,a\n" + rows))
    assert (signals.fps, signals.n_frames, signals.gaps) == (50, 60, ())
    assert signals.values[:, 0].tolist() == pytest.approx([*range(60)])
    assert "4 rows without a time left out" in get_notes(signals)


def test_rows_in_no_order_of_time_are_sorted(tmp_path) -> None:
    order = np.random.default_rng(0).permutation(400)
    with pytest.warns(KinemeWarning, match="not in order of time: sorted"):
        signals = read_clock(tmp_path, EVEN[order])
    assert signals.values[:, 0].tolist() == np.argsort(order).tolist()


@settings(deadline=None)
@given(st.lists(st.floats(-1e4, 1e4, width=32), min_size=2, max_size=30), st.booleans())
def test_any_clock_is_read_or_refused(tmp_path_factory, times, ascending) -> None:
    at = np.array(sorted(times) if ascending else times)
    with suppress(ReadError), warnings.catch_warnings():
        warnings.simplefilter("ignore", KinemeWarning)
        signals = read_clock(tmp_path_factory.getbasetemp(), at)
        assert 0 <= signals.values.min() <= signals.values.max() <= len(times) - 1
        assert np.isfinite(signals.duration)


def test_holes_are_filled_or_split_the_recording(tmp_path) -> None:
    cells = [f"{i},{i}" for i in range(100)]
    cells[10] = "10,"
    cells[40:60] = [f"{i},nan" for i in range(40, 60)]
    signals = read(write(tmp_path, "a.csv", "a,b\n" + "\n".join(cells)), fps=50)
    assert signals.values[10].tolist() == [10, 10]
    assert signals.gaps == ((40, 60),)
    assert signals.provenance.notes == (
        "1 missing value interpolated linearly",
        "1 gap of more than 0.2 s, 20 frames",
    )
    cells[10] = "10,10"
    whole = read(write(tmp_path, "c.csv", "a,b\n" + "\n".join(cells)), fps=50)
    assert whole.provenance.notes == ("1 gap of more than 0.2 s, 20 frames",)
    with pytest.raises(ReadError, match="column 'b' contains no number"):
        read(write(tmp_path, "b.csv", "a,b\n1,\n2,\n"), fps=50, columns=["a", "b"])
    left = read(tmp_path / "b.csv", fps=50)
    assert left.names == ("a",)
    assert left.provenance.notes == ("columns that are not channels: b",)


def test_what_tells_of_the_device_or_the_place_is_no_channel(tmp_path) -> None:
    others = "hand_temperature,Temp (degC),Battery level,lux,HR [bpm],HeartRate,steps,lat,GPS_lon"
    others += ",locationLatitude(WGS84),batteryLevel(R),pedometerNumberOfSteps(N),seq,Speed (m/s)"
    names = f"acc_x,heel_pressure,belt speed,template,{others}"
    rows = ["".join(f"{(i * k) % 7}," for k in range(1, 19)).rstrip(",") for i in range(20)]
    path = write(tmp_path, "a.csv", names + "\n" + "\n".join(rows))
    motion = ("acc_x", "heel_pressure", "belt speed", "template")
    assert read(path, fps=50).names == as_signals(csv.read_csv(path).to_pandas(), fps=50).names
    assert read(path, fps=50).names == motion
    assert read(path, fps=50, columns=["hand_temperature"]).names == ("hand_temperature",)
    alone = write(tmp_path, "b.csv", "heart_rate,count\n70,1\n71,1\n71,2\n")
    assert read(alone, fps=1).names == ("heart_rate",)
    machine = write(tmp_path, "c.csv", "speed,cadence,pressure\n7,1,2\n8,2,2\n")
    assert read(machine, fps=1).names == ("speed", "cadence", "pressure")
    with pytest.raises(ReadError, match="none of its columns is a channel"):
        read(write(tmp_path, "d.csv", "time,label\n0,1\n1,1\n2,2\n"))


@pytest.mark.parametrize("column", ["device", "person_id", "Joint", "sensorName"])
@pytest.mark.parametrize("channels", ["x,y", "head_x,head_y"])
@pytest.mark.parametrize("late", [0, 0.003])
def test_rows_of_several_in_turn_are_refused(tmp_path, column, channels, late) -> None:
    rows = [f"{i // 2 / 50 + late * (i % 2)},{'AB'[i % 2]},{i % 7}.5,0.25\n" for i in range(40)]
    path = write(tmp_path, "a.csv", f"time,{column},{channels}\n" + "".join(rows))
    said = rf"people or devices alternate \(column '{column}': A, B\)"
    with pytest.raises(ReadError, match=said):
        read(path)
    table = csv.read_csv(path)
    parquet.write_table(table, tmp_path / "a.parquet")
    with pytest.raises(ReadError, match=said):
        read(tmp_path / "a.parquet")
    with pytest.raises(ParameterError, match=said):
        as_signals(table.to_pandas())


def test_owners_of_many_successive_rows_are_one_recording(tmp_path) -> None:
    rows = [f"{i / 50},{'AB'[i > 20]},{i % 7}.5,0.25\n" for i in range(40)]
    path = write(tmp_path, "a.csv", "time,device,x,y\n" + "".join(rows))
    assert read(path).n_frames == as_signals(csv.read_csv(path).to_pandas()).n_frames == 40
    steps = [f"{i / 50},{'LR'[i // 10 % 2]},{i % 7}.5,0.25\n" for i in range(200)]
    assert read(write(tmp_path, "c.csv", "time,side,x,y\n" + "".join(steps))).n_frames == 200


@pytest.mark.parametrize(
    ("column", "cells"),
    [
        ("sensor", "01"),  # a foot switch
        ("joint", ["true", "false"]),
        ("track", ["0.5", "2e-3"]),
        ("type", "12"),
        ("side", ["both", "L"]),
        ("source", ["gps", "fused"]),
    ],
)
def test_measurements_and_labels_of_rows_are_no_owners(tmp_path, column, cells) -> None:
    rows = [f"{i / 50},{i % 7}.5,{cells[i % 2]}\n" for i in range(40)]
    path = write(tmp_path, "a.csv", f"time,acc_x,{column}\n" + "".join(rows))
    table = csv.read_csv(path)
    parquet.write_table(table, tmp_path / "a.parquet")
    found = [read(path), read(tmp_path / "a.parquet"), as_signals(table.to_pandas())]
    assert {(each.names[0], each.n_frames) for each in found} == {("acc_x", 40)}


def test_a_table_with_numbers_of_devices_is_read_if_channels_are_requested(tmp_path) -> None:
    rows = [f"{i / 50},{i % 7}.5,{i % 2}\n" for i in range(40)]
    path = write(tmp_path, "a.csv", "time,acc_x,device_id\n" + "".join(rows))
    with pytest.raises(ReadError, match="devices alternate"):
        read(path)
    assert read(path, columns=["acc_x"]).names == ("acc_x",)
    names = write(tmp_path, "b.csv", "time,acc_x,device\n" + "0,1,a\n1,2,b\n" * 9)
    with pytest.raises(ReadError, match="devices alternate"):
        read(names, columns=["acc_x"])


def test_parquet(tmp_path) -> None:
    table = pa.table({"time": [0, 0.5, 1], "a": [1, 2, 3], "who": list("xyz"), "b": [4.0, 5, 6]})
    parquet.write_table(table, tmp_path / "a.parquet")
    signals = read(tmp_path / "a.parquet")
    assert signals.names == ("a", "b")
    assert signals.values.tolist() == [[1, 4], [2, 5], [3, 6]]
    assert signals.fps == 2
    assert signals.provenance.notes == ("columns that are not channels: who",)
    for times in (None, "time"):
        assert as_signals(table, times=times).values.tolist() == signals.values.tolist()
    with pytest.raises(ReadError, match="cannot be read as numbers"):
        read(tmp_path / "a.parquet", columns=["who"])


@pytest.mark.parametrize("kind", ["M8[ns]", "m8[ms]"])
@pytest.mark.parametrize("name", ["time", "recorded_at", "__index_level_0__"])
@pytest.mark.parametrize("channels", [["a", "b"], ["hip_x", "hip_y"]])
def test_the_first_column_of_dates_is_the_clock(tmp_path, kind, name, channels) -> None:
    times = (np.arange(50) * 20 + 1_790_000_000_000).astype("i8").astype(f"{kind[:2]}[ms]")
    columns = {channel: 1 + np.arange(50) % 7 / 9 for channel in channels}
    columns |= {name: times.astype(kind), "uploaded": times[::-1].astype(kind)}
    parquet.write_table(pa.table(columns), tmp_path / "a.parquet")
    recording = read(tmp_path / "a.parquet", unit="m")
    assert (recording.fps, recording.n_frames) == (50, 50)
    found = as_signals(pa.table(columns).to_pandas())
    assert (found.fps, found.names) == (50, tuple(channels))


@pytest.mark.parametrize(
    ("names", "signals"),
    [
        ("time,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z", True),
        ("userAcceleration.x,userAcceleration.y,userAcceleration.z", True),
        ("left_wrist_gyr_x,left_wrist_gyr_y,left_wrist_gyr_z", True),
        ("LinAccX,LinAccY,LinAccZ", True),
        ("biceps,triceps", True),
        ("hip_x,hip_y,hip_z", False),
        ("time,hip_x,hip_y,hip_z,acc_x,acc_y,acc_z", False),
        ("hipX,hipY", False),
    ],
)
def test_sensors_are_told_from_joints(tmp_path, names, signals) -> None:
    assert hold_channels(names.split(",")) is signals
    rows = (",".join("1" for _ in names.split(",")) + "\n") * 2
    recording = read(write(tmp_path, "a.csv", names + "\n" + rows), fps=50, unit="m")
    assert isinstance(recording, Signals) is signals
    asked = read(tmp_path / "a.csv", fps=50, columns=names.split(",")[-1:])
    assert isinstance(asked, Signals)


@pytest.mark.parametrize("options", [{"columns": ["a"]}, {"emg": True}])
def test_what_holds_no_channels_is_not_read_as_such(tmp_path, options) -> None:
    with pytest.raises(ReadError, match="is BVH, which cannot be read as channels"):
        read(bundled_recording(), **options)
    with pytest.raises(ReadError, match="is a DeepLabCut table of joints, which is a motion"):
        read(write(tmp_path, "a.csv", "scorer,DLC,DLC\n"), **options)


def test_a_body_in_a_mat_file_is_told_from_sensors(tmp_path) -> None:
    track = np.cumsum(np.ones((60, 3)), axis=0) / 100
    savemat(tmp_path / "body.mat", {"fps": 50.0, "hip": track, "toe": track + 1})
    savemat(tmp_path / "imu.mat", {"fs": 50.0, "acc": track, "gyro": track})
    assert isinstance(read(tmp_path / "body.mat"), Motion)
    assert read(tmp_path / "imu.mat").names[:3] == ("acc_1", "acc_2", "acc_3")
    assert isinstance(read(tmp_path / "body.mat", columns=["hip_1"]), Signals)


@given(st.text(alphabet="ab,;\t\n 0123456789.-#\"'xyz", max_size=60))
@settings(max_examples=60)
def test_odd_tables_are_read_or_refused(tmp_path_factory, text) -> None:
    path = tmp_path_factory.getbasetemp() / "odd.csv"
    path.write_text("endheader\n" * ("#" in text) + text, encoding="utf-8")
    try:
        with warnings.catch_warnings(action="ignore", category=KinemeWarning):
            signals = read(path, fps=50)
    except FileError:
        return
    assert np.isfinite(signals.values).all()


def test_real_channels(data_dir) -> None:
    mot = read(data_dir / "formats" / "subject01_walk_IK.mot")
    assert (mot.n_frames, mot.n_channels, mot.fps) == (151, 10, 60)
    plates = read(data_dir / "formats" / "Eb015pi.c3d", columns=())
    assert (plates.names[:3], plates.fps) == (("FX1", "FY1", "FZ1"), 200)
    assert plates.values.shape == (1800, 16)
    with pytest.raises(ReadError, match=r"which analog .* muscles.* FX1, .*, CH15, CH16"):
        read(data_dir / "formats" / "Eb015pr.c3d", emg=True)
    with pytest.raises(ReadError, match="holds no analog channels"):
        read(data_dir / "cmu_formats" / "02_01.c3d", columns=())


def test_columns_are_chosen_by_wildcards(tmp_path) -> None:
    text = "time,acc_x,label,ACC_y,gyr_x,a*\n" + "".join(
        f"{i / 10},{i % 3},walk,{i % 5},{i % 7},1\n" for i in range(30)
    )
    path = write(tmp_path, "a.csv", text)
    assert read(path, columns=["acc_*"]).names == ("acc_x", "ACC_y")
    assert read(path, columns=["gyr_x", "*_?"]).names == ("gyr_x", "acc_x", "ACC_y")
    assert read(path, columns=["*"]).names == ("acc_x", "ACC_y", "gyr_x", "a*")
    assert read(path, columns=["a*"]).names == ("a*",)  # a column of that very name
    with pytest.raises(ReadError, match=r"no column 'emg\*'; there are time, acc_x"):
        read(path, columns=["emg*"])
