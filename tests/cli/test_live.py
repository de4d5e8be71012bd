"""``kineme live``: from lines to events, tables and recordings."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys

import numpy as np
import pytest

import kineme as package
from kineme.cli.live import describe
from kineme.live.events import ActivityEnded
from streams import FPS, two_exercises


@pytest.fixture(scope="module")
def lines():
    rows = two_exercises(8.0)[: int(16 * FPS)]
    times = 81_000_000 + 1000 * np.arange(len(rows)) / FPS
    return "t,x,y,note\n" + "".join(
        f"{t:.0f},{x:.4f},{y:.4f},easy\n" for t, (x, y) in zip(times, rows, strict=True)
    )


def test_lines_become_events_a_table_and_a_recording(kineme, lines, tmp_path):
    options = ("--json", "--output", "segments.csv", "--record", "take")
    remark = "skipped: columns that are not channels: note\n"
    done = kineme("live", *options, text=lines, errors=remark)
    events = [json.loads(line) for line in done.stdout.splitlines()]
    final = [e for e in events if e["event"] == "ActivityStarted" and e["state"] == "final"]
    rows = package.read_segments(tmp_path / "segments.csv").activities
    assert [e["start_s"] for e in final] == [round(row.start_s, 4) for row in rows]
    recording = package.read(tmp_path / "take.parquet")
    assert (recording.n_frames, recording.fps) == (16 * FPS, FPS)


@pytest.mark.parametrize("own_lines", [False, True])
def test_a_slow_channel_makes_no_gaps(kineme, own_lines):
    rows = two_exercises(8.0)[: int(16 * FPS)]
    lines = [{"t_s": i / FPS, "x": x, "y": y} for i, (x, y) in enumerate(rows.tolist())]
    lines[0]["pulse"] = 60
    for second in range(1, 16):
        row = lines[int(second * FPS)]
        if own_lines:
            lines.append({"t_s": row["t_s"] + 0.004, "pulse": 60 + second})
        else:
            row["pulse"] = 60 + second
    text = "".join(f"{json.dumps(line)}\n" for line in sorted(lines, key=lambda line: line["t_s"]))
    done = kineme("live", "--json", text=text)
    events = [json.loads(line) for line in done.stdout.splitlines()]
    assert not [event for event in events if event["event"] == "Gap"]
    assert [e["event"] for e in events if e["state"] == "final"].count("Repetition") > 4


def test_a_killed_run_is_recovered(kineme, lines, tmp_path):
    options = ["--quiet", "--fps", str(FPS), "--record", str(tmp_path / "take")]
    command = [sys.executable, "-m", "kineme", "live", *options]
    with subprocess.Popen(command, stdin=subprocess.PIPE, text=True) as process:
        process.stdin.write(lines)
        process.stdin.flush()
        journal = tmp_path / "take.journal.csv"
        while not journal.exists() or len(journal.read_text().splitlines()) < 16 * FPS + 1:
            assert process.poll() is None
        os.kill(process.pid, signal.SIGKILL)
    kineme("live", "--recover", journal)
    assert package.read(tmp_path / "take.parquet").n_frames == 16 * FPS


@pytest.mark.parametrize(
    ("options", "text", "code", "advice"),
    [
        ([], "", 1, "no lines received"),
        ([], "x\n1\n", 1, "give --fps"),
        (["--fps", "0"], "x\n1\n", 2, "above 0"),
        (["--recover", "nowhere.journal.csv"], "", 1, "nowhere"),
        (["--replay", "a.csv", "--osc", "9000"], "", 2, "one source"),
        (["--fps", "50", "--osc-out", "9000"], "x\n1\n", 1, "HOST:PORT"),
    ],
)
def test_what_makes_no_sense_is_said_in_a_sentence(kineme, options, text, code, advice):
    done = kineme("live", *options, text=text, code=code)
    assert advice in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(("count", "text"), [(1, "1 repetition"), (2, "2 repetitions")])
def test_the_end_of_an_activity_counts_its_repetitions(count: int, text: str) -> None:
    event = ActivityEnded(at_s=9.0, start_s=2.0, stop_s=8.0, cluster=0, repetitions=count)
    assert describe(event).endswith(f"cluster 0 ends, {text}")
