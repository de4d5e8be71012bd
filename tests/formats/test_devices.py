"""Device exports: header lines, clocks with their own names, dates."""

from __future__ import annotations

import json
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest
from marker_samples import to_c3d

import kineme
from kineme.errors import KinemeWarning, ReadError
from kineme.formats.dialects import DIALECTS, Dialect
from kineme.recordings.times import parse_date
from reading import read

N, FPS = 300, 50
VALUES = np.round(np.sin(np.arange(N)[:, None] / [7, 5, 3]), 4)
START = datetime(2026, 5, 7, 23, 59, 57, tzinfo=UTC)
ACTIGRAPH = (
    "------------ Data File Created By ActiGraph GT3X+ ActiLife v6.13.3 Firmware v2.5.0 "
    "date format M/d/yyyy at 50 Hz  Filter Normal -----------\nSerial Number: NEO1F18120387\n"
    "Start Time 00:00:00\nEpoch Period (hh:mm:ss) 00:00:00\n---------------------\n"
)
GENEACTIV = (
    "Device Type,GENEActiv\r\nDevice Model,1.1\r\nDevice Unique Serial Code,046164\r\n\r\n"
    "Calibration Date,2017-11-23 11:45:28:000\r\nMeasurement Frequency,50.0 Hz\r\nLast,\r\n\r\n"
)


def join_rows(separator: str, *first: object, end: str = "") -> str:
    """A line per row; ``first`` are the formats of the cells before the values."""
    lines = []
    for i, values in enumerate(VALUES.tolist()):
        at = START + timedelta(seconds=i / FPS)
        cells = [each(i, at) if callable(each) else each for each in first]
        lines.append(separator.join(map(str, [*cells, *values])) + end)
    return "\n".join(lines) + "\n"


def to_dates(pattern: str):
    return lambda _, at: at.strftime(pattern).replace("%3f", f"{at.microsecond // 1000:03}")


def to_counts(step: float, start: float = 0):
    return lambda i, _: f"{start + step * i:.10g}" if step < 1 else int(start + step * i)


HEADER = {
    "sensor": ["EMG", "RAW", "RAW"],
    "label": ["A1", "A2", "A3"],
    "column": ["nSeq", "I1", "A1", "A2", "A3"],
    "sampling rate": FPS,
}
FILES = {
    "ActiGraph": ACTIGRAPH + "Accelerometer X,Accelerometer Y,Accelerometer Z\n" + join_rows(","),
    "ActiGraph without names": ACTIGRAPH + join_rows(","),
    "ActiGraph with times": ACTIGRAPH
    + "Timestamp,X,Y,Z\n"
    + join_rows(",", to_dates("%m/%d/%Y %H:%M:%S.%3f")),
    "GENEActiv": GENEACTIV + join_rows(",", to_dates("%Y-%m-%d %H:%M:%S:%3f")),
    "Axivity": join_rows(",", to_dates("%Y-%m-%d %H:%M:%S.%3f")),
    "Shimmer": '"sep=\t"\nS_Timestamp_Unix_CAL\tS_X_CAL\tS_Y_CAL\tS_Z_CAL\t\nms\tg\tg\tg\t\n'
    + join_rows("\t", to_counts(20, 1.6e12), end="\t"),
    "Shimmer in four lines": "Shimmer\tShimmer\tShimmer\tShimmer\nTimestamp\tX\tY\tZ\n"
    "CAL\tCAL\tCAL\tCAL\nms\tg\tg\tg\n" + join_rows("\t", to_counts(20)),
    "Xsens DOT": "sep=,\nDeviceTag:,left\nOutputRate:,50Hz\n\nPacketCounter,SampleTimeFine,X,Y,Z\n"
    + join_rows(",", to_counts(1), to_counts(20_000, 2**31)),
    "Xsens MTw": "// Start Time: Unknown\n// Update Rate: 50.0Hz\n// Option Flags: none\n"
    "PacketCounter\tSampleTimeFine\tX\tY\tZ\n" + join_rows("\t", to_counts(1), "", end="\t"),
    "Empatica": ", ".join(["1419261264.000000"] * 3)
    + "\n"
    + ", ".join(["50.000000"] * 3)
    + "\n"
    + join_rows(","),
    "OpenSignals": "# OpenSignals Text File Format. Version 1\n# "
    + json.dumps({"98:D3:31": HEADER})
    + "\n# EndOfHeader\n"
    + join_rows("\t", lambda i, _: i % 16, lambda *_: 1, end="\t"),
    "Sensor Logger": "time,seconds_elapsed,X,Y,Z\n"
    + join_rows(",", to_counts(20_000_000, 1_670_000_000_000_000_000), to_counts(0.02)),
    "phyphox": '"Time (s)";"X (m/s^2)";"Y (m/s^2)";"Z (m/s^2)"\n'
    + join_rows(";", to_counts(0.02)).replace(".", ","),
    "BioStamp": "Timestamp (microseconds),Accel X (g),Accel Y (g),Accel Z (g)\n"
    + join_rows(",", to_counts(20_000, 1_500_000_000_000_000)),
    "MetaMotion": "epoc (ms),timestamp (+0100),elapsed (s),x-axis (g),y-axis (g),z-axis (g)\n"
    + join_rows(",", to_counts(20, 1.5e12), to_dates("%Y-%m-%dT%H.%M.%S.%3f"), to_counts(0.02)),
    "Movella DOT": "DeviceTag:,left\nOutputRate:,50Hz\n\n"
    "PacketCounter,SampleTimeFine,X,Y,Z,Status\n"
    + join_rows(",", to_counts(1), to_counts(20_000, 2**31), end=",0"),
    "Delsys": "X[s],biceps: EMG 1 [Volts],triceps: EMG 2 [Volts],ACC X 1 [g]\n"
    + join_rows(",", to_counts(0.02)),
    "SensorLog": "loggingTime(txt);loggingSample(N);X(G);Y(G);Z(G)\n"
    + join_rows(";", to_dates("%Y-%m-%dT%H:%M:%S.%3f+01:00"), to_counts(1)),
    "SensorLog of one sensor": "sensorTimestamp_sinceReboot(s),X,Y,Z\n"
    + join_rows(",", to_counts(0.02)),
    "a clock under its own name": "deviceTime [ms],X,Y,Z\n" + join_rows(",", to_counts(20, 7e6)),
    "German dates": "Zeit\tX\tY\tZ\n" + join_rows("\t", to_dates("%d.%m.%Y %H:%M:%S.%3f")),
    "months by name": "Timestamp,X,Y,Z\n" + join_rows(",", to_dates("%d-%b-%Y %H:%M:%S.%3f")),
    "twelve hours": "Timestamp,X,Y,Z\n" + join_rows(",", to_dates("%m/%d/%Y %I:%M:%S.%3f %p")),
    "units below": "time\tX\tY\tZ\nms\tg\tg\tg\n" + join_rows("\t", to_counts(20)),
}


@pytest.mark.parametrize("device", FILES)
def test_channels_and_rate_of_a_device_are_read_without_options(
    tmp_path: Path, device: str
) -> None:
    signals = read(tmp_path, "a.csv", FILES[device])
    assert (signals.fps, signals.gaps) == (FPS, ())
    assert np.array_equal(signals.values, VALUES)
    # Rate, rows and names of a chosen column are those of reading all of them.
    chosen = read(tmp_path, "a.csv", FILES[device], columns=signals.names[-1:])
    assert (chosen.names, chosen.fps) == (signals.names[-1:], FPS)
    assert np.array_equal(chosen.values, VALUES[:, 2:])


@pytest.mark.parametrize(
    ("device", "names"),
    {
        "ActiGraph without names": ["Accelerometer X", "Accelerometer Y", "Accelerometer Z"],
        "GENEActiv": ["x", "y", "z"],
        "Axivity": ["x", "y", "z"],
        "OpenSignals": ["A1 EMG", "A2", "A3"],
    }.items(),
)
def test_a_device_names_the_columns_of_rows_without_names(
    tmp_path: Path, device: str, names: list[str]
) -> None:
    signals = read(tmp_path, "a.csv", FILES[device])
    assert list(signals.names) == names
    assert f"read as {device.split()[0]} writes it" in signals.provenance.notes


def test_counters_and_clocks_of_a_device_are_channels_only_where_asked_for(tmp_path: Path) -> None:
    counted = read(tmp_path, "a.csv", FILES["Movella DOT"], columns=["PacketCounter", "X"])
    assert (counted.names, counted.fps) == (("PacketCounter", "X"), FPS)
    with pytest.raises(ReadError, match="no column '1'; there are nSeq, I1, A1 EMG, A2, A3"):
        read(tmp_path, "a.csv", FILES["OpenSignals"], columns=["1"])


def test_two_devices_of_opensignals_keep_their_sensors(tmp_path: Path) -> None:
    first = {**HEADER, "column": ["nSeq", "A1"], "label": ["A1"], "sensor": ["EMG"]}
    second = {**HEADER, "column": ["nSeq", "A1"], "label": ["A1"], "sensor": ["EDA"]}
    text = (
        "# OpenSignals Text File Format. Version 1\n# "
        + json.dumps({"98:D3:31": first, "98:D3:32": second})
        + "\n# EndOfHeader\n"
        + "".join(f"{i % 16}\t{i % 7}\t{i % 16}\t{-(i % 5)}\n" for i in range(200))
    )
    signals = read(tmp_path, "a.csv", text)
    assert signals.names == ("A1 EMG", "A1 EDA")
    assert signals.values[9].tolist() == [2, -4]


def test_counts_of_actigraph_have_the_rate_of_their_epochs(tmp_path: Path) -> None:
    header = ACTIGRAPH.replace("00:00:00\n--", "00:00:05\n--")
    assert read(tmp_path, "a.csv", header + "Axis1,Axis2,Axis3\n" + join_rows(",")).fps == 0.2


def test_signals_of_two_shimmers_are_told_apart(tmp_path: Path) -> None:
    text = (
        "Shimmer 1\tShimmer 1\tShimmer 2\tShimmer 2\nTimestamp\tX\tTimestamp\tX\n"
        "CAL\tCAL\tCAL\tCAL\nms\tg\tms\tg\n"
    )
    lines = "".join(f"{20 * i}\t{i % 7}\t{20 * i}\t{i % 5}\n" for i in range(N))
    signals = read(tmp_path, "a.csv", text + lines)
    assert (signals.names, signals.fps) == (("Shimmer 1 X", "Shimmer 2 X"), FPS)


DISCOVER = (
    "Application:,Trigno Discover (1.7.0)\nCollection Length (seconds):,6\n"
    "biceps (81201),,,,triceps (81202),\nsensor mode: 50,,,,sensor mode: 40,\n"
    "EMG 1 Time Series (s),EMG 1 (mV),ACC X Time Series (s),ACC X (G),EMG 1 Time Series (s),"
    "EMG 1 (mV)\n,50 Hz,,10 Hz,,50 Hz\n,,,,,\n"
)


def test_channels_of_delsys_have_rates_of_their_own(tmp_path: Path) -> None:
    lines = [
        f"{i / 50},{a},{f'{i / 10},{i}' if i < N // 5 else ','},{i / 50},{b}\n"
        for i, (a, b, _) in enumerate(VALUES.tolist())
    ]
    signals = read(tmp_path, "a.csv", DISCOVER + "".join(lines))
    muscles = ("biceps EMG 1 (mV)", "triceps EMG 1 (mV)")
    assert (signals.names, signals.fps) == ((muscles[0], "biceps ACC X (G)", muscles[1]), FPS)
    assert np.array_equal(signals.values[:, [0, 2]], VALUES[:, :2])
    assert signals.values[:296, 1] == pytest.approx(np.arange(296) / 5)  # a fifth of the rate
    assert "1 slower channel interpolated" in signals.provenance.notes
    assert read(tmp_path, "a.csv", DISCOVER + "".join(lines), emg=True).names == muscles
    (slow,) = read(tmp_path, "a.csv", DISCOVER + "".join(lines), columns=["*acc*"]).names
    assert slow == "biceps ACC X (G)"


@pytest.fixture
def my_watch() -> Iterator[None]:
    """A dialect of somebody's that gives signals: in halves, at ticks of 20 ms."""

    def recognises(names, lines):
        return names[0] == "MyWatch"

    def read_watch(table, options):
        values = [[float(cell) / 2 for cell in row.split(",")] for row in table.lines[2:]]
        source = table.content.provenance("MyWatch", [])
        return kineme.Signals(values, options.fps or FPS, ["x", "y"], provenance=source)

    DIALECTS.register(Dialect("MyWatch", recognises, read_watch))
    yield
    DIALECTS.remove("MyWatch")


@pytest.mark.usefixtures("my_watch")
def test_columns_are_chosen_from_signals_that_a_dialect_reads(tmp_path: Path) -> None:
    text = "MyWatch,3\nhalves,of\n2,4\n6,8\n"
    assert read(tmp_path, "a.csv", text).values.tolist() == [[1, 2], [3, 4]]
    assert read(tmp_path, "a.csv", text, emg=True).names == ("x", "y")
    for columns in (["y"], ["Y*"]):
        chosen = read(tmp_path, "a.csv", text, columns=columns, fps=10)
        assert (chosen.names, chosen.fps, chosen.values.tolist()) == (("y",), 10, [[2], [4]])
    with pytest.raises(ReadError, match="no column 'z'; there are x, y"):
        read(tmp_path, "a.csv", text, columns=["z"])


def test_a_rate_that_the_header_tells_is_said(tmp_path: Path) -> None:
    signals = read(tmp_path, "a.csv", FILES["ActiGraph"])
    assert "50 Hz, from a line above the columns" in signals.provenance.notes
    assert "5 lines above the names skipped" in signals.provenance.notes


def test_the_file_of_a_wristband_tells_what_its_columns_are(tmp_path: Path) -> None:
    path = tmp_path / "BVP.csv"
    path.write_text("1419261264.00\n64.000000\n" + "\n".join(map(str, VALUES[:, 0])) + "\n")
    pulse = kineme.read(path)
    assert (pulse.names, pulse.fps) == (("bvp",), 64.0)
    assert np.array_equal(pulse.values[:, 0], VALUES[:, 0])


def test_a_rate_is_not_guessed_from_several(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="it does not state its frame rate"):
        read(tmp_path, "a.csv", "EMG rate: 2000 Hz\nAcc rate: 100 Hz\nX,Y,Z\n" + join_rows(","))


def test_the_frequency_of_a_filter_is_no_rate(tmp_path: Path) -> None:
    text = "Low-pass: 6 Hz\nSampling frequency (Hz): 50\nX,Y,Z\n" + join_rows(",")
    assert read(tmp_path, "a.csv", text).fps == FPS


def test_a_day_that_could_be_a_month_is_said(tmp_path: Path) -> None:
    text = "Timestamp,X,Y,Z\n" + join_rows(",", to_dates("%d/%m/%Y %H:%M:%S.%3f"))
    with pytest.warns(KinemeWarning, match="1 pause, the first of 2.592e"):  # a month, so read
        signals = read(tmp_path, "a.csv", text)
    (said,) = [note for note in signals.provenance.notes if "taken for" in note]
    assert said == "'07/05/2026 23:59:57.000' is taken for 5 July 2026"


def test_one_day_beyond_the_twelfth_tells_the_order(tmp_path: Path) -> None:
    """A night from the 12th to the 13th goes on, without a jump of months."""
    times = [datetime(2026, 5, 12, 23, 59, 0, tzinfo=UTC) + timedelta(seconds=i) for i in range(90)]
    lines = [f"{at:%d/%m/%Y %H:%M:%S},{i % 7}" for i, at in enumerate(times)]
    signals = read(tmp_path, "a.csv", "Timestamp,X\n" + "\n".join(lines) + "\n")
    assert (signals.fps, signals.gaps, signals.provenance.notes) == (1, (), ())


def test_a_c3d_without_points_holds_channels(tmp_path: Path) -> None:
    analog = np.random.default_rng(0).standard_normal((60, 4, 3))
    (tmp_path / "a.c3d").write_bytes(to_c3d(np.empty((60, 0, 3)), [], analog=analog))
    signals = kineme.read(tmp_path / "a.c3d")
    assert isinstance(signals, kineme.Signals)
    assert (signals.names, signals.fps) == (("emg0", "emg1", "emg2"), 400)
    assert np.allclose(signals.values, analog.reshape(-1, 3), atol=1e-6)


def test_names_in_two_lines(tmp_path: Path) -> None:
    """As pandas writes columns of two levels."""
    lines = "".join(f"{i},{i % 7 + 1},{i % 5},{i % 3}\n" for i in range(N))
    signals = read(tmp_path, "a.csv", ",left,left,right\n,acc_x,gyr_x,acc_x\n" + lines, fps=FPS)
    assert signals.names == ("left_acc_x", "left_gyr_x", "right_acc_x")
    assert signals.provenance.notes == ("columns that are not channels: (no name)",)
    toes = read(tmp_path, "a.csv", "frame,L_TOE,L_TOE,L_TOE\n,x,y,z\n" + lines, fps=FPS, unit="mm")
    assert "L_TOE" in toes.skeleton.names


def test_a_leap_second(tmp_path: Path) -> None:
    assert parse_date("2016-12-31T23:59:60.5Z") == parse_date("2017-01-01T00:00:00.5Z")
    assert parse_date("23:59:60") == 86400
    assert parse_date("T09:30:00") == parse_date("09:30:00") == 34200
    with pytest.raises(ValueError, match="is not an ISO date"):
        parse_date("23:59:61")
    seconds = [58.0, 58.5, 59.0, 59.5, 60.0, 60.5]
    rows = "".join(f"2016-12-31T23:59:{second:04.1f}Z,{i}.5\n" for i, second in enumerate(seconds))
    (tmp_path / "a.csv").write_text("time,acc_x\n" + rows)
    found = kineme.read(tmp_path / "a.csv")
    assert (found.fps, found.n_frames, found.gaps) == (2, 6, ())


XSENS = "// Update Rate: 100.0Hz\nPacketCounter\tSampleTimeFine\tUTC_Second\tAcc_X\tGyr_X\n"


@pytest.mark.parametrize("clock", ["\t", "{i}00\t5"])
def test_xsens_takes_the_rate_of_its_header(tmp_path: Path, clock: str) -> None:
    rows = (f"{i:05}\t{clock.format(i=i)}\t{i % 7}.5\t{i % 5}.5\n" for i in range(300))
    text = XSENS + "".join(rows)
    for options, names in (({}, ("Acc_X", "Gyr_X")), ({"columns": ["Gyr_X"]}, ("Gyr_X",))):
        signals = read(tmp_path, "a.csv", text, **options)
        assert (signals.fps, signals.names) == (100, names)


@pytest.mark.parametrize(("order", "first"), [("dd/MM/yyyy", 1733875200), ("M/d/yyyy", 1731369600)])
def test_actigraph_dates_are_in_the_order_of_its_header(
    tmp_path: Path, order: str, first: int
) -> None:
    head = f"--- Data File Created By ActiGraph LEAP date format {order} at 32 Hz ---\nSerial: 1\n"
    rows = (f"11/12/2024 00:00:{i / 32:06.3f},{i % 3}.5,{i % 5}.5\n" for i in range(320))
    text = head + "Timestamp,Accelerometer X,Accelerometer Y\n" + "".join(rows)
    signals = read(tmp_path, "a.csv", text, columns=["Accelerometer *"])
    assert signals.fps == 32
    assert signals.provenance.clock is not None
    assert signals.provenance.clock.times[0] == first
