"""Rows from lines of text, LSL and OSC, each with the real thing."""

from __future__ import annotations

import socket
from itertools import chain, repeat
from threading import Thread
from time import sleep

import numpy as np
import pytest

from kineme.errors import ParameterError
from kineme.live.sources import measure_rate, read_lines, receive_lsl, receive_osc, replay
from kineme.recordings import Signals


def join(rows, name: str = "values") -> np.ndarray:
    return np.concatenate([getattr(each, name) for each in rows])


WRONG_LINES = [
    ["time_ms,x,y\n", "0,1,2\n", "\n", "20,3,\n", "40,5\n", "sixty,5,6\n"],
    ['{"time_ms": 0, "x": 1, "y": 2}', '{"time_ms": 20, "x": 3, "z": 1}', "[1]", "{"],
]
TEXTS_AND_COUNTERS = [
    ["time_ms,x,index,note,y\n", "ms,g,,,g\n", "0,1,1,a,2\n", "20,3,2,b,\n"],
    ["time_ms;x;index;note;y\n", "0;1,0;1;a;2,0\n", "20;3,0;2;b;\n"],
    [
        '{"time_ms": 0, "x": 1, "y": 2, "note": "a", "index": 1}',
        '{"time_ms": 20, "x": 3, "y": null, "note": "b"}',
    ],
]


@pytest.mark.parametrize(
    ("lines", "remarks"),
    [
        *((lines, ["2 lines left out: not a row of 3 cells"]) for lines in WRONG_LINES),
        *((lines, ["note", "index"]) for lines in TEXTS_AND_COUNTERS),
    ],
)
def test_lines_are_rows_with_times(lines, remarks):
    source = read_lines(lines)
    assert source.channels == ("x", "y")
    rows = list(source.rows)
    np.testing.assert_array_equal(join(rows, "values"), [[1, 2], [3, np.nan]])
    np.testing.assert_allclose(join(rows, "seconds"), [0, 0.02])
    said = " ".join(chain.from_iterable(each.remarks for each in rows))
    assert all(remark in said for remark in remarks)


def test_a_channel_may_begin_with_a_missing_value():
    source = read_lines(["time,a,b\n", "0,1,NA\n", "1,2,-\n", "2,3,4\n"])
    np.testing.assert_array_equal(join(source.rows), [[1, np.nan], [2, np.nan], [3, 4]])


def test_a_heart_rate_alone_is_a_channel():
    assert read_lines(["time,note,heart_rate\n", "0,a,70\n"]).channels == ("heart_rate",)


def test_rows_that_never_fit_the_names_are_refused():
    with pytest.raises(ParameterError, match="rows have 3 cells, but the first line has 2"):
        read_lines(chain(["a,b\n"], repeat("1,2,\n")))


def test_nested_json_becomes_channels():
    source = read_lines(['{"t": 0, "acc": {"x": 1, "y": 2}, "gyro": [3, 4]}'])
    assert source.channels == ("acc_x", "acc_y", "gyro_1", "gyro_2")
    np.testing.assert_array_equal(next(source.rows).values, [[1, 2, 3, 4]])


@pytest.mark.parametrize(("step", "start", "fps"), [(25, 8.1e7, 0), (25, 8.1e7, 40), (0.025, 0, 0)])
def test_times_of_a_source_become_seconds_and_tell_its_rate(step, start, fps):
    lines = [f"{start + step * i},{i}\n" for i in range(60)]
    source = measure_rate(read_lines(["t,x\n", *lines]), fps)
    assert source.fps == pytest.approx(40)
    np.testing.assert_allclose(np.diff(join(source.rows, "seconds")), np.full(59, 0.025))


def test_lines_without_names_and_chosen_columns():
    assert read_lines(["1.5,2\n", "3,4\n"]).channels == ("1", "2")
    source = read_lines(["acc_x,acc_y,pulse\n", "1,2,3\n"], ["acc_*"])
    assert source.channels == ("acc_x", "acc_y")
    with pytest.raises(ParameterError, match="--fps"):
        measure_rate(source)


def test_gaps_of_a_recording_are_replayed_as_nothing():
    source = replay(Signals(np.ones((50, 1)), 10.0, gaps=[(10, 20)]), speed=0)
    values = join(source.rows)
    assert np.isnan(values[:, 0]).nonzero()[0].tolist() == list(range(10, 20))


def test_lsl():
    pylsl = pytest.importorskip("pylsl")
    info = pylsl.StreamInfo("kineme-test", "IMU", 2, 100, "double64", "kineme-test")
    channels = info.desc().append_child("channels")
    for name in ("x", "y"):
        channels.append_child("channel").append_child_value("label", name)
    outlet = pylsl.StreamOutlet(info)
    source = receive_lsl("kineme-test")
    assert (source.fps, source.channels) == (100.0, ("x", "y"))
    next(source.rows)  # opens the connection
    outlet.wait_for_consumers(5)
    outlet.push_chunk([[1.0, 2.0], [3.0, 4.0]])
    got = next(each for each in source.rows if len(each.values))
    np.testing.assert_array_equal(got.values, [[1, 2], [3, 4]][: len(got.values)])


def test_osc_and_vmc():
    client = pytest.importorskip("pythonosc.udp_client")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]

    def send() -> None:
        sleep(0.3)
        with client.SimpleUDPClient("127.0.0.1", port) as sender:
            for i in range(20):
                for bone in ("Hips", "Head"):
                    pose = [bone, 0.0, 1.0, 0.0, float(i), 0.0, 0.0, 1.0]
                    sender.send_message("/VMC/Ext/Bone/Pos", pose)
                sender.send_message("/VMC/Ext/T", 0.1 * i)
                sleep(0.01)

    thread = Thread(target=send)
    thread.start()
    source = receive_osc(port)
    assert source.channels == tuple(f"Pos_{b}_{i}" for b in ("Hips", "Head") for i in range(1, 5))
    got = next(each for each in source.rows if len(each.values))
    assert got.values[0, 0] == got.values[0, 4] >= 1
    source.rows.close()
    thread.join()


def test_a_first_line_of_damaged_json_is_refused() -> None:
    with pytest.raises(ParameterError, match="first line is not complete JSON"):
        read_lines(['{"time_ms": 0, "x"'])
